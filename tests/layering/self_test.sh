#!/usr/bin/env bash
# Holds check.sh to its word: a small clean tree passes, and each violation, put into it alone, is reported.
set -euo pipefail
check="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)/check.sh"
tree="$(mktemp -d)"
trap 'rm -rf "$tree"' EXIT
cd "$tree"
failures=0
cases=0

# put FILE LINES...: writes a file of the given lines, with the opening a header needs.
put() {
  local file="$1"
  shift
  mkdir -p "$(dirname "$file")"
  {
    [[ "$file" == *.hpp ]] && printf '// A header.\n#pragma once\n'
    printf '%s\n' "$@"
  } >"$file"
}

# clean NAME: the tree as it is must pass.
clean() {
  cases=$((cases + 1))
  local output
  if ! output="$(bash "$check" "$tree" 2>&1)"; then
    printf 'should pass: %s\n%s\n' "$1" "$output"
    failures=$((failures + 1))
  fi
}

# violates "TEXT" FILE LINES...: with this file added the check must fail, with TEXT and the file's name in its output.
violates() {
  local text="$1" file="$2" output
  shift 2
  cases=$((cases + 1))
  [[ $# -gt 0 ]] && put "$file" "$@"
  if output="$(bash "$check" "$tree" 2>&1)"; then
    echo "not reported: $file ($text)"
    failures=$((failures + 1))
  elif [[ "$output" != *"$file:"*"$text"* ]]; then
    printf 'reported otherwise than "%s: ... %s":\n%s\n' "$file" "$text" "$output"
    failures=$((failures + 1))
  fi
  rm -f "$file"
}

put lib/catena/base/vec2.hpp '#include <array>'
put lib/catena/elements/revolute.hpp '#include "catena/base/vec2.hpp"'
put lib/catena/model/model.hpp '#include "catena/elements/revolute.hpp"'
put lib/catena/drawing/shapes/pen.cpp '#include "catena/model/model.hpp"'
put lib/catena/drawing/figures/plot.hpp '#include "catena/drawing/shapes/pen.hpp"'
put lib/catena/linalg/solver.cpp '#include <klu.h>' '#include <suitesparse/cholmod.h>' '#include "catena/base/vec2.hpp"'
put lib/catena/assembly/plan.cpp '#include "catena/model/model.hpp"' '#include "catena/assembly/structure/a.hpp"' '#include "catena/linalg/solver.hpp"' '#include <Eigen/Core>'
put lib/catena/analysis/statics/ipopt.cpp '#include <IpTNLP.hpp>' '#include <IpIpoptApplication.hpp>'
put lib/catena/analysis/statics/statics.cpp '#include "catena/analysis/run/report.hpp"'
put lib/catena/analysis/minimiser/nlopt.cpp '#include <nlopt.hpp>'
put lib/catena/analysis/design/design.cpp '#include "catena/analysis/minimiser/minimiser.hpp"'
put lib/catena/analysis/sensitivity/a.cpp '#include "catena/assembly/design/mechanism.hpp"'
put lib/catena/scene/reader.cpp '#include <nlohmann/json.hpp>' '#include <fmt/core.h>' '#include "catena/results/csv.hpp"' '#include "catena/drawing/figures/plot.hpp"'
put lib/catena/catena.hpp '#include "catena/scene/reader.hpp"'
put apps/catena/main.cpp '#include "catena/catena.hpp"' '#include "verbs.hpp"' '#include <iostream>'
put tests/base/vec2_test.cpp '#include "catena/base/vec2.hpp"' '#include <nlohmann/json.hpp>' '#include "matrices.hpp"'
mkdir -p data .ci build out
touch CMakeLists.txt CMakePresets.json LICENSE .gitignore
put README.md '[the manual](apps/manual/motion.md#equations-of-motion)'
put apps/manual/motion.md '# Motion' '## Equations of motion' 'see [above](motion.md#motion)' '```' '# no heading' '```'
put lib/catena/base/cited.hpp '// apps/manual/motion.md#equations-of-motion, README.md'
clean "a tree in order"

violates "base may not include elements" lib/catena/base/a.hpp '#include "catena/elements/revolute.hpp"'
violates "elements may not include model" lib/catena/elements/constraints/a.hpp '#include "catena/model/model.hpp"'
violates "linalg may not include model" lib/catena/linalg/a.cpp '#include "catena/model/model.hpp"'
violates "model may not include linalg" lib/catena/model/a.cpp '#  include "catena/linalg/solver.hpp"'
violates "assembly may not include analysis" lib/catena/assembly/a.cpp '#include <catena/analysis/kinematics.hpp>'
violates "assembly/structure may not include assembly/." lib/catena/assembly/structure/a.cpp '#include "catena/assembly/plan.hpp"'
violates "drawing may not include columns" lib/catena/drawing/shapes/a.cpp '#include "catena/columns/column_set.hpp"'
violates "results may not include drawing" lib/catena/results/a.cpp '#include "catena/drawing/shapes/pen.hpp"'
violates "drawing/shapes may not include drawing/figures" lib/catena/drawing/shapes/a.cpp '#include "catena/drawing/figures/plot.hpp"'
violates "results may not include scene" lib/catena/results/a.cpp '#include "catena/scene/reader.hpp"'
violates "analysis/run may not include analysis/statics" lib/catena/analysis/run/a.cpp '#include "catena/analysis/statics/a.hpp"'
violates "analysis/kinematics may not include analysis/dynamics" lib/catena/analysis/kinematics/a.cpp '#include "catena/analysis/dynamics/a.hpp"'
violates "analysis/measures may not include analysis/dynamics" lib/catena/analysis/measures/a.cpp '#include "catena/analysis/dynamics/a.hpp"'
violates "analysis/minimiser may not include analysis/design" lib/catena/analysis/minimiser/a.cpp '#include "catena/analysis/design/a.hpp"'
violates "scene/json may not include scene/." lib/catena/scene/json/a.cpp '#include "catena/scene/reader.hpp"'
violates "is no known folder" lib/catena/analysis/odds/a.cpp 'int a;'
for i in $(seq 30); do put lib/catena/columns/c$i.cpp 'int c;'; done
violates "more than 30 files" lib/catena/columns/d.cpp 'int d;'
rm lib/catena/columns/c*.cpp
violates "cites theory.md, which is not in the repository" lib/catena/base/a.cpp '// see theory.md'
violates "cites THEORY, which is not in the repository" lib/catena/base/a.hpp '// (THEORY section 4)'
violates "cites NUMERICS, which is not in the repository" tests/base/a.cpp '// Source: NUMERICS'
violates "no such heading" lib/catena/base/a.hpp '// apps/manual/motion.md#reactions'
violates "no such heading" apps/catena/a.cpp '// apps/manual/motion.md#no-heading'
violates "cites rest.md#rest, which is not in the repository" apps/manual/more.md '[rest](rest.md#rest)'
violates "no such heading" apps/manual/more.md '[motion](motion.md#rest)'
violates "in no known layer" lib/catena/results/a.cpp '#include "catena/util/a.hpp"'
violates "is no known layer" lib/catena/util/a.cpp 'int a;'
violates "not catena.hpp" lib/catena/scene/a.cpp '#include "catena/catena.hpp"'
violates "should start with catena/" lib/catena/scene/a.cpp '#include "reader.hpp"'
violates "SuiteSparse" lib/catena/linalg/a.hpp '#include <klu.h>'
violates "SuiteSparse" lib/catena/analysis/a.cpp '#include <SuiteSparseQR.hpp>'
violates "SuiteSparse" apps/bench/a.cpp '#include <suitesparse/umfpack.h>'
violates "SuiteSparse" lib/catena/assembly/a.cpp '#include <Eigen/CholmodSupport>'
violates "JSON" lib/catena/scene/a.hpp '#include <nlohmann/json_fwd.hpp>'
violates "JSON" apps/catena/a.cpp '#include <nlohmann/json.hpp>'
violates "Ipopt" lib/catena/analysis/z.cpp '#include <coin/IpTNLP.hpp>'
violates "Ipopt" apps/catena/a.cpp '#include <IpTNLP.hpp>'
violates "NLopt" lib/catena/analysis/z.cpp '#include <nlopt.h>'
violates "no Eigen" lib/catena/linalg/a.hpp '#include <Eigen/Core>'
violates "no fmt" lib/catena/results/a.hpp '#include <fmt/core.h>'
violates "no <iostream>" lib/catena/results/a.hpp '#include <iostream>'
violates "no known layer" lib/catena/a.hpp '#include "catena/elsewhere.hpp"'

mkdir -p lib/catena/base
printf '#pragma once\n' >lib/catena/base/a.hpp
violates "opens with a // comment" lib/catena/base/a.hpp
printf '//\n#pragma once\n' >lib/catena/base/a.hpp
violates "opens with a // comment" lib/catena/base/a.hpp
printf '// A header.\nint a;\n' >lib/catena/base/a.hpp
violates "without #pragma once" lib/catena/base/a.hpp
violates "top level" notes.txt 'text'
violates "top level" Makefile 'all:'
clean "the tree after all that"

# Under version control only what is committed or staged counts.
if command -v git >/dev/null; then
  git init -q . && git add CMakeLists.txt lib apps
  touch notes.txt
  clean "a stray file outside version control"
  git add notes.txt
  violates "top level" notes.txt
fi

# The counting of constants: their classes, and that too many, or too many without a reason, fail.
constants="$(dirname "$check")/constants.sh"
rm -rf "$tree/lib"
put lib/catena/analysis/x/a.cpp '// Of the largest.' 'constexpr double small = 1e-3, smaller = 1e-6;' 'constexpr int most = 80;' '' \
  'constexpr double alone = 4 * std::numeric_limits<double>::epsilon();' \
  'constexpr double none = std::numeric_limits<double>::quiet_NaN();' '// An alias.' \
  'constexpr double other = thresholds::small;' 'constexpr double ratio =' '    0.5;  // behind'
cases=$((cases + 1))
listed="$(bash "$constants" "$tree" --list | cut -f1,4,5 | tr '\t\n' ' ;')"
expected="threshold small = 1e-3 reason;threshold smaller = 1e-6 reason;bound most = 80 reason;"
expected+="threshold alone = 4 * std::numeric_limits<double>::epsilon() -;"
expected+="exact none = std::numeric_limits<double>::quiet_NaN() -;other other = thresholds::small reason;"
expected+="threshold ratio = 0.5 reason;"
if [[ "$listed" != "$expected" ]]; then
  printf 'constants are listed as\n%s\nand not as\n%s\n' "$listed" "$expected"
  failures=$((failures + 1))
fi
sed -i '/alone/d' "$tree/lib/catena/analysis/x/a.cpp"  # it has no reason
# few CLASS LINE COUNT: with so many such lines the count must fail.
few() {
  cases=$((cases + 1))
  bash "$constants" "$tree" >/dev/null || { echo "a few constants should pass"; failures=$((failures + 1)); }
  for k in $(seq "$3"); do printf '// A reason.\n%s;\n\n' "${2/NAME/n$k}"; done >"$tree/lib/catena/analysis/x/b.cpp"
  [[ "$1" == reason ]] && sed -i '/reason/d' "$tree/lib/catena/analysis/x/b.cpp"
  if bash "$constants" "$tree" >/dev/null; then
    echo "too many are not reported: $1"
    failures=$((failures + 1))
  fi
  rm "$tree/lib/catena/analysis/x/b.cpp"
}
few threshold 'constexpr double NAME = 0.1' 1000
few bound 'constexpr int NAME = 10' 1000
few reason 'constexpr double NAME = 1e-3' 100

echo "$cases cases, $failures failures"
[[ $failures -eq 0 ]]
