#!/usr/bin/env bash
# The same cameras as other programs write them give the same picture: write_cameras.py writes a synthetic
# scene's true cameras in each format, and a plane that photographs are projected on is drawn from one of them.
. "$2/tests/e2e/command_lib"

command -v python3 >/dev/null || { echo "skipped: python3 is not here"; exit 77; }
runs 0 "$oriel" synth monument --out photos --size 96x64 --count 6
printf 'v -30 0 -30\nv 30 0 -30\nv 30 0 30\nv -30 0 30\nf 1 2 3 4\n' >plane.obj
python3 "$source/tests/e2e/write_cameras.py" photos-truth/cameras.json photos sets || fail "no sets are written"

# view SCENE PHOTOGRAPH OUT
view() { runs 0 "$oriel" render "$1" --at "$2" --method ulr --set proxy=mesh --out "$3"; }
above() { awk -v a="$1" -v b="$2" 'BEGIN { exit !(a + 0 > b) }'; }

runs 0 "$oriel" import photos-truth/cameras.json --images photos --mesh plane.obj --out truth
view truth 0003.jpg truth.png
view truth 0004.jpg other.png
above "$(psnr truth.png other.png)" 34 && fail "the pictures of two cameras cannot be told apart"
for set in metashape realityscan meshroom opensfm polycam record3d llff nvm; do
    runs 0 "$oriel" import "sets/$set" --mesh plane.obj --out "$set"
    grep -q '6 registered' stdout.txt || fail "$set: cameras are missing"
    name=0003.jpg
    [ $set = record3d ] && name=2.jpg # it numbers its pictures
    view "$set" "$name" "$set.png"
    same=$(psnr truth.png "$set.png")
    above "$same" 34 || fail "$set: $same dB to the picture of the original camera"
done
exit $failed
