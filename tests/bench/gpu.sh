#!/usr/bin/env bash
# Measures Oriel on the GPU of this machine, in ten minutes at most: the tests of label gpu, frames a
# second of all methods, points splatted a second, stereo, memory, and the passes of
# Airieau 2012's Table 2. Leaves OUT/gpu.json and the page OUT/gpu.md, which belongs to docs/measured.
# A device that is software gets fewer and smaller pictures; what ten minutes do not
# reach is named.
# usage: tests/bench/gpu.sh BUILD OUT
#        tests/bench/gpu.sh --pack BUILD FILE.tar.gz
# --pack: what the measurement needs, with its libraries but for the C library and the driver, for a
# machine that has neither a compiler nor packages: unpack it there and run
#     ./gpu.sh build OUT
set -eu
usage() { sed -n '2,11s/^# *//p' "$0"; exit 2; }
here=$(cd "$(dirname "$0")" && pwd)

pack() {
    local build=$1 file=$2 work program
    work=$(mktemp -d)
    trap "rm -rf '$work'" EXIT
    mkdir -p "$work/gpu/build/tests" "$work/gpu/lib"
    cp "$here/gpu.sh" "$here/truth_cloud" "$work/gpu/"
    cp "$build/oriel" "$work/gpu/build/"
    cp "$build"/tests/gpu_test_* "$work/gpu/build/tests/"
    cp "$(command -v jq)" "$work/gpu/"
    for program in "$work/gpu/build/oriel" "$work"/gpu/build/tests/* "$work/gpu/jq"; do
        strip "$program"
        ldd "$program" | awk '$3 ~ /^\// { print $3 }'
    done | sort -u | grep -vE '/(libc|libm|libpthread|libdl|librt)\.so' | xargs cp -Lt "$work/gpu/lib"
    # The dispatcher of drivers, which epoxy opens by its name.
    cp -L /usr/lib/*/libEGL.so.1 /usr/lib/*/libOpenGL.so.0 /usr/lib/*/libGLdispatch.so.0 "$work/gpu/lib"
    tar -C "$work/gpu" -caf "$file" .
}

if [ "${1:-}" = --pack ]; then
    [ $# -eq 3 ] || usage
    pack "$2" "$3"
    exit
fi
[ $# -eq 2 ] || usage
build=$(realpath "$1") out=$(realpath -m "$2")
if [ -d "$here/lib" ]; then # what --pack made
    export LD_LIBRARY_PATH=$here/lib PATH=$here:$PATH
    source=$here
else
    source=$(cd "$here/../.." && pwd)
fi
commit=$("$build/oriel" version --verbose 2>/dev/null | tail -n 1)
commit=$(git -C "$source" rev-parse --short HEAD 2>/dev/null || echo "$commit")
mkdir -p "$out"
cd "$out"

# A part has until so many seconds after the beginning. by SECONDS COMMAND
by() {
    local end=$1
    shift
    [ $SECONDS -lt "$end" ] && timeout $((end - SECONDS)) "$@"
}

# The scene: photographs of a synthetic monument, and its true points. make_scene STEP SYNTH-OPTIONS
make_scene() {
    local step=$1
    shift
    rm -rf photos photos-truth scene
    "$build/oriel" synth monument --out photos "$@" --quiet
    mkdir scene
    "$here/truth_cloud" photos-truth "$step" >scene/fused.ply
    mv photos scene/images
    mv photos-truth/sparse scene/sparse
    rm -r photos-truth
}

echo "== the device"
make_scene 1 --size 192x128 --count 8
"$build/oriel" bench scene --method points --size 64x64 --seconds 0.01 --quiet --json device.json >/dev/null
jq -r '.device' device.json
if [ "$(jq .software device.json)" = true ]; then
    sizes=(256x256 512x512) seconds=0.05 stereo=
else
    sizes=(512x512 1024x1024 1920x1080) seconds=0.3 stereo=full
    make_scene 2 --size 768x512 --count 24
fi

echo null >frames.json # what this part leaves if it fails or is not done in time
echo "== frames"
wanted=()
for size in "${sizes[@]}"; do wanted+=(--size "$size"); done
by 180 "$build/oriel" bench scene --method all "${wanted[@]}" --seconds $seconds --quiet \
    --json frames.json >frames.txt || echo "the frames are not measured: see frames.txt"
echo "== stereo"
by 360 "$build/tests/gpu_test_densify_truth" $stereo >stereo.log 2>&1 ||
    echo "the stereo differs from the truth, or was not done in time"
stereo_s=$(sed -nE 's/^stereo: ([0-9.]+) s a photograph.*/\1/p' stereo.log)

echo "== the tests"
tests=()
for test in "$build"/tests/gpu_test_*; do
    name=${test##*/gpu_}
    [ "$name" != test_densify_truth ] || continue # above
    status=124
    if [ $SECONDS -lt 590 ]; then
        status=0
        by 590 "$test" >"$name.log" 2>&1 || status=$?
    fi
    case $status in 0) said=passed ;; 77) said=skipped ;; 124) said="not reached" ;; *) said=failed ;; esac
    [ "$said" = passed ] || echo "$name: $said"
    tests+=("{\"name\": \"$name\", \"result\": \"$said\"}")
