#!/usr/bin/env bash
# Fuzzes every reader of files with libFuzzer under AddressSanitizer and UBSan, then says how many
# lines of each reader the inputs reach.
# usage: tests/fuzz/run.sh SECONDS [TARGET]..      SECONDS for each target; 0: none, only count
# The build and the inputs found so far are kept in build-fuzz/ (FUZZ_DIR). FUZZ_JOBS targets run
# at once. Runs of one FUZZ_SEED try the same inputs in the same order, FUZZ_RUNS of them at most.
# Inputs that fail are in build-fuzz/failures: mend the reader, then add them to
# tests/fuzz/inputs/TARGET. Exit status 0 only when nothing failed.
set -u
[ $# -ge 1 ] || { sed -n '2,9s/^# *//p' "$0"; exit 2; }
here=$(cd "$(dirname "$0")" && pwd)
. "$here/../../.ci/deps.sh"
dir=${FUZZ_DIR:-$here/../../build-fuzz} jobs=${FUZZ_JOBS:-1} seconds=$1
shift
build_oriel "$dir" --preset=fuzz fuzz ||
    exit 1
dir=$(cd "$dir" && pwd)
fuzz=$dir/tests/fuzz/fuzz
mkdir -p "$dir/failures" "$dir/profiles"

# Each target and the files that it is there for.
readers=(
    "colmap_binary src/scene/colmap_read.c src/scene/colmap.c src/scene/colmap_distort.c"
    "colmap_text src/scene/colmap_read.c"
    "depth_map src/scene/colmap_map.c"
    "ply src/scene/points_ply.c src/scene/points.c src/scene/point_radii.c"
    "lod src/scene/point_lod.c src/scene/point_lod_write.c"
    "manifest src/scene/manifest.c src/scene/tuned_settings.c src/core/json.c"
    "stages src/scene/manifest.c"
    "path_json src/scene/path.c src/core/camera.c"
    "path_text src/scene/path.c src/scene/colmap_read.c"
    "exposures preprocess/job/exposure_list.c src/scene/text_lines.c"
    "exif src/io/exif.c"
    "jpeg src/io/jpeg.c src/io/picture.c"
    "png src/io/png.c"
    "stream src/io/stream.c"
    "tiff src/io/tiff.c src/io/profile.c"
    "heif src/io/heif.c"
    "exr src/io/exr_read.c"
    "raw src/io/raw.c"
    "cameras_json src/scene/known_json.c src/scene/known_cameras.c preprocess/import/import_target.c"
    "workspace src/scene/scene.c src/scene/info.c src/scene/ground_plane.c"
    "mesh src/scene/mesh_ply.c src/scene/mesh_obj.c src/scene/ply.c src/scene/mesh.c"
    "database preprocess/calibrate/database.c"
    "walk_message src/walk/choices.c src/walk/content.c src/walk/rendering.c"
    "walk_settings src/walk/settings.c"
    "options src/render/params.c"
    "shader src/gpu/shader_source.c"
)
wanted=" ${*:-} "
commit=$(git -C "$here" rev-parse --short=8 HEAD)

run_target() {
    local name=$1 corpus=$dir/corpus/$1
    local TIMEFORMAT=%U
    mkdir -p "$corpus"
    # Processor time, since the machine may have other work.
    { time FUZZ_TARGET=$name LLVM_PROFILE_FILE=/dev/null ASAN_OPTIONS=allocator_may_return_null=1 \
        LSAN_OPTIONS=suppressions=$here/../leaks.supp UBSAN_OPTIONS=print_stacktrace=1 \
        "$fuzz" "$corpus" "$here/inputs/$name" \
        -max_total_time="$seconds" -max_len=8192 -timeout=30 -rss_limit_mb=3000 \
        -seed="${FUZZ_SEED:-0}" -runs="${FUZZ_RUNS:--1}" -print_final_stats=1 \
        -artifact_prefix="$dir/failures/$name-" \
        >"$dir/$name.log" 2>&1; } 2>"$dir/$name.time"
    local status=$? runs
    runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$dir/$name.log")
    # All runs of this build folder, each with its commit.
    echo "$name ${runs:-0} $(tail -n 1 "$dir/$name.time") $commit" >>"$dir/tried.txt"
    if [ $status -eq 0 ]; then
        echo "$name: ${runs:-0} inputs"
    else
        echo "$name: FAILED, see $dir/$name.log and $dir/failures"
        tail -n 25 "$dir/$name.log"
        touch "$dir/failed"
    fi
}

# Lines "FILE LINES LINES_REACHED" of all source files, by what all inputs reach.
summarise() {
    llvm-cov export -summary-only -instr-profile="$dir/profiles/all" "$fuzz" |
        sed 's/{"filename":"/\n/g; s/"totals"/\n&/' |
        sed -nE 's/^([^"]*)".*[{,]"lines":\{"count":([0-9]+),"covered":([0-9]+).*/\1 \2 \3/p'
}

rm -f "$dir/failed"
started=$SECONDS
for row in "${readers[@]}"; do
    name=${row%% *}
    [ "$seconds" -gt 0 ] || break
    [ "$wanted" = "  " ] || [[ $wanted == *" $name "* ]] || continue
    run_target "$name" &
    while [ "$(jobs -rp | wc -l)" -ge "$jobs" ]; do wait -n; done
done
wait
echo "fuzzed for $((SECONDS - started)) s on $jobs core(s)"
[ -e "$dir/failed" ] && exit 1

# Coverage: every input once more, for its profile. A leak, which ends the program ahead of it, has
# been looked for above.
command -v llvm-cov >/dev/null || exit 0
for row in "${readers[@]}"; do
    name=${row%% *}
    mkdir -p "$dir/corpus/$name"
    FUZZ_TARGET=$name LLVM_PROFILE_FILE=$dir/profiles/$name.raw \
        ASAN_OPTIONS=allocator_may_return_null=1:detect_leaks=0 "$fuzz" -runs=0 "$dir/corpus/$name" \
        "$here/inputs/$name" -rss_limit_mb=3000 >/dev/null 2>&1
done
llvm-profdata merge -o "$dir/profiles/all" "$dir"/profiles/*.raw || exit 1
summarise >"$dir/summary.txt"
for row in "${readers[@]}"; do
    # shellcheck disable=SC2086
    set -- $row
    for file in "${@:2}"; do
        read -r _ lines reached <<<"$(grep "/$file " "$dir/summary.txt" | head -n 1)"
        echo "lines $1 $file ${reached:-0} ${lines:-0}"
    done
done | sort -u -k3,3 | tee "$dir/lines.txt" |
    awk '{ printf "%-34s %4d of %4d lines, %.0f %%\n", $3, $4, $5, 100 * $4 / ($5 ? $5 : 1) }'
