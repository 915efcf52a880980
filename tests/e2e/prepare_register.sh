#!/bin/bash
# Photographs that cannot be placed, and a full disk. With a stand-in for COLMAP.
. "$2/tests/e2e/prepare_lib"
export ORIEL_COLMAP=$source/tests/e2e/colmap_double
photos "$work/p" 0.png 1.png 2.png 3.png 4.png

# A camera that stood still: an error that says so.
DOUBLE_NO_MODEL=1 run 2 prepare "$work/p" --out "$work/still"
says "only 0 of 5 photographs could be placed"
says "all show one view, as of a camera that stood still"

# A COLMAP whose options have other names, and which says otherwise that it has no model.
DOUBLE_NEW=1 run 0 prepare "$work/p" --out "$work/new"
DOUBLE_NEW=1 DOUBLE_NO_MODEL=1 run 2 prepare "$work/p" --out "$work/new-still"
says "only 0 of 5 photographs could be placed"

# mapped_by COMMANDS: those of COLMAP's programs that made the last model.
mapped_by() {
    local by=$(grep -E "mapper|triang|adjust" "$work/trace" | tr "\n" " ")
    [ "$by" = "$1 " ] || fail "mapped by ${by}instead of $1"
    : >"$work/trace"
}
export DOUBLE_TRACE=$work/trace
run 0 prepare "$work/p" --out "$work/parts" --mapper hierarchical
mapped_by "hierarchical_mapper point_triangulator bundle_adjuster"
grep -q '"mapper": "hierarchical"' "$work/parts/scene.json" || fail "the scene does not say how"
grep -q '"bundle_adjuster_s"' "$work/parts/scene.json" || fail "no time of COLMAP's programs"
DOUBLE_NEW=1 run 0 prepare "$work/p" --out "$work/global" --mapper global
mapped_by "global_mapper"
# A camera that no lens makes is not the last word: another mapper may find an ordinary one.
DOUBLE_NEW=1 DOUBLE_GLOBAL_FOCAL=0 run 0 prepare "$work/p" --out "$work/global-odd" --mapper global
prints "5 used, 5 registered"
mapped_by "global_mapper mapper"
run 1 prepare "$work/p" --out "$work/old" --mapper global
says "COLMAP 9.9 has no global_mapper"
# A mapper that finds no model has the incremental one for a substitute.
DOUBLE_NO_MODEL=hierarchical_mapper run 0 prepare "$work/p" --out "$work/substitute" \
    --mapper hierarchical
mapped_by "hierarchical_mapper mapper"
unset DOUBLE_TRACE

# No overlap (grey pictures, which have nothing alike): an error with advice, and what was
# done is kept.
mkdir "$work/grey"
for name in 0 1 2; do
    base64 -d >"$work/grey/$name.png" <<'PNG'
iVBORw0KGgoAAAANSUhEUgAAAGAAAABQCAAAAADDiS9JAAAAN0lEQVR42u3NMQ0AAAwDoOqsfyFV
sWMJGCA9FoFAIBAIBAKBQCAQCAQCgUAgEAgEAoFAIBB8DAZcnYyXbTp6ngAAAABJRU5ErkJggg==
PNG
    echo "$name" >>"$work/grey/$name.png" # not the same file
done
DOUBLE_NO_MODEL=1 run 2 prepare "$work/grey" --out "$work/none"
says "only 0 of 3 photographs could be placed"
says "overlap"
[ -s "$work/none/.oriel/calibrate.tmp/database.db" ] || fail "the features were not kept"
run 2 info "$work/none"
says "missing: calibrate"

# One cannot be placed: named, and the job goes on with the others.
DOUBLE_ALONE=3.png run 0 prepare "$work/p" --out "$work/s" --test-list 0
says "3.png: cannot be placed, left out"
prints "5 used, 4 registered (3 train, 1 held out)"
run 0 info "$work/s"
prints "left out     3.png: cannot be placed"

