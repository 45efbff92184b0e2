// The operations on a block of force elements, derived from the element's force: stiffness and damping are its
// derivatives by dual numbers. Included by the per-type source files only.
#pragma once

#include <algorithm>

#include "catena/assembly/constraint_operations.hpp"
#include "catena/assembly/force_block.hpp"

namespace catena {
namespace detail {

/// The frames, velocities and function values of force element e; zero where laws give the functions. qd may be
/// nullptr: at rest. Arguments refer to this object.
template <class E>
struct ForceState {
  Frame<double> i, j;
  Twist<double> u, v;
  const double* f = nullptr;
  Vec2<double> ground{};
  const SharedStretch* shared = &no_stretch;

  ForceState(const ForceBlock<E>& block, const ForceData<E>& data, const Pose& pose, const double* qd, int e) {
    const auto k = static_cast<std::size_t>(e);
    i = pose.frames[static_cast<std::size_t>(block.body_i[k])];
    if constexpr (E::bodies == 1) {
      ground = data.shift[k].i;
    } else {
      i = shifted(i, data.shift[k].i);
      j = shifted(pose.frames[static_cast<std::size_t>(block.body_j[k])], data.shift[k].j);
    }
    if (qd) {
      const auto twist = [&](int body) { return Twist<double>{qd[3 * body], qd[3 * body + 1], qd[3 * body + 2]}; };
      u = twist(block.body_i[k]);
      if constexpr (E::bodies == 2) v = twist(block.body_j[k]);
    }
    if constexpr (E::functions > 0) f = &pose.loads[static_cast<std::size_t>(block.first_value + e * E::functions)];
    if constexpr (Sharing<E>) shared = &pose.stretches[k];
  }
  ForceArguments<double> arguments() const { return {i, j, u, v, f, ground, shared}; }
};

template <class E>
bool reads_laws(const ForceData<E>& data, const MovingPose& at) {
  return E::functions > 0 && at.laws && !data.law.empty();
}

/// The same with what laws give. Apart from the plain one, which compilers keep in registers.
template <class E>
struct LawfulForceState : ForceState<E> {
  LawfulForceState(const ForceBlock<E>& block, const ForceData<E>& data, const MovingPose& at, int e)
      : ForceState<E>(block, data, at.pose, at.qd, e) {
    if (!reads_laws(data, at)) return;
    for (std::size_t k = 0; k < lawful.size(); ++k) {
      const int law = data.law[static_cast<std::size_t>(e * E::functions) + k];
      lawful[k] = law < 0 ? this->f[k] : at.laws[law];
    }
    this->f = lawful.data();
  }
  LawfulForceState(const LawfulForceState&) = delete;
  LawfulForceState& operator=(const LawfulForceState&) = delete;

