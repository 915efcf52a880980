#!/bin/bash
# Runs the jobs of a scene on a Slurm of one node, made for this run (Debian: slurmctld slurmd munge
# snakemake; as root), and compares the result with prepare's on this machine.
# usage: tests/bench/slurm.sh ORIEL WORK_DIR      WORK_DIR must not exist
# Leaves WORK_DIR with both scenes and all logs. Exit status 0 only if the scenes are the same.
set -eu
oriel=$(realpath "$1") work=$2 source=$(cd "$(dirname "$0")/../.." && pwd)
mkdir "$work"
work=$(realpath "$work")
pids=()
trap 'for pid in "${pids[@]}"; do kill "$pid" 2>/dev/null || true; done' EXIT

# --- Slurm: who may speak (munge), the controller, one node ---
head -c 1024 /dev/urandom >"$work/munge.key"
chown -R munge: "$work/munge.key" && chmod 400 "$work/munge.key"
mkdir -p /run/munge "$work/spool" "$work/state" && chown munge: /run/munge && chmod 755 "$work" /run/munge
mkdir "$work/munge" && chown munge: "$work/munge"
setpriv --reuid munge --regid munge --clear-groups munged --foreground \
    --key-file="$work/munge.key" --log-file="$work/munge/log" --pid-file="$work/munge/pid" \
    --seed-file="$work/munge/seed" >"$work/munge.log" 2>&1 &
pids+=($!)
cat >"$work/slurm.conf" <<END
ClusterName=one
SlurmctldHost=$(hostname -s)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
ReturnToService=2
NodeName=$(hostname -s) CPUs=$(nproc) RealMemory=4000 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
END
export SLURM_CONF=$work/slurm.conf
sleep 2
slurmctld -D >"$work/slurmctld.log" 2>&1 &
pids+=($!)
slurmd -D >"$work/slurmd.log" 2>&1 &
pids+=($!)
for i in $(seq 30); do
    sinfo -h -o %T 2>/dev/null | grep -q idle && break
    sleep 1
done
sinfo

# --- the scene, by prepare and by jobs ---
"$oriel" synth monument --out "$work/p" --size 192x144 --count 7 --quiet
options="--quality draft --densifier gl --fuse-cluster 4"
"$oriel" prepare "$work/p" --out "$work/a" $options --until undistort --quiet
cp -r "$work/a" "$work/b"
"$oriel" prepare "$work/p" --out "$work/a" $options --resume --quiet
"$oriel" plan "$work/b" --photographs 2 --json >"$work/plan.json"
cd "$work"
snakemake -s "$source/cluster/Snakefile" --profile "$source/cluster/slurm" --config plan="$work/plan.json" \
    oriel="$oriel" >"$work/snakemake.log" 2>&1
grep "steps (100%) done" "$work/snakemake.log"
cmp "$work/a/points.ply" "$work/b/points.ply"
echo "$(grep -c "WEXITSTATUS 0" "$work/slurmctld.log") Slurm jobs; the same points"
