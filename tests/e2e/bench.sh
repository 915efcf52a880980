#!/usr/bin/env bash
# oriel bench on a workspace made by hand: figures that are sane, files, refusals. Never
# how long anything takes.
set -u
. "$2/tests/e2e/command_lib"

# Numbers of all fields of this name in FILE, one a line.
numbers() {
    sed -n "s/^ *\"$1\": \\([-0-9.e+]*\\),*\$/\\1/p" "$2"
}

workspace 4 || exit 77
square
scene train train train test
# A held-out photograph is not even read.
head -c 700 "ws/images/${names[3]}" >cut && mv cut "ws/images/${names[3]}"

bench=("$oriel" bench ws --quiet --seconds 0 --frames 3)
runs 0 "${bench[@]}" --size 64x48 --size 32x32 --method all --json out.json --trace trace.json
[ -s stderr.txt ] && fail "--quiet is not quiet"
for word in airieau points 64x48 32x32 photographs device host splat gather; do
    grep -q -- "$word" stdout.txt || fail "the tables lack $word"
done
for field in scene device driver software points photographs photo_size host_peak_bytes memory \
    sizes method size frames frame_ms slowest_ms cpu_ms fps device_bytes uploaded_bytes passes_ms owner tag bytes; do
    grep -q "\"$field\"" out.json || fail "no field $field"
done
for field in frame_ms slowest_ms device_bytes host_peak_bytes fps; do
    numbers $field out.json | awk '!($1 > 0 && $1 < 1e12) { exit 1 }' ||
        fail "$field is not a positive number"
done
methods=$("$oriel" eval ws --method nonsense 2>&1 | sed -n 's/.*there are: *//p' | wc -w)
[ "$(grep -c '"frame_ms":' out.json)" = $((2 * methods)) ] || fail "not each method at each size"
grep -q '"photographs": 3,' out.json || fail "other than the three photographs that are not held out"
numbers frames out.json | grep -qvx 3 && fail "other than three frames"

[ "$(head -c1 trace.json)" = "{" ] || fail "the trace is no object"
for word in traceEvents '"ph": "X"' '"frame"' '"splat"' thread_name; do
    grep -q "$word" trace.json || fail "the trace lacks $word"
done
numbers dur trace.json | awk '$1 < 0 { exit 1 }' || fail "a span that ends before it starts"

runs 0 "${bench[@]}" --size 32x32 --json -
head -c1 stdout.txt | grep -q '{' || fail "--json - writes something else, too"

# Of a sequence every frame shows another time step, so that its time has the hull's.
runs 0 "$oriel" synth figures --out set --cameras 5 --frames 3 --size 64x48
runs 0 "$oriel" import set --masks set/masks --background set/background --out moving
moving=("$oriel" bench moving --quiet --seconds 0 --frames 4 --size 32x32 --method li)
runs 0 "${moving[@]}" --json -
grep -q '"time_steps": 3,' stdout.txt || fail "does not say how many time steps there are"
grep -q '"hull"' stdout.txt || fail "the hull takes no time"
runs 0 "${moving[@]}"
grep -q '^time steps  *3, ' stdout.txt || fail "the tables do not say how many time steps there are"
mv moving/frames not-now
runs 0 "${moving[@]}" --json -
grep -q '"hull"' stdout.txt && fail "a hull that stays takes time in each frame"

runs 2 "${bench[@]}" --method nonsense
grep -q airieau stderr.txt || fail "does not list the methods"
runs 2 "${bench[@]}" --size 12
runs 2 "${bench[@]}" --size 64x48x2
runs 2 "${bench[@]}" --set nonsense=1
runs 2 "$oriel" bench nowhere
runs 0 "$oriel" bench --help
# Results that get lost.
if [ -w /dev/full ]; then
    "$oriel" bench ws --seconds 0 --frames 3 --size 32x32 >/dev/full 2>stderr.txt &&
        fail "figures that could not be written went unnoticed"
    "$oriel" info ws >/dev/full 2>stderr.txt && fail "info that could not be written went unnoticed"
fi

# Figures of these figures.
needs_reports
runs 0 "$oriel" plot out.json --out plots
for plot in passes memory; do
    tail -n1 plots/$plot.svg | grep -q '</svg>' || fail "no plot of $plot"
done
runs 2 "$oriel" plot trace.json --out plots
runs 2 "$oriel" plot out.json --out trace.json
grep -q '^oriel: error: trace.json: cannot make' stderr.txt || fail "does not say that --out is a file"
exit $failed
