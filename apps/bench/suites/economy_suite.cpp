// What a scene does not need costs nothing, and the answer is that of the full solve: counts, instructions, times.
#include <cmath>

#include "cases/economy_cases.hpp"
#include "suites/instructions.hpp"
#include "suites/suites.hpp"

namespace bench {

namespace {

double answers_apart(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return std::numeric_limits<double>::infinity();
  double worst = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const double difference = std::abs(a[k] - b[k]);
    if (!(difference <= worst)) worst = difference;
  }
  return worst;
}

}  // namespace

void economy_suite(Bench& bench) {
  std::string obstacle = bench.options().instructions ? no_instructions_because() : "not asked for";
  if (!obstacle.empty() && bench.options().instructions) bench.remark("economy: no instructions: " + obstacle);
  for (const EconomyCase& c : economy_cases()) {
    const EconomyOutcome lean = c.lean.prepare()(), full = c.full.prepare()();
    const double difference = answers_apart(lean.answer, full.answer);
    for (const EconomyVariant& variant : {c.lean, c.full}) {
      const EconomyOutcome& outcome = variant.prepare == c.lean.prepare ? lean : full;
      Row row{.suite = "economy", .problem = c.feature, .method = variant.name};
      row.error_of = std::string("difference of the two: ") + c.answer;
      row.reference = variant.prepare == c.lean.prepare ? c.full.name : c.lean.name;
      row.allowed = c.allowed;
      if (!bench.wants(row)) continue;
      row.error = difference;
      row.failure = outcome.failure;
      row.counts = outcome.counts;
      const EconomyWork work = variant.prepare();
      bench.time(row, work);
      if (obstacle.empty()) {
        const auto counted = instructions_of(c.feature + std::string(" / ") + variant.name);
        if (counted) {
          row.counts.emplace_back("instructions", *counted);
        } else {
          obstacle = "valgrind could not run this program";
          bench.remark("economy: no instructions: " + obstacle);
        }
      }
      bench.add(std::move(row));
    }
  }
}

}  // namespace bench
