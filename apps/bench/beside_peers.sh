#!/usr/bin/env bash
# Lays catena beside other engines, measured in one run on one machine.
#
#   apps/bench/beside_peers.sh <catena_bench> <folder of peer programs> [records file]
#
# A peer program is called peer_<engine>, takes the name of a scene and prints records as peer_records.hpp describes
# them. Every scene is run by all programs in turn, twice, and the lesser time of each record counts. Printed for each
# table: the shortest time of each engine at an error no larger than a limit, and the ratio to catena's. PEERS, if set,
# names the engines wanted; a program that takes longer than LIMIT seconds (300) is ended, its records so far are kept.
set -euo pipefail

if [[ $# -lt 2 ]]; then
  echo "usage: $0 <catena_bench> <folder of peer programs> [records file]" >&2
  exit 2
fi
bench="$1"
peers="$2"
records="${3:-$(mktemp)}"
# Times are processor times: threads of the BLAS would count double.
export OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1
: >"$records"

for round in 1 2; do
  for scene in acceleration chain fourbar squeezer equilibrium; do
    "$bench" --records "$scene" >>"$records"
    for peer in ${PEERS:-simbody mujoco dart bullet}; do
      case "$peer-$scene" in
        simbody-* | *-acceleration | *-chain | *-fourbar) ;;
        *) continue ;;  # only Simbody knows the other scenes
      esac
      [[ -x "$peers/peer_$peer" ]] || continue
      timeout "${LIMIT:-300}" "$peers/peer_$peer" "$scene" >>"$records" 2>/dev/null ||
        echo "note: peer_$peer $scene ended with status $? in round $round" >&2
    done
  done
done

# best <table> <title> <field of the time> <field of the error> <limit> [<field> <value that it must have>]
best() {
  printf '\n%s\n' "$2"
  awk -F'\t' -v table="$1" -v time="$3" -v error="$4" -v limit="$5" -v field="${6:-0}" -v value="${7:-}" '
    $1 != table || (field && $field != value) || (error && $error + 0 > limit) { next }
    { key = $2 }
    !(key in least) || $time + 0 < least[key] { least[key] = $time + 0; how[key] = $3 (error ? ", " $4 ", error " $error : "") }
    END {
      for (key in least)
        printf "  %-10s %12.3f %8.1f x   %s\n", key, least[key], least["catena"] ? least[key] / least["catena"] : 0, how[key]
    }' "$records" | sort -k2,2n
}

for n in 10 100 1000 10000 100000 1000000; do best S1a "Accelerations, chain of $n: ns a body" 5 0 0 4 "$n"; done
for limit in 1e-3 1e-5 3.3e-8 1e-10; do best S1b "Chain of 40 for 1 s, worst joint to $limit m: ms" 6 9 "$limit"; done
for n in 2 40; do
  for limit in 1e-2 6.9e-4 1e-5; do best S2 "A02, N = $n, 10 s, B0 to $limit m: ms" 6 8 "$limit" 5 "$n"; done
done
for limit in 1e-4 2.1e-8 2e-9; do best S3 "Andrews, angles to $limit rad: ms" 6 7 "$limit"; done
for n in 10 100 1000 10000 100000; do best S4 "Hanging chain of $n at rest, joints to 1e-5 of its length: ms" 6 8 "1e-5" 5 "$n"; done
echo
echo "records: $records"
