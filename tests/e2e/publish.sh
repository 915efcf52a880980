#!/usr/bin/env bash
# A published site: what is written, what is refused, and the page itself in a browser.
. "$(dirname "$0")/command_lib"
monument_scene || exit 1

cat >made/walk.json <<JSON
{"attribution": "Drawn by nobody", "modes": ["fly", "walk"], "notes": [
    {"title": "Far <b>ahead</b>", "text": "One.\nTwo.", "position": [0, 0, 0]}]}
JSON
runs 0 "$oriel" publish made --out served/path/site --title 'A "test" & <more>'
grep -q ': 6 photographs' stdout.txt || fail "publish does not say what it wrote"
site=served/path/site
for file in index.html style.css manifest.json poster.jpg js/main.js shaders.json points/coarse.bin photos/00000.jpg \
    depth/00000.png thumbs/00000.jpg; do
    [ -s "$site/$file" ] || fail "the site lacks $file"
done
[ "$(ls -A served/path)" = site ] || fail "something is left behind beside the site"
grep -q '<title>A &quot;test&quot; &amp; &lt;more></title>' "$site/index.html" ||
    fail "the title is not in the page as text"
grep -q '{{' "$site/index.html" && fail "the page has unfilled places"
# A folder's name need not be UTF-8.
cp -r made $'caf\xe9'
runs 0 "$oriel" publish $'caf\xe9' --out latin
grep -qF '"title": "caf\\xe9"' latin/manifest.json || fail "a name that is not UTF-8 is not the title"
# What must be there before the page shows anything.
first=$(find "$site" \( -path '*/js/*' -o -path '*/points/coarse.bin' -o \
    -path "$site/*" ! -path "$site/*/*" \) -type f -exec cat {} + | wc -c)
[ "$first" -le 1000000 ] || fail "$first bytes until the first picture"

# Of an earlier site what Oriel wrote is replaced, and nothing else.
mkdir -p served/path/site.part served/path/site.old.part $site/.git/refs
touch served/path/site.part/precious served/path/site.old.part/precious $site/.git/refs/precious
echo walk.example >$site/CNAME
ln -s CNAME $site/link
ln -s path/site served/link
echo old >$site/js/main.js
mv $site/photos/00000.jpg $site/photos/my.jpg
runs 0 "$oriel" publish made --out served/link --quiet
[ -e served/path/site.part/precious ] && [ -e served/path/site.old.part/precious ] ||
    fail "a folder of the user's beside the site is gone"
[ -e $site/.git/refs/precious ] && [ "$(cat $site/link)" = walk.example ] && [ -s $site/photos/my.jpg ] ||
    fail "files that the user put into the site are gone"
[ -L served/link ] && [ "$(cat $site/js/main.js)" != old ] && [ -s $site/photos/00000.jpg ] ||
    fail "a link as output is not written to"
[ "$(ls -A served/path | tr '\n' ' ')" = "site site.old.part site.part " ] || fail "something is left behind"
grep -v '"style.css"' $site/files.json >files.json && cp files.json $site/files.json
runs 2 "$oriel" publish made --out $site
grep -q 'style.css: was not written by Oriel' stderr.txt || fail "a file of the user's would be replaced"
rm $site/files.json # as sites of earlier versions are
runs 0 "$oriel" publish made --out $site --quiet
[ -e $site/.git/refs/precious ] && [ -e $site/files.json ] || fail "a site without a list loses files"
mkdir foreign && touch foreign/precious
runs 2 "$oriel" publish made --out foreign
[ -e foreign/precious ] || fail "a folder that is no site was emptied"
runs 2 "$oriel" publish made --out foreign/precious
runs 2 "$oriel" publish made
cp made/walk.json kept.json
echo '{"modes": ["swim"]}' >made/walk.json
runs 2 "$oriel" publish made --out other
grep -q 'walk.json: "modes"' stderr.txt || fail "a wrong walk.json is not named"
mv kept.json made/walk.json
runs 2 "$oriel" publish no-such-scene --out other
[ -e other ] && fail "a site of no scene"
runs 2 "$oriel" publish made --out foreign --single-file
runs 0 "$oriel" publish made --out single.html --single-file --max-points 4000 --max-size 120
ls -d .oriel-* 2>/dev/null && fail "something is left behind"
grep -q 'src="photos\|href="style.css"' single.html && fail "the single file names other files"
runs 0 "$oriel" publish made --out single.html --single-file
[ $failed -eq 0 ] || exit 1

rm "$site/photos/my.jpg"
needs_browser
timeout 900 /usr/bin/python3 -B "$source/tests/web/test_page.py" "$oriel" \
    "$tools/bench_web_pictures" "$work/made" "$work/$site" "$work/single.html" 2>&1
