#!/usr/bin/env bash
# Replays every stored input of every reader and runs the unit tests under valgrind, which sees reads of
# memory that nothing wrote: libraries are not built with MemorySanitizer. Takes half an hour.
# usage: valgrind.sh BUILD SOURCE [inputs | UNIT_TEST]..      BUILD: a build folder without sanitizers
# Each program gets VALGRIND_SECONDS (600) of processor time; those that need more are stopped and named.
set -u
build=$(realpath "$1") inputs=$(realpath "$2")/tests/fuzz/inputs limit=${VALGRIND_SECONDS:-600}
shift 2
command -v valgrind >/dev/null || { echo "valgrind is not installed"; exit 77; }
failed=0 replayed=0 run=0 stopped=()

# watched NAME COMMAND..: 0: ran to its end without an error of memory
watched() {
    local name=$1 log status
    shift
    log=$(ulimit -t "$limit"; valgrind -q --error-exitcode=9 --track-origins=yes "$@" 2>&1)
    status=$?
    if [ $status -eq 137 ] || [ $status -eq 152 ]; then # killed by the limit
        stopped+=("$name")
        return 1
    fi
    [ $status -eq 0 ] || [ $status -eq 77 ] && return
    echo "FAILED: $name (status $status)"
    grep == <<<"$log" | head -n 25
    failed=1
    return 1
}

# Short blocks of instructions: those of the decoder of AVIF exceed valgrind's own memory. Inputs of the script that
# reads other programs' cameras have no reader in C.
replay() {
    local replay=$build/tests/fuzz/fuzz_replay folder name
    for folder in "$inputs"/*/; do
        name=$(basename "$folder")
        "$replay" "$name" "" 2>&1 | grep -q "^no target" && continue
        watched "$name" --vex-guest-max-insns=20 "$replay" "$name" "$folder" &&
            replayed=$((replayed + $(find "$folder" -type f | wc -l)))
    done
}

# test_heif encodes its pictures by x265, whose assembly code valgrind cannot follow; what is decoded
# is among the inputs.
if [ $# -eq 0 ]; then
    set -- inputs
    for test in "$build"/tests/unit_test_*; do
        [ "${test##*/}" = unit_test_heif ] || set -- "$@" "${test##*/}"
    done
fi
for name in "$@"; do
    if [ "$name" = inputs ]; then
        replay
    else
        watched "$name" "$build/tests/$name" && run=$((run + 1))
    fi
done
echo "valgrind: $replayed inputs and $run unit tests without an error${stopped:+; stopped after $limit s: ${stopped[*]}}"
exit $failed
