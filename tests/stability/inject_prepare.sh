#!/usr/bin/env bash
# Fails and kills oriel prepare, from the start and resumed half-way, at every write, sync, rename,
# unlink and allocation in turn, and lets the power fail there and at its end, with a stand-in for
# COLMAP. After each, the scene does not open or is whole, the exit status tells, the photographs are
# as they were, and --resume gives the bytes of a job that nothing disturbed.
# Then a drive without fsync, flock and symbolic links, as many USB sticks and network drives are.
# usage: inject_prepare.sh ORIEL SOURCE LIBRARY [all]     without all: calls 1, 3, 9, 27..
set -u
library=$3 all=${4:-}
. "$2/tests/e2e/prepare_lib"
. "$2/tests/stability/inject_lib"
export ORIEL_COLMAP=$source/tests/e2e/colmap_double
photos=$work/p scene=$work/scene whole=$work/whole
declare -A tried

prepare() { "$oriel" prepare "$photos" --out "$scene" --test-list 1.png --keep all "$@"; }

photos "$photos" 0.png 1.png 2.png
cp -r "$photos" "$work/p-before"
prepare >/dev/null 2>"$work/err" || { fail "prepare itself"; finish; }
mv "$scene" "$whole"
# Half of the work, and the half's own files.
DOUBLE_FAIL=image_undistorter prepare >/dev/null 2>&1
mv "$scene" "$work/half"

# Differences between the scene and what it should be. Times and logs may differ; looks is a cache;
# what a killed writer left is swept when it is old enough to be nobody's (unit/test_core_atomic).
differences() {
    diff -rq -x stages.json -x logs -x lock -x looks -x '.oriel-part-*' -I '_s"' -I 'peak_rss_mib"' \
        "$scene" "$whole" |
        sed "s|$work/||g" | head -n 3 | tr '\n' ';'
    diff -rq "$photos" "$work/p-before"
}

# once NUMBER: runs the job with that call failing; 1 when there are fewer calls.
once() {
    local number=$1 status problems= kind="$call in $job${killed:+, $killed}"
    rm -rf "$scene" "$work/mark"
    [ "$job" = resume ] && cp -r "$work/half" "$scene"
    mkdir -p "$scene"
    (with_fault "$scene" "$oriel" prepare "$photos" --out "$scene" \
        --test-list 1.png --keep all --resume >"$work/out" 2>"$work/err"; exit $?) 2>/dev/null
    status=$?
    [ -e "$work/mark" ] || return 1
    tried[$kind]=$((${tried[$kind]:-0} + 1))
    if [ "$killed" ]; then
        [ $status -eq 137 ] || problems+=" status $status after a kill;"
    elif [ $status -ge 128 ]; then
        problems+=" crashed ($status);"
    elif [ $status -eq 0 ]; then
        problems+=$(differences)
    elif ! grep -q 'error: ' "$work/err"; then
        problems+=" status $status without a word;"
    fi
    if "$oriel" info "$scene" >/dev/null 2>&1 && ! "$oriel" info "$scene" --check >/dev/null 2>&1; then
        problems+=" a scene that is not whole opens;"
    fi
    if [ "$call" = end ] && ! "$oriel" info "$scene" --check >/dev/null 2>&1; then
        problems+=" what was done did not last;"
    fi
    prepare --resume >/dev/null 2>"$work/err.resumed" || problems+=" resume fails: $(tail -n 1 "$work/err.resumed")"
    problems+=$(differences)
    [ -z "$problems" ] || fail "prepare: $kind: call $number: $problems"
}

for job in prepare resume; do
    for call in write sync rename unlink malloc end; do
        for killed in '' "${endings[@]}"; do
            makes_sense || continue
            number=1
            while once $number; do
                number=$((all ? number + 1 : 3 * number))
            done
        done
    done
done

# A drive of few abilities: the same scene, whose maker hears that nothing locks it.
rm -rf "$scene"
env LD_PRELOAD="$library" INJECT_DRIVE=1 "$oriel" prepare "$photos" --out "$scene" --test-list 1.png \
    --keep all >"$work/out" 2>"$work/err" || fail "prepare fails on a drive without fsync and flock"
says 'cannot be locked'
problems=$(differences)
[ -z "$problems" ] || fail "a drive without fsync and flock: $problems"
env LD_PRELOAD="$library" INJECT_DRIVE=1 "$oriel" prepare "$photos" --out "$scene" --test-list 1.png \
    --keep all --resume >"$work/out" 2>"$work/err" || fail "prepare does not resume on such a drive"
says 'done already'

for kind in "${!tried[@]}"; do echo "injected: $kind ${tried[$kind]}"; done | sort
finish
