#!/usr/bin/env bash
# Renders an image on a Slurm cluster in tiles: an array job with a task per tile. With path and lightcuts the pixels of the
# tiles equal those of the full image.
#   farm/slurm/tiles.sh SCENE NAME.exr COLUMNSxROWS [options of lightsplat render]
# common.sh lists the environment variables.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
needs 3 $#
scene=$1 output=$2 columns=${3%x*} rows=${3#*x}
shift 3
mkdir -p "$(dirname "$output")"
size=$("$LIGHTSPLAT" render "$scene" -o "$output" --dry-run "$@" | sed -n 's/^resolution\t\([0-9]*x[0-9]*\).*/\1/p')
tiles=$(array "0-$((columns * rows - 1))" tile.sbatch "$scene" "$output" "$columns" "$rows" "${size%x*}" "${size#*x}" "$@")
echo "tiles: job $tiles"
