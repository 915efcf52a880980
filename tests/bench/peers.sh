#!/usr/bin/env bash
# Charts other programs beside Oriel's methods: what each makes of a scene's training photographs,
# drawn at the held-out cameras.
#     tests/bench/peers.sh ORIEL SCENE OUT [NAME=FILE.ply]... [-- CHART OPTIONS]
#   colmap-mesh    COLMAP's Poisson mesh of the scene's points, with the colours of its vertices
#   NAME=FILE.ply  points, or Gaussians of a 3D Gaussian splatting program, in the scene's frame
# A program that is not installed is named and left out. Oriel draws the results (--method points: a
# mesh by the colours of its vertices, points and Gaussians as opaque discs), and what they leave
# empty is filled from its surroundings as in that method, which a program's own viewer would leave
# black. Times and memory are those of this drawing. SCENE, made by oriel prepare, is only read;
# meshes, logs and pictures go to OUT, the report of oriel chart to OUT/chart. Programs that draw for
# themselves, and meshes with a texture, which Oriel does not draw, join by --peer NAME=DIR with
# their pictures after --. Needs jq.
set -euo pipefail
[ $# -ge 3 ] || { sed -n '2,15s/^# \{0,1\}//p' "$0"; exit 2; }
oriel=$(realpath "$1") scene=$(realpath "$2") out=$(realpath -m "$3")
shift 3
colmap=${ORIEL_COLMAP:-colmap}
export QT_QPA_PLATFORM=offscreen LC_ALL=C
name=$(basename "$scene")
peers=()
divide=1 # of the pictures that the chart times
[[ " $* " != *" --quick "* ]] || divide=2
mkdir -p "$out/logs"

held_out() {
    jq -r '.photographs[] | select(.split == "test") | .name' "$scene/scene.json"
}
[ -n "$(held_out)" ] || { echo "$scene: no photograph is held out" >&2; exit 2; }

# scene_of PEER: a scene without points and mesh of its own, in $ws. Files are shared, since links
# out of a scene are refused.
scene_of() {
    ws=$out/$1
    rm -rf "$ws"
    mkdir -p "$ws"
    cp -rl "$scene/images" "$scene/sparse" "$ws" 2>/dev/null ||
        { rm -rf "$ws/images" "$ws/sparse" && cp -r "$scene/images" "$scene/sparse" "$ws"; }
    [ ! -d "$scene/masks" ] || cp -r "$scene/masks" "$ws"
    # Checksums are those of the files that were left out, and defaults suit other methods.
    jq 'del(.checksums, .render, .tuned)' "$scene/scene.json" >"$ws/scene.json"
}

# draw PEER OPTIONS...: pictures of the scene in $ws, and its cost, as a peer of the chart.
draw() {
    local peer=$1 photo size cost
    shift
    mkdir -p "$out/pictures/$peer/$name"
    held_out | while read -r photo; do
        "$oriel" render "$ws" --at "$photo" --method points "$@" --quiet \
            --out "$out/pictures/$peer/$name/${photo%.*}.png" </dev/null
    done
    size=$("$oriel" info "$ws" --json | jq -r ".photographs[0].size | map(. / $divide | floor) | join(\"x\")")
    cost=$("$oriel" bench "$ws" --method points "$@" --size "$size" --seconds 1 --quiet \
        --json - | jq -r '.sizes[0] | "ms=\(.frame_ms),MIB=\(.device_bytes / 1048576)"')
    peers+=(--peer "$peer=$out/pictures/$peer,$cost")
    echo "$peer: $cost" >&2
}

# run LOG COMMAND...
run() {
    local log=$out/logs/$1
    shift
    "$@" >"$log" 2>&1 || { echo "$1 failed, see $log" >&2; return 1; }
}

# --- the peers ---

# With one thread the mesh does not depend on the threads' timing. Depth and trim are those of
# oriel prepare --mesh poisson.
run_colmap() {
    scene_of colmap-mesh
    cp "$scene/points.ply" "$ws/points.ply"
    run colmap-mesh.log "$colmap" poisson_mesher --input_path "$ws/points.ply" \
        --output_path "$ws/mesh.ply" --PoissonMeshing.depth 10 --PoissonMeshing.trim 7 \
        --PoissonMeshing.num_threads 1 || return 0
    draw colmap-mesh --set proxy=mesh
}

run_points() { # NAME FILE
    scene_of "$1"
    cp "$2" "$ws/points.ply"
    draw "$1"
}

if command -v "$colmap" >/dev/null; then
    run_colmap
else
    echo "left out: colmap-mesh, $colmap is not installed"
fi
while [ $# -gt 0 ] && [ "$1" != -- ]; do
    [ -f "${1#*=}" ] || { echo "$1: must be NAME=FILE.ply" >&2; exit 2; }
    run_points "${1%%=*}" "$(realpath "${1#*=}")"
    shift
done
[ "${1:-}" != -- ] || shift
"$oriel" chart "$scene" --out "$out/chart" "${peers[@]}" "$@"
