#include "catena/analysis/pose/singular_point.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "catena/analysis/run/name_list.hpp"
#include "catena/base/at.hpp"

namespace catena {

NullSpaces find_null_spaces(Evaluator& evaluator, std::span<const double> q, double threshold) {
  const Plan& plan = evaluator.plan();
  NullSpaces spaces;
  spaces.values = jacobian_values(evaluator, q);
  RankOptions options;
  options.tolerance = threshold;
  spaces.rank = jacobian_rank(evaluator, plan.jacobian, spaces.values, options);
  const SparseVectors& vectors = spaces.rank.right_null_vectors;
  for (int k = 0; k < vectors.count(); ++k) {
    std::vector<double> z(at(plan.coordinates()), 0.0);
    double largest = 0;
    for (std::size_t n = 0; n < vectors.indices(k).size(); ++n) {
      const int coordinate = plan.coordinate[at(vectors.indices(k)[n])];
      const double value = vectors.values(k)[n];
      z[at(coordinate)] = value;
      largest = std::max(largest, std::abs(value) / (coordinate % 3 == 2 ? 1 : evaluator.length_scale()));
    }
    for (double& value : z) value /= largest;
    spaces.z.push_back(std::move(z));
  }
  return spaces;
}

Opposed most_opposed(const Evaluator& evaluator, const RankReport& rank, std::span<const double> b) {
  const Plan& plan = evaluator.plan();
  const auto unit = [&](int r) { return plan.row_is_angle[at(r)] ? 1 : evaluator.length_scale(); };
  double squares_b = 0;
  for (int r = 0; r < plan.rows; ++r) squares_b += b[at(r)] / unit(r) * (b[at(r)] / unit(r));
  Opposed most{std::vector<double>(b.size(), 0.0)};
  int place = rank.left_null_vectors.count() > 0 ? 0 : -1;
  for (int k = 0; k < rank.left_null_vectors.count() && squares_b > 0; ++k) {
    const auto rows = rank.left_null_vectors.indices(k);
    const auto weights = rank.left_null_vectors.values(k);
    double product = 0, squares_w = 0;
    for (std::size_t n = 0; n < rows.size(); ++n) {
      product += weights[n] * b[at(rows[n])];
      squares_w += weights[n] * unit(rows[n]) * weights[n] * unit(rows[n]);
    }
    const double part = std::abs(product) / std::sqrt(squares_w * squares_b);
    if (part > most.part) most.part = part, place = k;
  }
  if (place < 0) return most;
  const auto rows = rank.left_null_vectors.indices(place);
  for (std::size_t n = 0; n < rows.size(); ++n) most.w[at(rows[n])] = rank.left_null_vectors.values(place)[n];
  return most;
}

std::vector<int> most_concerned(std::span<const double> share, std::size_t most) {
  std::vector<int> bodies(share.size());
  double largest = 0;
  for (std::size_t b = 0; b < share.size(); ++b) bodies[b] = static_cast<int>(b), largest = std::max(largest, share[b]);
  std::stable_sort(bodies.begin(), bodies.end(), [&](int a, int b) { return share[at(a)] > share[at(b)]; });
  std::size_t kept = 0;
  while (kept < bodies.size() && kept < most && share[at(bodies[kept])] > 1e-3 * largest && largest > 0) ++kept;
  bodies.resize(kept);
  return bodies;
}

double disagreement(const Evaluator& evaluator, std::span<const double> w, std::span<const double> b) {
  double product = 0, squares_w = 0, squares_b = 0;
  for (std::size_t r = 0; r < w.size(); ++r) {
    const double unit = evaluator.plan().row_is_angle[r] ? 1 : evaluator.length_scale();
    product += w[r] * b[r];
    squares_w += w[r] * unit * w[r] * unit;
    squares_b += b[r] / unit * (b[r] / unit);
  }
  return squares_w > 0 && squares_b > 0 ? std::abs(product) / std::sqrt(squares_w * squares_b) : 0;
}

void SingularPoint::name_bodies(const Evaluator& evaluator, std::span<const std::vector<double>> motions) {
  const Plan& plan = evaluator.plan();
  std::vector<double> share(at(plan.moving), 0.0);
  for (const auto& z : motions) {
    for (int b = 0; b < plan.moving; ++b) {
      const double shift = std::max(std::abs(z[at(3 * b)]), std::abs(z[at(3 * b + 1)])) / evaluator.length_scale();
      share[at(b)] = std::max({share[at(b)], shift, std::abs(z[at(3 * b + 2)])});
    }
  }
  bodies.clear();
  for (int b : most_concerned(share, 10)) bodies.emplace_back(evaluator.model().body_name(plan.model_body[at(b)]));
}

void SingularPoint::find_driver(const Evaluator& evaluator, std::span<const double> w, std::span<const double> nu) {
  const Plan& plan = evaluator.plan();
  double most = -1;
  for (int r = 0; r < plan.rows; ++r) {
    const int element = plan.row_element[at(r)];
    if (evaluator.model().elements[at(element)].kind != ElementKind::driver) continue;
    const double share = std::abs(w[at(r)] * nu[at(r)]);
    if (share > most) most = share, driver = element;
  }
  if (driver >= 0) driver_value = evaluator.element_value(driver).f;
}

void SingularPoint::put_first(std::size_t k) {
  const auto place = static_cast<std::ptrdiff_t>(k);
  std::rotate(tangents.begin(), tangents.begin() + place, tangents.begin() + place + 1);
  if (k < branches.size()) std::rotate(branches.begin(), branches.begin() + place, branches.begin() + place + 1);
}

std::string_view SingularPoint::kind_name() const {
  switch (kind) {
    case Kind::branch_point:
      return "branch_point";
    case Kind::tangency:
      return "tangency";
    case Kind::rest:
      return "rest";
    case Kind::isolated:
      return "isolated";
    case Kind::lock_up:
      return "lock_up";
  }
  return {};
}

std::string SingularPoint::describe_branches() const {
  constexpr std::size_t most = NameList::most;
  std::string text;
  for (std::size_t k = 0; k < branches.size() && k < most; ++k) {
    text += fmt::format("{}branch {}: {}", text.empty() ? "" : "; ", k + 1, branches[k]);
  }
  if (branches.size() > most) text += fmt::format("; and {} more", branches.size() - most);
  return text;
}

std::string SingularPoint::describe_ways() const {
  return fmt::format("{} branches meet there ({}, with the fastest driver at 1 rad/s or m/s)", branches.size(),
                     describe_branches());
}

Report SingularPoint::report_lock_up(const Model& model) const {
  Report report;
  report.status = Status::lock_up;
  report.message = fmt::format("lock-up at t = {:.12g} s: the drivers ask for a ", t);
  report.message += at_infinity && !bodies.empty()
                        ? fmt::format("place that body \"{}\" would reach only at infinity", bodies.front())
                        : "motion that the mechanism cannot make (a dead point)";
  if (driver >= 0) {
    report.message +=
        fmt::format("; most concerned: driver \"{}\" at {:.6g}", model.element_name(driver), driver_value);
  }
  return report;
}

}  // namespace catena
