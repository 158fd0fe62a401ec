# Sourced by the scripts that submit jobs. LIGHTSPLAT names the program, SBATCH_OPTIONS further options of sbatch
# (partition, time limit), SLURM_AT_ONCE the maximum number of tasks at a time. A task gets CPUS_PER_TASK processors, 8
# unless set: Slurm gives one if nothing is asked for. All files have to be on a file system that all nodes share.
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
export LIGHTSPLAT=${LIGHTSPLAT:-$(command -v lightsplat)} LIGHTSPLAT_FARM=$here
read -ra more <<<"${SBATCH_OPTIONS:-}"

# Prints the head of the script that sources this file, and ends, if there are fewer than $1 arguments.
needs() {
  if (($2 < $1)); then
    sed -n '2,/^set /{/^set /d;p}' "$0" >&2
    exit 2
  fi
}

# Submits an array of tasks (like 1-8) of the script $2 with its arguments; prints the number of the job.
array() {
  local tasks=$1${SLURM_AT_ONCE:+%$SLURM_AT_ONCE} script=$2
  shift 2
  sbatch --parsable "${more[@]}" --array="$tasks" --cpus-per-task="${CPUS_PER_TASK:-8}" "$here/$script" "$@"
}

# Submits the script $2 with its arguments, to be run when all tasks of the job $1 are done; prints the number of the job.
after() {
  local job=$1 script=$2
  shift 2
  sbatch --parsable "${more[@]}" --dependency="afterok:$job" --kill-on-invalid-dep=yes "$here/$script" "$@"
}
