#!/usr/bin/env bash
# Runs one fuzzer: fuzz.sh PROGRAM NAME
#
#   CATENA_FUZZ_SECONDS  how long, 30 by default
#   CATENA_FUZZ_CORPUS   a folder in which what is found is kept between runs; else it is forgotten
#
# It starts from corpus/NAME and, for scenes, from those of data/. Words of the language come from the scene schema. A
# finding is written to the current folder; to keep it, put its file into corpus/NAME.
set -euo pipefail
program="$1" name="$2"
here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
data="$here/../../data"

work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
found="${CATENA_FUZZ_CORPUS:+$CATENA_FUZZ_CORPUS/$name}"
found="${found:-$work/found}"
mkdir -p "$found" "$work/seeds"

options=(-timeout=20 -rss_limit_mb=2048 -malloc_limit_mb=1024 -print_final_stats=1 -verbosity=0)
seeds=("$here/corpus/$name")
if [[ "$name" == scene ]]; then
  # Scenes of more than some kilobytes change too slowly.
  find "$data/scenes" "$data/trials" -name '*.json' -size -6k -exec cp -t "$work/seeds" {} +
  seeds+=("$work/seeds")
  # Keys and words, with and without their quotes.
  grep -oE '"[A-Za-z_$][A-Za-z0-9_]*"' "$data/schema/catena-1.schema.json" | sort -u |
    sed -E 's/"(.*)"/"\1"\n"\\"\1\\""/' >"$work/words"
  options+=(-dict="$work/words" -max_len=6000)
fi

"$program" "${options[@]}" -max_total_time="${CATENA_FUZZ_SECONDS:-30}" "$found" "${seeds[@]}"
