#!/usr/bin/env bash
# Known cameras become scenes: a synthetic figure's, still and moving, from pictures and from
# clips, and where they are here Middlebury's temple by its NAME_par.txt.
. "$2/tests/e2e/command_lib"

has() { [ -e "$1" ] || fail "$1 is not there"; }
# The number that scene.json's counts have for a key.
count() { sed -nE "s/.*\"$2\": *([0-9]+).*/\1/p" "$1/scene.json" | head -n 1; }
same() { [ "$2" = "$3" ] || fail "$1: $2 instead of $3"; }

runs 0 "$oriel" synth figures --out set --cameras 6 --frames 4 --size 96x72
runs 2 "$oriel" synth figures --out set2 --exposures 1,2
grep -q "is an option of monument" stderr.txt || fail "does not refuse the monument's options"
runs 2 "$oriel" synth monument --out set2 --frames 3

# A sequence of numbered pictures with given silhouettes, and its hull.
runs 0 "$oriel" import set --masks set/masks --background set/background --out moving \
    --test-list cam04 --mesh hull=48,3000
grep -q '6 registered (5 train, 1 held out)' stdout.txt || fail "does not print the counts"
same frames "$(count moving frames)" 4
for file in images/cam05.jpg masks/cam05.jpg.png background/cam05.jpg.png points.ply mesh.ply \
    sparse/cameras.bin frames/00003/images/cam05.jpg frames/00003/masks/cam05.jpg.png; do
    has "moving/$file"
done
[ ! -e moving/frames/00004 ] && [ -z "$(ls -d .oriel-* 2>/dev/null)" ] || fail "something is left over"
[ "$(count moving triangles)" -le 3000 ] || fail "the hull has too many triangles"
runs 0 "$oriel" info moving

# The room comes from the file of cameras, or from the user; both methods of silhouettes draw it.
tr -d ' \n' <moving/scene.json | grep -q '"room":\[\[-4.0,0.0,-4.0\],\[4.0,3.0,4.0\]\]' ||
    fail "does not note the room"
runs 2 "$oriel" import set --masks set/masks --out other --room 0,0,0,1,1
grep -q 'lowest and its highest corner' stderr.txt || fail "does not say what a room is"
for method in li goldluecke; do
    runs 0 "$oriel" eval moving --method "$method" --set fill=room
    grep -q '^cam04' stdout.txt || fail "$method does not draw the camera that is held out"
done

# The same as clips, silhouettes by difference from a background clip.
if command -v ffmpeg >/dev/null; then
    for camera in 00 01 02; do
        mkdir -p "clips/cam$camera"
        ffmpeg -loglevel error -i "set/images/cam$camera/%05d.png" -c:v ffv1 \
            "clips/cam$camera/video.mkv"
        ffmpeg -loglevel error -i "set/background/cam$camera.png" -c:v ffv1 \
            "clips/cam$camera/background.mkv"
    done
    runs 0 "$oriel" import set/cameras.json --images clips --background clips --frames 1:4:2 \
        --out clip_scene
    grep -q 'no picture for 3 of 6 cameras' stderr.txt || fail "does not say what is left out"
    same "frames of clips" "$(count clip_scene frames)" 2
    has clip_scene/frames/00001/masks/cam02.jpg.png
fi

# Refusals leave nothing behind.
runs 2 "$oriel" import set --out other --masks set/masks --silhouettes dark
runs 2 "$oriel" import set --out other --silhouettes bright
runs 2 "$oriel" import set --out other --frames 3:1
runs 2 "$oriel" import set --out other --masks set/masks --test-every 2 --test-block 0:1
grep -q 'exclude each other' stderr.txt || fail "takes two ways to hold photographs out"
runs 2 "$oriel" import set --out other --masks set/masks --test-block 4:7
grep -q 'there are 6 photographs' stderr.txt || fail "does not say how many photographs there are"
runs 2 "$oriel" import set --out moving
grep -q 'moving: not empty' stderr.txt || fail "does not say that the folder is taken"
head -c 300 set/cameras.json >cut.json
runs 2 "$oriel" import cut.json --images set/images --out other
grep -q 'cut.json: line ' stderr.txt || fail "does not name the line"
[ ! -e other ] && [ -z "$(ls -d .oriel-* 2>/dev/null)" ] || fail "a refused import leaves something"

