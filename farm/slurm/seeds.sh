#!/usr/bin/env bash
# Renders an image on a Slurm cluster with several seeds: an array job with a task per seed, then one that merges them.
#   farm/slurm/seeds.sh SCENE NAME.exr SEEDS [options of lightsplat render]
# common.sh lists the environment variables.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
needs 3 $#
scene=$1 output=$2 seeds=$3
shift 3
mkdir -p "$(dirname "$output")"
render=$(array "1-$seeds" task.sbatch render "$scene" -o "${output%.exr}.seed.{}.exr" --seed '{}' --no-png --resume "$@")
merge=$(after "$render" merge.sbatch "$output" "$seeds")
echo "seeds: job $render; merging: job $merge"
