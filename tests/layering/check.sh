#!/usr/bin/env bash
# Checks the structure of a source tree and names every violation as file:line: message.
#
#   check.sh ROOT
#
# - includes go only towards the lower layers (rules.awk has the order)
# - each outside library stays in the folder that is there for it
# - every header opens with a comment that says what it is, and has #pragma once
# - what sources and the manual cite is there: page and heading (citations.awk)
# - the top level holds nothing but what is listed here
set -euo pipefail
root="$(cd "$1" && pwd)"
here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
rules="$here/rules.awk"
citations="$here/citations.awk"
cd "$root"

status=0
mapfile -t files < <(find lib/catena apps tests \( -name '*.hpp' -o -name '*.cpp' \) 2>/dev/null | LC_ALL=C sort)
if [[ ${#files[@]} -eq 0 ]]; then
  echo "$root: no sources found"
  exit 1
fi
awk -f "$rules" "${files[@]}" || status=1

# The rules themselves name what they forbid.
mapfile -t pages < <(ls README.md apps/manual/*.md 2>/dev/null)
mapfile -t citing < <(find lib apps tests -path tests/layering -prune -o -type f \( -name '*.hpp' -o -name '*.cpp' \
  -o -name '*.sh' -o -name '*.cmake' -o -name '*.in' -o -name CMakeLists.txt \) -print 2>/dev/null | LC_ALL=C sort)
awk -f "$citations" "${pages[@]}" cited=1 "${pages[@]}" "${citing[@]}" || status=1

# In a checkout the files under version control count; elsewhere (an unpacked archive) all but what builds leave.
if [[ "$(git rev-parse --show-toplevel 2>/dev/null)" == "$root" ]]; then
  entries="$(git ls-files | cut -d/ -f1 | LC_ALL=C sort -u)"
else
  entries="$(ls | grep -vxE 'build|out' || true)"
fi
while read -r entry; do
  case "$entry" in
    "" | .* | CMakeLists.txt | CMakePresets.json | README.md | LICENSE | lib | apps | tests | data) ;;
    *)
      echo "$entry:1: not a permitted entry at the top level"
      status=1
      ;;
  esac
done <<<"$entries"

[[ $status -eq 0 ]] && echo "${#files[@]} files keep the structure"
exit $status
