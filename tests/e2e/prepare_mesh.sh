#!/bin/bash
# The optional stage mesh: made when it is asked for, resumed, made again after the points change,
# removed when it is no longer wanted. With a stand-in for COLMAP.
. "$2/tests/e2e/prepare_lib"
export ORIEL_COLMAP=$source/tests/e2e/colmap_double DOUBLE_TRACE=$work/trace
photos "$work/p" 0.png 1.png 2.png 3.png
scene=$work/s

prepare() {
    local expected=$1
    shift
    : >"$work/trace"
    run "$expected" prepare "$work/p" --out "$scene" --test-list 1 "$@"
}
ran() { grep -v help "$work/trace" | uniq | tr '\n' ' '; }

prepare 0
[ ! -e "$scene/mesh.ply" ] || fail "a mesh that nobody asked for"
# Nothing but the mesh is made.
prepare 0 --resume --mesh poisson
[ "$(ran)" = "poisson_mesher " ] || fail "instead of the mesher ran: $(ran)"
[ -s "$scene/mesh.ply" ] && [ ! -e "$scene/.oriel/mesh.tmp" ] || fail "no mesh, or what made it"
grep -q '"triangles": 1' "$scene/scene.json" || fail "scene.json does not count the triangles"
prepare 0 --resume --mesh poisson
[ -z "$(ran)" ] || fail "a mesh that is there was made again: $(ran)"
run 0 info "$scene" --check
rm "$scene/mesh.ply"
prepare 0 --resume --mesh poisson
[ "$(ran)" = "poisson_mesher " ] || fail "a lost mesh was not made again"
# Another mesher, which reads the sparse model; a killed one leaves no scene and no mesh of its own.
DOUBLE_KILL=delaunay_mesher "$oriel" prepare "$work/p" --out "$scene" --test-list 1 --resume \
    --mesh delaunay 2>"$work/err"
run 2 info "$scene"
says "missing: mesh"
prepare 0 --resume --mesh delaunay
[ "$(ran)" = "delaunay_mesher " ] || fail "after the kill ran: $(ran)"
DOUBLE_FAIL=poisson_mesher prepare 1 --resume --mesh poisson
says "poisson_mesher failed"
# New points make a new mesh.
rm "$scene/points.ply" "$scene/.oriel/fused.ply"
DOUBLE_SHIFT=5 prepare 0 --resume --mesh delaunay
ran | grep -q 'patch_match_stereo delaunay_mesher' || fail "the mesh of other points stays: $(ran)"
# No longer wanted.
prepare 0 --resume
[ ! -e "$scene/mesh.ply" ] || fail "the mesh stays although it is not asked for"
grep -q '"triangles"' "$scene/scene.json" && fail "scene.json counts triangles without a mesh"
run 2 prepare "$work/p" --out "$scene" --mesh cubes
says "none, poisson, delaunay"
finish
