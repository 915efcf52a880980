#!/usr/bin/env bash
# A moving figure in the walk: time steps of the server, and the page that plays them, from it or from files.
. "$(dirname "$0")/command_lib"
runs 0 "$oriel" synth figures --out set --cameras 5 --frames 3 --size 96x72
runs 0 "$oriel" import set --masks set/masks --background set/background --out moving --test-list cam03
runs 0 "$oriel" info moving
grep -q '^time steps  *3$' stdout.txt || fail "does not say how many time steps there are"
grep -q '^silhouettes  *of 5 photographs$' stdout.txt || fail "does not say that there are silhouettes"
runs 0 "$oriel" publish moving --out site
grep -q ': 12 photographs' stdout.txt || fail "publish does not write the photographs of each time step"
for file in steps/00000/points/coarse.bin steps/00002/points/coarse.bin steps/00002/photos/00003.jpg \
    steps/00002/depth/00003.png photos/00003.jpg points/coarse.bin; do
    [ -s "site/$file" ] || fail "the site lacks $file"
done
cmp -s site/steps/00000/points/coarse.bin site/steps/00002/points/coarse.bin && fail "the hull stands still"
# Pictures of the empty place may be larger than photographs.
runs 0 "$oriel" synth figures --out large --cameras 5 --frames 3 --size 640x480
cp -r moving emptied
for file in emptied/background/*.jpg.png; do
    cp "large/background/$(basename "$file" .jpg.png).png" "$file" || fail "no larger background"
done
runs 0 "$oriel" publish emptied --out emptied_site
[ "$(stat -c %s emptied_site/points/coarse.bin)" = "$(stat -c %s site/points/coarse.bin)" ] ||
    fail "larger pictures of the empty place make more points"
[ $failed -eq 0 ] || exit 1
needs_browser
timeout 400 /usr/bin/python3 -B "$source/tests/web/test_time_steps.py" "$oriel" "$work/moving" "$work/site"
