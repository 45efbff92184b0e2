#include "documents/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace bench {

namespace {

double or_zero(double spread) { return std::isnan(spread) ? 0 : spread; }

std::string remark_on(const Row& now, const Row& then) {
  if (now.failed() && !then.failed()) return now.failure.empty() ? "now wrong" : "now no answer";
  // Below ten times the rounding of a double errors differ from run to run.
  constexpr double rounding = 1e-14;
  if (now.error > std::max(10 * then.error, rounding))
    return fmt::format("error {:.1e}, then {:.1e}", now.error, then.error);
  return "";
}

}  // namespace

Comparison compare(const Document& now, const Document& then) {
  Comparison comparison;
  std::map<std::string, const Row*> old;
  for (const Row& row : then.rows) old.emplace(row.key(), &row);
  std::vector<double> ratios;
  for (const Row& row : now.rows) {
    const std::string key = row.key();
    const auto found = old.find(key);
    if (found == old.end()) {
      comparison.only_now.push_back(key);
      continue;
    }
    const Row& before = *found->second;
    if (!(row.seconds > 0) || !(before.seconds > 0)) {
      const std::string remark = remark_on(row, before);
      comparison.without_time.push_back(remark.empty() ? key : key + " (" + remark + ")");
    } else {
      ComparedRow compared{
          .key = key, .ratio = row.seconds / before.seconds, .now = row.seconds, .then = before.seconds};
      compared.least = compared.ratio / (1 + or_zero(before.spread));
      compared.most = compared.ratio * (1 + or_zero(row.spread));
      compared.remark = remark_on(row, before);
      if (compared.least > 1) ++comparison.slower;
      if (compared.most < 1) ++comparison.faster;
      ratios.push_back(compared.ratio);
      comparison.rows.push_back(std::move(compared));
    }
    old.erase(found);
  }
  for (const Row& row : then.rows) {
    if (old.contains(row.key())) comparison.only_then.push_back(row.key());
  }
  std::sort(ratios.begin(), ratios.end());
  if (!ratios.empty()) comparison.median = ratios[ratios.size() / 2];
  const Machine &a = now.machine, &b = then.machine;
  if (a.cpu != b.cpu || a.compiler != b.compiler)
    comparison.machines =
        fmt::format("Not the same machine: now {} ({}), then {} ({}).", a.cpu, a.compiler, b.cpu, b.compiler);
  if (now.brief != then.brief) comparison.machines += " One of the two is a brief run: its times are of single calls.";
  return comparison;
}

}  // namespace bench
