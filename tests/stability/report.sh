#!/usr/bin/env bash
# Writes docs/measured/robustness.md: fuzzes every reader, injects every fault, soaks, counts.
# usage: tests/stability/report.sh BUILD SECONDS|keep|there [all|keep|there]
# SECONDS of fuzzing for each reader, 0: only the inputs that there are; keep: leave what the page
# says of fuzzing. all: every call fails in turn, which takes hours, instead of the first ones of a
# kind and then ever fewer; keep: leave what the page says of faults, frames and valgrind. there: from
# what lies in FUZZ_DIR, of the same commands run one by one at COMMIT. BUILD is a build folder with the program
# and tests. Inputs tried add up over the runs of tests/fuzz/run.sh in build-fuzz. SOAK_FRAMES and SOAK_ROUNDS: 10000 and 1000.
# THREADS_BUILD and SANITIZE_BUILD, where given: build folders with -DORL_SANITIZE_THREADS=ON and with
# -DORL_SANITIZE=ON, for the programs with threads and the tests of the whole program.
set -eu -o pipefail
[ $# -ge 2 ] || { sed -n '2,13s/^# *//p' "$0"; exit 2; }
source=$(cd "$(dirname "$0")/../.." && pwd) build=$(realpath "$1") seconds=$2 all=${3:-}
fuzz=${FUZZ_DIR:-$source/build-fuzz} page=$source/docs/measured/robustness.md
commit=${COMMIT:-$(git -C "$source" rev-parse --short HEAD)}
status=0
mkdir -p "$source/docs/measured" "$fuzz/failures"
[[ $seconds =~ keep|there ]] || "$source/tests/fuzz/run.sh" "$seconds" || status=1
if [[ ! $all =~ keep|there ]]; then
    : >"$fuzz/injected.txt"
    for script in inject inject_prepare inject_publish inject_trim; do
        "$source/tests/stability/$script.sh" "$build/oriel" "$source" "$build/tests/libinject.so" \
            $all 2>&1 | tee -a "$fuzz/injected.txt" || status=1
    done
    "$source/tests/stability/soak.sh" "$build/oriel" "$source" "$build/tests/soak" \
        "${SOAK_FRAMES:-10000}" "${SOAK_ROUNDS:-1000}" 2>&1 | tee "$fuzz/soaked.txt" || status=1
    "$source/tests/stability/valgrind.sh" "$build" "$source" | tee "$fuzz/valgrind.txt" || status=1
    [ -z "${THREADS_BUILD:-}" ] || "$source/tests/stability/threads.sh" "$THREADS_BUILD" "$source" |
        tee "$fuzz/threads.txt" || status=1
    [ -z "${SANITIZE_BUILD:-}" ] || ASAN_OPTIONS=detect_leaks=0 ctest --test-dir "$SANITIZE_BUILD" \
        -L e2e --output-on-failure | tee "$fuzz/sanitized.txt" || status=1
fi

failures() { find "$fuzz/failures" -type f | wc -l; }

fuzzing() {
    echo "## Inputs tried"
    echo
    echo "libFuzzer under AddressSanitizer and UndefinedBehaviorSanitizer, with memory limited, at commit"
    echo "$commit."
    echo
    echo "| reader | inputs tried | seconds of processor time | failures left |"
    echo "|---|--:|--:|--:|"
    awk '{ n[$1] += $2; s[$1] += $3 } END { for (k in n) print k, n[k], s[k] }' "$fuzz/tried.txt" |
        sort | while read -r name inputs time; do
        left=$(find "$fuzz/failures" -name "$name-*" | wc -l)
        printf '| %s | %s | %.0f | %s |\n' "$name" "$inputs" "$time" "$left"
    done
    awk '{ n += $2; s += $3 } END { printf "| **all** | %d | %d (%.2f hours) | ", n, s, s / 3600 }' \
        "$fuzz/tried.txt"
    echo "$(failures) |"
    echo
    echo "## Lines of each reader that these inputs reach"
    echo
    echo "Most of the lines that are left answer an allocation, a file or a library that fails, which"
    echo "the injection of faults below does; \`rendering.c\` draws with a device."
    echo
    echo "| file | lines | reached |"
    echo "|---|--:|--:|"
    awk '{ printf "| `%s` | %d | %.0f %% |\n", $3, $5, 100 * $4 / ($5 ? $5 : 1) }' "$fuzz/lines.txt"
    echo
}

# Faults, frames and valgrind.
running() {
    echo "## Faults injected"
    echo
    echo "At commit $commit."
    echo
    echo "A call of a kind fails, or the program is killed ahead of it, once in \`info\`, \`render\`"
    echo "(PNG, EXR), \`hdr\`, \`synth\` and \`lod\`. Or the power fails there, or at the end (\`end\`): what"
    echo "was not synced then is empty or zeros. Afterwards a final name holds what it held before or the whole"
    echo "result, the exit status tells, and only a killed program leaves a temporary file. So too in"
    echo "\`prepare\`, from the start and resumed half-way, with a stand-in for COLMAP; afterwards"
    echo "\`--resume\` gives the bytes of a job that nothing disturbed. And in \`trim\`; afterwards the scene"
    echo "that it reads is as it was, and the one that it makes is whole or absent. And in \`publish\`, which"
    echo "replaces a site; afterwards the old or the new site is whole. Unless the script was told \`all\`, these"
    echo "are the first six calls of a kind and then every so many, in \`prepare\` calls 1, 3, 9 and so on, in"
    echo "\`trim\` 1, 32 and 1024, in \`publish\` those around the exchange of the two sites."
    echo
    echo "| fault | times | files cut, crashes, wrong statuses |"
    echo "|---|--:|--:|"
    sed -n 's/^injected: \(.*\) \([0-9]*\)$/\1|\2/p' "$fuzz/injected.txt" | while IFS='|' read -r kind times; do
        echo "| $kind | $times | $(grep -c "^FAILED.*: $kind: call " "$fuzz/injected.txt" || true) |"
    done
    echo
    echo "## Soaked"
    echo
    echo "Random views of a small scene by all methods in turn, then the scene opened, drawn once and"
    echo "closed again and again, the device too every twentieth time. Every pixel must be finite, no"
    echo "buffer or texture may stay, and resident memory may grow by 16 MiB at most."
    echo
    echo "| what | growth of memory after the first fifth, KiB |"
    echo "|---|--:|"
    sed -n 's/^soaked: \(.*\), memory \([-+0-9]*\) KiB.*/| \1 | \2 |/p' "$fuzz/soaked.txt"
    echo
    if [ -e "$fuzz/threads.txt" ]; then
        echo "## Threads"
        echo
        echo "Under ThreadSanitizer: $(sed -n 's/^threads: //p' "$fuzz/threads.txt")," \
            "$(grep -c ^FAILED "$fuzz/threads.txt" || true) with a race."
        echo
    fi
    if [ -e "$fuzz/sanitized.txt" ]; then
        echo "## The whole program under sanitizers"
        echo
        echo "Under AddressSanitizer and UndefinedBehaviorSanitizer, without leaks, which the unit tests"
        echo "look for, $(grep -cE '\*\*\*(Failed|Timeout|Exception)' "$fuzz/sanitized.txt" || true) failed of" \
            "$(sed -nE 's/.*Test +#[0-9]+: e2e\/([a-z_]+) .*(Passed|\*\*\*[FTE]).*/`\1`/p' "$fuzz/sanitized.txt" |
                sort -u | paste -sd, | sed 's/,/, /g' | fold -sw 96)" \
            "(of $(find "$source/tests/e2e" -name '*.sh' | wc -l) scripts)."
        echo
    fi
    echo "## Uninitialized memory"
    echo
    echo "The stored inputs of every reader and the unit tests under valgrind:"
    echo "$(sed -n 's/^valgrind: //p' "$fuzz/valgrind.txt"), $(grep -c ^FAILED "$fuzz/valgrind.txt" || true) of them with an error."
    echo
}

{
    cat <<'END'
# Robustness: what was tried, and what failed

Made by `tests/stability/report.sh BUILD SECONDS`. SECURITY.md says what Oriel promises; the inputs
and checks below are in `tests/fuzz` and `tests/stability`.

END
    if [ "$seconds" = keep ]; then
        sed -n '/^## Inputs tried/,/^## Faults/{/^## Faults/!p}' "$page"
    else
        fuzzing
    fi
    if [ "$all" = keep ]; then
        sed -n '/^## Faults injected/,/^## Found/{/^## Found/!p}' "$page"
    else
        running
    fi
    echo "## Found, mended, and kept as tests"
    echo
    echo "| what was wrong | test |"
    echo "|---|---|"
    awk -F'|' '{ gsub(/, /, "`, `", $2); printf "| %s | `%s` |\n", $1, $2 }' \
        "$source/tests/stability/found.txt"
} >"$page.part"
mv "$page.part" "$page"
echo "$page"
exit $status
