#!/usr/bin/env bash
# oriel stress on a small monument and on a workspace made by hand: files, rows used again only
# where they may be, refusals, and the page in a browser where there is one.
set -u
. "$2/tests/e2e/command_lib"

small=(--quick --size 96 --photographs 4 --quiet)
runs 0 "$oriel" stress synth --out report --axes photographs,jpeg --method oriel,points "${small[@]}"
[ -s stderr.txt ] && fail "--quiet is not quiet"
grep -q '^12 rows measured, 0 used again, 0 left out, 0 break an invariant' stdout.txt || fail "no summary"
grep -q '(jpeg)$' stdout.txt || fail "no table of an axis"
awk '$1 == "points" && $2 != $3 { bad = 1 } END { exit bad }' stdout.txt ||
    fail "points depend on the photographs' files"
for field in version commit device driver software quick scene checksum truth photographs held_out points size \
    seed methods axes title unit levels own_truth rows severity level mean psnr_db ssim flip crumbs completeness \
    coverage flicker invariants hold not_finite brightness overshoot moved_mean moved_share provenance \
    picture losses start_db worst_db lost_db at; do
    grep -q "\"$field\"" report/stress.json || fail "no field $field"
done
for axis in photographs jpeg; do
    tail -n1 "report/stress.$axis.svg" | grep -q '</svg>' || fail "no figure of $axis"
done
grep -q 'data:image/jpeg' report/stress.html || fail "no pictures in the page"
grep -q '@[A-Z]*@' report/stress.html && fail "the page has not got its data"
grep -Eq '(src|href)="?(https?:)?//' report/stress.html && fail "the page needs a network"
ls -d report/.work* 2>/dev/null && fail "work files were left"

# Rows are used again while nothing changed, and only then.
cp report/stress.json before.json
runs 0 "$oriel" stress synth --out report --axes photographs,jpeg --method oriel,points "${small[@]}"
grep -q '^0 rows measured, 12 used again' stdout.txt || fail "rows were not used again"
cmp -s before.json report/stress.json || fail "the same rows make another report"
rm report/pictures/synth/jpeg-5.points.jpg
runs 0 "$oriel" stress synth --out report --axes photographs,jpeg --method oriel,points "${small[@]}"
grep -q '^1 rows measured' stdout.txt || fail "a row without its picture was used again"
runs 0 "$oriel" stress synth --out report --axes jpeg --method points "${small[@]}" --seed 2
grep -q '^3 rows measured' stdout.txt || fail "rows of another seed were used"

# Rows made in parts give the same report.
parts=("$oriel" stress synth --out parts --axes photographs,jpeg --method oriel,points "${small[@]}")
in_two_parts stress "${parts[@]}"
grep -q '^0 rows measured, 12 used again' stdout.txt || fail "rows of the parts were not used"
cmp before.json parts/stress.json || fail "the parts make another report"
runs 2 "${parts[@]}" --part 3/2

# A scene: what needs the truth is left out.
workspace 6 || exit 77
square
scene train train train train test test
runs 0 "$oriel" stress ws --out real --method airieau "${small[@]}" --axes exposure,gloss
grep -q '(exposure, EV)$' stdout.txt || fail "no axis of a scene"
grep -q gloss stdout.txt && fail "gloss without the truth"
grep -q '"truth": false' real/stress.json || fail "a scene has no truth"
runs 2 "$oriel" stress ws --out real "${small[@]}" --axes gloss
grep -q 'suits' stderr.txt || fail "does not say that no axis suits the scene"
runs 2 "$oriel" stress ws --out real --axes nonsense
grep -q 'passers-by' stderr.txt || fail "does not list the axes"
runs 2 "$oriel" stress ws --out real --method nonsense
grep -q airieau stderr.txt || fail "does not list the methods"
runs 2 "$oriel" stress ws
runs 2 "$oriel" stress --out real
runs 2 "$oriel" stress nowhere --out none
runs 0 "$oriel" stress --help

# In a browser: a click on a cell and on an axis, another figure, no error.
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome)
[ -n "$browser" ] || { echo "no browser: the page was not tried"; exit $failed; }
cat >click.html <<'END'
<script>
document.querySelectorAll("td.cell")[2].click();
document.querySelector("#small .card").click();
document.querySelectorAll("td.cell")[3].click();
document.getElementById("figure").value = 4;
document.getElementById("figure").dispatchEvent(new Event("change"));
const loaded = [...document.querySelectorAll("#pictures-of img")].map(image => image.decode());
Promise.all(loaded).then(() => { document.title = "clicked, " + loaded.length + " pictures"; });
</script>
END
runs 0 "$oriel" stress synth --out report --axes photographs,jpeg --method oriel,points "${small[@]}"
sed -e '/<\/body>/{r click.html' -e '}' report/stress.html >clicked.html
"$browser" --headless --no-sandbox --disable-gpu --user-data-dir="$work/browser" \
    --enable-logging=stderr --virtual-time-budget=4000 --dump-dom "file://$work/clicked.html" \
    >dom.html 2>console.txt
grep -i 'console' console.txt && fail "the page complains"
grep -q '<title>clicked, 4 pictures</title>' dom.html || fail "no pictures after a click"
grep -q 'flicker' dom.html || fail "no other figure"
exit $failed
