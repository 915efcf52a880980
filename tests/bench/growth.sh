#!/usr/bin/env bash
# How does the time of prepare grow with the number of photographs? Prepares the synthetic monument
# with several numbers of photographs under names that tell nothing of their order, and prints
# processor time by stage, the exponent of its growth, memory and disk.
# usage: growth.sh ORIEL WORK_DIR COUNT... [-- PREPARE OPTIONS]     needs jq
#   COUNT: ascending divisors of the last one, whose photographs are drawn once. Scenes in WORK_DIR
#   are used again; with --until undistort as an option, only calibration and undistort are measured.
set -eu
oriel=$1 work=$2
shift 2
counts=()
while [ $# -gt 0 ] && [ "$1" != -- ]; do
    counts+=("$1")
    shift
done
[ $# -gt 0 ] && shift
mkdir -p "$work"
most=${counts[-1]}
[ -e "$work/photos" ] ||
    "$oriel" synth monument --out "$work/photos" --count "$most" --size 384x256 --quiet
for count in "${counts[@]}"; do
    if [ ! -e "$work/$count" ]; then
        mkdir "$work/$count"
        number=0
        for photo in $(ls "$work/photos" | awk -v every=$((most / count)) 'NR % every == 1 % every' |
            shuf --random-source=<(yes "$count")); do
            ln "$work/photos/$photo" "$work/$count/$(printf 'p%04d.jpg' $number)"
            number=$((number + 1))
        done
    fi
    resume=
    [ -e "$work/scene-$count/.oriel" ] && resume=--resume
    "$oriel" prepare "$work/$count" --out "$work/scene-$count" --quality draft --quiet $resume "$@"
done

# Rows: what is measured, then a value a count. The exponent is the slope of the line through all
# points of log time over log count.
for count in "${counts[@]}"; do
    jq -r --arg count "$count" '.done as $done
        | ($done.calibrate | [.mapper_s, .hierarchical_mapper_s, .global_mapper_s]
           | map(. // 0) | add) as $mapper
        | (["registered", $done.calibrate.registered], ["mapper", $mapper],
           ["calibrate without the mapper", $done.calibrate.cpu_s - $mapper],
           ($done | to_entries[] | select(.value.cpu_s and .key != "calibrate")
            | [.key, .value.cpu_s]),
           ["peak memory, MiB", ([$done[] | .peak_rss_mib // 0, .child_peak_rss_mib // 0] | max)])
        | [$count] + . | @tsv' "$work/scene-$count/.oriel/stages.json"
    printf '%s\tdisk, MiB\t%s\n' "$count" "$(du -sm "$work/scene-$count" | cut -f 1)"
done | awk -F '\t' -v counts="${counts[*]}" '
    { if (!($2 in seen)) { order[++rows] = $2; seen[$2] = 1 } value[$2, $1] = $3 }
    END {
        n = split(counts, c, " ")
        line = "| s of CPU"
        for (i = 1; i <= n; i++) line = line " | " c[i]
        print line " | exponent |"
        line = "|---"
        for (i = 0; i <= n; i++) line = line "|---"
        print line "|"
        for (r = 1; r <= rows; r++) {
            sx = sy = sxx = sxy = 0
            line = "| " order[r]
            for (i = 1; i <= n; i++) {
                v = value[order[r], c[i]]
                line = line " | " sprintf(v < 100 && order[r] !~ /regist|MiB/ ? "%.1f" : "%.0f", v)
                x = log(c[i]); y = log(v > 0 ? v : 1e-3)
                sx += x; sy += y; sxx += x * x; sxy += x * y
            }
            slope = (n * sxy - sx * sy) / (n * sxx - sx * sx)
            print line " | " (order[r] ~ /regist/ ? "" : sprintf("%.2f", slope)) " |"
        }
    }'
