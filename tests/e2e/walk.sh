#!/usr/bin/env bash
# The walk's server: what it answers, whom, and its page in a browser.
. "$(dirname "$0")/command_lib"
monument_scene || exit 1

runs 2 "$oriel" walk no-such-scene
runs 2 "$oriel" walk made --port 70000
runs 2 timeout 60 "$oriel" walk made --host 192.0.2.1 --port 0
grep -q 'cannot listen on 192.0.2.1' stderr.txt || fail "an address that is not ours is not named"
"$oriel" walk made --host 0.0.0.0 --port 0 >stdout.txt 2>stderr.txt &
for ((tries = 0; tries < 600; tries++)); do
    grep -q 'name or address in place of 0.0.0.0' stderr.txt && break
    sleep 0.1
done
kill $!
wait
[ $tries -lt 600 ] || fail "does not say what other machines open"
[ $failed -eq 0 ] || exit 1
needs_browser
# More light than one exposure holds.
"$oriel" synth monument --out bright --size 120x80 --count 6 --contrast 8 --exposures -3,0,3 --quiet &&
    "$tools/bench_truth_scene" bright bright-truth radiance 2 9 || exit 1
timeout 400 /usr/bin/python3 -B "$source/tests/web/test_server.py" "$oriel" \
    "$tools/bench_web_pictures" "$work/made" "$work/radiance" 2>&1
