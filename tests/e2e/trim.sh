#!/usr/bin/env bash
# oriel trim on a scene of the monument: the result is an ordinary scene, smaller and as good, within
# a tolerance or a budget.
set -u
. "$2/tests/e2e/command_lib"

monument_scene || exit 77
mapfile -t names < <(ls made/images)
trim=("$oriel" trim made --views 4)

runs 0 "${trim[@]}" --out small --tolerance 0.2 --json small.json
for field in before after psnr_db point_bytes photo_bytes file_bytes worst_loss_db held_psnr_db \
    steps what taken settings complete; do
    grep -q "\"$field\"" small.json || fail "no field $field"
done
awk '/^small: / { exit !($2 > 1.5) }' stdout.txt || fail "hardly smaller"
awk '/training photographs lost/ { for (i = 1; i < NF; i++) if ($i == "lost") exit !($(i + 1) <= 0.2) }' \
    stdout.txt || fail "lost more than was allowed"

# An ordinary scene that every command opens, drawn as it was found.
runs 0 "$oriel" info small --check
runs 0 "$oriel" info small
grep -q "^drawn " stdout.txt || fail "info does not say how it is drawn"
[ "$(du -sb made | cut -f 1)" -gt "$(du -sb small | cut -f 1)" ] || fail "files are not smaller"
runs 0 "$oriel" eval small --quiet --json after.json
runs 0 "$oriel" eval made --quiet --json before.json
psnr() { grep -o '"psnr_db": [0-9.]*' "$1" | tail -n 1 | cut -d ' ' -f 2; }
# Which steps are taken depends on how long frames take, too. Trim never sees these photographs, and of
# six others some may go: on a busy machine they have lost 1.7 dB.
awk -v a="$(psnr before.json)" -v b="$(psnr after.json)" 'BEGIN { exit !(b > a - 2.5) }' ||
    fail "held-out photographs: $(psnr before.json) dB before, $(psnr after.json) after"
runs 0 "$oriel" render small --at "${names[0]}" --quiet --out view.png

# A budget instead of a tolerance.
runs 0 "${trim[@]}" --out half --max-bytes 1.2 --quiet
awk '$1 == "trimmed" { exit !($4 <= 1.2) }' stdout.txt || fail "more than the budget"
runs 2 "${trim[@]}" --out hurried --max-bytes 0.001 --budget 0.001
grep -q "before --budget ran out" stderr.txt || fail "does not say that the time was too short"
[ -e hurried ] && fail "writes a scene that is larger than asked for"
runs 0 "${trim[@]}" --out clean --budget 0.001 --size-divide 16 --json - # options, too, are compared at 1/16
jq -e .steps stdout.txt >/dev/null || fail "prints more than JSON"

# What is wrong is said, and nothing is lost.
runs 2 "${trim[@]}"
grep -q -- "--out SCENE2 is missing" stderr.txt || fail "does not ask for --out"
runs 2 "${trim[@]}" --out made
runs 2 "${trim[@]}" --out small
grep -q "not empty" stderr.txt || fail "does not say why"
runs 0 "$oriel" info made
runs 0 "$oriel" trim --help
exit $failed