# So few can be placed that other features are tried: no model of the former ones goes on with them.
photos "$work/lonely" 5.png 6.png 7.png
cp "$work/p"/* "$work/lonely/"
export DOUBLE_ALONE="3.png 4.png 5.png 6.png 7.png"
run 0 prepare "$work/lonely" --out "$work/other"
says "trying affine-shape features"
prints "8 used, 3 registered"

# The same where homographies explain all pairs: the model of those three means nothing.
DOUBLE_FLAT=1 run 2 prepare "$work/lonely" --out "$work/turned"
says "only 3 of 8 photographs could be placed"
says "the camera turned on one spot"
unset DOUBLE_ALONE

# All but one of those that remain are held out.
DOUBLE_ALONE=3.png run 2 prepare "$work/p" --out "$work/few" --test-list 0,1,2
says "of the photographs that are not held out only 1 could be placed"

# Features of large photographs are taken without enlarging these, and again where they are too few.
mkdir "$work/large"
for shade in 10 20 30; do
    convert -size 2400x1700 "gradient:black-gray$shade" "$work/large/$shade.png"
done
extracted() {
    local runs=$(grep -c "^feature_extractor.*$1" "$work/options")
    [ "$runs" = "$2" ] || fail "$runs runs with '$1' instead of $2"
}
export DOUBLE_NO_CUDA=1 DOUBLE_OPTIONS=$work/options
run 2 prepare "$work/large" --out "$work/coarse" --until undistort
says "but its camera has 96x80" # the stand-in's
extracted "first_octave 0" 1
extracted "" 2
: >"$work/options"
run 0 prepare "$work/p" --out "$work/small" --until undistort
extracted "" 1
# Jobs do the same.
: >"$work/options"
run 0 prepare "$work/large" --out "$work/coarse-jobs" --until collect
run 0 job calibrate "$work/coarse-jobs" --step features --part 1/1
extracted "first_octave 0" 1
extracted "" 2
unset DOUBLE_NO_CUDA DOUBLE_OPTIONS

# A distortion that turns back on itself: the mapper runs again without any.
DOUBLE_BENT=1 run 0 prepare "$work/p" --out "$work/bent" --verbose
says "a distortion that no lens has"
prints "5 used, 5 registered"
grep -q " 0$" "$work/bent/.oriel/calibrate/model/cameras.txt" || fail "the bent camera was kept"
# Where none makes the camera one of no lens, the bent one stays.
DOUBLE_BENT=1 DOUBLE_STRAIGHT_FOCAL=0 "$oriel" prepare "$work/p" --out "$work/bent-still" >"$work/out" 2>"$work/err"
[ -d "$work/bent-still/.oriel/calibrate/model" ] || fail "no camera is left"

# Without distortion COLMAP would make photographs smaller, but not their cameras.
run 0 prepare "$work/p" --out "$work/shrunk" --max-size 64
run 0 info "$work/shrunk"
prints "64x53"

# What panoramas and fisheye pictures end as.
DOUBLE_FOCAL=15 run 2 prepare "$work/p" --out "$work/round"
says "a focal length of 15 pixels for photographs of 96x80"
says "panoramas must be cut into flat views"
DOUBLE_FOCAL=0 run 2 prepare "$work/p" --out "$work/flat"
says "photographs of a fisheye lens"
# Where others were placed before, those count.
DOUBLE_ALONE=3.png DOUBLE_JOINED_FOCAL=0 run 0 prepare "$work/p" --out "$work/bent-later"
says "a camera that no ordinary lens makes and does not count"
prints "5 used, 4 registered"
# So does another model of the same run.
DOUBLE_ODD_FIRST=1 run 0 prepare "$work/p" --out "$work/odd-first"
says "a camera that no ordinary lens makes and does not count"
prints "5 used, 5 registered"

# Masks reach COLMAP under its names, are undistorted as photographs are, and leave points out.
photos "$work/m" 1.png.png
base64 -d >"$work/m/0.png" <<'PNG'
iVBORw0KGgoAAAANSUhEUgAAAGAAAABQCAAAAADDiS9JAAAAgklEQVRYCbXBAQEAAABAIP6ftkLJTGYyk5nMZCYzmclM
ZjKTmcxkJjOZyUxmMpOZzGQmM5nJTGYyk5nMZCYzmclMZjKTmcxkJjOZyUxmMpOZzGQmM5nJTGYyk5nMZCYzmclMZjKT
mcxkJjOZyUxmMpOZzGQmM5nJTGYyk5nMZCYzmQXqNABRn24ZTwAAAABJRU5ErkJggg==
PNG
run 0 prepare "$work/p" --out "$work/masked" --masks "$work/m"
says "1 of 2 masks are black, as that of 0.png"
says "3 of 5 photographs have no mask"
[ "$(ls "$work/masked/masks" | tr '\n' ' ')" = "0.png.png 1.png.png " ] ||
    fail "masks are $(ls "$work/masked/masks")"
[ "$(grep -c '"mask": true' "$work/masked/scene.json")" = 2 ] || fail "scene.json lists other masks"
grep -q -e "--ImageReader.mask_path" "$work/masked/logs/colmap.log" || fail "no mask for COLMAP"
points() {
    run 0 info "$1"
    awk '$1 == "points" { print $2 }' "$work/out"
}
masked=$(points "$work/masked")

# Where masks leave too few features, those of whole photographs place the photographs; where they place no more, the
# model of the masked ones stays. Points are made of what masks show all the same.
DOUBLE_MASKED_ALONE="3.png 4.png" run 0 prepare "$work/p" --out "$work/whole" --masks "$work/m"
says "3 of 5 photographs register; taking features of whole photographs"
prints "5 used, 5 registered"
[ "$(points "$work/whole")" = "$masked" ] || fail "stereo does without masks where features do"
DOUBLE_ALONE="3.png 4.png" run 0 prepare "$work/p" --out "$work/whole-too" --masks "$work/m" --until undistort
says "taking features of whole photographs"
[ "$(grep -c mask_path "$work/whole-too/logs/colmap.log")" = 1 ] || fail "masks were passed over at first"
# So do those whose pairs are chosen by look, as of more than 25 photographs.
DOUBLE_MASKED_ALONE="3.png 4.png" run 0 prepare "$work/p" --out "$work/whole-looks" --masks "$work/m" \
    --matching retrieval --until undistort
says "taking features of whole photographs"

# A scene whose mask is missing does not open; without masks the folder goes.
cp -r "$work/masked" "$work/lacking"
rm "$work/lacking/masks/1.png.png"
run 2 info "$work/lacking"
says "masks/1.png.png: this mask is missing"
run 0 prepare "$work/p" --out "$work/masked" --resume
[ -e "$work/masked/masks" ] && fail "masks of another job were kept"
all=$(points "$work/masked")
[ "$masked" -lt "$all" ] || fail "fusion has $masked points with masks, $all without"

# A full disk, played by a limit on the size of files that no cloud fits into.
(
    trap '' XFSZ
    ulimit -f 200
    "$oriel" prepare "$work/p" --out "$work/full" >"$work/out" 2>"$work/err"
    [ $? = 1 ]
) || fail "a full disk is not an error of status 1"
says "$work/full"
run 2 info "$work/full"
says "has not finished this scene"
run 0 prepare "$work/p" --out "$work/full" --resume
run 0 info "$work/full"

finish
