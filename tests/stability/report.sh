#!/usr/bin/env bash
# Writes docs/measured/robustness.md: fuzzes every reader, injects every fault, soaks, counts.
# usage: tests/stability/report.sh BUILD [STEP]..
# BUILD: a build folder with the program and tests. STEP: what to run now, each a section of the page
# that names its commit; without any, all of them. A step that is not named keeps its section, or
# gets a new one of what an earlier run left in FUZZ_DIR (build-fuzz).
#   fuzz       every reader for FUZZ_SECONDS (3; 0: only the inputs that there are); inputs tried add
#              up over the runs of one commit, of each reader the last (tests/fuzz/run.sh)
#   faults     the first calls of a kind and then ever fewer, or with FAULTS=all every call in turn,
#              which takes hours
#   soak       SOAK_FRAMES (10000) frames and SOAK_ROUNDS (1000) openings
#   threads    what has threads; THREADS_BUILD: configured with -DORL_SANITIZE_THREADS=ON
#   sanitized  the tests of the whole program; SANITIZE_BUILD: configured with -DORL_SANITIZE=ON
#   valgrind   every stored input and the unit tests
set -u -o pipefail
[ $# -ge 1 ] || { sed -n '3,15s/^# *//p' "$0"; exit 2; }
source=$(cd "$(dirname "$0")/../.." && pwd) build=$(realpath "$1")
fuzz=${FUZZ_DIR:-$source/build-fuzz} page=$source/docs/measured/robustness.md
shift
[ $# -gt 0 ] || set -- fuzz faults soak threads sanitized valgrind
status=0
mkdir -p "$fuzz/failures"

# begin STEP: forgets what an earlier run found, and notes the commit that this one tries.
begin() {
    : >"$fuzz/$1.txt"
    git -C "$source" rev-parse --short=8 HEAD >"$fuzz/$1.commit"
}

run_step() {
    local script
    case $1 in
    fuzz)
        "$source/tests/fuzz/run.sh" "${FUZZ_SECONDS:-3}"
        local tried=$?
        fuzz_rows | awk '{ print $4 }' >"$fuzz/fuzz.commit"
        [ $tried -eq 0 ]
        ;;
    faults)
        begin faults
        for script in inject inject_prepare inject_publish inject_trim; do
            "$source/tests/stability/$script.sh" "$build/oriel" "$source" \
                "$build/tests/libinject.so" "${FAULTS:-}" 2>&1 | tee -a "$fuzz/faults.txt" || status=1
        done
        ;;
    soak)
        begin soak
        "$source/tests/stability/soak.sh" "$build/oriel" "$source" "$build/tests/soak" \
            "${SOAK_FRAMES:-10000}" "${SOAK_ROUNDS:-1000}" 2>&1 | tee "$fuzz/soak.txt"
        ;;
    threads)
        begin threads
        "$source/tests/stability/threads.sh" "${THREADS_BUILD:?}" "$source" | tee "$fuzz/threads.txt"
        ;;
    sanitized)
        begin sanitized
        ASAN_OPTIONS=detect_leaks=0 ctest --test-dir "${SANITIZE_BUILD:?}" -L e2e \
            --output-on-failure | tee "$fuzz/sanitized.txt"
        ;;
    valgrind)
        begin valgrind
        "$source/tests/stability/valgrind.sh" "$build" "$source" | tee "$fuzz/valgrind.txt"
        ;;
    *) echo "no step $1" >&2 && false ;;
    esac || status=1
}

# Lines "READER INPUTS SECONDS COMMIT": the runs of each reader at the commit of its last one.
fuzz_rows() {
    awk '{ last[$1] = $4; n[$1, $4] += $2; s[$1, $4] += $3 }
         END { for (k in last) print k, n[k, last[k]], s[k, last[k]], last[k] }' "$fuzz/tried.txt" | sort
}

at_commit() {
    sort -u "$fuzz/$1.commit" | paste -sd, | sed 's/,/, /g; s/.*/At commit &./'
    echo
}

