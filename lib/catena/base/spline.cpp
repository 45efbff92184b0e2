#include "catena/base/spline.hpp"

#include <initializer_list>
#include <stdexcept>
#include <string>

#include "catena/base/number_text.hpp"

namespace catena {
namespace {

/// Solves lower[k] x[k-1] + diagonal[k] x[k] + upper[k] x[k+1] = right[k] in place (Thomas). Stable without pivoting:
/// spline matrices are diagonally dominant. `diagonal` is overwritten; x comes back in `right`, of any number of
/// columns.
template <class S>
void solve_tridiagonal(const std::vector<S>& lower, std::vector<S>& diagonal, const std::vector<S>& upper,
                       std::initializer_list<std::vector<S>*> right) {
  const std::size_t n = diagonal.size();
  for (std::size_t k = 1; k < n; ++k) {
    const S factor = lower[k] / diagonal[k - 1];
    diagonal[k] -= factor * upper[k - 1];
    for (std::vector<S>* x : right) (*x)[k] -= factor * (*x)[k - 1];
  }
  for (std::vector<S>* x : right) {
    for (std::size_t k = n; k-- > 0;) {
      if (k + 1 < n) (*x)[k] -= upper[k] * (*x)[k + 1];
      (*x)[k] /= diagonal[k];
    }
  }
}

/// Second derivatives at all n + 1 knots, from the interval lengths and the slopes of the chords.
template <class S>
std::vector<S> second_derivatives(const std::vector<S>& h, const std::vector<S>& chord, SplineEnd end) {
  const std::size_t n = h.size();
  std::vector<S> m(n + 1, S(0.0));
  if (end == SplineEnd::clamped) {
    // Unknowns at every knot; the end equations say that the slope there is zero.
    std::vector<S> lower(n + 1), diagonal(n + 1), upper(n + 1);
    for (std::size_t k = 0; k <= n; ++k) {
      lower[k] = k > 0 ? h[k - 1] : S(0.0);
      upper[k] = k < n ? h[k] : S(0.0);
      diagonal[k] = S(2.0) * (lower[k] + upper[k]);
      m[k] = S(6.0) * ((k < n ? chord[k] : S(0.0)) - (k > 0 ? chord[k - 1] : S(0.0)));
    }
    solve_tridiagonal(lower, diagonal, upper, {&m});
    return m;
  }
  if (n < 2) return m;  // a chord; a periodic one is level
  // Unknowns at the inner knots: M = particular + end_value * unit, with end_value = M[0] = M[n].
  std::vector<S> lower(n - 1), diagonal(n - 1), upper(n - 1), particular(n - 1), unit(n - 1, S(0.0));
  for (std::size_t k = 0; k + 1 < n; ++k) {
    lower[k] = h[k];
    upper[k] = h[k + 1];
    diagonal[k] = S(2.0) * (h[k] + h[k + 1]);
    particular[k] = S(6.0) * (chord[k + 1] - chord[k]);
  }
  S end_value(0.0);
  if (end == SplineEnd::periodic) {
    unit.front() -= h.front();
    unit.back() -= h.back();
    solve_tridiagonal(lower, diagonal, upper, {&particular, &unit});
    // The equation at the seam closes the circle.
    const S right =
        S(6.0) * (chord.front() - chord.back()) - h.front() * particular.front() - h.back() * particular.back();
    end_value = right / (S(2.0) * (h.front() + h.back()) + h.front() * unit.front() + h.back() * unit.back());
  } else {
    solve_tridiagonal(lower, diagonal, upper, {&particular});
  }
  m.front() = m.back() = end_value;
  for (std::size_t k = 0; k + 1 < n; ++k) m[k + 1] = particular[k] + end_value * unit[k];
  return m;
}

template <class S>
void check(std::span<const S> knots, std::span<const S> values, SplineEnd end) {
  const auto fail = [](const std::string& what) { throw std::invalid_argument("spline: " + what); };
  if (knots.size() != values.size()) {
    fail(std::to_string(knots.size()) + " knots, but " + std::to_string(values.size()) + " values");
  }
  if (knots.size() < 2) fail("needs at least 2 points, has " + std::to_string(knots.size()));
  double largest = 0;
  for (std::size_t k = 0; k < knots.size(); ++k) {
    const std::string index = "[" + std::to_string(k) + "]";
    const double knot = value_of(knots[k]), value = value_of(values[k]);
    if (!std::isfinite(knot)) fail("knot" + index + " is not finite");
    if (!std::isfinite(value)) fail("value" + index + " is not finite");
    if (k > 0 && !(knot > value_of(knots[k - 1]))) {
      fail("knots must increase, but knot" + index + " = " + number_text(knot) + " follows " +
           number_text(value_of(knots[k - 1])));
    }
    largest = std::max(largest, std::abs(value));
  }
  const double start = value_of(values.front()), finish = value_of(values.back());
  if (end == SplineEnd::periodic && std::abs(finish - start) > 1e-12 * largest) {
    fail("periodic, but it starts at " + number_text(start) + " and ends at " + number_text(finish));
  }
}

}  // namespace

template <class S>
Spline<S>::Spline(std::span<const S> knots, std::span<const S> values, SplineEnd end, Beyond beyond)
    : periodic_(end == SplineEnd::periodic), beyond_(beyond) {
  check(knots, values, end);
  const std::size_t n = knots.size() - 1;
  std::vector<S> h(n), chord(n);
  for (std::size_t k = 0; k < n; ++k) {
    h[k] = knots[k + 1] - knots[k];
    chord[k] = (values[k + 1] - values[k]) / h[k];
  }
  const std::vector<S> m = second_derivatives(h, chord, end);
  period_ = knots.back() - knots.front();
  for (const S& knot : knots) positions_.push_back(value_of(knot));

  pieces_.resize(n + 2);
  S area(0.0);
  for (std::size_t k = 0; k < n; ++k) {
    const S slope = chord[k] - h[k] * (S(2.0) * m[k] + m[k + 1]) / S(6.0);
    pieces_[k + 1] = {knots[k], values[k], slope, m[k] / S(2.0), (m[k + 1] - m[k]) / (S(6.0) * h[k]), area};
    area += h[k] * (values[k] + values[k + 1]) / S(2.0) - h[k] * h[k] * h[k] * (m[k] + m[k + 1]) / S(24.0);
  }
  const S end_slope = chord[n - 1] + h[n - 1] * (m[n - 1] + S(2.0) * m[n]) / S(6.0);
  const bool holds = beyond == Beyond::hold;
  pieces_.front() = {knots[0], values[0], holds ? S(0.0) : pieces_[1].c1, S(0.0), S(0.0), S(0.0)};
  pieces_.back() = {knots[n], values[n], holds ? S(0.0) : end_slope, S(0.0), S(0.0), area};
}

template class Spline<double>;
template class Spline<Dual<double, 4>>;

}  // namespace catena
