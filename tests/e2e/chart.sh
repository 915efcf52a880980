#!/usr/bin/env bash
# oriel chart on workspaces made by hand: figures, files, rows used again only where they may
# be, peers, refusals. Never how long anything takes.
set -u
. "$2/tests/e2e/command_lib"

needs_reports
workspace 5 || exit 77
square
scene train train train test test
cp -r ws other

chart=("$oriel" chart ws --quiet --out report --quick)
runs 0 "${chart[@]}" --method points,ulr
[ -s stderr.txt ] && fail "--quiet is not quiet"
grep -q '^2 rows measured, 0 used again, 0 left out' stdout.txt || fail "no summary"
grep -q 'front$' stdout.txt || fail "nothing is on the front"
for field in version device quick scenes rows overall photographs held_out points prepare_s views mean sd \
    psnr_db psnr_cc_db psnr_covered_db ssim flip crumbs coverage completeness flicker frame_ms cpu_ms \
    device_bytes device_bytes_by_owner on_front dominated_by pictures; do
    grep -q "\"$field\"" report/chart.json || fail "no field $field"
done
for file in chart.svg chart.ws.svg; do
    tail -n1 "report/$file" | grep -q '</svg>' || fail "no figure $file"
done
[ "$(ls report/pictures/ws/points.*.jpg | wc -l)" = 2 ] || fail "no pictures of both photographs"
grep -q 'src="pictures/ws/points\.' report/chart.html || fail "no pictures in the page"
grep -Eq '(src|href)="?(https?:)?//' report/chart.html && fail "the page needs a network"

# Rows are used again while nothing changed, and only then; those of two parts are all of them.
cp report/chart.json before.json
runs 0 "${chart[@]}" --method points,ulr
grep -q '^0 rows measured, 2 used again' stdout.txt || fail "rows were not used again"
cmp -s before.json report/chart.json || fail "the same rows make another chart"
cut -c 1-40 report/rows/ws/points.json >cut && mv cut report/rows/ws/points.json
runs 0 "${chart[@]}" --method points,ulr
grep -q '^1 rows measured' stdout.txt || fail "a damaged row was used"
printf ' ' >>ws/scene.json
parts=("$oriel" chart ws --quiet --out parts --quick --method points,ulr)
in_two_parts chart "${parts[@]}"
grep -q '^0 rows measured, 2 used again' stdout.txt || fail "rows of the parts were not used"
runs 0 "${chart[@]}" --method points,ulr
grep -q '^2 rows measured' stdout.txt || fail "rows of another scene were used"
runs 2 "${parts[@]}" --part 3/2

# A paper's method once more on the proxy of oriel; settings of the method that has some; two scenes.
runs 0 "$oriel" chart ws other --quiet --out full --views 1 --method oriel-fast
grep -q '^oriel-fast  *photos_per_pixel=1 ' stdout.txt || fail "no settings"
grep -q '(all scenes)$' stdout.txt || fail "nothing over all scenes"
for setting in 'photographs at 1/2' 'textures ycc' 'photos_per_pixel=1'; do
    grep -q "\"setting\": \"$setting\"" full/chart.json || fail "no row $setting"
done
runs 0 "$oriel" eval ws --method airieau,paired --json - --quiet
grep -q '"on the proxy of oriel"' stdout.txt || fail "no weights on the same proxy"
[ "$(grep -c '"method": "airieau"' stdout.txt)" = 2 ] || fail "other methods than the one that is named"

# The same photographs, the same figures as those of oriel eval.
runs 0 "$oriel" eval ws --method points --divide 2 --views 2 --json eval.json --quiet
for field in psnr_db ssim flip crumbs completeness; do
    a=$(sed -n "s/.*\"$field\": \([0-9.]*\),*/\1/p" eval.json | tail -n 1) # its mean
    b=$(sed -n "s/.*\"$field\": \([0-9.]*\),*/\1/p" report/rows/ws/points.json | tail -n 2 | head -n 1)
    # Pictures this small may have no crumbs.
    awk -v a="$a" -v b="$b" 'BEGIN { exit !(a != "" && b != "" && (a - b) ^ 2 < 1e-8) }' ||
        fail "$field is $a by eval, $b by chart"
done

# Values of one's own, of the methods that read the option.
runs 0 "${chart[@]}" --method airieau,points --vary depth_tolerance=0.1,0.5
grep -q '^airieau  *depth_tolerance=0.5 ' stdout.txt || fail "no row for a value"
grep -q '^points  *depth' stdout.txt && fail "a value of an option that is not read"
runs 2 "${chart[@]}" --vary nonsense=7

# Another program's pictures: the photographs themselves are perfect.
mkdir -p perfect/ws
for name in "${names[@]:3}"; do
    cp "ws/images/$name" "perfect/ws/$name"
done
runs 0 "$oriel" eval ws --pictures perfect/ws --quiet
grep -q '^mean  *100.00' stdout.txt || fail "the photographs themselves are not perfect"
runs 0 "${chart[@]}" --method points --peer best=perfect,ms=0.001,MIB=2
awk '$1 == "best" && $4 == "100.00" && $NF == "front" { found = 1 } END { exit !found }' stdout.txt ||
    fail "the photographs themselves are not on the front"
runs 0 "${chart[@]}" --method points --peer best=perfect
awk '$1 == "best" && $2 == "-" { found = 1 } END { exit !found }' stdout.txt ||
    fail "a time that nobody told"
rm "perfect/ws/${names[3]}"
runs 2 "${chart[@]}" --method points --peer best=perfect
grep -q "no picture of ${names[3]}" stderr.txt || fail "does not name the picture that lacks"
runs 2 "$oriel" eval ws --pictures perfect/ws --method points

runs 2 "${chart[@]}" --method nonsense
grep -q airieau stderr.txt || fail "does not list the methods"
runs 2 "${chart[@]}" --method points --peer nonsense
runs 2 "${chart[@]}" --method points --peer ms=3
runs 2 "${chart[@]}" --method points --peer best=perfect,ms=none
runs 2 "$oriel" chart ws --quick
runs 2 "$oriel" chart ws --quick --out ws/scene.json
[ "$(cat stderr.txt)" = "oriel: error: ws/scene.json: cannot make this folder: File exists" ] ||
    fail "measures before it says that --out is a file"
runs 2 "$oriel" chart
runs 2 "$oriel" chart ws ws --quick --out twice --method points
grep -q 'two scenes are named ws' stderr.txt || fail "does not say that names are alike"
runs 2 "$oriel" chart nowhere --out none
sed -i 's/"test"/"train"/' other/scene.json
runs 2 "$oriel" chart other --out none
grep -q 'held out' stderr.txt || fail "does not say that nothing is held out"
runs 0 "$oriel" chart --help
exit $failed