fuzz_section() {
    local name inputs time commit left
    echo "## Inputs tried"
    echo
    echo "libFuzzer under AddressSanitizer and UndefinedBehaviorSanitizer, with memory limited."
    echo
    echo "| reader | inputs tried | seconds of processor time | commit | failures left |"
    echo "|---|--:|--:|---|--:|"
    fuzz_rows | while read -r name inputs time commit; do
        left=$(find "$fuzz/failures" -name "$name-*" | wc -l)
        printf '| %s | %s | %.0f | %s | %s |\n' "$name" "$inputs" "$time" "$commit" "$left"
    done
    fuzz_rows | awk '{ n += $2; s += $3 } END { printf "| **all** | %d | %d (%.2f hours) | | ", n, s, s / 3600 }'
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
    echo "| fault | times | commit | files cut, crashes, wrong statuses |"
    echo "|---|--:|---|--:|"
    sed -n 's/^injected: \(.*\) \([0-9]*\)$/\1|\2/p' "$fuzz/faults.txt" |
        while IFS='|' read -r kind times; do
            echo "| $kind | $times | $(cat "$fuzz/faults.commit") | $(grep -c "^FAILED.*: $kind: call " "$fuzz/faults.txt") |"
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
    echo "| what | commit | slope of memory, KiB each |"
    echo "|---|---|--:|"
    sed -n "s/^soaked: \(.*\), memory \([-+.0-9]*\) KiB.*/| \1 | $(cat "$fuzz/soak.commit") | \2 |/p" "$fuzz/soak.txt"
}

threads_section() {
    echo "## Threads"
    echo
    at_commit threads
    echo "Under ThreadSanitizer: $(sed -n 's/^threads: //p' "$fuzz/threads.txt")," \
        "$(grep -c ^FAILED "$fuzz/threads.txt") with a race."
}

sanitized_section() {
    echo "## The whole program under sanitizers"
    echo
    at_commit sanitized
    echo "Under AddressSanitizer and UndefinedBehaviorSanitizer, without leaks, which the unit tests"
    echo "look for, $(grep -cE '\*\*\*(Failed|Timeout|Exception)' "$fuzz/sanitized.txt") failed of" \
        "$(sed -nE 's/.*Test +#[0-9]+: e2e\/([a-z_]+) .*(Passed|\*\*\*[FTE]).*/`\1`/p' "$fuzz/sanitized.txt" |
            sort -u | paste -sd, | sed 's/,/, /g' | fold -sw 96)" \
        "(of $(find "$source/tests/e2e" -name '*.sh' | wc -l) scripts)."
}

valgrind_section() {
    echo "## Uninitialized memory"
    echo
    at_commit valgrind
    echo "The stored inputs of every reader and the unit tests under valgrind:"
    echo "$(sed -n 's/^valgrind: //p' "$fuzz/valgrind.txt"), $(grep -c ^FAILED "$fuzz/valgrind.txt") of them with an error."
}

# The commits of all sections; of those that are kept, what the page has.
all_commits() {
    { cat "$fuzz"/*.commit
      [ "$(ls "$fuzz"/*.commit | wc -l)" -eq 6 ] ||
          sed -n 's/^- Commit: \([^;]*\).*/\1/p' "$page" | tr -d ' ' | tr , '\n'
    } | sort -u | paste -sd, | sed 's/,/, /g'
}

# section STEP HEADING: of what lies in FUZZ_DIR, else as the page has it.
section() {
    if [ -s "$fuzz/$1.commit" ]; then
        "$1_section"
        echo
    else
        awk -v heading="## $2" '/^## / { inside = $0 == heading } inside' "$page"
    fi
}

device() {
    echo "$(sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo | head -n 1), $(nproc) cores"
}

for step in "$@"; do
    run_step "$step"
done
{
    cat <<END
# Robustness: what was tried, and what failed

- Commit: $(all_commits); each section names its own
- Scenes: stored inputs of \`tests/fuzz\`; tiny synthetic scenes
- Device: $(device)
- Date: $(date -u +%F)
- Made by: \`tests/stability/report.sh BUILD [STEP]..\`

SECURITY.md says what Oriel promises; the inputs and checks below are in \`tests/fuzz\` and \`tests/stability\`.

END
    section fuzz "Inputs tried"
    section faults "Faults injected"
    section soak "Soaked"
    section threads "Threads"
    section sanitized "The whole program under sanitizers"
    section valgrind "Uninitialized memory"
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
