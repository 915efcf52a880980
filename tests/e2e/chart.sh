#!/usr/bin/env bash
# oriel chart on workspaces made by hand: figures, files, rows used again only where they may
# be, peers, refusals, and the page in a browser where there is one. Never how long anything takes.
set -u
. "$2/tests/e2e/command_lib"

workspace 5 || exit 77
square
scene train train train test test
cp -r ws other

chart=("$oriel" chart ws --quiet --seconds 0 --out report)
runs 0 "${chart[@]}" --quick
[ -s stderr.txt ] && fail "--quiet is not quiet"
methods=$("$oriel" methods | grep -c '^[a-z].* ')
methods=$((methods - 1)) # its last line is advice
methods=$((methods + 7)) # the methods of papers but goldluecke, once more on the proxy of oriel
rows=$(grep -c ' *[0-9.]* .*[0-9]\.[0-9]' stdout.txt)
[ "$(ls report/rows/ws | wc -l)" = "$methods" ] || fail "not a row for each method"
grep -q "^$methods rows measured, 0 used again, 0 left out" stdout.txt || fail "no summary"
grep -q 'front$' stdout.txt || fail "nothing is on the front"
grep -q '^airieau  *on the proxy of oriel ' stdout.txt || fail "no weights on the same proxy"
for field in version commit device driver software quick scenes rows overall checksum held_out \
    points prepare_s views picture error_map mean sd psnr_db psnr_cc_db psnr_covered_db ssim flip \
    crumbs coverage completeness flicker frame_ms p95_ms cpu_ms frames open_s device_bytes host_peak_bytes \
    device_bytes_by_owner photographs provenance scene_checksum on_front dominated_by sentence; do
    grep -q "\"$field\"" report/chart.json || fail "no field $field"
done
for file in chart.svg chart.ws.svg; do
    tail -n1 "report/$file" | grep -q '</svg>' || fail "no figure $file"
done
grep -q '>line: the front<' report/chart.ws.svg || fail "no front in the figure"
grep -q 'data:image/jpeg' report/chart.html || fail "no pictures in the page"
grep -q '@DATA@\|@PICTURES@' report/chart.html && fail "the page has not got its data"
grep -Eq '(src|href)="?(https?:)?//' report/chart.html && fail "the page needs a network"

# Rows are used again while nothing changed, and only then.
cp report/chart.json before.json
runs 0 "${chart[@]}" --quick
grep -q "^0 rows measured, $methods used again" stdout.txt || fail "rows were not used again"
cmp -s before.json report/chart.json || fail "the same rows make another chart"