# Every file of an imported scene has a checksum. An import cannot be resumed, so no advice says so.
runs 0 "$oriel" info moving --check
for file in images/cam05.jpg masks/cam05.jpg.png frames/00003/images/cam05.jpg mesh.ply sparse/images.bin; do
    cp "moving/$file" kept
    truncate -s 100 "moving/$file"
    runs 2 "$oriel" info moving --check
    grep -q "$file: changed since" stderr.txt || fail "does not name $file"
    grep -q -- --resume stderr.txt && fail "wants to resume an import"
    cp kept "moving/$file"
done
runs 0 "$oriel" info moving --check

# What cannot be drawn for want of points says how to get them.
runs 0 "$oriel" import moving --out hollow
grep -q -- '--points densify' stderr.txt || fail "does not warn of a scene without points"
runs 2 "$oriel" render hollow --at cam00 --out none.png
grep -q -- '--points densify' stderr.txt || fail "does not say how to get points"

# What COLMAP wrote imports as it is; a scene is such a workspace.
runs 0 "$oriel" import moving --out again --test-every 3
same "workspace's photographs" "$(count again registered)" 6
cmp moving/images/cam00.jpg again/images/cam00.jpg || fail "an undistorted picture was changed"

# Points as prepare makes them, with the true cameras of a monument.
if command -v colmap >/dev/null; then
    # Photographs that match nowhere.
    runs 2 "$oriel" import set --frames 0:1 --points densify --quality draft --out nothing
    grep -q 'points in common' stderr.txt || fail "does not say that there are no common points"
    runs 0 "$oriel" synth monument --out photos --size 256x192 --count 7
    runs 0 "$oriel" import photos-truth/cameras.json --images photos --points densify \
        --quality draft --test-list 0003 --out dense
    grep -q '7 registered (6 train, 1 held out)' stdout.txt || fail "does not print the counts"
    [ "$(count dense points)" -ge 1000 ] || fail "only $(count dense points) points"
    runs 0 "$oriel" info dense --check
    [ ! -e dense/.oriel ] && [ ! -e dense/stereo ] || fail "what was needed on the way is left over"
    runs 0 "$oriel" eval dense --method points
    # The silhouettes of cameras all around close the surfaces, and do no harm to the picture.
    runs 0 "$oriel" synth figures --cameras 16 --size 480x360 --out around
    runs 0 "$oriel" import around --masks around/masks --points densify --quality draft \
        --test-list cam03 --out closed --verbose
    grep -q 'visual hull of 15 silhouettes (masks) closes surfaces by [1-9]' stderr.txt ||
        fail "silhouettes close nothing"
    # What suits it is what oriel tune finds.
    runs 0 "$oriel" tune closed --fresh --only sharpness --views 8 --size-divide 2 \
        --gain 0.1 --json tuned.json
    settled() { sed -n '/"settings"/,/"photographs"/p' | tr -d ' \n' | sed 's/.*"settings"/"settings"/'; }
    [ "$(sed -n '/"tuned"/,$p' closed/scene.json | settled)" = "$(settled <tuned.json)" ] ||
        fail "the stage tune found: $(sed -n '/"tuned"/,$p' closed/scene.json | settled)"
    grep -Eq '"backdrop": "(moves|rests)"' closed/scene.json || fail "nothing was found of the backdrop"
    # The cameras are those that were given, in the truth's own coordinates: a copy without
    # points has the same.
    runs 0 "$oriel" import photos-truth/cameras.json --images photos --test-list 0003 --out bare
    cmp dense/sparse/cameras.bin bare/sparse/cameras.bin || fail "densify changed the cameras"
fi

temple=${ORL_DATASETS:-$source/../shared/datasets}/temple-sparse-ring
if [ -d "$temple" ]; then
    # Its tight box is (-0.0736 0.0217 -0.0124) to (0.0289 0.1819 0.0627): the hull holds it.
    runs 0 "$oriel" import "$temple/templeSR_par.txt" --images "$temple/images" \
        --silhouettes dark=55 --mesh hull=96 --test-every 8 --out temple
    same "temple's photographs" "$(count temple registered)" 16
    runs 0 "$oriel" info temple
    [ "$(count temple triangles)" -gt 1000 ] || fail "the temple's hull is too small"
else
    echo "without the temple: $temple is not here"
fi
exit $failed
