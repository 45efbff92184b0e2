// The operations on a block of constraints, derived from the element's phi unless it provides a closed form.
//
//   Phi_q   dual numbers with the 3 or 6 coordinates of the element's bodies as variables
//   nu      -dPhi/dt with the bodies at rest                          (Taylor series of phi)
//   gamma   -d2Phi/dt2 along q(t) = q + qd t, c(t)                    (Taylor series of phi)
//
// Included by the per-type source files only: this is where templates meet every scalar.
#pragma once

#include "catena/assembly/constraint_block.hpp"
#include "catena/assembly/hessian_slots.hpp"

namespace catena {
namespace detail {

template <class T>
Frame<T> shifted(Frame<T> f, const Vec2<double>& by) {
  f.x = f.x + T(by.x);
  f.y = f.y + T(by.y);
  return f;
}

/// The two frames of element e in its common origin.
template <class E>
struct ElementFrames {
  Frame<double> i, j;
  Vec2<double> ground{};
  const CurvePlace* contact = &no_contact;

  ElementFrames(const ConstraintBlock<E>& block, const ConstraintData<E>& data, const Pose& pose, int e) {
    const auto k = static_cast<std::size_t>(e);
    if constexpr (E::bodies == 1) {
      i = pose.frames[static_cast<std::size_t>(block.body_i[k])];
      ground = data.shift[k].i;
    } else {
      i = shifted(pose.frames[static_cast<std::size_t>(block.body_i[k])], data.shift[k].i);
      j = shifted(pose.frames[static_cast<std::size_t>(block.body_j[k])], data.shift[k].j);
    }
    if constexpr (SearchesCurve<E>) contact = pose.contacts.data() + block.first_contact + block.entry[k];
  }
  /// They refer to this object.
  Arguments<double> arguments(double c) const { return {i, j, c, ground, contact}; }
};

template <class E>
Taylor<double> value_at([[maybe_unused]] const ConstraintBlock<E>& block, [[maybe_unused]] const Pose& pose,
                        [[maybe_unused]] int e) {
  if constexpr (E::functions > 0) {
    return pose.values[static_cast<std::size_t>(block.first_value + e)];
  } else {
    return {};
  }
}

template <class E>
double scale_at([[maybe_unused]] const ConstraintData<E>& data, [[maybe_unused]] int e) {
  if constexpr (HasSquaredValue<E>) {
    return data.scale[static_cast<std::size_t>(e)];
  } else {
    return 1;
  }
}

/// Phi_q of an element by dual numbers, row-major, all entries.
template <class E>
void derived_jacobian(const E& element, const ElementFrames<E>& f, double c, double* entries) {
  constexpr int columns = 3 * E::bodies;
  using D = Dual<double, columns>;
  const Frame<D> i = seed<double, columns>(f.i, 0);
  const Frame<D> j = [&] {
    if constexpr (E::bodies == 2) {
      return seed<double, columns>(f.j, 3);
    } else {
      return constant_frame<D>(f.j);
    }
  }();
  D rows[E::rows];
  element.phi(Arguments<D>{i, j, D(c), f.ground, f.contact}, rows);
  for (int r = 0; r < E::rows; ++r) {
    for (int k = 0; k < columns; ++k) entries[r * columns + k] = rows[r].d[static_cast<std::size_t>(k)];
  }
}

/// Phi along q(t) = q + qd t with c(t): value, first and second derivative of every row.
template <class E>
void taylor_rows(const E& element, const ElementFrames<E>& f, const Rates& u, const Rates& v, const Taylor<double>& c,
                 Taylor<double>* rows) {
  const auto i = moving(f.i, u.vx, u.vy, u.omega);
  const auto j = moving(f.j, v.vx, v.vy, v.omega);
  element.phi(Arguments<Taylor<double>>{i, j, c, f.ground, f.contact}, rows);
}

template <class E>
Rates rates_of(const std::vector<int>& body, const double* qd, int e) {
  const double* p = qd + 3 * body[static_cast<std::size_t>(e)];
  return {p[0], p[1], p[2]};
}

}  // namespace detail

template <class E>
void ConstraintOperations<E>::phi(const Block& block, const Data& data, const Pose& pose, double* out) {
  double* row = out + block.first_row;
  for (int e = 0; e < block.size(); ++e, row += E::rows) {
    const detail::ElementFrames<E> f(block, data, pose, e);
    if constexpr (Joining<E>) {
      double part;
      data.element[static_cast<std::size_t>(e)].phi(f.arguments(0), &part);
      out[block.row(e)] += part;
      continue;
    }
    data.element[static_cast<std::size_t>(e)].phi(f.arguments(detail::value_at(block, pose, e).f), row);
    if constexpr (HasSquaredValue<E>) row[0] *= detail::scale_at(data, e);
  }
}

template <class E>
void ConstraintOperations<E>::jacobian(const Block& block, const Data& data, const Pose& pose, double* values) {
  constexpr int varying = varying_entries<E>();
  if constexpr (varying > 0) {
    const int* slot = block.slot.data();
    for (int e = 0; e < block.size(); ++e, slot += varying) {
      const detail::ElementFrames<E> f(block, data, pose, e);
      const double c = detail::value_at(block, pose, e).f, scale = detail::scale_at(data, e);
      const E& element = data.element[static_cast<std::size_t>(e)];
      double entries[jacobian_size<E>];
      if constexpr (HasClosedJacobian<E>) {
        element.jacobian(f.arguments(c), entries);
        for (int k = 0; k < varying; ++k) {
          if constexpr (Joining<E>) {
            values[slot[k]] += entries[k];
          } else {
            values[slot[k]] = scale * entries[k];
          }
        }
      } else {
        constexpr auto pattern = jacobian_pattern<E>();
        detail::derived_jacobian(element, f, c, entries);
        int k = 0;
        for (std::size_t n = 0; n < pattern.size(); ++n) {
          if (pattern[n] == Entry::varying) values[slot[k++]] = scale * entries[n];
        }
      }
    }
  }
}

template <class E>
void ConstraintOperations<E>::nu(const Block& block, const Data& data, const Pose& pose, double* out) {
  if constexpr (E::functions > 0) {
    for (const auto& timed : data.timed) {
      const int e = timed.element;
      const detail::ElementFrames<E> f(block, data, pose, e);
      Taylor<double> rows[E::rows];
      detail::taylor_rows(data.element[static_cast<std::size_t>(e)], f, {}, {}, detail::value_at(block, pose, e), rows);
      for (int r = 0; r < E::rows; ++r) out[block.row(e) + r] = -detail::scale_at(data, e) * rows[r].d;
    }
  }
}

template <class E>
void ConstraintOperations<E>::gamma(const Block& block, const Data& data, const Pose& pose, const double* qd,
                                    double* out) {
  double* row = out + block.first_row;
  for (int e = 0; e < block.size(); ++e, row += E::rows) {
    const detail::ElementFrames<E> f(block, data, pose, e);
    const Rates u = detail::rates_of<E>(block.body_i, qd, e);
    const Rates v = E::bodies == 2 ? detail::rates_of<E>(block.body_j, qd, e) : Rates{};
    const E& element = data.element[static_cast<std::size_t>(e)];
    if constexpr (Joining<E>) {
      double part;
      element.gamma(f.arguments(0), u, v, &part);
      out[block.row(e)] += part;
    } else if constexpr (HasClosedGamma<E>) {
      element.gamma(f.arguments(detail::value_at(block, pose, e).f), u, v, row);
    } else {
      Taylor<double> rows[E::rows];
      detail::taylor_rows(element, f, u, v, detail::value_at(block, pose, e), rows);
      for (int r = 0; r < E::rows; ++r) row[r] = -rows[r].dd;
    }
    if constexpr (HasSquaredValue<E>) row[0] *= detail::scale_at(data, e);
  }
  // A closed form speaks of the bodies' motion only; the part of c(t) is separate in every published form.
  if constexpr (HasClosedGamma<E> && E::functions > 0) {
    for (const auto& timed : data.timed) {
      const int e = timed.element;
      const detail::ElementFrames<E> f(block, data, pose, e);
      Taylor<double> rows[E::rows];
      detail::taylor_rows(data.element[static_cast<std::size_t>(e)], f, {}, {}, detail::value_at(block, pose, e), rows);
      for (int r = 0; r < E::rows; ++r) out[block.row(e) + r] -= detail::scale_at(data, e) * rows[r].dd;
    }
  }
}

template <class E>
ElementMatrix ConstraintOperations<E>::hessian(const Block& block, const Data& data, const Pose& pose,
                                               const double* lambda, int e) {
  using Inner = Dual<double, 6>;
  using Outer = Dual<Inner, 6>;
  const detail::ElementFrames<E> f(block, data, pose, e);
  const auto i = seed<Inner, 6>(seed<double, 6>(f.i, 0), 0);
  const auto j = seed<Inner, 6>(seed<double, 6>(f.j, 3), 3);
  Outer rows[E::rows];
  data.element[static_cast<std::size_t>(e)].phi(
      Arguments<Outer>{i, j, Outer(Inner(detail::value_at(block, pose, e).f)), f.ground, f.contact}, rows);
  ElementMatrix matrix{};
  for (int r = 0; r < E::rows; ++r) {
    const double weight = lambda[block.row(e) + r] * detail::scale_at(data, e);
    for (std::size_t a = 0; a < 6; ++a) {
      for (std::size_t b = 0; b < 6; ++b) matrix[6 * a + b] += weight * rows[r].d[a].d[b];
    }
  }
  return matrix;
}

template <class E>
void ConstraintOperations<E>::add_hessians(const Block& block, const Data& data, const Pose& pose, const double* lambda,
                                           bool convex, const int* slot, double* values) {
  constexpr auto pattern = hessian_pattern<E>();
  constexpr auto written = written_hessian<E>();
  if constexpr (pattern.size() > 0) {
    for (int e = 0; e < block.size(); ++e, slot += written.size()) {
      double entries[pattern.size()];
      if constexpr (HasClosedHessian<E>) {
        const detail::ElementFrames<E> f(block, data, pose, e);
        double weights[E::rows];
        for (int r = 0; r < E::rows; ++r) weights[r] = lambda[block.row(e) + r] * detail::scale_at(data, e);
        data.element[static_cast<std::size_t>(e)].hessian(f.arguments(detail::value_at(block, pose, e).f), weights,
                                                          entries);
      } else {
        const ElementMatrix matrix = hessian(block, data, pose, lambda, e);
        for (std::size_t k = 0; k < pattern.size(); ++k) {
          entries[k] = matrix[static_cast<std::size_t>(6 * pattern[k].row + pattern[k].column)];
        }
      }
      detail::scatter_hessian(written, pattern, entries, convex && !only_turning(pattern), slot, values);
    }
  }
}

template <class E>
const char* ConstraintOperations<E>::trouble(const Block& block, const Data& data, const Pose& pose, int e) {
  if constexpr (HasTrouble<E>) {
    const detail::ElementFrames<E> f(block, data, pose, e);
    return data.element[static_cast<std::size_t>(e)].trouble(f.arguments(detail::value_at(block, pose, e).f));
  } else {
    return nullptr;
  }
}

template <class E>
std::optional<CurveUse> ConstraintOperations<E>::curve_use(const Block& block, const Data& data, const Pose& pose,
                                                           int e) {
  if constexpr (HasCurveUse<E>) {
    const E& element = data.element[static_cast<std::size_t>(e)];
    if (!element.can_leave_curve()) return {};
    const detail::ElementFrames<E> f(block, data, pose, e);
    return element.curve_use(f.arguments(detail::value_at(block, pose, e).f));
  } else {
    return {};
  }
}

template <class E>
LocalJacobian<E> ConstraintOperations<E>::local_jacobian(const Block& block, const Data& data, const Pose& pose,
                                                         int e) {
  LocalJacobian<E> local;
  const detail::ElementFrames<E> f(block, data, pose, e);
  detail::derived_jacobian(data.element[static_cast<std::size_t>(e)], f, detail::value_at(block, pose, e).f,
                           local.entries.data());
  local.scale = detail::scale_at(data, e);
  return local;
}

template <class E>
Measured ConstraintOperations<E>::measure(const Block& block, const Data& data, const Pose& pose, const double* qd,
                                          const double* qdd, int e) {
  if constexpr (Measuring<E>) {
    const detail::ElementFrames<E> f(block, data, pose, e);
    const auto accelerated = [&](Frame<double> frame, const std::vector<int>& bodies) {
      const int body = bodies[static_cast<std::size_t>(e)];
      const Rates u = qd ? detail::rates_of<E>(bodies, qd, e) : Rates{};
      Frame<Taylor<double>> m = moving(frame, u.vx, u.vy, u.omega);
      if (qdd) {
        const double* a = qdd + 3 * body;
        m.x.dd += a[0];
        m.y.dd += a[1];
        m.phi.dd += a[2];
        m.c.dd -= frame.s * a[2];
        m.s.dd += frame.c * a[2];
      }
      return m;
    };
    // The absolute types measure in the ground frame: bring the body there.
    const Frame<double> fi = E::bodies == 1 ? detail::shifted(f.i, f.ground) : f.i;
    const auto i = accelerated(fi, block.body_i);
    const auto j = E::bodies == 2 ? accelerated(f.j, block.body_j) : Frame<Taylor<double>>{};
    const Taylor<double> m = measure_of(data.element[static_cast<std::size_t>(e)], i, j, *f.contact);
    return {m.f, m.d, m.dd};
  } else {
    return {};
  }
}

}  // namespace catena
