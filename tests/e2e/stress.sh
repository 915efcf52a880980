#!/usr/bin/env bash
# oriel stress on a small monument and on a workspace made by hand: files, what worse input costs, rows
# used again only where they may be, refusals.
set -u
. "$2/tests/e2e/command_lib"

needs_reports
small=(--quick --size 96 --photographs 4 --quiet)
some=(--axes photographs,points,pose,exposure,jpeg,nearer --method ulr,points,paired)
runs 0 env LD_PRELOAD="$(dirname "$oriel")/tests/libgpu_check.so" ORIEL_GPU_CHECK=1 "$oriel" stress synth --out report "${some[@]}" "${small[@]}"
grep -q '^checked on the device: [1-9].* 0 faults$' stderr.txt || fail "no shader was checked"
grep -qv '^checked on the device' stderr.txt && fail "--quiet is not quiet"
grep -q '^18 rows measured, 0 used again, 0 left out' stdout.txt || fail "no summary"
grep -q '(jpeg)$' stdout.txt || fail "no table of an axis"
for field in version device quick scene truth size seed methods axes title unit levels own_truth rows severity \
    level mean psnr_db ssim flip crumbs completeness coverage flicker frame_ms cpu_ms device_bytes losses start_db worst_db lost_db at; do
    grep -q "\"$field\"" report/stress.json || fail "no field $field"
done
for axis in photographs jpeg; do
    tail -n1 "report/stress.$axis.svg" | grep -q '</svg>' || fail "no figure of $axis"
    grep -q "src=\"stress.$axis.svg\"" report/stress.html || fail "no figure of $axis in the page"
done

# db AXIS METHOD: PSNR at the first severity and at the worst.
db() { awk -v axis="($1" -v method="$2" '/^method/ { on = index($0, axis) } on && $1 == method { print $2, $3 }' stdout.txt; }
for axis in points pose exposure jpeg; do
    # The same weights on the depth and the background of oriel are better.
    echo "$(db $axis ulr) $(db $axis ulr+oriel)" | awk '!($3 > $1 + 0.5) { exit 1 }' || fail "$axis: not on the proxy of oriel"
    db $axis ulr | awk '!($1 > 10 && $2 < $1 - 0.3) { exit 1 }' || fail "$axis costs nothing: $(db $axis ulr)"
done
for axis in pose jpeg; do
    db $axis points | awk '!(($1 - $2) ^ 2 < 1e-4) { exit 1 }' || fail "points depend on photographs: $axis"
done
[ "$(db photographs ulr | cut -d ' ' -f 1)" = "$(db nearer ulr | cut -d ' ' -f 1)" ] ||
    fail "the unchanged scene is another on another axis"

# Rows are used again while nothing changed, and only then.
cp report/stress.json before.json
runs 0 "$oriel" stress synth --out report "${some[@]}" "${small[@]}"
grep -q '^0 rows measured, 18 used again' stdout.txt || fail "rows were not used again"
cmp -s before.json report/stress.json || fail "the same rows make another report"
one=(--axes jpeg --method points)
runs 0 "$oriel" stress synth --out report "${one[@]}" "${small[@]}" --seed 2
grep -q '^3 rows measured' stdout.txt || fail "rows of another seed were used"
in_two_parts stress "$oriel" stress synth --out parts "${one[@]}" "${small[@]}"
grep -q '^0 rows measured, 3 used again' stdout.txt || fail "rows of the parts were not used"

# Each severity has soft splats of its own, which gain where photographs are many.
runs 0 "$oriel" stress synth --out refined --axes points --method oriel,refined --quick --size 96 --photographs 12 --quiet
echo "$(db points oriel) $(db points oriel+soft)" | awk '!($3 > $1 + 0.2 && $4 > $2 - 0.2) { exit 1 }' || fail "soft splats gain nothing"
runs 2 "$oriel" chart refined --out chart --method refined
grep -q 'method refined is not known' stderr.txt || fail "a chart of what it cannot refine"

# The figure's silhouettes carve a hull, on which no method shows the points' own colours.
runs 0 "$oriel" stress synth --out hull --axes silhouettes,hull-cameras,unsynchronised,backgrounds --method ulr,points "${small[@]}"
for axis in silhouettes hull-cameras unsynchronised backgrounds; do
    db $axis ulr | awk '!($1 > 20 && $2 < $1 - 0.8) { exit 1 }' || fail "wrong $axis cost nothing: $(db $axis ulr)"
done

# Of the vehicle its own pixels alone count, at points of stereo, which finds nothing in three photographs.
runs 0 "$oriel" stress synth --out vehicle --axes vehicle --method points --quick --size 128 --photographs 10 --quiet
jq -e '[.rows[] | select(.mean.psnr_db > 8 and .mean.psnr_db < 18 and .mean.coverage > 0.5 and .mean.crumbs > 0
                         and .mean.ssim == null)] | length == 1' vehicle/stress.json >jq.txt || fail "no row of the vehicle"
jq -e '[.rows[].level] == [0]' vehicle/stress.json >jq.txt || fail "stereo without neighbours"

# A scene: what needs the truth is left out.
workspace 6 || exit 77
square
scene train train train train test test
runs 0 "$oriel" stress ws --out real --method points "${small[@]}" --axes points,gloss
grep -q '(points, %)$' stdout.txt || fail "no axis of a scene"
grep -q gloss stdout.txt && fail "gloss without the truth"
grep -q '"truth": false' real/stress.json || fail "a scene has no truth"
runs 2 "$oriel" stress ws --out real "${small[@]}" --axes gloss
grep -q 'suits' stderr.txt || fail "does not say that no axis suits the scene"
runs 2 "$oriel" stress ws --out real --axes nonsense
grep -q 'passers-by' stderr.txt || fail "does not list the axes"
runs 2 "$oriel" stress ws --out real --method nonsense
grep -q airieau stderr.txt || fail "does not list the methods"
runs 2 "$oriel" stress ws
runs 2 "$oriel" stress ws --out ws/scene.json
[ "$(cat stderr.txt)" = "oriel: error: ws/scene.json: cannot make this folder: File exists" ] ||
    fail "measures before it says that --out is a file"
runs 2 "$oriel" stress --out real
runs 2 "$oriel" stress nowhere --out none
runs 0 "$oriel" stress --help
exit $failed
