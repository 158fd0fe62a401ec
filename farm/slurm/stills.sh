#!/usr/bin/env bash
# Renders the images, walks and views of job files on a Slurm cluster: an array job with a task per entry.
#   farm/slurm/stills.sh JOBS.toml...
# common.sh lists the environment variables.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
needs 1 $#
count=$("$LIGHTSPLAT" batch "$@" --list | wc -l)
images=$(array "1-$count" task.sbatch batch "$@" --only '{}' --resume)
echo "images: job $images"
