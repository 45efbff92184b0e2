#!/usr/bin/env bash
# Runs the figure commands of README.md as they stand and compares what they draw with the gallery that README.md shows:
# the same text, and numbers that differ by no more than the last digit of a coordinate.
#
#   gallery.sh CATENA SOURCE_DIR
set -euo pipefail
program="$1"
source_dir="$2"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
ln -s "$source_dir/data" "$work/data"
cd "$work"

commands=0
while read -r _ arguments; do
  commands=$((commands + 1))
  # shellcheck disable=SC2086  # the words of the line are the arguments
  "$program" $arguments
done < <(grep -E '^catena (draw|plot) .*--svg [a-z_]+\.svg$' "$source_dir"/README.md)

differences=0
for figure in *.svg; do
  kept="$source_dir/apps/manual/gallery/$figure"
  if ! awk -v kept="$kept" '
      function words(line, out) { gsub(/[^-0-9.]+/, " ", line); return split(line, out, " ") }
      function letters(line) { gsub(/[-0-9.]+/, "#", line); return line }
      {
        if ((getline other < kept) <= 0 || letters($0) != letters(other)) exit 1
        n = words($0, a)
        words(other, b)
        for (k = 1; k <= n; ++k) if (a[k] - b[k] > 0.021 || b[k] - a[k] > 0.021) exit 1
      }
      END { if ((getline other < kept) > 0) exit 1 }' "$figure"; then
    echo "$figure differs from $kept: make it anew by its command in README.md"
    differences=$((differences + 1))
  fi
done
echo "$commands commands, $differences differences"
[[ $commands -ge 6 && $differences -eq 0 ]]
