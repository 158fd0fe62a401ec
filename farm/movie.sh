#!/usr/bin/env bash
# Makes a movie of the frames of a walk, by ffmpeg: of all that there are from FIRST on, none of which may lack.
#   farm/movie.sh frames/f.%04d.png out.mp4 [FRAMES_A_SECOND] [FIRST]
set -euo pipefail
if (($# < 2)); then
  sed -n 2,3p "$0" >&2
  exit 2
fi
names=$1 movie=$2 rate=${3:-24} first=${4:-1}
fail() {
  echo "$1" >&2
  exit 1
}
[[ $names =~ ^([^%]*)%0?[0-9]*d([^%]*)$ ]] || fail "$names: write the number's place as in f.%04d.png"
before=${BASH_REMATCH[1]} after=${BASH_REMATCH[2]}
command -v ffmpeg >/dev/null ||
  fail "ffmpeg is not there; install it, or look at a contact sheet: lightsplat sheet f.####.exr --frames LIST -o sheet.png"
# ffmpeg would end the movie before the first frame that lacks, and say nothing.
last=0
for file in "$before"*"$after"; do
  number=${file#"$before"} number=${number%"$after"}
  if [[ $number =~ ^[0-9]+$ ]] && ((10#$number > last)); then last=$((10#$number)); fi
done
((last >= first)) || fail "$names: there are no frames from $first on"
for ((frame = first; frame <= last; frame++)); do
  # shellcheck disable=SC2059
  file=$(printf "$names" "$frame")
  [[ -s $file ]] || fail "$file is missing; lightsplat walk --resume renders it"
done
part=${movie%.*}.part.${movie##*.}
# Players want even sizes and 4:2:0.
ffmpeg -nostdin -y -framerate "$rate" -start_number "$first" -i "$names" -vf 'pad=ceil(iw/2)*2:ceil(ih/2)*2' -c:v libx264 \
  -crf 16 -pix_fmt yuv420p "$part"
mv "$part" "$movie"
