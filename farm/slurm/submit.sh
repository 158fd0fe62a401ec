#!/usr/bin/env bash
# Renders a walk on a Slurm cluster: an array job with a task per chunk, then a contact sheet of all frames.
#   farm/slurm/submit.sh SCENE NAME.####.exr FIRST-LAST CHUNK [options of lightsplat walk]
# common.sh lists the environment variables.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
needs 4 $#
scene=$1 output=$2 first=${3%-*} last=${3#*-} chunk=$4
shift 4
mkdir -p "$(dirname "$output")"
render=$(array "$(((first - 1) / chunk))-$(((last - 1) / chunk))" chunk.sbatch "$scene" "$output" "$first" "$last" "$chunk" "$@")
sheet=$(after "$render" sheet.sbatch "$output" "$first" "$last")
echo "chunks: job $render; contact sheet: job $sheet"
