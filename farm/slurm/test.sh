#!/usr/bin/env bash
# Tries the scripts beside it on a cluster of a controller and three nodes on this machine (Debian: slurmctld, slurmd, munge;
# as root). One node is lost in mid-frame: its chunk is rendered by another, and the frames are those of a walk in one piece.
# On a node with two processors, tasks get as many as they ask for. Stills, tiles and seeds are rendered there.
#   LIGHTSPLAT=target/release/lightsplat farm/slurm/test.sh SCENE [options of lightsplat walk]
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
scene=$(realpath "$1")
shift
LIGHTSPLAT=$(realpath "$LIGHTSPLAT")
export LIGHTSPLAT
options=(--reproducible --threads 1 "$@")
work=$(mktemp -d)
mkdir "$work"/{state,frames,alone}
chmod 755 "$work"
daemons=()
stop() { kill -9 "${daemons[@]}" 2>/dev/null || true; }
trap stop EXIT

mkdir -p /run/munge
chown munge /run/munge
if ! munge -n 2>/dev/null | unmunge >/dev/null 2>&1; then
  [[ -s /etc/munge/munge.key ]] || mungekey
  setpriv --reuid=munge --regid=munge --clear-groups munged --foreground 2>/dev/null &
  daemons+=($!)
  sleep 1
fi
export SLURM_CONF=$work/slurm.conf
cat >"$SLURM_CONF" <<CONF
ClusterName=lightsplat
SlurmctldHost=$(hostname -s)(127.0.0.1)
SlurmUser=root
SlurmctldPort=17000
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool-%n
SlurmdPidFile=$work/slurmd-%n.pid
SlurmctldPidFile=$work/slurmctld.pid
AuthType=auth/munge
ProctrackType=proctrack/pgid
TaskPlugin=task/affinity
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SwitchType=switch/none
MpiDefault=none
SlurmdTimeout=10
KillWait=5
MinJobAge=3600
ReturnToService=2
SlurmdParameters=config_overrides
NodeName=n1 NodeHostname=$(hostname -s) NodeAddr=127.0.0.1 Port=17001 CPUs=1 RealMemory=1000
NodeName=n2 NodeHostname=$(hostname -s) NodeAddr=127.0.0.1 Port=17002 CPUs=1 RealMemory=1000
NodeName=n3 NodeHostname=$(hostname -s) NodeAddr=127.0.0.1 Port=17003 CPUs=2 RealMemory=1000
PartitionName=pair Nodes=n3 MaxTime=INFINITE State=UP
PartitionName=all Nodes=n1,n2 Default=YES MaxTime=INFINITE State=UP
CONF
slurmctld -D >"$work/slurmctld.log" 2>&1 &
daemons+=($!)
for node in n1 n2 n3; do
  slurmd -D -N $node >"$work/$node.log" 2>&1 &
  daemons+=($!)
  declare "$node=$!"
done
until [[ $(sinfo -h -o %T 2>/dev/null | sort -u) == idle ]]; do sleep 0.5; done
sinfo

cd "$work"
CPUS_PER_TASK=1 SBATCH_OPTIONS="--output=$work/%x-%A_%a.log" "$here/submit.sh" "$scene" "$work/frames/f.####.exr" 1-12 4 "${options[@]}"
# Processes of a node: the daemon, those that have its name in their environment, and the step daemon above them.
processes_of() {
  local pid
  for pid in $(grep -lsz "^SLURMD_NODENAME=$1\$" /proc/[0-9]*/environ | cut -d/ -f3); do
    grep -qsz "^SLURM_CONF=$SLURM_CONF\$" "/proc/$pid/environ" || continue
    echo "$pid"
    ps -o ppid= -p "$pid"
  done | sort -u | awk '$1 > 1 {print $1}'
}
# The first node dies while it renders a frame of its chunk that is not the first.
until task=$(squeue -h -w n1 -t R -o %F_%K 2>/dev/null) && [[ -n $task ]]; do sleep 0.2; done
log=$work/lightsplat-$task.log
until grep -q wrote "$log" 2>/dev/null; do sleep 0.1; done
sleep 0.3
# shellcheck disable=SC2154
kill -9 "$n1" $(processes_of n1)
echo "node n1 lost while it rendered task $task, after: $(grep -c wrote "$log") frames"

until [[ -z $(squeue -h) ]]; do sleep 1; done
echo "-- log of task $task"
cat "$log"
cd "$work"
"$LIGHTSPLAT" walk "$scene" -o "$work/alone/f.####.exr" --frames 1-12 --chunk 4 "${options[@]}" 2>/dev/null
for file in alone/*; do
  cmp "$file" "frames/${file#alone/}"
done
[[ -s frames/sheet.png ]]
echo "all $(ls alone/*.exr | wc -l) frames are there, the same as in one piece; contact sheet: $work/frames/sheet.png"

# A task has the processors that it asks for, and lightsplat a thread for each.
export SBATCH_OPTIONS="-p pair --output=$work/%x-%A_%a.log"
mkdir pair
processors() {
  sbatch -p pair --wait --output="$work/pair/$1.log" --cpus-per-task="$1" --wrap nproc >/dev/null
  cat "$work/pair/$1.log"
}
[[ "$(processors 1) $(processors 2)" == '1 2' ]]
echo "a task gets the processors that it asks for"
cat >pair/jobs.toml <<JOBS
options = { resolution = "24x16", method = "path", spp = 16 }
[[picture]]
scene = "$scene"
output = "a.exr"
[[picture]]
scene = "$scene"
output = "b.exr"
spp = 32
JOBS
CPUS_PER_TASK=2 "$here/stills.sh" pair/jobs.toml
export CPUS_PER_TASK=1
small=(--resolution 24x16 --method path --spp 16 --no-denoise)
"$here/tiles.sh" "$scene" "$work/pair/tiled.exr" 2x2 "${small[@]}"
"$here/seeds.sh" "$scene" "$work/pair/merged.exr" 2 "${small[@]}"
until [[ -z $(squeue -h) ]]; do sleep 0.5; done
for file in {a,b}.{exr,png} tiled.tile.{0,1,2,3}.exr merged.exr; do
  [[ -s pair/$file ]] || {
    echo "$file is missing"
    exit 1
  }
done
echo "stills, tiles and merged seeds are there"
