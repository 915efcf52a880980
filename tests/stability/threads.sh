#!/usr/bin/env bash
# Runs what has threads, and what is read beside them, under ThreadSanitizer: the pairs of photographs,
# what is read ahead, frames that sharpen while photographs arrive, pages of points. Then a program with a race, which must be found. Takes minutes.
# usage: threads.sh BUILD SOURCE [TEST]..      BUILD: configured with -DORL_SANITIZE_THREADS=ON
set -u
build=$(realpath "$1") source=$(realpath "$2")
shift 2
[ $# -gt 0 ] || set -- unit_test_pairs unit_test_point_lod gpu_test_prefetch \
    gpu_test_progressive gpu_test_cloud
# What libraries do by themselves, without instructions of the sanitizer, is not ours.
export TSAN_OPTIONS=suppressions=$source/tests/checks/tsan.txt:ignore_noninstrumented_modules=1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0
for name in "$@"; do
    "$build/tests/$name" >"$work/log" 2>&1
    status=$?
    [ $status -eq 0 ] && continue
    [ $status -eq 77 ] && echo "skipped: $name" && continue
    echo "FAILED: $name (status $status)"
    grep -A 12 -E 'WARNING: ThreadSanitizer|FATAL|FAILED' "$work/log" | head -n 40
    failed=1
done
cat >"$work/race.c" <<'C'
#include <pthread.h>
static int n;
static void *add(void *priv) { n++; return priv; }
int main(void)
{
    pthread_t thread;
    if (pthread_create(&thread, 0, add, 0)) return 2;
    n++;
    return pthread_join(thread, 0);
}
C
"${CC:-cc}" -g -fsanitize=thread "$work/race.c" -o "$work/race" && "$work/race" >"$work/log" 2>&1
[ $? -eq 66 ] || { echo "FAILED: a race is not found"; failed=1; }
echo "threads: $# programs"
exit $failed
