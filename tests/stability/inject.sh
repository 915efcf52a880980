#!/usr/bin/env bash
# Fails and kills oriel at every write, sync, rename, unlink and allocation of its commands in
# turn, and lets the power fail there and at their ends, so that what was not synced is lost. After
# each, a final name must hold what it held before or the whole result, the exit status must tell,
# and no temporary file may stay unless its writer was killed.
# usage: inject.sh ORIEL SOURCE LIBRARY [all]     without all: the first six calls of a kind, then
# every so many, as they grow in number
set -u
library=$3 all=${4:-}
. "$2/tests/e2e/command_lib"
. "$2/tests/stability/inject_lib"
export MESA_SHADER_CACHE_DIR=$work/mesa ORIEL_CACHE=$work/programs # filled by the first run
declare -A tried

workspace 3 && square || exit 1
scene train test train
cp -r ws base
mkdir lod
(cd lod && monument_scene) || exit

# A clean start: `out` holds an older file under each final name, but where a command refuses that,
# or is a scene that the command adds to.
prepare_out() {
    rm -rf out
    [ "${command[1]}" = synth ] && mkdir out || cp -r old out
}

# check COMMAND..: its outputs are whole, or as they were
check_out() {
    local file
    (cd out && find . -type f) | while read -r file; do
        case $file in
        */.oriel-part-*) [ "$killed" ] || [ "$call" = unlink ] || echo "left: $file" ;;
        *) cmp -s "out/$file" "whole/$file" || cmp -s "out/$file" "old/$file" ||
            echo "partial: $file" ;;
        esac
    done
}

# once: runs "${command[@]}" with the N-th call failing; 1 when there are fewer calls.
once() {
    local number=$1 status problems kind="$call${killed:+, $killed}"
    prepare_out
    rm -f mark
    (with_fault out "${command[@]}" >stdout.txt 2>stderr.txt; exit $?) 2>/dev/null
    status=$?
    [ -e mark ] || return 1
    tried[$kind]=$((${tried[$kind]:-0} + 1))
    problems=$(check_out)
    if [ "$killed" ]; then
        [ $status -eq 137 ] || problems+=" status $status after a kill"
    elif [ $status -ge 128 ]; then
        problems+=" crashed ($status)"
    elif [ $status -eq 0 ] && [ "$call" != unlink ] && ! whole_result; then
        problems+=" status 0 without its result"
    fi
    [ -z "$problems" ] || fail "${command[*]}: $kind: call $number: $problems"
}

whole_result() {
    diff -r -x '.oriel-part-*' out whole >/dev/null && cmp -s stdout.txt whole.txt
}

sweep() {
    command=("$@")
    rm -rf old out whole
    mkdir old
    [ "$2" = lod ] && cp -r lod/made out || mkdir out
    "${command[@]}" >whole.txt 2>stderr.txt || { fail "the command itself: $*"; return; }
    mv out whole
    if [ "$2" = lod ]; then
        cp -r lod/made/. old
    else
        (cd whole && find . -type f -exec sh -c \
            'mkdir -p "../old/$(dirname "$1")"; echo older >"../old/$1"' _ {} \;)
    fi
    local started=$SECONDS
    for call in write sync rename unlink malloc end; do
        for killed in '' "${endings[@]}"; do
            makes_sense || continue
            [[ $killed && $call = unlink ]] && continue
            local number=1
            while once $number; do
                [ "$all" ] || [ $number -lt 6 ] && number=$((number + 1)) ||
                    number=$((number * 8 / 5))
            done
        done
    done
    echo "swept in $((SECONDS - started)) s: ${*:2}"
}

photo=${names[0]}
sweep "$oriel" info base --json
sweep "$oriel" render base --at "$photo" --out out/view.png
sweep "$oriel" render base --at "$photo" --out out/view.exr --layers depth,normal
sweep "$oriel" hdr base --at "$photo" --out out/view.exr
sweep "$oriel" synth monument --size 64x64 --count 2 --quiet --out out/photos
sweep "$oriel" lod out
for kind in "${!tried[@]}"; do echo "injected: $kind ${tried[$kind]}"; done | sort
exit $failed
