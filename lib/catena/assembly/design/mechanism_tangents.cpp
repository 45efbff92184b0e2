#include "catena/assembly/design/mechanism_tangents.hpp"

#include <type_traits>

#include "catena/assembly/design/element_motion.hpp"
#include "catena/base/at.hpp"
#include "catena/linalg/kernels/lanes.hpp"
#include "catena/linalg/kernels/packs.hpp"

namespace catena {
namespace {

/// out += factor x along, over all directions.
void add_row(double factor, const double* along, std::size_t width, double* out) {
  for (std::size_t p = 0; p < width; p += Lanes::count)
    (Lanes::load(out + p) + factor * Lanes::load(along + p)).store(out + p);
}

}  // namespace

MechanismTangents::MechanismTangents(const Evaluator& evaluator) : AdjointMechanism(evaluator) {
  std::vector<char> reads(at(3 * plan_->bodies), 0);
  const auto note = [&](const auto& block, bool angle_alone) {
    using E = typename std::remove_cvref_t<decltype(block)>::Element;
    for (int e = 0; e < block.size(); ++e) {
      for (int b = 0; b < E::bodies; ++b) {
        const int body = b == 0 ? block.body_i[at(e)] : block.body_j[at(e)];
        for (int k = angle_alone ? 2 : 0; k < 3 && body < plan_->moving; ++k) reads[at(3 * body + k)] = 1;
      }
    }
  };
  for_each_list(plan_->blocks, [&](const auto& block, int) {
    note(block, std::is_same_v<typename std::remove_cvref_t<decltype(block)>::Element, Revolute<double>>);
  });
  for_each_list(plan_->forces, [&](const auto& block, int) {
    note(block, false);
    any_force_ = any_force_ || block.size() > 0;
  });
  for (std::size_t c = 0; c < reads.size(); ++c) {
    if (reads[c]) read_.push_back(static_cast<int>(c));
  }
}

struct MechanismTangents::PinKernel {
  std::span<const PinWeights> ends;
  Directions along;
  double *rows, *loads;  // nullptr where they are not wanted

