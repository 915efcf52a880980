#!/bin/bash
# Which pairs COLMAP is asked to match, by way of matching. With a stand-in for COLMAP.
. "$2/tests/e2e/prepare_lib"
command -v sqlite3 >/dev/null || { echo "sqlite3 is not installed"; exit 77; }
export ORIEL_COLMAP=$source/tests/e2e/colmap_double
export DOUBLE_TRACE=$work/trace DOUBLE_PAIRS=$work/pairs

# database FILE NAMES...: COLMAP's, whose photographs have no features, but a pair with parallax.
database() {
    local file=$1
    shift
    {
        echo "CREATE TABLE images (image_id INTEGER PRIMARY KEY, name TEXT, camera_id INTEGER);"
        for table in keypoints descriptors; do
            echo "CREATE TABLE $table (image_id INTEGER, rows INTEGER, cols INTEGER, data BLOB);"
        done
        echo "CREATE TABLE two_view_geometries (pair_id INTEGER, rows INTEGER, config INTEGER);"
        echo "INSERT INTO two_view_geometries VALUES (2147483649, 40, 2);"
        for name in "$@"; do
            echo "INSERT INTO images (name, camera_id) VALUES ('$name', 1);"
        done
    } | sqlite3 "$file"
}

# matched_by COMMAND: nothing else matched.
matched_by() {
    local by=$(grep -E "_matcher|matches_" "$work/trace" | uniq | tr "\n" " ")
    [ "$by" = "$1 " ] ||
        fail "matched by ${by}instead of $1"
    : >"$work/trace"
}

# Up to 25 photographs auto matches all pairs; other ways when they are asked for.
photos "$work/p" 0.png 1.png 2.png "one day.png"
run 0 prepare "$work/p" --out "$work/auto"
matched_by exhaustive_matcher
run 0 prepare "$work/p" --out "$work/sequential" --matching sequential
matched_by sequential_matcher
run 2 prepare "$work/p" --out "$work/wrong" --matching best
says "retrieval"

# Retrieval: a list of pairs, in which COLMAP finds names with spaces. Nothing tells these four
# apart, so each is linked to the others.
database "$work/four.db" 0.png 1.png 2.png "one day.png"
DOUBLE_DATABASE=$work/four.db run 0 prepare "$work/p" --out "$work/retrieval" --matching retrieval
matched_by matches_importer
says "6 of 6 pairs are worth matching"
hidden=$'one\x1fday.png' # a space as lists of COLMAP have it
grep -qx "0.png $hidden" "$work/pairs" || fail "the list is $(cat "$work/pairs")"
[ "$(sort -u "$work/pairs" | wc -l)" = 6 ] || fail "not six pairs, but $(cat "$work/pairs")"
[ "$(sqlite3 "$work/retrieval/.oriel/calibrate/database.db" \
    "SELECT COUNT(*) FROM images WHERE name = 'one day.png'")" = 1 ] ||
    fail "the name with a space did not come back"
grep -q '"matching": "retrieval"' "$work/retrieval/scene.json" || fail "the scene does not say how"

# Another way is another calibration; the same is not.
run 0 prepare "$work/p" --out "$work/auto" --resume
[ -s "$work/trace" ] && fail "a whole scene was worked on"
DOUBLE_DATABASE=$work/four.db run 0 prepare "$work/p" --out "$work/auto" --resume --matching retrieval
matched_by matches_importer

# A photograph that is left out is matched with all others.
: >"$work/pairs"
DOUBLE_ALONE=2.png DOUBLE_DATABASE=$work/four.db run 0 prepare "$work/p" --out "$work/left" \
    --matching retrieval --verbose
says "3 of 4 photographs register; matching the others with all"
[ "$(tail -n 3 "$work/pairs" | tr '\n' ',')" = "0.png 2.png,1.png 2.png,2.png $hidden," ] ||
    fail "the last pairs are $(tail -n 3 "$work/pairs")"
: >"$work/trace"

# A database that is damaged is named, and the job can go on once it is whole.
run 2 prepare "$work/p" --out "$work/damaged" --matching retrieval
says "database.db: cannot be used as COLMAP's database"
DOUBLE_DATABASE=$work/four.db run 0 prepare "$work/p" --out "$work/damaged" --matching retrieval \
    --resume
run 0 info "$work/damaged"

# Killed while it matches: done again from the start of the features.
: >"$work/trace"
DOUBLE_KILL=matches_importer DOUBLE_DATABASE=$work/four.db \
    run 137 prepare "$work/p" --out "$work/killed" --matching retrieval
sleep 2 # the double's last word
DOUBLE_DATABASE=$work/four.db run 0 prepare "$work/p" --out "$work/killed" --matching retrieval \
    --resume
[ "$(grep -c feature_extractor "$work/trace")" = 2 ] || fail "half a database was used"
run 0 info "$work/killed"

# Above 25 photographs auto retrieves.
names=$(seq -f %02.0f.png 26)
photos "$work/many" $names
database "$work/many.db" $names
: >"$work/trace"
DOUBLE_DATABASE=$work/many.db run 0 prepare "$work/many" --out "$work/auto26"
matched_by matches_importer

finish
