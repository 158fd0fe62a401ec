#!/usr/bin/env bash
# Makes a movie of the frames of a walk, by ffmpeg.
#   farm/movie.sh frames/f.%04d.png out.mp4 [FRAMES_A_SECOND] [FIRST]
set -euo pipefail
if (($# < 2)); then
  sed -n 2,3p "$0" >&2
  exit 2
fi
command -v ffmpeg >/dev/null || {
  echo "ffmpeg is not there; install it, or look at a contact sheet: lightsplat sheet f.####.exr --frames LIST -o sheet.png" >&2
  exit 1
}
# Players want even sizes and 4:2:0.
ffmpeg -y -framerate "${3:-24}" -start_number "${4:-1}" -i "$1" -vf 'pad=ceil(iw/2)*2:ceil(ih/2)*2' -c:v libx264 -crf 16 \
  -pix_fmt yuv420p "$2"
