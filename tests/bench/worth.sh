#!/usr/bin/env bash
# What each rule of method oriel and what stages found is worth: held-out photographs with it and without it.
#     tests/bench/worth.sh ORIEL SCENE...
# Prints a table in Markdown:
# what is lost without it, in dB of PSNR and thousandths of SSIM of whole pictures, the mean over
# the scenes, crumbs added, and the processor time of a frame without it as a share. Needs jq.
set -euo pipefail
[ $# -ge 2 ] || { sed -n '2,7s/^# *//p' "$0"; exit 2; }
oriel=$1
shift
without=(fill=color fill=depth guess_depths=0 guess_blur=0 antialias=off alignment=off
    front_layer=0 outliers=0 photos_per_pixel=2 sampling=bilinear "--adapt none" "--occluders none")
# What these options of oriel prepare leave out of a scene's manifest.
declare -A found=(["--adapt none"]='del(.tuned)' ["--occluders none"]='del(.photographs[].occluded)')
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# row CHANGE: one figure of each scene, tab-separated: PSNR, SSIM, crumbs, milliseconds of the processor.
row() {
    local scene at set left_out=${1:+${found[$1]:-}}
    for scene in "${scenes[@]}"; do
        at=$scene set=(${1:+--set "$1"})
        if [ "$left_out" ]; then
            at=$work/scene set=()
            rm -rf "$at"
            cp -r "$scene/." "$at" # of a link, what it points to
            jq "$left_out" "$scene/scene.json" >"$at/scene.json"
        fi
        "$oriel" eval "$at" --method oriel "${set[@]}" --quiet --json - </dev/null |
            jq -c 'if type == "array" then .[0] else . end | .mean'
    done | jq -sc '{change: $change, psnr: map(.psnr_db), ssim: map(.ssim), crumbs: map(.crumbs),
                    ms: map(.cpu_ms)}' --arg change "$1"
}

scenes=("$@")
row "" >"$work/whole"
for change in "${without[@]}"; do
    row "$change"
done >"$work/rows"
names=$(printf '%s\n' "${scenes[@]##*/}" | jq -R . | jq -sc .)
jq -rs --argjson names "$names" --slurpfile whole "$work/whole" '
  $whole[0] as $w
  | def mean: add / length;
    def at(d): pow(10; d) as $p | (. * $p | round) / $p | tostring;
    (["without"] + $names + ["mean", "crumbs", "time"] | "| " + join(" | ") + " |"),
    (["without"] + $names + ["mean", "crumbs", "time"] | "|" + (map("---") | join("|")) + "|"),
    (.[] | . as $r
      | [range($names | length) | {db: ($w.psnr[.] - $r.psnr[.]), ssim: (1000 * ($w.ssim[.] - $r.ssim[.]))}] as $d
      | ["`" + .change + "`"] + ($d | map((.db | at(2)) + ", " + (.ssim | at(1))))
        + [($d | map(.db) | mean | at(3)) + ", " + ($d | map(.ssim) | mean | at(1)),
           ([range($names | length) | $r.crumbs[.] - $w.crumbs[.]] | mean | at(2)),
           ([range($names | length) | $r.ms[.] / $w.ms[.]] | sort | .[length / 2 | floor] | at(2))]
      | "| " + join(" | ") + " |")' "$work/rows"
