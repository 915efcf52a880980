#!/usr/bin/env bash
# What soft splats are worth: held-out photographs by the scene's points, by method oriel without splats, with the shares
# that oriel refine finds, and by the splats alone.
#     tests/bench/soft.sh ORIEL DIVIDE SCENE...
# Everything is at 1/DIVIDE of the photographs' size. Each scene is refined in a copy, so it need not be refined
# and stays as it is. Prints a table in Markdown: PSNR in dB and crumbs of each picture, how much memory the splats
# take, seconds of the processor for refine and, at the scene's own size, for prepare, and a frame's time as a share of
# that without splats. Needs jq.
set -euo pipefail
[ $# -ge 3 ] || { sed -n '2,9s/^# *//p' "$0"; exit 2; }
oriel=$1 divide=$2
shift 2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export LC_ALL=C TIMEFORMAT='%U %S'

# picture METHOD [OPTION=VALUE...]: PSNR, crumbs and the processor time of a frame.
picture() {
    local method=$1 set=() one
    shift
    for one in "$@"; do set+=(--set "$one"); done
    "$oriel" eval "$work/scene" --method "$method" "${set[@]}" --divide "$divide" --quiet --json - </dev/null |
        jq -c 'if type == "array" then .[0] else . end | .mean | [.psnr_db, .crumbs, .cpu_ms]'
}

for scene in "$@"; do
    rm -rf "$work/scene"
    cp -r "$scene/." "$work/scene" # of a link, what it points to
    { time "$oriel" refine "$work/scene" --size-divide "$divide" --quiet >/dev/null 2>"$work/log"; } 2>"$work/seconds" ||
        { cat "$work/log" >&2; exit 1; }
    jq -nc --arg name "$(basename "$scene")" --argjson seconds "$(awk '{ print $1 + $2 }' "$work/seconds")" \
        --argjson bytes "$(stat -c %s "$work/scene/soft.ply")" --slurpfile manifest "$work/scene/scene.json" \
        --argjson points "$(picture points)" --argjson oriel "$(picture oriel soft=0)" --argjson found "$(picture oriel)" \
        --argjson alone "$(picture oriel soft=1 soft_mix=1)" '$manifest[0] as $m | ($m.tuned.oriel.settings // {}) as $s
        | {$name, $seconds, $bytes, $points, $oriel, $found, $alone,
           prepare: ([$m.stages[].cpu_s // 0] | add), soft: ($s.soft // 0), mix: ($s.soft_mix // 0),
           photographs: ([$m.photographs[] | select(.split != "test")] | length)}'
done | jq -rs '
  def at(d): pow(10; d) as $p | (. * $p | round) / $p | tostring;
  def both: (.[0] | at(2)) + ", " + (.[1] | at(1));
  ["scene", "photographs", "points", "oriel", "shares", "with them", "splats alone", "MiB", "refine, s", "prepare, s", "frame"] as $columns
  | ($columns, ($columns | map("---")),
     (.[] | [.name, (.photographs | tostring), (.points | both), (.oriel | both), "\(.soft | at(2)), \(.mix | at(2))",
             (.found | both), (.alone | both), (.bytes / 1048576 | at(1)), (.seconds | at(0)),
             (.prepare | at(0)), (.found[2] / .oriel[2] | at(1))]))
  | "| " + join(" | ") + " |"'