# Rows made in parts give the same chart, timings aside.
parts=("$oriel" chart ws --quiet --seconds 0 --out parts --quick)
in_two_parts chart "${parts[@]}"
grep -q "^0 rows measured, $methods used again" stdout.txt || fail "rows of the parts were not used"
figures='"(scene|method|setting|photo|psnr_db|psnr_cc_db|psnr_covered_db|ssim|flip|crumbs|coverage|completeness)"'
for folder in report parts; do
    (cd "$folder/rows/ws" && grep -E "$figures" ./*.json) >"$folder.rows"
done
cmp report.rows parts.rows || fail "the parts make other rows"
runs 2 "${parts[@]}" --part 3/2

rm report/pictures/ws/points/*.flip.jpg
runs 0 "${chart[@]}" --quick
grep -q "^1 rows measured" stdout.txt || fail "a row without its pictures was used again"
cut -c 1-40 report/rows/ws/points.json >cut && mv cut report/rows/ws/points.json
runs 0 "${chart[@]}" --quick
grep -q "^1 rows measured" stdout.txt || fail "a damaged row was used"
printf ' ' >>ws/scene.json
runs 0 "${chart[@]}" --quick
grep -q "^$methods rows measured, 0 used again" stdout.txt || fail "rows of another scene were used"

# Settings, of the method that has some; and two scenes.
runs 0 "$oriel" chart ws other --quiet --seconds 0 --out full --method oriel,points
grep -q '^oriel  *candidates=2 ' stdout.txt || fail "no settings of oriel"
grep -q '^points  *[a-z]' stdout.txt && fail "settings of a method without any"
grep -q '(all scenes)$' stdout.txt || fail "nothing over all scenes"
for setting in 'photographs at 1/2' 'textures bc7' 'pictures at 1/2' 'photos_per_pixel=1'; do
    grep -q "\"setting\": \"$setting\"" full/chart.json || fail "no row $setting"
done
[ "$(grep -c '"scene": "ws"' full/chart.json)" = "$(grep -c '"scene": "other"' full/chart.json)" ] ||
    fail "scenes of one kind have other rows"

# The same photographs, the same figures as those of oriel eval.
runs 0 "$oriel" eval ws --method points --json eval.json --quiet
for field in psnr_db ssim flip crumbs completeness; do
    a=$(sed -n "s/.*\"$field\": \([0-9.]*\),*/\1/p" eval.json | tail -n 1)       # its mean
    b=$(sed -n "s/.*\"$field\": \([0-9.]*\),*/\1/p" full/rows/ws/points.json | head -n 1)
    awk -v a="$a" -v b="$b" 'BEGIN { exit !(a > 0 && (a - b) ^ 2 < 1e-8) }' ||
        fail "$field is $a by eval, $b by chart"
done

# Interrupted after the first row: no report, and the next run goes on.
"$oriel" chart ws other --seconds 3 --out broken --method points,airieau >stdout.txt 2>stderr.txt &
pid=$!
for ((i = 0; i < 600; i++)); do
    ls broken/rows/ws/*.json >/dev/null 2>&1 && break
    sleep 0.1
done
kill -INT $pid
wait $pid
[ $? -eq 130 ] || fail "no word of the interruption"
[ -e broken/chart.html ] && fail "a report of half the rows"
runs 0 "$oriel" chart ws other --seconds 3 --out broken --method points,airieau
grep -q '^4 rows' stdout.txt && fail "what was measured is lost"
grep -Eq '^[1-3] rows measured, [1-3] used again' stdout.txt || fail "did not go on"

# Values of one's own, of the methods that read the option.
runs 0 "${chart[@]}" --quick --method airieau,points --vary depth_tolerance=0.1,0.5
grep -q '^airieau  *depth_tolerance=0.5 ' stdout.txt || fail "no row for a value"
grep -q '^points  *depth' stdout.txt && fail "a value of an option that is not read"
runs 2 "${chart[@]}" --quick --method airieau --vary depth_tolerance=7
runs 2 "${chart[@]}" --quick --vary nonsense=7

# Another program's pictures: the photographs themselves are perfect.
mkdir -p perfect/ws
for name in "${names[@]:3}"; do
    cp "ws/images/$name" "perfect/ws/$name"
done
runs 0 "${chart[@]}" --quick --method points --peer best=perfect,ms=0.001,MIB=2
awk '$1 == "best" && $3 == "100.00" && $7 == "2.0" && $NF == "front" { found = 1 }
     END { exit !found }' stdout.txt || fail "the photographs themselves are not perfect"
runs 0 "${chart[@]}" --quick --method points --peer best=perfect
awk '$1 == "best" && $2 == "-" { found = 1 } END { exit !found }' stdout.txt ||
    fail "a time that nobody told"
rm "perfect/ws/${names[3]}"
runs 2 "${chart[@]}" --quick --method points --peer best=perfect
grep -q "no picture of ${names[3]}" stderr.txt || fail "does not name the picture that lacks"
mkdir empty
runs 0 "$oriel" chart ws --seconds 0 --out report --quick --method points --peer none=empty
grep -q "no picture of ws" stderr.txt || fail "does not say that a peer has nothing"

runs 2 "${chart[@]}" --method nonsense
grep -q airieau stderr.txt || fail "does not list the methods"
runs 2 "${chart[@]}" --peer nonsense
runs 2 "${chart[@]}" --peer ms=3
runs 2 "${chart[@]}" --peer best=perfect,ms=none
runs 2 "$oriel" chart ws --quick
runs 2 "$oriel" chart
runs 2 "$oriel" chart ws ws --quick --out twice --method points
grep -q 'two scenes are named ws' stderr.txt || fail "does not say that names are alike"
runs 2 "$oriel" chart nowhere --out none
sed -i 's/"test"/"train"/' other/scene.json
runs 2 "$oriel" chart other --out none
grep -q 'held out' stderr.txt || fail "does not say that nothing is held out"
runs 0 "$oriel" chart --help

# In a browser: dots, rows, pictures, a click on each kind of thing, no error.
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome)
[ -n "$browser" ] || { echo "no browser: the page was not tried"; exit $failed; }
cat >click.html <<'END'
<script>
document.querySelectorAll("#scatter .dot")[1].dispatchEvent(new MouseEvent("click"));
document.querySelectorAll("#head th")[2].click();
document.querySelector("#body tr").click();
document.querySelectorAll("#scenes button")[1].click();
document.getElementById("y").value = 4;
document.getElementById("y").dispatchEvent(new Event("change"));
const loaded = [...document.querySelectorAll(".pictures img")].map(image => image.decode());
Promise.all(loaded).then(() => { document.title = "clicked, " + loaded.length + " pictures"; });
</script>
END
sed -e '/<\/body>/{r click.html' -e '}' full/chart.html >clicked.html
"$browser" --headless --no-sandbox --disable-gpu --user-data-dir="$work/browser" \
    --enable-logging=stderr --virtual-time-budget=4000 --dump-dom "file://$work/clicked.html" \
    >dom.html 2>console.txt
grep -i 'console' console.txt && fail "the page complains"
grep -q '<title>clicked, 3 pictures</title>' dom.html || fail "no pictures after a click"
grep -q 'aria-sort="descending"' dom.html || fail "the table was not sorted"
grep -q 'aria-pressed="true">ws<' dom.html || fail "the scene was not chosen"
exit $failed
