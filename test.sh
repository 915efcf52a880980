#!/usr/bin/env bash
# Installs what is missing, builds Oriel and runs all of its tests.
#   ./test.sh                  everything
#   ./test.sh --quick [REGEX]  the plain build and its tests only, those of that name
# --strict: warnings are errors, as in CI.
set -u
cd "$(dirname "$0")" || exit 1
. .ci/deps.sh

quick='' strict=() names=.
for word in "$@"; do
    case $word in
        --quick) quick=1 ;;
        --strict) strict=(-DCMAKE_COMPILE_WARNING_AS_ERROR=ON) ;;
        -*) sed -n '3,5s/^# *//p' "$0"; exit 2 ;;
        *) names=$word ;;
    esac
done
start=$SECONDS
# Rough minutes on two cores without a GPU, for the time left: "name minutes".
steps=("dependencies 2" "build 1" "tests 9")
[ "$quick" ] || steps+=("zink 2" "clang 2" "mutants 5" "sanitizers 4" "fuzz 3")
failed=()
passed=0 failures=0 skipped=0 gpu_run=0

minutes_left() {
    local left=0 seen= step
    for step in "${steps[@]}"; do
        [ "${step% *}" = "$1" ] && seen=1
        [ "$seen" ] && left=$((left + ${step#* }))
    done
    echo "$left"
}

step() {
    local minutes
    minutes=$(minutes_left "$1")
    echo "== [$((SECONDS - start)) s] $2 (about $minutes min left)"
}

# Runs ctest in a build folder and adds its counts to the totals.
run_tests() {
    local dir=$1 log=$1/ctest.log line
    shift
    # Two at a time: most end-to-end tests keep one core busy.
    ctest --test-dir "$dir" --output-on-failure -j 2 "$@" | tee "$log"
    [ "${PIPESTATUS[0]}" -eq 0 ] || failed+=("tests in $dir")
    line=$(grep -E '^[0-9]+% tests passed' "$log")
    local bad total away
    bad=$(sed -E 's/.*passed, ([0-9]+) tests? failed.*/\1/' <<<"$line")
    total=$(sed -E 's/.*out of ([0-9]+).*/\1/' <<<"$line")
    away=$(grep -cE '\*\*\*Skipped' "$log")
    passed=$((passed + ${total:-0} - ${bad:-0} - away))
    failures=$((failures + ${bad:-0}))
    skipped=$((skipped + away))
    gpu_run=$((gpu_run + $(grep -cE ' (gpu|golden)/[a-z_]+ \.* +Passed' "$log")))
}

finish() {
    # Mesa's software renderer is among the dependencies: without a device nothing was tested.
    [ "$gpu_run" -gt 0 ] || failed+=("every GPU test was skipped")
    for name in "${failed[@]}"; do
        echo "FAILED: $name"
    done
    echo "== took $((SECONDS - start)) s"
    echo "$passed passed, $failures failed, $skipped skipped"
    [ ${#failed[@]} -eq 0 ] && [ "$failures" -eq 0 ] && [ "$passed" -gt 0 ]
    exit
}

step dependencies "checking dependencies"
extra=(libcmocka-dev git jq curl openexr imagemagick libheif-examples sqlite3
    chromium chromium-driver firefox-esr python3-selenium python3-flask python3-matplotlib python3-numpy python3-pil
    glslang-tools spirv-tools cppcheck)
# HEIC and AVIF files are written by plugins, where libheif has such.
apt-cache show libheif-plugin-x265 >/dev/null 2>&1 && extra+=(libheif-plugin-x265 libheif-plugin-aomenc)
[ "$quick" ] || extra+=(clang llvm libclang-rt-dev mesa-vulkan-drivers)
install_dependencies "${extra[@]}" || { failed+=("installing dependencies"); finish; }

step build "building with gcc"
build_oriel build -DORL_TESTS=ON "${strict[@]}" || { failed+=("gcc build"); finish; }

step tests "running the tests"
run_tests build -R "$names"

if [ -z "$quick" ]; then
    step zink "running the GPU tests on a second OpenGL: zink, over a software Vulkan"
    # Left out are the tests that take longest; others compile the same programs. A driver on top of
    # another one may be tried twice.
    export GALLIUM_DRIVER=zink LIBGL_ALWAYS_SOFTWARE=1 ORIEL_TEST_DEVICE=zink
    run_tests build -L 'gpu|golden' -E 'test_trim|test_densify_truth|gpu/shaders' \
        --repeat until-pass:2
    unset GALLIUM_DRIVER LIBGL_ALWAYS_SOFTWARE ORIEL_TEST_DEVICE

    step clang "building with clang and testing that"
    if CC=clang CXX=clang++ build_oriel build-clang -DORL_TESTS=ON "${strict[@]}"; then
        run_tests build-clang -L 'unit|golden'
    else
        failed+=("clang build")
    fi

    step mutants "making small wrong changes to files of the last 20 commits, which tests must notice"
    # Where there are fewer commits, to what came after the first.
    if before=$(git rev-list --max-count=21 HEAD | tail -n 1) && [ "$before" ]; then
        tests/mutants/run.py build --changed "$before" --minutes 5 || failed+=("changes that no test notices")
    fi

    step sanitizers "building and testing with AddressSanitizer and UBSan"
    # Leaks of Mesa and EGL's driver loading are not ours to fix: leak detection
    # stays on for the unit tests, which use no GL. leaks.supp names other libraries'.
    if build_oriel build-sanitize --preset=sanitize "${strict[@]}"; then
        LSAN_OPTIONS=suppressions=$PWD/tests/leaks.supp UBSAN_OPTIONS=print_stacktrace=1 \
            run_tests build-sanitize -L 'unit|fuzz'
        ASAN_OPTIONS=detect_leaks=0 UBSAN_OPTIONS=print_stacktrace=1 \
            run_tests build-sanitize -L gpu -E gpu/shaders # which needs the golden tests, too
        ASAN_OPTIONS=detect_leaks=0 UBSAN_OPTIONS=print_stacktrace=1 run_tests build-sanitize -R '^e2e/(help|methods)$'
    else
        failed+=("sanitizer build")
    fi

    step fuzz "fuzzing every reader of files for some seconds"
    # Always the same search, with an end that no faster machine passes: what decides about a change
    # is that change, not a draw.
    FUZZ_SEED=1 FUZZ_RUNS=10000 FUZZ_JOBS=$(nproc) tests/fuzz/run.sh 3 || failed+=("fuzzing")
fi
finish