done
(IFS=,; echo "[${tests[*]}]") >tests.json

jq -n --arg commit "$commit" --arg date "$(date -u +%F)" --argjson stereo "${stereo_s:-null}" \
    --arg cpu "$(sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo | head -n 1), $(nproc) cores" \
    --slurpfile tests tests.json --slurpfile frames frames.json \
    --slurpfile device device.json --argjson seconds $SECONDS --argjson photographs "$(ls scene/images | wc -l)" \
    '{commit: $commit, date: $date, device: $device[0].device, driver: $device[0].driver,
      software: $device[0].software, photographs: $photographs, cpu: $cpu, seconds: $seconds, tests: $tests[0], stereo_s_a_photograph: $stereo,
      frames: $frames[0]}' >gpu.json
jq -r '
def fixed(d): if . == null then "-" else . * pow(10; d) | round / pow(10; d) end;
def row: "| " + (map(tostring) | join(" | ")) + " |";
def table(head; rows): (head | row), (head | map("---") | row), (rows | row), "";
"# On a GPU", "",
"- Commit: \(.commit)",
"- Scenes: a synthetic monument of \(.photographs) photographs",
"- Device: \(.device), driver \(.driver)\(if .software then
 ", which is software: no GPU has been measured here" else "" end); \(.cpu)",
"- Date: \(.date)",
"- Made by: `tests/bench/gpu.sh BUILD OUT`, in \(.seconds) s of the 600 that it may take", "",
def tests(result): [.tests[] | select(.result == result) | .name];
def named(what): if length > 0 then what + " " + join(", ") else "none " + what end;
"Tests of label `gpu`: \(tests("passed") | length) passed, \(tests("failed") | named("failed")), " +
"\(tests("skipped") | length) skipped, \(tests("not reached") | named("not reached")). " +
"Stereo: \(if .stereo_s_a_photograph then "\(.stereo_s_a_photograph) s a photograph" else "not measured" end).", "",
(if .frames then "Frames of \(.photographs) photographs of \(.frames.photo_size | map(tostring) | join("x")) " +
"and \(.frames.points) points." else "Frames were not measured: the bench failed, or took too long." end), "",
([.frames.sizes // [] | .[].size] | unique) as $sizes | (.frames.sizes // []) as $runs |
table(["method"] + [$sizes[] | map(tostring) | join("x") + ", fps"] + ["device memory, MiB"];
      ([$runs[].method] | unique)[] as $m |
      [$m] + [$sizes[] as $s | [$runs[] | select(.method == $m and .size == $s) | .fps][0] | fixed(1)] +
      [[$runs[] | select(.method == $m) | .device_bytes] | max / 1048576 | round]),
table(["points", "picture", "splat, ms", "G points a second"];
      .frames.points as $points | $runs[] | select(.method == "points") | [$points, (.size | map(tostring) | join("x")),
      (.passes_ms.splat | fixed(3)), ($points / .passes_ms.splat / 1e6 | fixed(4))]),
"Airieau 2012, Table 2 (a GeForce GTX 570), beside the method `airieau` here; milliseconds.", "",
table(["scene", "size", "raster", "pull-push", "accumulate", "frame"];
      (["Cathedral, 3.8 M points, 58 photographs", "512x512", 7.4, 1.3, 2.7, 11.8], ["", "1024x1024", 7.6, 3.4, 7.0, 18.5],
       ["Church, 1.2 M, 20", "512x512", 2.7, 1.3, 1.3, 5.7], ["", "1024x1024", 2.8, 3.4, 3.3, 10.3],
       ["Sculpture, 0.3 M, 62", "512x512", 0.7, 1.3, 2.3, 4.6], ["", "1024x1024", 0.8, 3.4, 8.2, 13.0],
       ["Statue, 3.8 M, 100", "512x512", 7.5, 1.3, 2.8, 11.9], ["", "1024x1024", 8.5, 3.4, 10.3, 22.7],
       ["Bell, 0.5 M, 236", "512x512", 1.0, 1.3, 8.9, 11.6], ["", "1024x1024", 1.1, 3.4, 25.5, 30.7]),
      ($runs[] | select(.method == "airieau") | ["here", (.size | map(tostring) | join("x")), (.passes_ms.splat | fixed(2)),
       (.passes_ms["pull-push"] | fixed(2)), (.passes_ms.gather | fixed(2)), (.frame_ms | fixed(2))]))
' gpu.json >gpu.md
rm -rf scene
echo "== done: $out/gpu.md"
