#!/usr/bin/env bash
# What visitors of comparable viewers report, on a published page and a live walk.
. "$(dirname "$0")/command_lib"
needs_browser
monument_scene || exit 1
cat >made/walk.json <<JSON
{"attribution": "Drawn by nobody", "notes": [{"title": "Arch", "text": "One.\nTwo.", "position": [0, 0, 0]},
                                             {"title": "Wall", "position": [0.3, 0, 0]}]}
JSON
runs 0 "$oriel" publish made --out site --quiet
# More light than one exposure holds.
"$oriel" synth monument --out bright --size 288x192 --count 6 --contrast 3 --exposures -3,0,3 --quiet &&
    "$tools/bench_truth_scene" bright bright-truth radiance 2 4 || exit 1
runs 0 "$oriel" publish radiance --out radiance-site
grep -q 'several exposures' stderr.txt || fail "publish does not say that exposures are merged"
[ $failed -eq 0 ] || exit 1
# axe-core judges what screen readers meet. A later release may know more rules: this one is named.
if [ ! -e "${ORIEL_NODE_MODULES:-nowhere}/axe-core" ]; then
    export ORIEL_NODE_MODULES=$work/node_modules
    timeout 60 npm install --prefix "$work" --no-audit --no-fund --silent --ignore-scripts --fetch-retries 1 \
        axe-core@4.14.1 >npm.txt 2>&1 || echo "npm is missing or reaches no registry: screen readers are not tested"
fi
timeout 1800 /usr/bin/python3 -B "$source/tests/web/test_visitors.py" "$oriel" \
    "$tools/bench_web_pictures" "$work/made" "$work/site" "$work/radiance" \
    "$work/radiance-site" 2>&1
