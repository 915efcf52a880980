#!/usr/bin/env bash
# A moving figure in a room: every time step is painted from its own photographs over its own hull, and
# time runs along a path.
. "$2/tests/e2e/command_lib"

runs 0 "$oriel" synth figures --out set --cameras 6 --frames 6 --size 120x90
# Time steps 0 and 5 are a fifth of a second apart.
runs 0 "$oriel" import set --frames 0:6:5 --masks set/masks --background set/background \
    --mesh hull=48,3000 --test-list cam04 --out moving
cmp -s moving/mesh.ply moving/frames/00000/mesh.ply || fail "the scene's hull is not the first's"
cmp -s moving/mesh.ply moving/frames/00001/mesh.ply && fail "both time steps have the same hull"
method=(--method orzan-shadow --set fill=none)
runs 0 "$oriel" eval moving --frame 1 "${method[@]}"

# A path of four pictures from a camera that stands still: two show each time step, and what is drawn
# after another time step is what is drawn alone.
cat >still.json <<'JSON'
{"keyframes": [{"photo": "cam04"}, {"photo": "cam04"}, {"photo": "cam04"}, {"photo": "cam04"}]}
JSON
runs 0 "$oriel" render moving --path still.json "${method[@]}" --out path
runs 0 "$oriel" render moving --at cam04 --frame 0 "${method[@]}" --out first.png
runs 0 "$oriel" render moving --at cam04 --frame 1 "${method[@]}" --out second.png
cmp -s first.png second.png && fail "both time steps look the same"
for i in 0 1; do cmp path/0000$i.png first.png || fail "picture $i is not of the first time step"; done
for i in 2 3; do cmp path/0000$i.png second.png || fail "picture $i is not of the second time step"; done
runs 0 "$oriel" render moving --path still.json --frame 1 "${method[@]}" --out frozen
cmp frozen/00000.png second.png || fail "time runs although a time step was asked for"

# The second time step depends on its own hull and on its own photographs.
for own in mesh.ply images/cam03.jpg; do
    cp "moving/frames/00001/$own" kept
    cp "moving/frames/00000/$own" "moving/frames/00001/$own"
    runs 0 "$oriel" render moving --at cam04 --frame 1 "${method[@]}" --out other.png
    cmp -s other.png second.png && fail "the second time step does not read its $own"
    cp kept "moving/frames/00001/$own"
done
if command -v ffprobe >/dev/null; then
    runs 0 "$oriel" render moving --path circle --frames 6 "${method[@]}" --out circle.mp4
    frames=$(ffprobe -v error -count_frames -show_entries stream=nb_read_frames -of csv=p=0 circle.mp4)
    [ "$frames" = 6 ] || fail "$frames frames instead of 6"
fi

runs 2 "$oriel" render moving --at cam04 --frame 2 --out third.png
grep -q 'no time step 2: there are 2' stderr.txt || fail "does not say which time steps there are"
runs 2 "$oriel" eval moving --frame 9
exit $failed
