#!/usr/bin/env bash
# Fails and kills oriel trim at every write, sync, rename, unlink and allocation in turn, and lets
# the power fail there and at its end. After each, SCENE2 is absent or whole, SCENE is as it was, the
# exit status tells, and nothing stays beside SCENE2 unless its writer was killed or could not remove
# it.
# usage: inject_trim.sh ORIEL SOURCE LIBRARY [all]     without all: calls 1, 32, 1024.., and a search
# that ends at once
set -u
library=$3 all=${4:-}
. "$2/tests/e2e/command_lib"
. "$2/tests/stability/inject_lib"
export MESA_SHADER_CACHE_DIR=$work/mesa ORIEL_CACHE=$work/programs # filled by the first run
declare -A tried

workspace 4 && square || exit 1
scene train train test train
cp -r ws base
cp -r base before
trim=("$oriel" trim base --out out --views 2 --keep-options --size-divide 2 --tolerance 3 --worst 9)
[ "$all" ] || trim+=(--budget 0.01)

# problems STATUS: what is wrong after a run that a fault met
problems() {
    local part
    diff -rq base before
    if [ -e out ]; then
        "$oriel" info out --check >/dev/null 2>&1 || echo "SCENE2 is there and not whole;"
    elif [ "$1" -eq 0 ]; then
        echo "status 0 without SCENE2;"
    fi
    if [ "$killed" ]; then
        [ "$1" -eq 137 ] || echo "status $1 after a kill;"
    else
        [ "$1" -lt 128 ] || echo "crashed ($1);"
        [ "$1" -eq 0 ] || grep -q 'error: ' stderr.txt || echo "status $1 without a word;"
        [ "$call" = unlink ] || for part in .oriel-*; do [ ! -e "$part" ] || echo "left: $part;"; done
    fi
}

# once NUMBER: runs the command with that call failing; 1 when there are fewer calls.
once() {
    local number=$1 status found kind="$call in trim${killed:+, $killed}"
    rm -rf out .oriel-* mark
    (with_fault "$work" "${trim[@]}" >stdout.txt 2>stderr.txt; exit $?) 2>/dev/null
    status=$?
    [ -e mark ] || return 1
    tried[$kind]=$((${tried[$kind]:-0} + 1))
    found=$(problems $status)
    [ -z "$found" ] || fail "trim: $kind: call $number: $found"
}

runs 0 "${trim[@]}"
runs 0 "$oriel" info out --check
for call in write sync rename unlink malloc end; do
    for killed in '' "${endings[@]}"; do
        makes_sense || continue
        number=1
        while once $number; do
            number=$((all ? number + 1 : 32 * number))
        done
    done
done
# What a killed one leaves does not hinder the next.
killed=killed call=rename
once 1
runs 0 "${trim[@]}"
runs 0 "$oriel" info out --check
for kind in "${!tried[@]}"; do echo "injected: $kind ${tried[$kind]}"; done | sort
exit $failed
