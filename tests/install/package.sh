#!/usr/bin/env bash
# Installs the built library to a prefix of its own and uses it as a stranger would: find_package from the install tree
# and from the build tree, pkg-config, and every installed header.
# CMakeLists.txt sets SOURCE_DIR BUILD_DIR WORK_DIR CMAKE CXX GENERATOR VERSION.
set -euo pipefail
here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
work="$WORK_DIR/package"
prefix="$work/prefix"
rm -rf "$work"
mkdir -p "$work"

# expect_output COMMAND...: the consumer runs and prints the version.
expect_output() {
  local output
  output="$("$@")"
  echo "$output"
  [[ "$output" == "catena $VERSION "* ]]
}

echo "--- install"
"$CMAKE" --install "$BUILD_DIR" --prefix "$prefix" >"$work/install.log"
[[ -f "$prefix/include/catena/base/status.hpp" ]]
if find "$prefix/include" -type f ! -name '*.hpp' | grep .; then
  echo "only headers belong in include/"
  exit 1
fi
if [[ -x "$prefix/bin/catena" ]]; then
  "$prefix/bin/catena" --version
fi

module="$(find "$prefix" -name __init__.py -path '*/catena/*')"
if [[ -n "$module" ]]; then
  echo "--- the Python package"
  # Where an interpreter with this prefix looks for it.
  [[ "$module" == "$prefix"/lib/python3.*/dist-packages/catena/__init__.py ]]
  PYTHONPATH="$(dirname "$(dirname "$module")")" "$PYTHON" -c 'import catena; print(catena.loads("{\"catena\": 1}").run())'
fi

for tree in install build; do
  echo "--- find_package from the $tree tree"
  location="$prefix"
  [[ $tree == build ]] && location="$BUILD_DIR"
  "$CMAKE" -S "$here/consumer" -B "$work/$tree" -G "$GENERATOR" -DCMAKE_CXX_COMPILER="$CXX" \
    -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$location" -DEXPECTED_VERSION="$VERSION" >"$work/$tree.log"
  "$CMAKE" --build "$work/$tree" >>"$work/$tree.log" || { cat "$work/$tree.log"; exit 1; }
  expect_output "$work/$tree/consumer"
done

echo "--- pkg-config"
if command -v pkg-config >/dev/null; then
  pc="$(find "$prefix" -name catena.pc)"
  PKG_CONFIG_PATH="$(dirname "$pc")"
  export PKG_CONFIG_PATH
  [[ "$(pkg-config --modversion catena)" == "$VERSION" ]]
  read -ra flags <<<"$(pkg-config --cflags --libs catena)"
  "$CXX" -std=c++20 -DEXPECTED_VERSION="\"$VERSION\"" "$here/consumer/main.cpp" -o "$work/pkg_config_consumer" "${flags[@]}"
  LD_LIBRARY_PATH="$(dirname "$(dirname "$pc")")" expect_output "$work/pkg_config_consumer"
else
  echo "pkg-config is not installed: left out"
fi

echo "--- every installed header"
# In two units, in alphabetical order and against it, so that a header that leans on what another one includes shows;
# with the installed headers alone on the include path and warnings as a strict user would have them.
cd "$prefix/include"
for order in "" --reverse; do
  find catena -name '*.hpp' | LC_ALL=C sort $order | sed 's/.*/#include "&"/' >"$work/headers$order.cpp"
  "$CXX" -std=c++20 -fsyntax-only -Wall -Wextra -Wpedantic -Wshadow -Werror -I. "$work/headers$order.cpp"
done
wc -l <"$work/headers.cpp"
