#!/bin/bash
# The jobs of oriel plan, several at once and one killed, give the scene that prepare gives from the
# same calibration, byte for byte. With Snakemake where it is installed, else one after the other.
. "$2/tests/e2e/prepare_lib"
monument 384x288 7
prepare() {
    run "$1" prepare "$work/p" --out "$work/$2" --quality draft \
        --max-size 192 --matching retrieval --densifier gl --radius-overlap 1.3 --test-list 0004 \
        --fuse-cluster 3 "${@:3}"
}

# jobs_in_order PLAN: runs its jobs one after the other, in an order in which they can run.
jobs_in_order() {
    sed -n '/"command": \[/,/\]/p' "$1" |
        sed 's/^ *"command": \[//; s/^ *\],*$/END/; s/^ *"\(.*\)",*$/\1/; /^$/d' >"$work/commands"
    local word words=()
    while read -r word; do
        if [ "$word" = END ]; then
            "$oriel" "${words[@]:1}" >"$work/out" 2>"$work/err" || fail "${words[*]} fails"
            words=()
        else
            words+=("$word")
        fi
    done <"$work/commands"
}

# jobs PLAN [OPTION]..: runs its jobs with Snakemake.
jobs() {
    local plan=$1
    shift
    (cd "$work" && XDG_CACHE_HOME=$work/cache snakemake -s "$source/cluster/Snakefile" \
        --cores 4 --config plan="$plan" oriel="$work/oriel" "$@") >"$work/out" 2>"$work/err"
}

# Calibration: features in three parts, one of which is killed and goes on; pairs; matches.
run 2 plan "$work"
says "nothing to plan yet"
run 2 job calibrate "$work" --step features --part 1/3
prepare 0 a --until collect
says "collected; oriel plan says what is left"
run 2 job calibrate "$work/a" --step pairs
says "features of some part are missing"
run 0 plan "$work/a" --photographs 3 --json
cp "$work/out" "$work/first.json"
grep -q '"name": "matches-000001"' "$work/first.json" || fail "no job matches pairs"
timeout -s KILL 0.3 "$oriel" job calibrate "$work/a" --step features --part 1/3 >/dev/null 2>&1
jobs_in_order "$work/first.json"
says "using the features and matches of jobs"
says "oriel plan says what is left"
ls "$work/a/.oriel/calibrate" | grep -q "features\|matches-\|work" && fail "the parts are left over"
if command -v sqlite3 >/dev/null; then
    database=$work/a/.oriel/calibrate/database.db
    [ "$(sqlite3 "$database" "SELECT COUNT(*), COUNT(DISTINCT camera_id) FROM images")" = "7|1" ] ||
        fail "the photographs of the parts do not share their camera"
fi
run 0 job calibrate "$work/a" --step pairs
says "nothing left to do"
[ -e "$work/a/scene.json" ] && fail "a scene that is not whole has a manifest"
run 2 info "$work/a"
cp -r "$work/a" "$work/b c"

# The graph: three passes of three parts, two clusters and the rest; a pass needs the one before.
run 0 plan "$work/b c" --photographs 2
prints "of CPU  up to"
run 0 plan "$work/b c" --photographs 2 --json
cp "$work/out" "$work/plan.json"
grep -q '"densify-0-0001"' "$work/plan.json" || fail "a geometric pass needs nothing"
[ "$(grep -c '"kind": "densify"' "$work/plan.json")" -ge 6 ] || fail "too few jobs"
grep -q '"name": "fuse-000002"' "$work/plan.json" || fail "no job for the second cluster"
photos=$(realpath "$work/p")
grep -q '"--radius-overlap"' "$work/plan.json" || fail "the last job has other radii"
grep -qF "\"$photos\"" "$work/plan.json" || fail "the last job does not name the photographs"

# A part that is not begun with these settings, and one that does not exist, change nothing.
run 2 densify "$work/b c" --part 1/3 --photos "$work/b c/stereo/fusion.cfg" --sources 7
says "not begun with these settings"
run 2 densify "$work/b c" --part 4/3
says "must be K/N"
run 2 job fuse "$work/b c" --part 1/3 --photographs 3
says "6 photographs are fused in 2 clusters, not in 3"
[ -z "$(ls "$work/b c/stereo/depth_maps")" ] || fail "a part that was refused has made maps"

prepare 0 a --resume
grep -q '"clusters": 2' "$work/a/scene.json" || fail "prepare fuses no clusters"

if command -v snakemake >/dev/null; then
    # Oriel under another name, one of whose jobs from the fourth on dies with SIGKILL.
    cat >"$work/oriel" <<END
#!/bin/sh
mkdir "$work/count.\$\$"
[ \$(ls -d "$work"/count.* | wc -l) -ge 4 ] && mkdir "$work/killed" 2>/dev/null &&
    { timeout -s KILL 1 "$oriel" "\$@"; kill -9 \$\$; }
exec "$oriel" "\$@"
END
    chmod +x "$work/oriel"
    jobs plan.json && fail "a job that was killed is no failure"
    [ -e "$work/b c/scene.json" ] && fail "a scene that is not whole has a manifest"
    jobs plan.json --rerun-incomplete || fail "the jobs do not go on: $(tail -n 5 "$work/err")"
else
    jobs_in_order "$work/plan.json"
fi
for file in points.ply sparse/points3D.bin images/0003.jpg; do
    cmp "$work/a/$file" "$work/b c/$file" || fail "the jobs make another $file"
done
for scene in a "b c"; do
    grep -v '_s"\|_mib"' "$work/$scene/scene.json" >"$work/$scene.json"
done
diff "$work/a.json" "$work/b c.json" >"$work/diff" || fail "another manifest: $(head -n 5 "$work/diff")"

# Everything again changes nothing, and there is nothing left to plan.
run 0 densify "$work/b c" --part 1/3 --pass 0
says "nothing left to do"
run 0 job fuse "$work/b c" --part 1/2 --photographs 3
says "nothing left to do"
run 0 plan "$work/b c"
prints "is whole"
finish
