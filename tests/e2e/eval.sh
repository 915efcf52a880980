#!/usr/bin/env bash
# oriel eval on a workspace made by hand: figures, files, and what it refuses.
set -u
. "$2/tests/e2e/command_lib"

workspace 3 || exit 1
square

runs 2 "$oriel" eval ws
grep -q -- '--test-every' stderr.txt || fail "no advice when nothing is held out"

scene train test train

runs 0 "$oriel" eval ws --json out.json --images pictures --quiet
grep -q "${names[1]}.*96x64" stdout.txt || fail "no row for the held-out photograph"
grep -q "${names[0]}" stdout.txt && fail "a row for a photograph that is not held out"
grep -q '^mean' stdout.txt || fail "no mean"
[ -s stderr.txt ] && fail "--quiet is not quiet"
head -c1 out.json | grep -q '{' || fail "the JSON of one method is no object"
for field in scene method device size views mean photo psnr_db psnr_cc_db psnr_covered_db ssim \
    coverage completeness ncc_error crumbs flip render_ms; do
    grep -q "\"$field\"" out.json || fail "no field $field"
done
[ "$(ls pictures | wc -l)" -eq 3 ] || fail "not three pictures: $(ls pictures)"

runs 0 "$oriel" eval ws --method all --json - --quiet
head -c1 stdout.txt | grep -q '\[' || fail "the JSON of all methods is no array"
tail -n1 stdout.txt | grep -q '\]' || fail "something after the JSON"
grep -q '"points"' stdout.txt || fail "not all methods"

# An option's values, and what they cost.
runs 0 "$oriel" eval ws --vary photos_per_pixel=1,3 --json out.json --quiet
[ "$(grep -c '^oriel photos_per_pixel=[13],' stdout.txt)" -eq 2 ] || fail "not a table for each value"
grep -q '"setting": "photos_per_pixel=3"' out.json || fail "no setting in the JSON"
head -c1 out.json | grep -q '\[' || fail "the JSON of several values is no array"
runs 2 "$oriel" eval ws --vary photos_per_pixel
runs 2 "$oriel" eval ws --vary photos_per_pixel=1,nonsense
runs 2 "$oriel" eval ws --vary photos_per_pixel=1,2 --images pictures
runs 2 "$oriel" eval ws --walk 3 --vary photos_per_pixel=1

runs 2 "$oriel" eval ws --method nonsense
grep -q 'airieau' stderr.txt || fail "does not list the methods"
runs 2 "$oriel" eval ws --set nonsense=1
runs 2 "$oriel" eval nowhere
runs 2 "$oriel" eval
runs 0 "$oriel" eval --help

# A screen smaller than the photographs.
runs 0 "$oriel" eval ws --divide 2 --quiet
grep -q "${names[1]}.*48x32" stdout.txt || fail "not at half the size"
runs 2 "$oriel" eval ws --divide 2 --truth nowhere

# A walk.
runs 0 "$oriel" eval ws --walk 3 --divide 2 --method all --json walk.json --images walk --quiet
grep -q 'walk of 3 frames of 48x32' stdout.txt || fail "no head of the walk's table"
grep -q '^oriel ' stdout.txt || fail "no row for a method"
[ -s walk/oriel.00002.png ] || fail "no frame of the walk"
for field in scene method device size frames compared mean p99 floor blocks block_mean block_worst \
    block_at jump steps all; do
    grep -q "\"$field\"" walk.json || fail "no field $field"
done
head -c1 walk.json | grep -q '\[' || fail "the JSON of all methods is no array"
runs 2 "$oriel" eval ws --walk 3 --merge fused

# Radiance: the truth's own photographs are the scene's, so undistortion is none.
runs 0 "$oriel" eval ws --truth photos-truth --merge fused --json out.json
grep -q 'no distortion' stderr.txt || fail "does not say what it assumes"
for field in pu21_psnr_db mu_psnr_db log2_rmse log2_rmse_fitted psnr_db; do
    [ "$(grep -c "\"$field\"" out.json)" -eq 2 ] || fail "no field $field in view and mean"
done
grep -q '^radiance' stdout.txt || fail "no table of radiance"
runs 2 "$oriel" eval ws --merge fused --textures ycc
grep -q 'without --textures' stderr.txt || fail "does not say that --merge ignores --textures"
runs 2 "$oriel" eval ws --merge added
grep -q 'fused, series' stderr.txt || fail "does not list the merges"
runs 2 "$oriel" eval ws --truth nowhere
grep -q 'nowhere/synth.json' stderr.txt || fail "does not name the missing truth"

# A held-out photograph that is damaged: no figures, no report.
head -c 700 "ws/images/${names[1]}" >cut && mv cut "ws/images/${names[1]}"
rm -f out.json
runs 2 "$oriel" eval ws --json out.json
grep -q "${names[1]}" stderr.txt || fail "does not name the damaged photograph"
[ -e out.json ] && fail "a report in spite of the failure"
exit $failed
