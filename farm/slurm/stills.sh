#!/usr/bin/env bash
# Renders the images, walks and views of job files on a Slurm cluster: an array job with a task per entry, or per
# ENTRIES_PER_TASK entries, which a task renders as many at a time as it has processors.
#   farm/slurm/stills.sh JOBS.toml...
# common.sh lists the environment variables.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
needs 1 $#
count=$("$LIGHTSPLAT" batch "$@" --list | wc -l)
export ENTRIES=$count ENTRIES_PER_TASK=${ENTRIES_PER_TASK:-1}
tasks=$(((count + ENTRIES_PER_TASK - 1) / ENTRIES_PER_TASK))
images=$(array "1-$tasks" task.sbatch batch "$@" --only '{entries}' --resume -j "$ENTRIES_PER_TASK")
echo "images: job $images"
