#!/usr/bin/env bash
# UMFPACK, SPQR, Ipopt, NLopt and the viewer all left out: the project can be configured so, and the program made of
# files compiled so (CMakeLists.txt) links none of the libraries and runs a mechanism.
# CMakeLists.txt sets SOURCE_DIR WORK_DIR CMAKE CXX GENERATOR WITHOUT.
set -euo pipefail
work="$WORK_DIR/switched_off"

"$CMAKE" -S "$SOURCE_DIR" -B "$work" -G "$GENERATOR" -DCMAKE_CXX_COMPILER="$CXX" -DCMAKE_BUILD_TYPE=Release \
  -DCATENA_WITH_UMFPACK=OFF -DCATENA_WITH_SPQR=OFF -DCATENA_WITH_IPOPT=OFF -DCATENA_WITH_NLOPT=OFF \
  -DCATENA_WITH_VIEWER=OFF \
  -DCATENA_BUILD_TESTS=OFF -DCATENA_BUILD_BENCH=OFF

program="$WITHOUT"
needed="$(readelf --dynamic "$program" | grep NEEDED)"
echo "$needed"
if grep -E 'umfpack|spqr|ipopt|nlopt' <<<"$needed"; then
  echo "linked although switched off"
  exit 1
fi
"$program" run "$SOURCE_DIR/data/scenes/crank_rocker.json" >"$work/crank_rocker.txt"
head -n 20 "$work/crank_rocker.txt"

# What needs a library that was left out says so.
for solver in ipopt nlopt; do
  cat >"$work/held_$solver.json" <<SCENE
{"catena": 1, "gravity": [0, -10], "bodies": {"bar": {"mass": 1, "rod": {"from": [0, 0], "to": [1, 0]}}},
 "constraints": [{"type": "revolute", "i": "ground", "j": "bar.from"}],
 "analyses": [{"type": "equilibrium", "solver": "$solver"}]}
SCENE
  if "$program" run "$work/held_$solver.json" >"$work/held_$solver.txt" 2>&1; then
    echo "equilibrium by $solver ran although it was left out"
    exit 1
  fi
  grep -i "built without $solver" "$work/held_$solver.txt"
done
if "$program" view "$SOURCE_DIR/data/scenes/crank_rocker.json" -o "$work/page.html" >"$work/view.txt" 2>&1; then
  echo "view wrote a page although the viewer was left out"
  exit 1
fi
grep "built without the viewer" "$work/view.txt"
"$program" draw "$SOURCE_DIR/data/scenes/crank_rocker.json" --svg "$work/crank_rocker.svg"
