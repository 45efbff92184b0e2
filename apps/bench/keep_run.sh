#!/usr/bin/env bash
# Measures the run that the repository keeps: keep_run.sh [PROGRAM], build/release/bin/catena by default.
#
# All suites, with the programs of other engines in build/release/peers beside them, into data/bench/all.json; of the
# plots those that README.md shows, and the figures of its sentence on the run. Before, the ratios to the run kept so far
# are printed. About six minutes on an idle machine; it ends with 1, and keeps the old run, where a row has no right
# answer.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
program="${1:-build/release/bin/catena}"
peers=build/release/peers
[[ -x "$program" ]] || {
  echo "keep_run.sh: there is no program $program: build it, or name another" >&2
  exit 2
}
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT

arguments=(bench all --json "$work/all.json" --svg "$work/plots")
if [[ -d "$peers" ]]; then
  arguments+=(--peers "$peers")
else
  echo "keep_run.sh: no other engines: there is no folder $peers (cmake --build build/release --target peers)" >&2
fi
if [[ -f data/bench/all.json ]]; then arguments+=(--compare data/bench/all.json); fi
start=$SECONDS
"$program" "${arguments[@]}"
python3 - "$work/all.json" $((SECONDS - start)) <<'PYTHON'
import datetime, json, re, sys
run, seconds = json.load(open(sys.argv[1])), int(sys.argv[2])
machine, day = run["machine"], datetime.date.fromisoformat(run["date"][:10])
others = sorted({row["engine"] for row in run["rows"]} - {"catena", "closed form by hand"})
sentence = (f"{len(run['rows'])} rows in {seconds / 60:.1f} minutes\non {day.day} {day:%B %Y}, on {machine['cores']} cores of "
            f"an {machine['cpu']} ({machine['compiler']}, load {machine['load']:.1f}), "
            f"beside {', '.join(others) or 'no other engine'};")
text = open("README.md").read()
text, places = re.subn(r"(kept in \[data/bench/all\.json\]\(data/bench/all\.json\): )[^;]*;", lambda m: m[1] + sentence, text)
if places != 1:
    sys.exit("keep_run.sh: README.md has no sentence on the run that is kept")
open("README.md", "w").write(text)
PYTHON
cp "$work/all.json" data/bench/all.json
for plot in $(grep -o 'data/bench/[a-z0-9_]*\.svg' README.md | sort -u); do
  cp "$work/plots/$(basename "$plot")" "$plot"
done
git diff --stat -- README.md data/bench
