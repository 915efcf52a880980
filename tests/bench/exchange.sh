#!/usr/bin/env bash
# Writes the table of docs/measured/exchange.md: exported splats, drawn as programs of Gaussian
# splatting draw them, beside methods `points` and `oriel` at held-out photographs.
#     tests/bench/exchange.sh BUILD SCENE... >>docs/measured/exchange.md
# Needs jq. Covered: each method's own. Splats are not brought to the exposure of the held-out
# photograph, as Oriel's methods are.
set -euo pipefail
[ $# -ge 2 ] || { sed -n '2,7s/^# \{0,1\}//p' "$0"; exit 2; }
build=$(realpath "$1")
shift
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
echo "| scene | drawn | PSNR covered | covered % |"
echo "|---|---|---|---|"
for scene in "$@"; do
    name=$(basename "$scene")
    for degree in 0 1 2; do
        "$build/oriel" export "$scene" --as splats --sh $degree --out "$work/s.ply" --quiet
        "$build/tests/bench_splat_pictures" "$scene" "$work/s.ply" "$work/pictures" |
            awk -v row="| $name | splats, \`--sh $degree\`" '$1 != "mean" { sum += $5; n++ }
                $1 == "mean" { printf "%s | %.2f | %.1f |\n", row, $3, 100 * sum / n }'
    done
    for method in points oriel; do
        "$build/oriel" eval "$scene" --method $method --quiet --json "$work/eval.json" >/dev/null
        jq -r '.mean | [.psnr_covered_db, 100 * .coverage] | @tsv' "$work/eval.json" |
            awk -v row="| $name | \`$method\`" '{ printf "%s | %.2f | %.1f |\n", row, $1, $2 }'
    done
done
