#!/bin/bash
# COLMAP missing, failing, and Oriel killed at every stage: what is done stays, a scene
# that is not whole does not open, and --resume completes it. With a stand-in for COLMAP.
. "$2/tests/e2e/prepare_lib"
double=$source/tests/e2e/colmap_double
photos "$work/p" 0.png 1.png 2.png 3.png 4.png
scene=$work/s
all="feature_extractor matches_importer mapper image_undistorter patch_match_stereo"

prepare() {
    local expected=$1
    shift
    run "$expected" prepare "$work/p" --out "$scene" --test-list 1,3.png --keep all "$@"
}

# Without COLMAP: one clear sentence, and the photographs' check is kept.
ORIEL_COLMAP=$work/no-such-program prepare 1
says "$work/no-such-program: this program is not installed"
says "COLMAP is needed"
export ORIEL_COLMAP=$double
prepare 2
says "--resume"

# Each command fails once, then the job goes on from there.
export DOUBLE_TRACE=$work/trace
for command in $all; do
    : >"$work/trace"
    DOUBLE_FAIL=$command prepare 1 --resume
    says "$command failed (exit status 3)"
    says "ERROR: the double was told to fail"
    says "$scene/logs/colmap.log"
    run 2 info "$scene"
    says "has not finished this scene"
    [ "$(tail -n 1 "$work/trace")" = "$command" ] || fail "work was done after $command failed"
done
grep -q "told to fail" "$scene/logs/colmap.log" || fail "the log lacks COLMAP's words"
: >"$work/trace"
prepare 0 --resume
[ "$(grep -v help "$work/trace" | uniq)" = patch_match_stereo ] || fail "work that was done was done again"
run 0 info "$scene"
prints "5 registered (3 train, 2 held out)"
prints "occluders   "

# A whole scene: nothing is left to do, and without --resume it is not touched.
sum=$(md5sum <"$scene/points.ply")
: >"$work/trace"
prepare 0 --resume
[ -s "$work/trace" ] && fail "a whole scene was worked on"
says "ground: done already"
says "occluders: done already"
# The ground is looked for once a scene, and opening takes what the stage found.
grep -q '"ground": null' "$scene/scene.json" || fail "scene.json does not tell of the ground"
sed -i 's/"ground": null/"ground": {"plane": [0, -1, 0, 1], "height": 1.25}/' "$scene/scene.json"
run 0 info "$scene"
prints "ground       1.25 below the photographs"
prepare 2
[ "$(md5sum <"$scene/points.ply")" = "$sum" ] || fail "a whole scene was changed"

# Records that an older program left, with stages and options that are gone: those whose keys and files are the same
# stay, the others are made again, once. The photographs hold their paths, so that their hashes are those of the records.
older() {
    (cd "$work" && run 0 prepare older --out from-older --test-list 1,3.png --keep all "$@"; exit $failures)
    failures=$?
}
(cd "$work" && photos older 0.png 1.png 2.png 3.png 4.png)
older
cp "$source/tests/e2e/stages_older.json" "$work/from-older/.oriel/stages.json"
older --resume
says "some stages are done again"
says "calibrate: done already"
grep -q "densify: done already" "$work/err" && fail "maps of an older program were taken for those of this one"
run 0 info "$work/from-older"
prints "5 registered (3 train, 2 held out)"
: >"$work/trace"
older --resume
[ -s "$work/trace" ] && fail "what was made again was not recorded"
says "undistort: done already"
says "occluders: done already"
rm -r "$work/older" "$work/from-older"

# Held-out photographs are neither fused nor stereo sources.
[ "$(tr '\n' ' ' <"$scene/stereo/fusion.cfg")" = "0.png 2.png 4.png " ] ||
    fail "fusion.cfg lists other than the training photographs"
grep -q '1\.png\|3\.png' "$scene/stereo/patch-match.cfg" && fail "a held-out photograph is a source"
[ "$(wc -l <"$scene/stereo/patch-match.cfg")" = 6 ] || fail "patch-match.cfg lacks photographs"

# Other held-out photographs: calibration stays, stereo does not.
: >"$work/trace"
run 0 prepare "$work/p" --out "$scene" --test-list 0 --resume --keep all
[ "$(grep -v help "$work/trace" | uniq | tr '\n' ' ')" = "patch_match_stereo " ] ||
    fail "other hold-outs redo $(tr '\n' ' ' <"$work/trace")"
