#!/usr/bin/env bash
# oriel tune on a workspace made by hand: it finds what was made worse on purpose, says
# the same twice, keeps it when told to, and never looks at held-out photographs.
set -u
. "$2/tests/e2e/command_lib"

workspace 5 || exit 77
bash "$source/tests/bench/truth_cloud" photos-truth 2 >ws/fused.ply || exit 1
scene train train train train test
# A held-out photograph is not even read.
cp "ws/images/${names[4]}" whole.jpg
head -c 700 whole.jpg >"ws/images/${names[4]}"

tune=("$oriel" tune ws --method airieau --size-divide 1)
runs 0 "${tune[@]}" --set depth_tolerance=0.0002 --only depth_tolerance,splat_scale --json a.json
grep -q "^--set depth_tolerance=" stdout.txt || fail "a tolerance far too small was left as it is"
grep -q '"tuned"' ws/scene.json && fail "kept without --apply"
awk '/^airieau: / { exit !($2 > $5 + 0.5) }' stdout.txt || fail "hardly better than the start"
runs 0 "${tune[@]}" --set depth_tolerance=0.0002 --only depth_tolerance,splat_scale --json b.json
cmp -s a.json b.json || fail "a second run says something else"
for field in settings before_psnr_db psnr_db photographs size_divide complete scene method device \
    trials key value ssim kept; do
    grep -q "\"$field\"" a.json || fail "no field $field"
done
grep -q '"photographs": 4' a.json || fail "not the four training photographs"
grep -q '"key": "front_layer"' a.json && fail "an option that was not asked for was tried"

# Kept: info shows it, render uses it, --set wins, and tune goes on from it.
runs 0 "${tune[@]}" --set depth_tolerance=0.0002 --only depth_tolerance --apply --quiet
value=$(sed -n 's/^--set depth_tolerance=//p' stdout.txt)
runs 0 "$oriel" info ws
grep -q "tuned  *airieau: depth_tolerance=$value\$" stdout.txt || fail "info does not show it"
runs 0 "$oriel" info ws --json
grep -q '"tuned"' stdout.txt || fail "info --json does not show it"
picture() {
    runs 0 "$oriel" render ws --at "${names[1]}" --method airieau --quiet --out "$@"
}
picture tuned.png
picture same.png --set depth_tolerance="$value"
picture own.png --set depth_tolerance=0.5
picture start.png --set depth_tolerance=0.0002
cmp -s tuned.png same.png || fail "render does not use what was kept"
cmp -s tuned.png start.png && fail "--set does not win"
cp ws/scene.json kept.json
# Names that the search did not change are kept with the numbers that were found under them.
runs 0 "${tune[@]}" --set visibility=soft --only splat_scale --apply --quiet
grep -q "^--set visibility=soft$" stdout.txt || fail "does not print a setting with a name"
runs 0 "$oriel" info ws
grep -q "visibility=soft" stdout.txt || fail "forgets a setting with a name"
cp kept.json ws/scene.json
runs 0 "$oriel" render ws --at "${names[1]}" --method points --quiet --out other.png
cp whole.jpg "ws/images/${names[4]}"
runs 0 "$oriel" eval ws --method airieau --json tuned.json --quiet
runs 0 "$oriel" eval ws --method airieau --json own.json --quiet --set depth_tolerance="$value"
[ "$(grep psnr_db tuned.json)" = "$(grep psnr_db own.json)" ] || fail "eval does not use it"

# What this program does not know is ignored and said, by the method that it is for.
sed -i 's/"depth_tolerance"/"of_tomorrow"/' ws/scene.json
runs 0 "$oriel" render ws --at "${names[1]}" --method airieau --out other.png
grep -q "of_tomorrow" stderr.txt || fail "an unknown setting is ignored in silence"
runs 0 "$oriel" render ws --at "${names[1]}" --method points --quiet --out other.png
! grep -q "of_tomorrow" stderr.txt || fail "another method names it"
cp kept.json ws/scene.json

runs 2 "${tune[@]}" --only fill
grep -q "fill: not an option that can be tuned" stderr.txt || fail "does not name the option"
runs 2 "${tune[@]}" --method nonsense
runs 0 "${tune[@]}" --budget 0.000001
grep -q "budget" stdout.txt || fail "does not say that the budget ended it"
runs 0 "${tune[@]}" --only splat_scale --json -
jq -e .trials stdout.txt >/dev/null || fail "prints more than JSON"
# What --apply cannot keep is not searched for.
mv ws/scene.json kept.json
runs 2 "${tune[@]}" --apply --only splat_scale
grep -q "prepared scenes only" stderr.txt || fail "does not say which scenes keep settings"
[ -s stdout.txt ] && fail "searches for what cannot be kept"
mv kept.json ws/scene.json
if [ "$(id -u)" -ne 0 ]; then
    chmod a-w ws
    runs 1 "${tune[@]}" --apply --only splat_scale
    chmod u+w ws
    [ -s stdout.txt ] && fail "searches in a scene that cannot be written"
fi
sed -i "s/\"train\"/\"test\"/" ws/scene.json
runs 2 "${tune[@]}"
grep -q "three are needed" stderr.txt || fail "does not say how many are needed"
runs 0 "$oriel" tune --help
exit $failed
