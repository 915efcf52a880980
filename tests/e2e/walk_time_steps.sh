#!/usr/bin/env bash
# A moving figure in the walk: time steps of the server, and the page that plays them.
. "$(dirname "$0")/command_lib"
runs 0 "$oriel" synth figures --out set --cameras 5 --frames 3 --size 96x72
runs 0 "$oriel" import set --masks set/masks --background set/background --out moving --test-list cam03
runs 0 "$oriel" info moving
grep -q '^time steps  *3$' stdout.txt || fail "does not say how many time steps there are"
grep -q '^silhouettes  *of 5 photographs$' stdout.txt || fail "does not say that there are silhouettes"
[ $failed -eq 0 ] || exit 1
needs_browser
timeout 400 /usr/bin/python3 -B "$source/tests/web/test_time_steps.py" "$oriel" "$work/moving"
