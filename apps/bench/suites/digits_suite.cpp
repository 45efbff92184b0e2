// How many digits of columns are right, claimed beside true ones: random mechanisms with closed forms, and a sweep of
// the condition number. A row is wrong where a claim is optimistic by more than ten; the count `claimed` is the error
// that its column claims, relative to the column's largest magnitude as the error is.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cases/digits_cases.hpp"
#include "catena/scene/loading/scene.hpp"
#include "suites/suites.hpp"

namespace bench {

using namespace catena;

namespace {

struct Claim {
  double claimed = not_measured, error = 0;
  double optimism() const { return error / claimed; }
};

/// Of the columns with exact values, one each.
std::vector<Claim> claims_of(const DigitsCase& c, const AnalysisOutcome& run) {
  // A column may be right by chance: not more than to a quarter of the rounding of a double.
  constexpr double least = std::numeric_limits<double>::epsilon() / 4;
  const AnalysisResult& result = run.result();
  const bool has_rows = result.columns.front().name == "t" || result.type == "path";
  const std::vector<double> instants = has_rows ? run.column(result.columns.front().name) : std::vector<double>{0};
  std::vector<Claim> claims;
  for (std::size_t k = 0; k < c.columns.size(); ++k) {
    const std::vector<double> values = run.column(c.columns[k]);
    long double worst = 0, size = 0;
    for (std::size_t row = 0; row < values.size(); ++row) {
      worst = std::max(worst, std::abs(values[row] - c.exact(c, instants[row])[k]));
      size = std::max<long double>(size, std::abs(values[row]));
    }
    Claim& claim = claims.emplace_back();
    claim.error = std::max(least, static_cast<double>(worst / size));
    for (std::size_t column = 0; column < result.digits.size(); ++column) {
      if (result.columns[column].name == c.columns[k]) claim.claimed = std::pow(10.0, -result.digits[column]);
    }
  }
  return claims;
}

/// One row of these claims: of column number `shown`, or of the most optimistic one where that is wrong.
void add_claims(Bench& bench, Row row, const DigitsCase& c, std::size_t shown, std::vector<double>& optimism) {
  row.suite = "digits";
  row.reference = "closed form in 64 bits";
  if (!bench.wants(row)) return;
  const Scene scene = Scene::loads(c.scene);
  const double start = processor_time();
  const SceneResults results = scene.run();
  row.seconds = processor_time() - start;
  row.spread = 0;
  row.repeats = 1;
  const AnalysisOutcome& run = results[std::size_t{0}];
  row.counts = named_counts(run.report().counters);
  if (!run.ok()) {
    row.failure = run.report().message;
    return bench.add(std::move(row));
  }
  const std::vector<Claim> claims = claims_of(c, run);
  if (std::any_of(claims.begin(), claims.end(), [](const Claim& claim) { return std::isnan(claim.claimed); })) {
    row.failure = "no digits are claimed";
    return bench.add(std::move(row));
  }
  const auto worst = std::max_element(claims.begin(), claims.end(),
                                      [](const Claim& a, const Claim& b) { return a.optimism() < b.optimism(); });
  if (worst->optimism() > 10) shown = static_cast<std::size_t>(worst - claims.begin());
  const Claim& claim = claims[shown];
  row.error_of = c.columns[shown] + ", relative";
  row.error = claim.error;
  row.allowed = 10 * claim.claimed;
  row.counts.emplace_back("claimed", claim.claimed);
  if (c.condition > 0) row.counts.emplace_back("condition", c.condition);
  for (const Claim& of_column : claims) optimism.push_back(of_column.optimism());
  bench.add(std::move(row));
}

struct Family {
  const char *name, *method;
  int bodies;
  DigitsCase (*make)(unsigned seed);
};
DigitsCase pendulum(unsigned seed) { return random_pendulum(seed); }
DigitsCase adams_pendulum(unsigned seed) { return random_pendulum(seed, "adams"); }
DigitsCase stabilised_pendulum(unsigned seed) { return random_pendulum(seed, "baumgarte"); }
DigitsCase partitioned_pendulum(unsigned seed) { return random_pendulum(seed, "partitioning"); }

constexpr Family families[] = {{"driven slider-cranks", "inverse_dynamics", 3, random_slider_crank},
                               {"pendulums", "dynamics", 1, pendulum},
                               {"pendulums", "adams", 1, adams_pendulum},
                               {"pendulums", "baumgarte", 1, stabilised_pendulum},
                               {"pendulums", "partitioning", 1, partitioned_pendulum},
                               {"bouncing balls", "dynamics", 1, random_bouncing_ball},
                               {"rods on springs", "equilibrium", 1, random_rod_on_spring},
                               {"loaded rods", "path", 1, random_loaded_rod}};

}  // namespace

void digits_suite(Bench& bench) {
  std::vector<double> optimism;
  const unsigned cases = bench.brief() ? 4 : 40;
  for (const Family& family : families) {
    for (unsigned seed = 1; seed <= cases; ++seed) {
      const DigitsCase c = family.make(seed);
      const Row row{.problem = family.name,
                    .method = family.method,
                    .setting = fmt::format("seed {}", seed),
                    .bodies = family.bodies};
      add_claims(bench, row, c, seed % c.columns.size(), optimism);
    }
  }
  static const char* const orders[] = {"place", "velocity", "acceleration"};
  for (int power = 1; power <= 10; power += bench.brief() ? 4 : 1) {
    const DigitsCase c = slider_crank_near_dead_point(std::pow(10.0, -power));
    for (std::size_t order = 0; order < 3; ++order) {
      const Row row{.problem = "slider-crank near its dead point",
                    .method = orders[order],
                    .setting = fmt::format("condition {:.1e}", c.condition),
                    .bodies = 3};
      add_claims(bench, row, c, order, optimism);
    }
  }
  if (optimism.empty()) return;
  std::sort(optimism.begin(), optimism.end());
  bench.remark(
      fmt::format("digits: of {} columns the true error is {:.2g} of the claimed one at the median, {:.2g} at most",
                  optimism.size(), optimism[optimism.size() / 2], optimism.back()));
}

}  // namespace bench
