#!/usr/bin/env bash
# Writes docs/measured/robustness.md: fuzzes every reader, injects every fault, soaks, counts.
# usage: tests/stability/report.sh BUILD [STEP]..
# BUILD: a build folder with the program and tests. STEP: what to run now; without any, all of them.
# The page is written once FUZZ_DIR (build-fuzz) has all steps of one commit.
#   fuzz       every reader for FUZZ_SECONDS (3; 0: only the inputs that there are); inputs tried add
#              up over the runs of one commit (tests/fuzz/run.sh)
#   faults     the first calls of a kind and then ever fewer, or with FAULTS=all every call in turn,
#              which takes hours
#   soak       SOAK_FRAMES (10000) frames and SOAK_ROUNDS (1000) openings
#   threads    what has threads; THREADS_BUILD: configured with -DORL_SANITIZE_THREADS=ON
#   sanitized  the tests of the whole program; SANITIZE_BUILD: configured with -DORL_SANITIZE=ON
#   valgrind   every stored input and the unit tests
set -u -o pipefail
[ $# -ge 1 ] || { sed -n '3,14s/^# *//p' "$0"; exit 2; }
source=$(cd "$(dirname "$0")/../.." && pwd) build=$(realpath "$1")
fuzz=${FUZZ_DIR:-$source/build-fuzz} page=$source/docs/measured/robustness.md
steps=(fuzz faults soak threads sanitized valgrind)
commit=$(git -C "$source" rev-parse --short=8 HEAD)
shift
[ $# -gt 0 ] || set -- "${steps[@]}"
status=0
mkdir -p "$fuzz/failures"

run_step() {
    local script
    case $1 in
    fuzz) "$source/tests/fuzz/run.sh" "${FUZZ_SECONDS:-3}" ;;
    faults)
        : >"$fuzz/faults.txt"
        for script in inject inject_prepare inject_publish inject_trim; do
            "$source/tests/stability/$script.sh" "$build/oriel" "$source" \
                "$build/tests/libinject.so" "${FAULTS:-}" 2>&1 | tee -a "$fuzz/faults.txt" || status=1
        done
        ;;
    soak)
        "$source/tests/stability/soak.sh" "$build/oriel" "$source" "$build/tests/soak" \
            "${SOAK_FRAMES:-10000}" "${SOAK_ROUNDS:-1000}" 2>&1 | tee "$fuzz/soak.txt"
        ;;
    threads)
        "$source/tests/stability/threads.sh" "${THREADS_BUILD:?}" "$source" | tee "$fuzz/threads.txt"
        ;;
    sanitized)
        ASAN_OPTIONS=detect_leaks=0 ctest --test-dir "${SANITIZE_BUILD:?}" -L e2e \
            --output-on-failure | tee "$fuzz/sanitized.txt"
        ;;
    valgrind)
        "$source/tests/stability/valgrind.sh" "$build" "$source" | tee "$fuzz/valgrind.txt"
        ;;
    *) echo "no step $1" >&2 && exit 2 ;;
    esac || status=1
    echo "$commit" >"$fuzz/$1.commit"
}

# Lines "READER INPUTS SECONDS": of this commit.
fuzz_rows() {
    awk -v commit="$commit" '$4 == commit { n[$1] += $2; s[$1] += $3 }
                             END { for (k in n) print k, n[k], s[k] }' "$fuzz/tried.txt" | sort
}

fuzz_section() {
    local name inputs time left
    echo "## Inputs tried"
    echo
    echo "libFuzzer under AddressSanitizer and UndefinedBehaviorSanitizer, with memory limited."
    echo
    echo "| reader | inputs tried | seconds of processor time | failures left |"
    echo "|---|--:|--:|--:|"
    fuzz_rows | while read -r name inputs time; do
        left=$(find "$fuzz/failures" -name "$name-*" | wc -l)
        printf '| %s | %s | %.0f | %s |\n' "$name" "$inputs" "$time" "$left"
    done
    fuzz_rows | awk '{ n += $2; s += $3 } END { printf "| **all** | %d | %d (%.2f hours) | ", n, s, s / 3600 }'
    echo "$(find "$fuzz/failures" -type f | wc -l) |"
    echo
    echo "### Lines of each reader that these inputs reach"
    echo
    echo "Most of the lines that are left answer an allocation, a file or a library that fails, which"
    echo "the injection of faults below does; \`rendering.c\` draws with a device."
    echo
    echo "| file | lines | reached |"
    echo "|---|--:|--:|"
    awk '{ printf "| `%s` | %d | %.0f %% |\n", $3, $5, 100 * $4 / ($5 ? $5 : 1) }' "$fuzz/lines.txt"
}

