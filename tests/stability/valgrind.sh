#!/usr/bin/env bash
# Replays every stored input of every reader and runs the unit tests under valgrind, which sees reads of
# memory that nothing wrote: libraries are not built with MemorySanitizer. Takes half an hour.
# usage: valgrind.sh BUILD SOURCE [UNIT_TEST]..      BUILD: a build folder without sanitizers
set -u
build=$(realpath "$1") inputs=$(realpath "$2")/tests/fuzz/inputs
shift 2
command -v valgrind >/dev/null || { echo "valgrind is not installed"; exit 77; }
failed=0
count=0
for folder in "$inputs"/*/; do
    name=$(basename "$folder")
    # Short blocks of instructions: those of the decoder of AVIF exceed valgrind's own memory.
    log=$(valgrind -q --vex-guest-max-insns=20 --error-exitcode=9 --track-origins=yes \
        "$build/tests/fuzz/fuzz_replay" "$name" "$folder" 2>&1)
    status=$?
    if [ $status -ne 0 ]; then
        echo "FAILED: $name (status $status)"
        grep == <<<"$log" | head -n 25
        failed=1
    fi
    count=$((count + $(find "$folder" -type f | wc -l)))
done
# test_heif encodes its pictures by x265, whose assembly code valgrind cannot follow; what is decoded
# is among the inputs above.
[ $# -gt 0 ] || for test in "$build"/tests/unit_test_*; do
    [ "${test##*/}" = unit_test_heif ] || set -- "$@" "${test##*/}"
done
for name in "$@"; do
    log=$(valgrind -q --error-exitcode=9 --track-origins=yes "$build/tests/$name" 2>&1)
    status=$?
    [ $status -eq 0 ] || [ $status -eq 77 ] && continue
    echo "FAILED: $name (status $status)"
    grep == <<<"$log" | head -n 25
    failed=1
done
echo "valgrind: $count inputs and $# unit tests"
exit $failed
