#!/usr/bin/env bash
# Installs the Debian packages that catena is built with: the one place that lists them.
#
#   apps/setup.sh            what building the library and the command line needs
#   apps/setup.sh --python   also what the Python package needs
#   apps/setup.sh --tests    also what the tests and benchmarks need
#   apps/setup.sh --checks   also the second compiler and the formatter
#   apps/setup.sh --browser  what the tests need, and the browser that pages are tested in
#   apps/setup.sh --all      all of these
#
# Installs only what is missing, as root or through sudo, and says what it does. With nothing missing it ends at once
# and silently.
set -euo pipefail

packages=(
  cmake g++ ninja-build
  libeigen3-dev         # small dense matrices
  libsuitesparse-dev    # CHOLMOD, KLU, UMFPACK, SPQR
  libopenblas-dev       # the BLAS below SuiteSparse
  coinor-libipopt-dev   # optimisation, one-sided equilibrium
  libnlopt-dev          # derivative-free optimisation
  nlohmann-json3-dev    # scene files
  libcli11-dev          # the command line
  libfmt-dev            # text reports
  libxsimd-dev          # batches of designs in SIMD lanes
  esbuild               # the page of `catena view`
)
python_packages=(
  pybind11-dev python3-dev python3-numpy
)
test_packages=(
  "${python_packages[@]}"
  libgtest-dev
  librapidcheck-dev     # property tests
  libboost-dev          # 50-digit arithmetic to compare with
  libbenchmark-dev      # apps/bench
  pkgconf               # the installed package is used through pkg-config too
  node-typescript       # the types of the page are checked
  python3-pandas        # data frames of results
  python3-matplotlib    # plots and animations of results
  libopenmpi-dev openmpi-bin            # sweeps over processes
  python3-mpi4py python3-distributed    # and from Python
  mypy                  # the types of the Python package are checked
)
browser_packages=(
  chromium chromium-driver
  nodejs                # speaks with the driver
)
check_packages=(
  clang clang-format
  libclang-rt-dev       # the sanitizers of clang
  lld                   # links sanitized programs
)

case "${1:-}" in
  "") ;;
  --python) packages+=("${python_packages[@]}") ;;
  --tests) packages+=("${test_packages[@]}") ;;
  --checks) packages+=("${test_packages[@]}" "${check_packages[@]}") ;;
  --browser) packages+=("${test_packages[@]}" "${browser_packages[@]}") ;;
  --all) packages+=("${test_packages[@]}" "${browser_packages[@]}" "${check_packages[@]}") ;;
  *)
    echo "usage: apps/setup.sh [--python | --tests | --checks | --browser | --all]" >&2
    exit 2
    ;;
esac

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  echo "Not a Debian system: nothing is installed. catena needs what these Debian packages hold: ${packages[*]}"
  exit 0
fi

# dpkg-query fails when one of the names is unknown to it; what it prints for the others counts all the same.
installed=" $(dpkg-query --show --showformat '${db:Status-Status}:${Package} ' "${packages[@]}" 2>/dev/null || true)"
missing=()
for package in "${packages[@]}"; do
  [[ "$installed" == *" installed:$package "* ]] || missing+=("$package")
done
[[ ${#missing[@]} -eq 0 ]] && exit 0

as_root=()
if [[ $(id -u) -ne 0 ]]; then
  if ! command -v sudo >/dev/null; then
    echo "These Debian packages are missing and neither root nor sudo is at hand to install them: ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi

echo "Installing ${#missing[@]} missing Debian packages (${as_root[*]:+with sudo, }apt-get): ${missing[*]}"
export DEBIAN_FRONTEND=noninteractive
"${as_root[@]}" apt-get update -q </dev/null
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
  apt-get install -y -q --no-install-recommends "${missing[@]}" </dev/null
echo "Installed: ${missing[*]}"