prints "4 train, 1 held out"
grep -q '"height": 1.25' "$scene/scene.json" && fail "the ground of other hold-outs was kept"
# Depth maps go once they are fused, unless all is to be kept, and are not made again for that.
: >"$work/trace"
run 0 prepare "$work/p" --out "$scene" --test-list 0 --resume --keep all
[ -d "$scene/stereo" ] || fail "--keep all keeps no depth maps"
run 0 prepare "$work/p" --out "$scene" --test-list 0 --resume
[ -e "$scene/stereo" ] && fail "depth maps are kept by default"
run 0 prepare "$work/p" --out "$scene" --test-list 0 --resume
run 0 info "$scene" --check
[ -s "$work/trace" ] && fail "deleted depth maps were made again"
# Where they are asked for, or needed, they are.
run 0 prepare "$work/p" --out "$scene" --test-list 0 --resume --keep all
grep -q patch_match_stereo "$work/trace" || fail "--keep all made no depth maps"
# Other radii: nothing before them is done again. The
# usual values are those without the options.
sum=$(md5sum <"$scene/points.ply")
: >"$work/trace"
echo "of the points before" >"$scene/soft.ply"
run 0 prepare "$work/p" --out "$scene" --test-list 0 --resume --keep all --radius-overlap 2
[ -e "$scene/soft.ply" ] && fail "soft splats of other points stay"
says "fuse: done already"
grep -q "radii: done already" "$work/err" && fail "radii of another overlap were kept"
[ "$(md5sum <"$scene/points.ply")" = "$sum" ] && fail "--radius-overlap changes nothing"
grep -q '"overlap": 2.0' "$scene/scene.json" || fail "scene.json does not tell of the overlap"
doubled=$(md5sum <"$scene/points.ply")
run 0 prepare "$work/p" --out "$scene" --test-list 0 --resume --keep all --radius-neighbours 3
[ "$(md5sum <"$scene/points.ply")" = "$sum" ] && fail "--radius-neighbours changes nothing"
[ "$(md5sum <"$scene/points.ply")" = "$doubled" ] && fail "the overlap of an earlier run stayed"
run 0 prepare "$work/p" --out "$scene" --test-list 0 --resume --keep all \
    --radius-neighbours 6 --radius-overlap 1
[ "$(md5sum <"$scene/points.ply")" = "$sum" ] || fail "the usual radii are others when asked for"
run 0 prepare "$work/p" --out "$scene" --test-list 0 --resume --keep all
says "radii: done already"
[ -s "$work/trace" ] && fail "radii need COLMAP"
# Without the visual hull points are fused again, of the same maps.
run 0 prepare "$work/p" --out "$scene" --test-list 0 --resume --keep all --hull none
says "densify: done already"
grep -q "fuse: done already" "$work/err" && fail "the cloud stays when there is to be no hull"
[ -s "$work/trace" ] && fail "--hull none needs COLMAP"
run 0 prepare "$work/p" --out "$scene" --test-list 0 --resume --keep all
run 2 prepare "$work/p" --out "$scene" --test-list 0 --resume --keep all --radius-overlap 9
says "--radius-overlap 9: must be a number from 0.01 to 8"
run 0 prepare "$work/p" --out "$scene" --test-list 0 --resume --keep minimal
: >"$work/trace"
rm "$scene/.oriel/fused.ply"
run 0 prepare "$work/p" --out "$scene" --test-list 0 --resume
[ "$(grep -v help "$work/trace" | uniq | tr '\n' ' ')" = "patch_match_stereo " ] ||
    fail "a lost cloud without depth maps redoes $(tr '\n' ' ' <"$work/trace")"
run 2 prepare "$work/p" --out "$scene" --resume --keep some
says "must be one of minimal, all"
# A lost result is made again.
rm "$scene/points.ply"
run 0 prepare "$work/p" --out "$scene" --test-list 0 --resume
[ -f "$scene/points.ply" ] || fail "points.ply was not made again"
# Whatever is lost or damaged is noticed, on opening or by --check, and made again: the stage
# that left it, and no other.
run 0 info "$scene" --check
prints "all as they were made"
damage() { # FILE STAGE COMMANDS...: what a resume runs of COLMAP
    local file=$1 stage=$2
    shift 2
    run 2 info "$scene" --check
    says "$scene/$file: "
    : >"$work/trace"
    run 0 prepare "$work/p" --out "$scene" --test-list 0 --resume
    says "$scene/$file: "
    says "$stage is done again"
    [ "$(grep -v help "$work/trace" | uniq | tr '\n' ' ')" = "$*" ] ||
        fail "$file: redone: $(tr '\n' ' ' <"$work/trace")"
    [ "$(md5sum <"$scene/points.ply")" = "$sum" ] || fail "$file: points.ply is another"
    run 0 info "$scene" --check
}
sum=$(md5sum <"$scene/points.ply")
rm "$scene/images/2.png"
damage images/2.png undistort "image_undistorter "
printf x | dd of="$scene/images/1.png" bs=1 seek=100 conv=notrunc status=none
damage images/1.png undistort "image_undistorter "
echo "# a comment" >>"$scene/sparse/images.txt"
damage sparse/images.txt undistort "image_undistorter "
rm -r "$scene/sparse"
damage sparse/cameras.txt undistort "image_undistorter "
truncate -s -20 "$scene/points.ply"
run 2 info "$scene"
damage points.ply radii ""
printf '\1' | dd of="$scene/points.ply" bs=1 seek=600 conv=notrunc status=none
run 0 info "$scene"
says "points.ply: changed since the scene was made"
damage points.ply radii ""