 private:
  std::array<double, static_cast<std::size_t>(E::functions)> lawful;  // set where laws are read
};

using D6 = Dual<double, 6>;

/// Minus the derivatives of [Q_i, Q_j] with respect to the seeded variables.
template <class E>
ElementMatrix differentiate(const E& element, const ForceState<E>& s, const Frame<D6>& i, const Frame<D6>& j,
                            const Twist<D6>& u, const Twist<D6>& v) {
  std::array<D6, static_cast<std::size_t>(E::functions) + 1> f;
  for (int k = 0; k < E::functions; ++k) f[static_cast<std::size_t>(k)] = D6(s.f[k]);
  Wrench<D6> on_i, on_j;
  element.force(ForceArguments<D6>{i, j, u, v, f.data(), s.ground, s.shared}, on_i, on_j);
  const D6* rows[6] = {&on_i.fx, &on_i.fy, &on_i.moment, &on_j.fx, &on_j.fy, &on_j.moment};
  ElementMatrix matrix{};
  for (std::size_t r = 0; r < 6; ++r) {
    for (std::size_t c = 0; c < 6; ++c) matrix[6 * r + c] = -rows[r]->d[c];
  }
  return matrix;
}

/// dV/dt along the motion, functions of time included; what laws give has no part in V.
template <class E>
double potential_rate(const E& element, const ForceBlock<E>& block, const ForceState<E>& s, const Pose& pose, int e) {
  using D1 = Dual<double, 1>;
  const auto along = [](double value, double rate) {
    D1 x(value);
    x.d[0] = rate;
    return x;
  };
  const auto frame = [&](const Frame<double>& f, const Twist<double>& v) {
    return Frame<D1>{along(f.x, v.vx), along(f.y, v.vy), along(f.phi, v.omega), along(f.c, -f.s * v.omega),
                     along(f.s, f.c * v.omega)};
  };
  const Twist<D1> rest;
  std::array<D1, static_cast<std::size_t>(E::functions) + 1> f;
  for (std::size_t k = 0; k < static_cast<std::size_t>(E::functions); ++k) {
    const std::size_t place = static_cast<std::size_t>(block.first_value + e * E::functions) + k;
    f[k] = along(pose.loads[place], pose.load_rates[place]);
  }
  const Frame<D1> i = frame(s.i, s.u), j = frame(s.j, s.v);
  return element.potential(ForceArguments<D1>{i, j, rest, rest, f.data(), s.ground, s.shared}).d[0];
}

inline Twist<D6> seed_twist(const Twist<double>& t, int first) {
  return {D6::variable(t.vx, first), D6::variable(t.vy, first + 1), D6::variable(t.omega, first + 2)};
}
inline Twist<D6> constant_twist(const Twist<double>& t) { return {D6(t.vx), D6(t.vy), D6(t.omega)}; }

}  // namespace detail

template <class E>
void ForceOperations<E>::add_forces(const Block& block, const Data& data, const MovingPose& at, double* Q) {
  const auto add = [&](const detail::ForceState<E>& s, int e) {
    Wrench<double> on_i, on_j;
    data.element[static_cast<std::size_t>(e)].force(s.arguments(), on_i, on_j);
    double* target = Q + 3 * block.body_i[static_cast<std::size_t>(e)];
    target[0] += on_i.fx;
    target[1] += on_i.fy;
    target[2] += on_i.moment;
    if constexpr (E::bodies == 2) {
      target = Q + 3 * block.body_j[static_cast<std::size_t>(e)];
      target[0] += on_j.fx;
      target[1] += on_j.fy;
      target[2] += on_j.moment;
    }
  };
  if (detail::reads_laws(data, at)) {
    for (int e = 0; e < block.size(); ++e) add(detail::LawfulForceState<E>(block, data, at, e), e);
  } else {
    for (int e = 0; e < block.size(); ++e) add(detail::ForceState<E>(block, data, at.pose, at.qd, e), e);
  }
}

template <class E>
std::array<double, 6> ForceOperations<E>::force(const Block& block, const Data& data, const MovingPose& at, int e) {
  const detail::LawfulForceState<E> s(block, data, at, e);
  Wrench<double> on_i, on_j;
  data.element[static_cast<std::size_t>(e)].force(s.arguments(), on_i, on_j);
  return {on_i.fx, on_i.fy, on_i.moment, on_j.fx, on_j.fy, on_j.moment};
}

template <class E>
std::optional<CurveUse> ForceOperations<E>::curve_use(const Block& block, const Data& data, const Pose& pose, int e) {
  if constexpr (HasCurveUse<E>) {
    const E& element = data.element[static_cast<std::size_t>(e)];
    if (!element.can_leave_curve()) return {};
    const detail::ForceState<E> s(block, data, pose, nullptr, e);
    return element.curve_use(s.arguments());
  } else {
    return {};
  }
}

template <class E>
double ForceOperations<E>::potential(const Block& block, const Data& data, const Pose& pose) {
  double sum = 0;
  if constexpr (HasPotential<E>) {
    for (int e = 0; e < block.size(); ++e) {
      const detail::ForceState<E> s(block, data, pose, nullptr, e);
      const E& element = data.element[static_cast<std::size_t>(e)];
      if (is_conservative(element)) sum += element.potential(s.arguments());
    }
  }
  return sum;
}

template <class E>
double ForceOperations<E>::dissipation(const Block& block, const Data& data, const MovingPose& at) {
  double sum = 0;
  if constexpr (requires(const E& x, const ForceArguments<double>& a) { x.dissipation(a); }) {
    for (int e = 0; e < block.size(); ++e) {
      const detail::LawfulForceState<E> s(block, data, at, e);
      sum += data.element[static_cast<std::size_t>(e)].dissipation(s.arguments());
    }
  }
  return sum;
}

template <class E>
double ForceOperations<E>::load_power(const Block& block, const Data& data, const MovingPose& at) {
  const auto supplied = [&](int e) {
    const detail::LawfulForceState<E> s(block, data, at, e);
    const E& element = data.element[static_cast<std::size_t>(e)];
    Wrench<double> on_i, on_j;
    element.force(s.arguments(), on_i, on_j);
    double power = on_i.fx * s.u.vx + on_i.fy * s.u.vy + on_i.moment * s.u.omega;
    if constexpr (E::bodies == 2) power += on_j.fx * s.v.vx + on_j.fy * s.v.vy + on_j.moment * s.v.omega;
    if constexpr (requires { element.dissipation(s.arguments()); }) power += element.dissipation(s.arguments());
    if constexpr (HasPotential<E>) {
      if (is_conservative(element)) power += detail::potential_rate(element, block, s, at.pose, e);
    }
    return power;
  };
  double sum = 0;
  for (int e = 0; e < block.size(); ++e) {
    if (!is_conservative(data.element[static_cast<std::size_t>(e)])) sum += supplied(e);
  }
  for (const int e : data.supplied) sum += supplied(e);
  return sum;
}

template <class E>
ElementMatrix ForceOperations<E>::stiffness(const Block& block, const Data& data, const MovingPose& at, int e) {
  const detail::LawfulForceState<E> s(block, data, at, e);
  if constexpr (Sharing<E>) {
    constexpr auto pattern = stiffness_pattern<E>();
    double entries[pattern.size()];
    data.element[static_cast<std::size_t>(e)].stiffness(s.arguments(), entries);
    ElementMatrix matrix{};
    for (std::size_t k = 0; k < pattern.size(); ++k) {
      const auto r = static_cast<std::size_t>(pattern[k].row), c = static_cast<std::size_t>(pattern[k].column);
      matrix[6 * r + c] = matrix[6 * c + r] = entries[k];
    }
    return matrix;
  }
  return detail::differentiate(data.element[static_cast<std::size_t>(e)], s, seed<double, 6>(s.i, 0),
                               seed<double, 6>(s.j, 3), detail::constant_twist(s.u), detail::constant_twist(s.v));
}

template <class E>
void ForceOperations<E>::add_stiffness(const Block& block, const Data& data, const MovingPose& at, bool convex,
                                       const int* slot, double* values) {
  constexpr auto pattern = stiffness_pattern<E>();
  constexpr auto written = written_stiffness<E>();
  if constexpr (pattern.size() > 0) {
    for (int e = 0; e < block.size(); ++e, slot += written.size()) {
      double entries[pattern.size()];
      if constexpr (HasClosedStiffness<E>) {
        const detail::LawfulForceState<E> s(block, data, at, e);
        data.element[static_cast<std::size_t>(e)].stiffness(s.arguments(), entries);
      } else {
        const ElementMatrix matrix = stiffness(block, data, at, e);
        for (std::size_t k = 0; k < pattern.size(); ++k) {
          const auto r = static_cast<std::size_t>(pattern[k].row), c = static_cast<std::size_t>(pattern[k].column);
          entries[k] = (matrix[6 * r + c] + matrix[6 * c + r]) / 2;
        }
      }
      detail::scatter_hessian(written, pattern, entries, convex && !only_turning(pattern), slot, values);
    }
  }
}

template <class E>
ElementMatrix ForceOperations<E>::damping(const Block& block, const Data& data, const MovingPose& at, int e) {
  const detail::LawfulForceState<E> s(block, data, at, e);
  return detail::differentiate(data.element[static_cast<std::size_t>(e)], s, constant_frame<detail::D6>(s.i),
                               constant_frame<detail::D6>(s.j), detail::seed_twist(s.u, 0), detail::seed_twist(s.v, 3));
}

template <class E>
std::array<double, 6> ForceOperations<E>::by_function(const Block& block, const Data& data, const MovingPose& at, int e,
                                                      int k) {
  std::array<double, 6> result{};
  if constexpr (E::functions > 0) {
    using detail::D6;
    const detail::LawfulForceState<E> s(block, data, at, e);
    std::array<D6, static_cast<std::size_t>(E::functions)> f;
    for (std::size_t n = 0; n < f.size(); ++n) f[n] = D6(s.f[n]);
    f[static_cast<std::size_t>(k)] = D6::variable(s.f[k], 0);
    const Frame<D6> i = constant_frame<D6>(s.i), j = constant_frame<D6>(s.j);
    const Twist<D6> u = detail::constant_twist(s.u), v = detail::constant_twist(s.v);
    Wrench<D6> on_i, on_j;
    data.element[static_cast<std::size_t>(e)].force(ForceArguments<D6>{i, j, u, v, f.data(), s.ground, s.shared}, on_i,
                                                    on_j);
    const D6* rows[6] = {&on_i.fx, &on_i.fy, &on_i.moment, &on_j.fx, &on_j.fy, &on_j.moment};
    for (std::size_t r = 0; r < 6; ++r) result[r] = rows[r]->d[0];
  }
  return result;
}

template <class E>
bool ForceOperations<E>::conservative(const Data& data) {
  if (!data.lawful.empty()) return false;
  for (const E& element : data.element) {
    if (!is_conservative(element)) return false;
  }
  return true;
}

}  // namespace catena
