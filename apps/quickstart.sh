#!/usr/bin/env bash
# From a fresh clone to a result: installs what is missing, builds the command line and runs a mechanism through it.
#
#   apps/quickstart.sh [SCENE]     SCENE: a scene file; without one, the crank-rocker of data/scenes
#   apps/quickstart.sh --python [SCENE]    builds the Python package too, and runs the scene through it
#
# The build goes to build/release, the results to out/<name of the scene>, both in this tree and ignored by git.
set -euo pipefail

here="$(pwd)"
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
python=OFF
if [[ "${1:-}" == --python ]]; then
  python=ON
  shift
fi
scene="${1:-$root/data/scenes/crank_rocker.json}"
[[ "$scene" == /* ]] || scene="$here/$scene"
cd "$root"

if [[ $python == ON ]]; then apps/setup.sh --python; else apps/setup.sh; fi

build=build/release
if [[ ! -f $build/build.ninja ]]; then
  echo "Configuring $build (Release)"
  cmake --preset release -DCATENA_BUILD_TESTS=OFF -DCATENA_BUILD_BENCH=OFF
fi
echo "Building $build/bin/catena"
cmake --build $build --target catena_cli
if [[ $python == ON ]]; then
  cmake -B $build -DCATENA_WITH_PYTHON=ON >/dev/null
  cmake --build $build --target catena_python
fi

out="out/$(basename "$scene" .json)"
mkdir -p "$out"
shown="${scene#"$root"/}"
echo
echo "\$ $build/bin/catena run $shown -o $out"
started="$(mktemp)"
trap 'rm -f "$started"' EXIT
sleep 0.02  # file times are coarser than a quick run
status=0
$build/bin/catena run "$shown" -o "$out" || status=$?

echo
written="$(find "$out" -type f -newer "$started" | sort)"
if [[ -n "$written" ]]; then
  echo "Files written:"
  while read -r file; do
    printf '  %-48s %10d bytes\n' "$file" "$(stat -c %s "$file")"
  done <<<"$written"
else
  echo "No files were written to $out."
fi
if [[ $python == ON ]]; then
  echo
  interpreter="$(sed -n 's/^Python_EXECUTABLE:[A-Z]*=//p' $build/CMakeCache.txt)"
  code='import sys, catena; print(catena.load(sys.argv[1]).run())'
  echo "\$ PYTHONPATH=$build/python ${interpreter:-python3} -c '$code' $shown"
  PYTHONPATH=$build/python "${interpreter:-python3}" -c "$code" "$shown"
fi
exit $status
