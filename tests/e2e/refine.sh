#!/usr/bin/env bash
# oriel refine on a workspace made by hand: soft splats that mend the picture of training photographs, the same twice and
# when it is killed on the way, without a look at held-out ones.
set -u
. "$2/tests/e2e/command_lib"

workspace 5 || exit 77
bash "$source/tests/bench/truth_cloud" photos-truth 2 >ws/fused.ply || exit 1
scene train train train train test
# A held-out photograph is not even read.
head -c 700 "ws/images/${names[4]}" >short && mv short "ws/images/${names[4]}"

# picture STATUS SOFT FILE [SOFT_MIX]
picture() {
    runs "$1" "$oriel" render ws --at "${names[1]}" --set "soft=$2" --set "soft_mix=${4:-0}" --quiet --out "$3"
}
picture 2 0.3 none.png
grep -q 'soft.ply: missing; oriel refine' stderr.txt || fail "not said what makes soft splats"
[ -e none.png ] && fail "a picture without them"

# killed COMMAND...: kills it as soon as it has kept a state that was not there before; false if it ends by itself.
killed() {
    local before
    before=$(stat -c %i ws/refine.state 2>/dev/null)
    "$@" >stdout.txt 2>stderr.txt &
    while kill -0 $! 2>/dev/null; do
        [ "$(stat -c %i ws/refine.state 2>/dev/null || echo "$before")" = "$before" ] || kill -9 $! 2>/dev/null
        sleep 0.01
    done
    ! wait $! 2>/dev/null
}

refine=("$oriel" refine ws --steps 10 --splats 3000 --size-divide 2)
runs 0 "${refine[@]}"
grep -q "; 28 steps on 4 photographs, loss" stdout.txt || fail "other steps or photographs" # 14 on two of them, 14 on all
# Few photographs: what lies between them is not fitted.
grep -q "^2 photographs that .*, and no better with any share of them: " stdout.txt || fail "splats of four photographs are taken"
[ -s ws/soft.ply ] || fail "no soft.ply"
cp ws/soft.ply first.ply
cp stdout.txt first.txt
kills=0
while killed "${refine[@]}" && [ $kills -lt 40 ]; do kills=$((kills + 1)); done
[ $kills -gt 1 ] || fail "killed $kills times only"
grep -q "refine: goes on after [0-9]* steps" stderr.txt || fail "it does not go on"
cmp -s first.ply ws/soft.ply || fail "a run that was killed makes other splats"
cmp first.txt stdout.txt || fail "a run that was killed reports other figures"
[ -e ws/refine.state ] && fail "a run that has finished leaves its state"
killed "${refine[@]}" || fail "not killed"
truncate -s -1 ws/refine.state
runs 0 "${refine[@]}"
grep -q "refine.state: .* damaged; refine begins anew" stderr.txt || fail "a damaged state is not named"
cmp -s first.ply ws/soft.ply || fail "a second run makes other splats"
killed "${refine[@]}" || fail "not killed"
runs 0 "${refine[@]}" --seed 2
grep -q "refine.state: .* other settings" stderr.txt || fail "goes on with another seed"
cmp -s first.ply ws/soft.ply && fail "the seed does not matter"
killed "${refine[@]}" || fail "not killed"
cp ws/scene.json scene.json
jq '.tuned.oriel.settings.sharpness = 3' scene.json >ws/scene.json
runs 0 "${refine[@]}"
grep -q "refine.state: .* other settings" stderr.txt || fail "goes on with other options of the method"
mv scene.json ws/scene.json
runs 1 "$oriel" refine ws --max-vram 1
grep -q "refine: 1 MiB of device memory are not enough for photographs of 96x64: the least is 7\." stderr.txt || fail "too little memory"

picture 0 0 own.png
picture 0 0.3 soft.png
cmp -s own.png soft.png && fail "soft splats change nothing"
runs 0 "$oriel" bench ws --size 64x48 --set soft=0.3 --seconds 0.1 --json bench.json
grep -q '"soft splats"' bench.json || fail "their pass is not timed"
jq -e '.sizes[0].passes_ms | keys_unsorted | index("soft splats") < index("specks")' bench.json >/dev/null || fail "specks go before soft splats come"

# A damaged file is named.
head -c 300 first.ply >ws/soft.ply
picture 2 0.3 none.png
grep -q 'soft.ply' stderr.txt || fail "a damaged file is not named"

# Many photographs: a share is found, kept, and taken without being asked for. A trimmed scene has no splats.
rm -r ws photos photos-truth
workspace 20 || exit 77
bash "$source/tests/bench/truth_cloud" photos-truth 5 >ws/fused.ply || exit 1
scene train train train train train train train train train train train train train train train train train train train test
runs 0 "$oriel" refine ws --steps 1 --max-vram 8
grep -q "refine: 3[0-9][0-9][0-9] splats at 96x64 need [0-9]* MiB of device memory; using [12][0-9][0-9][0-9]$" stderr.txt || fail "not fewer splats"
grep -q "splats, of [12][0-9][0-9][0-9] on surfaces" stdout.txt || fail "other splats than it said"
runs 0 "$oriel" refine ws --splats 20000
grep -q '^3 photographs that .* with --set soft=[0-9.]* --set soft_mix=[0-9.]*, which the scene takes from now on$' stdout.txt || fail "no share"
share=$(jq .tuned.oriel.settings.soft ws/scene.json) mix_share=$(jq '.tuned.oriel.settings.soft_mix // 0' ws/scene.json)
runs 0 "$oriel" render ws --at "${names[1]}" --quiet --out tuned.png
picture 0 "$share" set.png "$mix_share"
picture 0 0 own.png
cmp -s tuned.png set.png || fail "the share is not taken"
cmp -s own.png tuned.png && fail "the share changes nothing"
# The held-out photograph, which took no part, comes out better.
psnr() { "$oriel" eval ws ${1:+--set "$1"} --quiet --json - | jq .mean.psnr_db; }
jq -n "$(psnr "") > $(psnr soft=0) + 0.05" | grep -q true || fail "no gain at the held-out photograph"
runs 0 "$oriel" trim ws --out small --budget 1 --views 2 --quiet
runs 0 "$oriel" render small --at "${names[1]}" --quiet --out small.png
exit $failed