faults_section() {
    local kind times
    echo "## Faults injected"
    echo
    echo "A call of a kind fails, or the program is killed ahead of it, once in \`info\`, \`render\`"
    echo "(PNG, EXR), \`hdr\`, \`synth\` and \`lod\`. Or the power fails there, or at the end (\`end\`): what"
    echo "was not synced then is empty or zeros. Afterwards a final name holds what it held before or the whole"
    echo "result, the exit status tells, and only a killed program leaves a temporary file. So too in"
    echo "\`prepare\`, from the start and resumed half-way, with a stand-in for COLMAP; afterwards"
    echo "\`--resume\` gives the bytes of a job that nothing disturbed. And in \`trim\`; afterwards the scene"
    echo "that it reads is as it was, and the one that it makes is whole or absent. And in \`publish\`, which"
    echo "replaces a site in which the user keeps a file; afterwards the old or the new site is whole, with that file. Unless the script was told \`all\`, these"
    echo "are the first six calls of a kind and then every so many, in \`prepare\` calls 1, 3, 9 and so on, in"
    echo "\`trim\` 1, 32 and 1024, in \`publish\` those around the exchange of the two sites."
    echo
    echo "| fault | times | files cut, crashes, wrong statuses |"
    echo "|---|--:|--:|"
    sed -n 's/^injected: \(.*\) \([0-9]*\)$/\1|\2/p' "$fuzz/faults.txt" |
        while IFS='|' read -r kind times; do
            echo "| $kind | $times | $(grep -c "^FAILED.*: $kind: call " "$fuzz/faults.txt") |"
        done
}

soak_section() {
    echo "## Soaked"
    echo
    echo "Random views of a small scene by all methods in turn, then the scene opened, drawn once and"
    echo "closed again and again, the device too every twentieth time. Every pixel must be finite, no"
    echo "buffer or texture may stay, and resident memory may not grow from one to the next: the slope after"
    echo "the first fifth, by least squares, is at most 8 KiB a frame and 1 MiB an opening."
    echo
    echo "| what | slope of memory, KiB each |"
    echo "|---|--:|"
    sed -n 's/^soaked: \(.*\), memory \([-+.0-9]*\) KiB.*/| \1 | \2 |/p' "$fuzz/soak.txt"
}

threads_section() {
    echo "## Threads"
    echo
    echo "Under ThreadSanitizer: $(sed -n 's/^threads: //p' "$fuzz/threads.txt")," \
        "$(grep -c ^FAILED "$fuzz/threads.txt") with a race."
}

sanitized_section() {
    echo "## The whole program under sanitizers"
    echo
    echo "Under AddressSanitizer and UndefinedBehaviorSanitizer, without leaks, which the unit tests look"
    echo "for, $(grep -cE 'e2e/.*Passed' "$fuzz/sanitized.txt") scripts of \`tests/e2e\` pass. \`untrusted\` limits the address space, and"
    echo "\`stress\` preloads a library into Python: neither can run so. Besides these two failed:" \
        "$(sed -nE 's/.*Test +#[0-9]+: e2e\/([a-z_]+) .*\*\*\*[FTE].*/`\1`/p' "$fuzz/sanitized.txt" |
            grep -vE 'untrusted|stress' | paste -sd, | sed 's/,/, /g; s/^$/none/')."
}

valgrind_section() {
    echo "## Uninitialized memory"
    echo
    echo "The stored inputs of every reader and the unit tests under valgrind:"
    echo "$(sed -n 's/^valgrind: //p' "$fuzz/valgrind.txt"), $(grep -c ^FAILED "$fuzz/valgrind.txt") of them with an error."
}

device() {
    echo "$(sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo | head -n 1), $(nproc) cores"
}

for step in "$@"; do
    run_step "$step"
done
missing=()
for step in "${steps[@]}"; do
    [ "$(cat "$fuzz/$step.commit" 2>/dev/null)" = "$commit" ] || missing+=("$step")
done
[ ${#missing[@]} -eq 0 ] || { echo "no page: not run at $commit: ${missing[*]}"; exit $status; }
{
    cat <<END
# Robustness: what was tried, and what failed

- Commit: $commit
- Scenes: stored inputs of \`tests/fuzz\`; tiny synthetic scenes
- Device: $(device)
- Date: $(date -u +%F)
- Made by: \`tests/stability/report.sh BUILD\`

SECURITY.md says what Oriel promises; the inputs and checks below are in \`tests/fuzz\` and \`tests/stability\`.
END
    for step in "${steps[@]}"; do
        echo
        "${step}_section"
    done
} >"$page.part"
mv "$page.part" "$page"
echo "$page"
exit $status