  template <class P>
  void run(std::size_t first) const {
    const std::size_t w = along.width;
    const double *const dq = along.dq.data() + first, *const dqd = along.dqd.data() + first;
    for (const PinWeights& end : ends) {
      P turn, rate, sum;
      packs::load(turn, dq + end.angle * w);
      packs::load(rate, dqd + end.angle * w);
      if (loads) packs::add(loads + end.angle * w + first, end.load, turn);
      if (!rows) continue;
      double* const x = rows + end.row * w + first;
      packs::load(sum, x);
      sum += end.turn.x * turn + end.rate.x * rate;
      packs::store(sum, x);
      packs::load(sum, x + w);
      sum += end.turn.y * turn + end.rate.y * rate;
      packs::store(sum, x + w);
    }
  }
};

// With the arm a = A s: Phi by the angle is R a, (R a)' = -a omega, (R a)'' = -a alpha - R a omega^2, and the curvature
// -a. Translations have constant columns.
template <class Block, class List>
void MechanismTangents::add_pins(const Block& block, const List& list, std::span<const double> lambda,
                                 const Directions& along, std::span<double> rows, std::span<double> loads, bool rates) {
  pin_weights_.resize(2 * at(block.size()));
  std::size_t ends = 0;
  for (int e = 0; e < block.size(); ++e) {
    const auto& pin = list[at(block.entry[at(e)])].element;
    const std::size_t row = at(block.row(e));
    const Vec2<double> multipliers = loads.empty() ? Vec2<double>{} : Vec2<double>{lambda[row], lambda[row + 1]};
    for (int b = 0; b < 2; ++b) {
      const int body = b == 0 ? block.body_i[at(e)] : block.body_j[at(e)];
      if (body >= plan_->moving) continue;
      const Frame<Taylor<double>>& f = motion_[at(body)];
      const Vec2<double>& s = b == 0 ? pin.s_i : pin.s_j;
      const double sign = b == 0 ? -1 : 1, omega = f.phi.d, alpha = f.phi.dd, square = omega * omega;
      const Vec2<double> a{sign * (f.c.f * s.x - f.s.f * s.y), sign * (f.s.f * s.x + f.c.f * s.y)};
      PinWeights& end = pin_weights_[ends++];
      end.row = row;
      end.angle = at(3 * body + 2);
      end.load = dot(multipliers, a);
      end.turn = rates ? Vec2<double>{-a.x * omega, -a.y * omega}
                       : Vec2<double>{a.y * square - a.x * alpha, -a.y * alpha - a.x * square};
      end.rate = rates ? Vec2<double>{} : Vec2<double>{-2 * a.x * omega, -2 * a.y * omega};
    }
  }
  const auto target = [](std::span<double> all) { return all.empty() ? nullptr : all.data(); };
  const auto all = std::span<const PinWeights>(pin_weights_).first(ends);
  packs::with_packs(PinKernel{all, along, target(rows), target(loads)}, along.width);
}

template <class Block, class List>
void MechanismTangents::add_pins(const Block& block, const List& list, std::span<const double> lambda,
                                 const Directions& along, const TangentSums& sums) {
  if (!sums.bends.empty() || !sums.loads.empty()) add_pins(block, list, lambda, along, sums.bends, sums.loads, false);
  if (!sums.rates.empty()) add_pins(block, list, lambda, along, sums.rates, {}, true);
}

template <class Block, class List>
void MechanismTangents::add_constraints(const Block& block, const List& list, std::span<const double> lambda,
                                        const Directions& along, const TangentSums& sums) const {
  using E = ElementOf<List>;
  constexpr int columns = 3 * E::bodies;
  using Slopes = Dual<Taylor<double>, columns>;
  using Once = Dual<double, columns>;
  using Twice = Dual<Once, columns>;
  const std::size_t w = along.width;
  for (int e = 0; e < block.size(); ++e) {
    const auto& entry = list[at(block.entry[at(e)])];
    const double scale = scale_[at(entry.id)];
    const Taylor<double> c = detail::value_of_entry(entry, values_);
    const auto coordinate = [&](int k) { return at(3 * (k < 3 ? block.body_i[at(e)] : block.body_j[at(e)]) + k % 3); };
    const auto f = detail::design_frames<Taylor<double>>(block, e, plan_->moving, origin_,
                                                         [&](int body) { return motion_[at(body)]; });
    if (!sums.bends.empty() || !sums.rates.empty()) {
      const Frame<Slopes> i = seed<Taylor<double>, columns>(f.i, 0);
      Frame<Slopes> j;
      if constexpr (E::bodies == 2) j = seed<Taylor<double>, columns>(f.j, 3);
      Slopes rows[E::rows];
      entry.element.phi(Arguments<Slopes>{i, j, Slopes(c), f.ground}, rows);
      for (int r = 0; r < E::rows; ++r) {
        const std::size_t row = at(block.row(e) + r) * w;
        for (int k = 0; k < columns; ++k) {
          const Taylor<double>& slope = rows[r].d[at(k)];
          const double *dq = along.dq.data() + coordinate(k) * w, *dqd = along.dqd.data() + coordinate(k) * w;
          if (!sums.rates.empty()) add_row(scale * slope.d, dq, w, sums.rates.data() + row);
          if (sums.bends.empty()) continue;
          add_row(scale * slope.dd, dq, w, sums.bends.data() + row);
          add_row(2 * scale * slope.d, dqd, w, sums.bends.data() + row);
        }
      }
    }
    if (sums.loads.empty()) continue;
    const auto twice = [](const Frame<Taylor<double>>& g, int first) {
      return seed<Once, columns>(seed<double, columns>(Frame<double>{g.x.f, g.y.f, g.phi.f, g.c.f, g.s.f}, first),
                                 first);
    };
    Frame<Twice> j;
    if constexpr (E::bodies == 2) j = twice(f.j, 3);
    Twice rows[E::rows];
    entry.element.phi(Arguments<Twice>{twice(f.i, 0), j, Twice(Once(c.f)), f.ground}, rows);
    for (int k = 0; k < columns; ++k) {
      for (int l = 0; l < columns; ++l) {
        double bend = 0;
        for (int r = 0; r < E::rows; ++r) bend += scale * lambda[at(block.row(e) + r)] * rows[r].d[at(k)].d[at(l)];
        if (bend != 0) add_row(-bend, along.dq.data() + coordinate(l) * w, w, sums.loads.data() + coordinate(k) * w);
      }
    }
  }
}

template <class Block, class List>
void MechanismTangents::add_forces(const Evaluator& evaluator, const Block& block, const List& list,
                                   const Directions& along, std::span<double> loads) const {
  using E = ElementOf<List>;
  using D = Dual<double, 12>;  // by the poses of both bodies, then by their rates
  const std::size_t w = along.width;
  for (int e = 0; e < block.size(); ++e) {
    const auto& entry = list[at(block.entry[at(e)])];
    const int bodies[2] = {block.body_i[at(e)], E::bodies == 2 ? block.body_j[at(e)] : plan_->bodies};
    const auto f = detail::design_frames<double>(block, e, plan_->moving, origin_,
                                                 [&](int body) { return evaluator.frames()[at(body)]; });
    std::array<D, E::functions + 1> values;
    for (std::size_t n = 0; n < entry.values.size(); ++n) {
      const auto& value = entry.values[n];
      values[n] = value.function < 0 ? D(value.constant) : D(values_[at(value.function)].f);
    }
    const auto twist = [&](int body, int first) {
      const double* rate = rates_.data() + 3 * body;
      return Twist<D>{D::variable(rate[0], first), D::variable(rate[1], first + 1), D::variable(rate[2], first + 2)};
    };
    const Twist<D> u = twist(bodies[0], 6), v = twist(bodies[1], 9);
    Wrench<D> on[2];
    entry.element.force(
        ForceArguments<D>{seed<double, 12>(f.i, 0), seed<double, 12>(f.j, 3), u, v, values.data(), f.ground}, on[0],
        on[1]);
    for (int b = 0; b < E::bodies; ++b) {
      const D* parts[3] = {&on[b].fx, &on[b].fy, &on[b].moment};
      for (int r = 0; r < 3; ++r) {
        for (int k = 0; k < 3 * E::bodies; ++k) {
          const std::size_t c = at(3 * bodies[k / 3] + k % 3) * w;
          double* load = loads.data() + at(3 * bodies[b] + r) * w;
          add_row(parts[r]->d[at(k)], along.dq.data() + c, w, load);
          add_row(parts[r]->d[at(6 + k)], along.dqd.data() + c, w, load);
        }
      }
    }
  }
}

void MechanismTangents::add_along(const Evaluator& evaluator, std::span<const double> lambda,
                                  std::span<const double> dq, std::span<const double> dqd, std::size_t width,
                                  const TangentSums& sums) {
  const Directions along{dq, dqd, width};
  detail::visit_constraints(*plan_, *model_, [&](const auto& block, const auto& list) {
    using E = ElementOf<decltype(list)>;
    if constexpr (std::is_same_v<E, Revolute<double>>)
      add_pins(block, list, lambda, along, sums);
    else if constexpr (detail::is_differentiated<E>)
      add_constraints(block, list, lambda, along, sums);
  });
  if (sums.loads.empty() || !any_force_) return;
  for_each_list(plan_->forces, model_->forces, [&](const auto& block, const auto& list, int) {
    if constexpr (detail::is_differentiated<ElementOf<decltype(list)>>)
      add_forces(evaluator, block, list, along, sums.loads);
  });
}

}  // namespace catena