# One that does not come out the same, here since the stereo found other points, takes what was
# made from it along.
DOUBLE_SHIFT=1 run 0 prepare "$work/p" --out "$scene" --test-list 0 --resume --keep all
rm "$scene/.oriel/fused.ply"
for map in "$scene"/stereo/depth_maps/*; do
    perl -e 'print "96&80&1&", pack("f<", 3.2) x (96 * 80)' >"$map"
done
run 0 prepare "$work/p" --out "$scene" --test-list 0 --resume --keep all
says "fuse is done again"
says "densify: done already"
grep -q "radii: done already" "$work/err" && fail "points of another cloud were kept"
[ "$(md5sum <"$scene/points.ply")" = "$sum" ] && fail "points.ply is that of another cloud"
run 0 info "$scene" --check

# Damaged records: what they tell is not believed, and the scene can be had again.
for damaged in '' '{"version": 1}' '{"version": 1, "done": []}' '{"version": 1, "done": 7' '[]'; do
    echo "$damaged" >"$scene/.oriel/stages.json"
    run 0 prepare "$work/p" --out "$scene" --test-list 0 --resume
    says "stages.json: damaged"
    run 0 info "$scene" --check
done
for edit in 's/"photographs": \[/"photographs": [1, /' 's/"name": "2.png"/"nme": "2.png"/' \
    's/"key"/"kex"/' 's/"ground": null/"grund": null/' \
    's/"left_out"/"left_in"/' 's/"files": {/"fills": {/' 's/"points": [0-9][0-9]*/"points": 7/' \
    's/"backdrop": "[a-z]*"/"backdrop": 7/' \
    's/"ground": null/"ground": {"plane": [0, -1, 0, 1], "height": 1.25}/' \
    's/"series": 0/"series": -1/' 's/"split": "t[a-z]*"/"split": "both"/' \
    's/"responses": \[/"responses": [7/'; do
    cp "$scene/.oriel/stages.json" "$work/before"
    sed -i "$edit" "$scene/.oriel/stages.json"
    cmp -s "$work/before" "$scene/.oriel/stages.json" && fail "nothing there to edit: $edit"
    run 0 prepare "$work/p" --out "$scene" --test-list 0 --resume
    run 0 info "$scene" --check
    run 0 info "$scene"
    grep -q '"height": 1.25' "$scene/scene.json" && fail "an edited ground was believed"
done
# Records of earlier versions have no checksum. What opening would refuse is not made a scene.
manifest=$(md5sum <"$scene/scene.json")
cp "$scene/.oriel/stages.json" "$work/before"
sed -i 's/"sum": /"mus": /; s/"backdrop": "[a-z]*"/"backdrop": 7/' "$scene/.oriel/stages.json"
run 2 prepare "$work/p" --out "$scene" --test-list 0 --resume
says 'stages.json: "backdrop" is neither "moves" nor "rests"'
says "remove this file"
[ "$(md5sum <"$scene/scene.json")" = "$manifest" ] || fail "a scene was made of a bad value"
sed 's/"sum": /"mus": /' "$work/before" >"$scene/.oriel/stages.json"
run 0 prepare "$work/p" --out "$scene" --test-list 0 --resume
says "ground: done already"
sed -i 's/^{$/&"tuned": {"points": {"settings": {"blend": [1]}}},/' "$scene/scene.json"
run 2 info "$scene"
run 0 prepare "$work/p" --out "$scene" --test-list 0 --resume
says '"tuned" cannot be read and is left out'
run 0 info "$scene"
echo '{"version' >"$scene/scene.json"
run 0 prepare "$work/p" --out "$scene" --test-list 0 --resume
says "scene.json: cannot be read; written anew"
run 0 info "$scene"

# A stage that is not wanted is not missed.
run 0 prepare "$work/p" --out "$scene" --test-list 0 --resume --occluders none
says "expose: done already"
run 0 prepare "$work/p" --out "$scene" --test-list 0 --resume --occluders none
grep -q "are done again" "$work/err" && fail "a stage that is not wanted is missed"
# What tune keeps stays, until the scene is made anew.
run 0 tune "$scene" --method points --set splat_scale=2 --only front_layer --apply --budget 0.000001
run 0 prepare "$work/p" --out "$scene" --test-list 0 --resume --occluders none
grep -q '"splat_scale": 2' "$scene/scene.json" || fail "what tune found was not kept"
run 0 prepare "$work/p" --out "$work/few" --test-list 0,1,2
says "occluders: none are looked for: needs 3 training photographs"
run 0 info "$work/few"
run 2 prepare "$work/p" --out "$scene" --resume --occluders much
says "must be one of none, find"

# A changed photograph changes all.
printf '\0' >>"$work/p/2.png"
: >"$work/trace"
run 0 prepare "$work/p" --out "$scene" --test-list 0 --resume --keep all
says "have changed"
[ "$(grep -v help "$work/trace" | uniq | wc -l)" = 5 ] || fail "a changed photograph was not noticed"

# Depth maps of an interrupted run stay, unless the settings are others.
map=$scene/stereo/depth_maps/of-an-interrupted-run.bin
: >"$map"
DOUBLE_FAIL=patch_match_stereo run 1 prepare "$work/p" --out "$scene" --seed 2 --resume
[ -e "$map" ] && fail "depth maps of another seed were kept"
: >"$map"
DOUBLE_FAIL=patch_match_stereo run 1 prepare "$work/p" --out "$scene" --seed 2 --resume
[ -e "$map" ] || fail "depth maps of the same settings were not kept"
DOUBLE_FAIL=patch_match_stereo run 1 prepare "$work/p" --out "$scene" --seed 2 --quality draft \
    --resume
[ -e "$map" ] && fail "depth maps of another quality were kept"

# Killed in the middle of each command.
rm -r "$scene"
for command in $all; do
    : >"$work/trace"
    DOUBLE_KILL=$command "$oriel" prepare "$work/p" --out "$scene" --test-list 1 --resume \
        >"$work/out" 2>"$work/err"
    status=$?
    [ $status = 137 ] || fail "killed in $command: status $status"
    grep -qx "$command" "$work/trace" || fail "$command was not reached"
    run 2 info "$scene"
    says "has not finished this scene (missing: "
done
sleep 2.2
grep -q "still here" "$work/trace" && fail "COLMAP outlived a killed Oriel"
run 0 prepare "$work/p" --out "$scene" --test-list 1 --resume
run 0 info "$scene"
prints "4 train, 1 held out"
find "$scene" -name '*tmp*' | grep . && fail "temporary files are left"

# A killed re-run must not leave the old scene open to be taken for the new one.
DOUBLE_KILL=patch_match_stereo "$oriel" prepare "$work/p" --out "$scene" --test-list 2 --resume \
    >/dev/null 2>&1
run 2 info "$scene"
says "missing: densify"

# Two at once.
(
    flock 9
    run 2 prepare "$work/p" --out "$scene" --resume
    says "another oriel prepare is at work here"
    [ $failures = 0 ]
) 9>>"$scene/.oriel/lock" || failures=$((failures + 1))

# Soft splats at the end, of a scene that is whole by then. Killed there, it goes on, with the same result.
run 0 prepare "$work/p" --out "$scene" --test-list 1 --resume --refine
[ -s "$scene/soft.ply" ] || fail "no soft splats"
grep -q '"tuned"' "$scene/scene.json" || fail "what refine found is not kept"
run 0 info "$scene"
grep -Eq '^refine +[0-9.]+ s wall' "$work/out" || fail "info does not say what refine took"
soft=$(md5sum <"$scene/soft.ply")
run 0 prepare "$work/p" --out "$scene" --test-list 1 --resume --refine
says "refine: done already"
run 0 info "$scene"
grep -Eq '^refine +[0-9.]+ s wall' "$work/out" || fail "what refine took is forgotten"
grep -q '"tuned"' "$scene/scene.json" || fail "what refine found is forgotten"
run 0 prepare "$work/p" --out "$scene" --test-list 1 --resume --radius-overlap 2
[ -e "$scene/soft.ply" ] && fail "soft splats of other points stay"
run 0 info "$scene"
grep -q '^refine' "$work/out" && fail "the record of soft splats that are gone stays"
"$oriel" prepare "$work/p" --out "$scene" --test-list 1 --resume --refine >/dev/null 2>&1 &
while kill -0 $! 2>/dev/null && ! [ -e "$scene/refine.state" ]; do sleep 0.05; done
kill -9 $!
wait $! 2>/dev/null
run 0 info "$scene"
run 0 prepare "$work/p" --out "$scene" --test-list 1 --resume --refine
says "radii: done already"
says "refine: goes on after "
[ "$(md5sum <"$scene/soft.ply")" = "$soft" ] || fail "a run that was killed makes other soft splats"
run 0 prepare "$work/p" --out "$scene" --test-list 1 --resume --occluders none
[ -e "$scene/soft.ply" ] && fail "soft splats stay, and nothing says how much of them pictures take"

finish
