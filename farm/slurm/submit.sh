#!/usr/bin/env bash
# Renders a walk on a Slurm cluster: an array job of a task a chunk, then a contact sheet of all frames.
#   farm/slurm/submit.sh SCENE NAME.####.exr FIRST-LAST CHUNK [options of lightsplat walk]
# The files have to be on a file system that all nodes share. LIGHTSPLAT names the program, SBATCH_OPTIONS what sbatch is
# to be told besides (partition, time limit, --array's %N is SLURM_AT_ONCE). A task gets CPUS_PER_TASK processors, 8 unless
# set: Slurm gives one if nothing is asked for.
set -euo pipefail
if (($# < 4)); then
  sed -n 2,6p "$0" >&2
  exit 2
fi
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
scene=$1 output=$2 first=${3%-*} last=${3#*-} chunk=$4
shift 4
export LIGHTSPLAT=${LIGHTSPLAT:-$(command -v lightsplat)}
tasks=$(((first - 1) / chunk))-$(((last - 1) / chunk))${SLURM_AT_ONCE:+%$SLURM_AT_ONCE}
mkdir -p "$(dirname "$output")"
read -ra more <<<"${SBATCH_OPTIONS:-}"
render=$(sbatch --parsable "${more[@]}" --array="$tasks" --cpus-per-task="${CPUS_PER_TASK:-8}" \
  "$here/chunk.sbatch" "$scene" "$output" "$first" "$last" "$chunk" "$@")
sheet=$(sbatch --parsable "${more[@]}" --dependency="afterok:$render" --kill-on-invalid-dep=yes "$here/sheet.sbatch" "$output" \
  "$first" "$last")
echo "chunks: job $render; contact sheet: job $sheet"
