#include "catena/analysis/pose/departure.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace catena {
namespace {

// Times (s) between which drivers at rest come as far as they are waited for.
constexpr double shortest = 1e-9, longest = 1e9;

}  // namespace

Departure::Departure(Evaluator& evaluator, double rest, double direction)
    : evaluator_(evaluator), rest_(rest), direction_(direction) {
  const auto& elements = evaluator.model().elements;
  for (std::size_t e = 0; e < elements.size(); ++e) {
    if (elements[e].kind == ElementKind::driver) drivers_.push_back(static_cast<int>(e));
  }
  evaluator_.set_time(rest, direction > 0 ? Side::after : Side::before);
  for (int e : drivers_) start_.push_back(evaluator_.element_value(e));
}

double Departure::at(double t) const {
  const Fastest fastest = fastest_at(t);
  evaluator_.set_time(t);
  return drivers_.empty() ? 0 : fastest.sign * way(fastest.driver);
}

double Departure::acceleration(double t) const {
  const Fastest fastest = fastest_at(t);
  return drivers_.empty() ? 0 : fastest.sign * start_[fastest.driver].dd;
}

Taylor<double> Departure::rates(double t, double later) const {
  if (drivers_.empty()) return {};
  const Fastest fastest = fastest_at(later);
  evaluator_.set_time(t);
  const Taylor<double> now = evaluator_.element_value(drivers_[fastest.driver]);
  return {fastest.sign * (now.f - start_[fastest.driver].f), fastest.sign * now.d, fastest.sign * now.dd};
}

Departure::Fastest Departure::fastest_at(double t) const {
  evaluator_.set_time(rest_ + direction_ * std::abs(t - rest_));
  Fastest fastest;
  double most = 0;
  for (std::size_t k = 0; k < drivers_.size(); ++k) {
    const double w = way(k);
    if (std::abs(w) > std::abs(most)) most = w, fastest = {k, std::copysign(1.0, w)};
  }
  return fastest;
}

double time_to_depart(Evaluator& evaluator, double rest, double direction, double way) {
  const Departure departure(evaluator, rest, direction);
  const auto beyond = [&](double h) { return departure.at(rest + direction * h) >= way; };
  double low = 0, high = shortest;
  while (high < longest && functions_exist_at(evaluator, rest + direction * high) && !beyond(high))
    low = high, high *= 2;
  if (!(high < longest) || !functions_exist_at(evaluator, rest + direction * high))
    return std::numeric_limits<double>::infinity();
  while (high - low > 1e-3 * high) {
    const double middle = low + (high - low) / 2;
    (beyond(middle) ? high : low) = middle;
  }
  return high;
}

bool functions_exist_at(const Evaluator& evaluator, double t) {
  const auto& functions = evaluator.model().functions;
  return evaluator.time_limit().contains(t) ||
         std::none_of(functions.begin(), functions.end(), std::mem_fn(&TimeFunction<double>::has_callback));
}

}  // namespace catena
