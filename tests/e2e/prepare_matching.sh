#!/bin/bash
# Which pairs COLMAP is asked to match, by way of matching. With a stand-in for COLMAP.
. "$2/tests/e2e/prepare_lib"
export ORIEL_COLMAP=$source/tests/e2e/colmap_double
export DOUBLE_TRACE=$work/trace DOUBLE_PAIRS=$work/pairs

# matched NUMBER: so many pairs.
matched() {
    local pairs=$(sort -u "$work/pairs" | wc -l)
    [ "$pairs" = "$1" ] || fail "matched $pairs pairs instead of $1"
    : >"$work/pairs"
    : >"$work/trace"
}

# Up to 25 photographs auto matches all pairs, in a list in which COLMAP finds names with spaces.
photos "$work/p" 0.png 1.png 2.png "one day.png"
run 0 prepare "$work/p" --out "$work/auto"
hidden=$'one\x1fday.png' # a space as lists of COLMAP have it
grep -qx "0.png $hidden" "$work/pairs" || fail "the list is $(cat "$work/pairs")"
[ "$(sqlite3 "$work/auto/.oriel/calibrate/database.db" \
    "SELECT COUNT(*) FROM images WHERE name = 'one day.png'")" = 1 ] ||
    fail "the name with a space did not come back"
matched 6
run 2 prepare "$work/p" --out "$work/wrong" --matching best
says "retrieval"

# Retrieval. Nothing tells these four apart, so each is linked to the others.
run 0 prepare "$work/p" --out "$work/retrieval" --matching retrieval
says "6 of 6 pairs are worth matching"
matched 6
grep -q '"matching": "retrieval"' "$work/retrieval/scene.json" || fail "the scene does not say how"

# Another way is another calibration; the same is not.
run 0 prepare "$work/p" --out "$work/auto" --resume
[ -s "$work/trace" ] && fail "a whole scene was worked on"
run 0 prepare "$work/p" --out "$work/auto" --resume --matching retrieval
matched 6

# A photograph that is left out is matched with all others.
: >"$work/pairs"
DOUBLE_ALONE=2.png run 0 prepare "$work/p" --out "$work/left" \
    --matching retrieval --verbose
says "3 of 4 photographs register; matching the others with all"
[ "$(tail -n 3 "$work/pairs" | tr '\n' ',')" = "0.png 2.png,1.png 2.png,2.png $hidden," ] ||
    fail "the last pairs are $(tail -n 3 "$work/pairs")"
: >"$work/trace"

# A database that is damaged is named, and the job can go on once it is whole.
echo features >"$work/damage"
DOUBLE_DATABASE=$work/damage run 2 prepare "$work/p" --out "$work/damaged" --matching retrieval
says "database.db: cannot be used as COLMAP's database"
run 0 prepare "$work/p" --out "$work/damaged" --matching retrieval \
    --resume
run 0 info "$work/damaged"

# Killed while it matches: done again from the start of the features.
: >"$work/trace"
DOUBLE_KILL=matches_importer run 137 prepare "$work/p" --out "$work/killed" --matching retrieval
sleep 2 # the double's last word
run 0 prepare "$work/p" --out "$work/killed" --matching retrieval \
    --resume
[ "$(grep -c feature_extractor "$work/trace")" = 2 ] || fail "half a database was used"
run 0 info "$work/killed"

# Ended while names had no spaces, at matches that came after the mapper: they have them again.
DOUBLE_FAIL=mapper run 1 prepare "$work/p" --out "$work/spaces"
sqlite3 "$work/spaces/.oriel/calibrate.tmp/database.db" "UPDATE images SET name = replace(name, ' ', char(31))"
run 0 prepare "$work/p" --out "$work/spaces" --resume
says "features and matches are there already"
[ "$(sqlite3 "$work/spaces/.oriel/calibrate/database.db" \
    "SELECT COUNT(*) FROM images WHERE name = 'one day.png'")" = 1 ] || fail "a photograph has another name"

# Of 26, sequential matches those up to 20 apart, and auto retrieves.
photos "$work/many" $(seq -f %02.0f.png 26)
: >"$work/pairs"
run 0 prepare "$work/many" --out "$work/sequential" --matching sequential
matched 310
run 0 prepare "$work/many" --out "$work/auto26"
says "pairs are worth matching"

finish
