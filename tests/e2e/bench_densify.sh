#!/bin/bash
# tests/bench/densify_compare.sh with what is installed, and with stand-ins for OpenMVS: all
# rows are there, held-out photographs are not, a failing densifier is named.
. "$2/tests/e2e/prepare_lib"
command -v colmap >/dev/null || { echo "skipped: COLMAP is not installed"; exit 77; }
truth_tool=$(dirname "$oriel")/tests/cloud_truth
[ -x "$truth_tool" ] || { echo "skipped: cloud_truth was not built"; exit 77; }
"$oriel" synth monument --out "$work/p" --size 384x288 --count 7 >"$work/out" 2>"$work/err" || {
    grep -q "OpenGL\|EGL" "$work/err" && echo "skipped: no OpenGL device" && exit 77
    fail "no photographs could be made"
    finish
}
scene=$work/s
run 0 prepare "$work/p" --out "$scene" --quality draft --max-size 256 --test-list 0004
export CLOUD_TRUTH=$truth_tool
compare=$source/tests/bench/densify_compare.sh
plain=$(dirname "$(command -v colmap)"):/usr/bin:/bin
PATH=$plain bash "$compare" "$oriel" "$scene" "$work/one" "$work/p-truth" >"$work/out" 2>"$work/err" ||
    fail "comparing failed"
grep -q "^oriel  *[0-9.]*  *[0-9.]*  *[0-9]*  *[0-9]*  *[0-9.]*  *[0-9.]*  *[0-9.]*  *[0-9.]*  *0\." \
    "$work/out" || fail "no whole row of oriel"
prints "not compared: OpenMVS"
awk '$1 == "oriel" { exit !($5 > 200 && $6 > 35 && $7 < 40 && $8 > 10 && $9 > 5) }' "$work/out" ||
    fail "figures that cannot be right: $(grep ^oriel "$work/out")"
[ -e "$work/one/oriel/stereo/depth_maps/0004.jpg.geometric.bin" ] &&
    fail "a held-out photograph took part"

# OpenMVS's programs, whose work is oriel's cloud; the model they get lacks the held-out one.
mkdir "$work/bin"
cat >"$work/bin/InterfaceCOLMAP" <<'S'
#!/bin/bash
while [ $# -gt 1 ]; do [ "$1" = -i ] && in=$2; [ "$1" = -o ] && out=$2; shift; done
grep -q 0004.jpg "$in/sparse/images.bin" && { echo "held-out photograph"; exit 1; }
echo "$in" >"$out"
S
cat >"$work/bin/DensifyPointCloud" <<'S'
#!/bin/bash
[ -n "$MVS_FAIL" ] && { echo "no luck"; exit 4; }
while [ $# -gt 1 ]; do [ "$1" = -o ] && out=$2; shift; done
cp "$CLOUD" "${out%.mvs}.ply"
S
chmod +x "$work"/bin/*
export CLOUD=$work/one/oriel/fused.ply
figures() {
    awk -v name="$1" '$1 == name { print $5, $6, $7, $8, $9, $10 }' "$2"
}
cp "$work/out" "$work/first"
ONLY=openmvs PATH=$work/bin:$plain bash "$compare" "$oriel" "$scene" "$work/two" \
    "$work/p-truth" >"$work/out" 2>"$work/err" || fail "comparing OpenMVS's stand-in failed"
# The same cloud, so the same figures.
[ -n "$(figures openmvs "$work/out")" ] &&
    [ "$(figures oriel "$work/first")" = "$(figures openmvs "$work/out")" ] ||
    fail "the same cloud has other figures"
MVS_FAIL=1 ONLY=openmvs PATH=$work/bin:$plain bash "$compare" "$oriel" "$scene" "$work/three" \
    >"$work/out" 2>"$work/err" && fail "a failing densifier went unnoticed"
prints "openmvs FAILED: see $work/three/openmvs"
finish
