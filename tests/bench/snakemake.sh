#!/bin/bash
# Runs the jobs of a scene with Snakemake on this machine, kills Snakemake and all of its jobs, goes
# on, and compares every file with the scene that prepare makes from the same calibration.
# usage: snakemake.sh ORIEL WORK_DIR PHOTOS [PREPARE OPTIONS]      WORK_DIR must not exist
# Leaves WORK_DIR with both scenes and all logs. Exit status 0 only if the scenes are the same.
set -eu
oriel=$(realpath "$1") work=$2 photos=$(realpath "$3") source=$(cd "$(dirname "$0")/../.." && pwd)
shift 3
mkdir "$work"
work=$(realpath "$work")
prepare() {
    local scene=$1
    shift
    "$oriel" prepare "$photos" --out "$work/$scene" --densifier gl --quiet "$@"
}
# Starts Snakemake and all of its jobs as a process group of their own, whose number is $group. The
# group ends with this script, however that ends.
group=
stop() {
    [ -z "$group" ] || kill -KILL -- "-$group" 2>/dev/null || true
    group=
}
trap stop EXIT
trap 'exit 1' HUP INT TERM
start() {
    setsid setpriv --pdeathsig INT snakemake -s "$source/cluster/Snakefile" --cores "$(nproc)" \
        --rerun-incomplete --config plan="$work/$1" oriel="$oriel" >>"$work/snakemake.log" 2>&1 &
    group=$!
}
jobs() {
    start "$1"
    wait "$group"
    group=
}
cd "$work"

# Calibration, by jobs.
prepare a "$@" --until collect
"$oriel" plan a --json --photographs 16 >first.json
jobs first.json
"$oriel" info a >/dev/null 2>&1 && exit 1 # not whole yet
cp -r a b

# The stereo and all that follows: by prepare, and by jobs of which all are killed once.
prepare a "$@" --resume
"$oriel" plan b --json --photographs 16 >plan.json
count=$(grep -c '"name":' plan.json)
start plan.json
until [ "$(ls b.jobs 2>/dev/null | grep -vc log)" -ge $((count / 3)) ]; do
    kill -0 "$group" # else Snakemake has failed
    sleep 0.2
done
pid=$group
stop
wait "$pid" || true
done_before=$(ls b.jobs | grep -vc log)
[ ! -e b/scene.json ]
rm -rf .snakemake/locks # of the Snakemake that was killed
jobs plan.json
for file in points.ply sparse/points3D.bin $(cd a && ls images/*); do
    cmp "a/$file" "b/$file"
done
for scene in a b; do
    grep -v '_s"\|_mib"' $scene/scene.json >$scene.json
done
diff a.json b.json
echo "$(grep -c '"name":' first.json) jobs of the calibration; $count jobs after it, killed when" \
    "$done_before were done; the same $("$oriel" info a --json | grep -o '"points": [0-9]*' | tail -n 1 |
    grep -o '[0-9]*') points, photographs and manifest"
