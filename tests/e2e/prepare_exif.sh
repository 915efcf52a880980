#!/bin/bash
# EXIF that tells one exposure of photographs that differ by stops, as that of copies may: it is said, and exposures are
# estimated from the pictures. With a list of the true ones nothing is amiss.
# Exposures that the pictures do not show are no bracket.
. "$2/tests/e2e/prepare_lib"
monument 320x240 9 --exposures -1.5,0,1.5

# Gives all photographs the EXIF of the first, whose camera has a name that is not UTF-8.
python3 - "$work"/p/*.jpg <<'PY' || fail "EXIF was not copied"
import sys

def exif(data):
    """Where the segment APP1 of a JPEG begins and ends."""
    at = 2
    while data[at + 1] != 0xE1:
        at += 2 + int.from_bytes(data[at + 2:at + 4], "big")
    return at, at + 2 + int.from_bytes(data[at + 2:at + 4], "big")

first = None
for name in sys.argv[1:]:
    with open(name, "rb+") as file:
        data = file.read()
        start, end = exif(data)
        first = first or data[start:end].replace(b"synthetic", b"synth\xe9tic")
        file.seek(0)
        file.write(data[:start] + first + data[end:])
        file.truncate()
PY

lies="do not fit the pictures, which differ from them by more than a stop"
prepare=(prepare "$work/p" --out "$work/s" --quality draft --max-size 128)
run 0 "${prepare[@]}"
says "the exposures that EXIF tells $lies"
says "--exposures FILE takes a list"
# evs WORDS: exposures are from there, and most steps of the series are those that were taken.
evs() {
    jq -e --arg from "$1" '[.photographs[] | select(.exposure_from == $from) | .exposure_ev] | length == 9 and
        ([range(0; 9; 3) as $i | .[$i + 1] - .[$i], .[$i + 2] - .[$i + 1] | select(. > 1.2 and . < 1.8)] | length >= 4)' \
        "$work/s/scene.json" >"$work/jq" ||
        fail "exposures are not from the $1: $(jq -c '[.photographs[] | [.exposure_from, .exposure_ev]]' "$work/s/scene.json")"
}
evs scene

# A list of one photograph, which says of it what EXIF does. It is kept while the exposures of the others are estimated.
one=("$work"/p/*.jpg)
echo "$(basename "${one[0]}"),0.00141421,8,100" >"$work/one"
run 0 "${prepare[@]}" --resume --exposures "$work/one"
says "the exposures that EXIF tells $lies"
jq -e '[.photographs[].exposure_from] | .[0] == "list" and (.[1:] | all(. == "scene"))' "$work/s/scene.json" \
    >"$work/jq" || fail "the listed exposure is not kept: $(jq -c '[.photographs[].exposure_from]' "$work/s/scene.json")"

set -- -1.5 0 1.5
for photo in "$work"/p/*.jpg; do
    echo "$(basename "$photo"),$1"
    set -- "$2" "$3" "$1"
done >"$work/list"
run 0 "${prepare[@]}" --resume --exposures "$work/list"
grep -qF "$lies" "$work/err" && fail "a list that fits the pictures is taken for wrong"
evs list
# series COUNT: of the photographs, by scene.json.
series() {
    jq -e --argjson count "$1" '.stages.expose.series == $count and ([.photographs[].series] | unique | length) == $count' \
        "$work/s/scene.json" >"$work/jq" || fail "not $1 series: $(jq -c '[.photographs[].series]' "$work/s/scene.json")"
}
series 3

# The scene has each response curve that its photographs name.
run 0 "${prepare[@]}" --resume --exposures "$work/list" --response debevec
jq -e '(.responses | length) == ([.photographs[].response // empty] | unique | length)' "$work/s/scene.json" \
    >"$work/jq" || fail "response curves are missing"
run 0 info "$work/s"

# Pictures of more exposure that are not brighter, as where a camera meters by itself, are no bracket.
sed -i 's/,-1.5$/,x/; s/,1.5$/,-1.5/; s/,0$/,1.5/; s/,x$/,0/' "$work/list"
run 0 "${prepare[@]}" --resume --exposures "$work/list"
says "the camera chose the exposures by itself"
series 1
finish
