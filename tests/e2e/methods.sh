#!/usr/bin/env bash
# oriel methods: every method, and every option of one with its value and range.
set -u
. "$2/tests/e2e/command_lib"

runs 0 "$oriel" methods
names=$("$oriel" render x --at y --out z.png --method nonsense 2>&1 | sed -n 's/.*there are: *//p')
[ -n "$names" ] || fail "no list of methods to compare with"
for name in $names; do
    grep -q "^$name " stdout.txt || fail "$name is not listed"
done
for name in $names; do
    runs 0 "$oriel" methods "$name"
    head -n 1 stdout.txt | grep -q "^$name: " || fail "does not say what $name is"
    grep -q '^source: .' stdout.txt || fail "does not say where $name comes from"
    grep -qE '^asks: .*(points|mesh|silhouettes)' stdout.txt || fail "does not say what $name asks"
    grep -q '^cost: .*photograph' stdout.txt || fail "does not say what $name costs"
    # Each value that it shows may be set again.
    tail -n +7 stdout.txt >options.txt
    [ "$(wc -l <options.txt)" -gt 4 ] || fail "hardly any option of $name"
    set=()
    while read -r key value _; do
        set+=(--set "$key=$value")
    done <options.txt
    "$oriel" render nowhere --at y --out z.png --method "$name" "${set[@]}" 2>stderr.txt
    grep -q 'nowhere' stderr.txt || fail "a value of $name that it does not take"
done
runs 0 "$oriel" methods orzan-shadow
grep -qx 'cost: for each pixel 5 photographs, read twice; a depth map of each' stdout.txt ||
    fail "another cost of orzan-shadow"
runs 0 "$oriel" methods li
grep -q '^asks: silhouettes' stdout.txt || fail "li asks for something else"
runs 0 "$oriel" methods oriel
grep -q '^splat_scale  *1  *0.01 to 16 ' stdout.txt || fail "no range"
grep -q '^sampling  *bicubic  *bilinear, bicubic ' stdout.txt || fail "no names"
runs 2 "$oriel" methods nonsense
grep -q airieau stderr.txt || fail "does not list the methods"
runs 2 "$oriel" methods oriel points
exit $failed
