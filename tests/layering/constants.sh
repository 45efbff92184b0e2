#!/usr/bin/env bash
# Counts the named constants of the analyses by class (constants.awk) and holds them to what is written here: a new
# threshold has to take the place of another, or to be one of run/thresholds.hpp if it means the same, not only where
# it has the same value. Each must have a reason beside it.
#
#   constants.sh ROOT          counts and checks
#   constants.sh ROOT --list   all of them, one a line
set -euo pipefail
root="$(cd "$1" && pwd)"
here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
most_thresholds=438
most_bounds=153
most_unexplained=0

cd "$root"
mapfile -t files < <(find lib/catena/analysis \( -name '*.hpp' -o -name '*.cpp' \) | LC_ALL=C sort)
found="$(awk -f "$here/constants.awk" "${files[@]}")"
if [[ "${2:-}" == --list ]]; then
  echo "$found"
  exit 0
fi
count() { awk -F '\t' -v class="$1" '$1 == class { ++n } END { print n + 0 }' <<<"$found"; }
thresholds="$(count threshold)"
bounds="$(count bound)"
echo "$thresholds thresholds, $bounds bounds of work and size, $(count exact) exact, $(count other) by other names"

status=0
if ((thresholds > most_thresholds)); then
  echo "more than $most_thresholds thresholds: take one of run/thresholds.hpp that means the same, or derive it"
  status=1
fi
if ((bounds > most_bounds)); then
  echo "more than $most_bounds bounds of work and size"
  status=1
fi
unexplained="$(awk -F '\t' '$1 ~ /^(threshold|bound)$/ && $5 == "-" { print $3 "\t" $4 }' <<<"$found")"
if [[ -n "$unexplained" ]]; then
  echo "without a reason beside it (what it follows from, or what it was measured by):"
  echo "$unexplained"
  (($(wc -l <<<"$unexplained") <= most_unexplained)) || status=1
fi
exit $status
