// MechanismTangents: derivatives by design parameters, of what these reach.
#include "catena/assembly/design/element_motion.hpp"
#include "catena/assembly/design/mechanism_tangents.hpp"
#include "catena/base/at.hpp"
#include "catena/linalg/kernels/lanes.hpp"
#include "catena/linalg/kernels/packs.hpp"

namespace catena {
namespace {

using detail::DesignSeries;

/// Derivatives by the parameters of a group into a row of directions.
void add_derivatives(double factor, const DesignScalar& x, double* out) {
  for (std::size_t p = 0; p < x.d.size(); ++p) out[p] += factor * x.d[p];
}

}  // namespace

struct MechanismTangents::PinParametersKernel {
  const MechanismTangents& tangents;
  const Reached& reached;
  std::span<const double> lambda;
  std::size_t width;
  double *phi, *rates, *bends, *loads;  // at the group's first direction; nullptr where they are not wanted

  template <class P>
  static void add(double* out, double by_x, const P& x, double by_y, const P& y) {
    P sum;
    packs::load(sum, out);
    sum += by_x * x + by_y * y;
    packs::store(sum, out);
  }
  template <class P>
  void run(std::size_t lane) const {
    for (const Reached::PinEnd& end : reached.pins_) {
      const Frame<Series>& f = tangents.motion_[at(end.body)];
      const double omega = f.phi.d, alpha = f.phi.dd, square = omega * omega;
      P s_x, s_y;
      packs::load(s_x, end.x.data() + lane);
      packs::load(s_y, end.y.data() + lane);
      const P x = f.c.f * s_x - f.s.f * s_y, y = f.s.f * s_x + f.c.f * s_y;
      const std::size_t row = at(end.row) * width + lane;
      if (phi) {
        packs::add(phi + row, 1, x);
        packs::add(phi + row + width, 1, y);
      }
      if (rates) {
        packs::add(rates + row, -omega, y);
        packs::add(rates + row + width, omega, x);
      }
      if (bends) {
        add(bends + row, -square, x, -alpha, y);
        add(bends + row + width, alpha, x, -square, y);
      }
      if (loads && end.body < tangents.plan_->moving)
        add(loads + at(3 * end.body + 2) * width + lane, -lambda[at(end.row + 1)], x, lambda[at(end.row)], y);
    }
  }
};

// With the arm a = A s and its derivative A s_p: h_p = A s_p, h'_p = R A s_p omega, h''_p = R A s_p alpha - A s_p
// omega^2, and of the load's moment lambda . R A s_p.
void MechanismTangents::add_pin_parameters(const Reached& reached, std::span<const double> lambda, std::size_t first,
                                           std::size_t width, const TangentSums& sums) const {
  if (reached.pins_.empty()) return;
  const auto target = [&](std::span<double> all) { return all.empty() ? nullptr : all.data() + first; };
  packs::with_packs(PinParametersKernel{*this, reached, lambda, width, target(sums.phi), target(sums.rates),
                                        target(sums.bends), target(sums.loads)},
                    parameters_at_once);
}

void MechanismTangents::add_constraint_parameters(const DesignMechanism& mechanism, const Reached& reached,
                                                  std::span<const double> lambda, std::size_t first, std::size_t width,
                                                  const TangentSums& sums) const {
  const auto target = [&](std::span<double> all, std::size_t row) { return all.data() + row * width + first; };
  const auto frame = [&](int body) { return frame_of(mechanism, body); };
  std::size_t type = 0;
  for_each_list(plan_->blocks, mechanism.model().constraints, [&](const auto& block, const auto& list, int) {
    using E = ElementOf<decltype(list)>;
    using Plain = typename std::remove_cvref_t<decltype(block)>::Element;
    const std::vector<int>& places = reached.constraints_[type++];
    if constexpr (detail::is_differentiated<Plain>) {
      for (const int e : places) {
        const auto& entry = list[at(block.entry[at(e)])];
        const double scale = scale_[at(entry.id)];
        DesignSeries c;
        if constexpr (E::functions > 0) c = mechanism.element_value(entry.id);
        const auto f = detail::design_frames<DesignSeries>(block, e, plan_->moving, origin_, frame);
        DesignSeries rows[E::rows];
        entry.element.phi(Arguments<DesignSeries>{f.i, f.j, c, f.ground}, rows);
        for (int r = 0; r < E::rows; ++r) {
          const std::size_t row = at(block.row(e) + r);
          if (!sums.phi.empty()) add_derivatives(scale, rows[r].f, target(sums.phi, row));
          if (!sums.rates.empty()) add_derivatives(scale, rows[r].d, target(sums.rates, row));
          if (!sums.bends.empty()) add_derivatives(scale, rows[r].dd, target(sums.bends, row));
        }
        if (sums.loads.empty()) continue;
        constexpr int columns = 3 * E::bodies;
        using D = Dual<DesignScalar, columns>;
        Frame<D> j;
        if constexpr (E::bodies == 2) j = seed<DesignScalar, columns>(detail::present(f.j), 3);
        D slopes[E::rows];
        entry.element.phi(Arguments<D>{seed<DesignScalar, columns>(detail::present(f.i), 0), j, D(c.f), f.ground},
                          slopes);
        for (int r = 0; r < E::rows; ++r) {
          const double weight = -scale * lambda[at(block.row(e) + r)];
          for (int k = 0; k < columns; ++k) {
            const int body = k < 3 ? block.body_i[at(e)] : block.body_j[at(e)];
            add_derivatives(weight, slopes[r].d[at(k)], target(sums.loads, at(3 * body + k % 3)));
          }
        }
      }
    }
  });
}

void MechanismTangents::add_force_parameters(const DesignMechanism& mechanism, const Reached& reached,
                                             std::size_t first, std::size_t width, std::span<double> loads) const {
  const DesignModel& model = mechanism.model();
  const auto target = [&](std::size_t row) { return loads.data() + row * width + first; };
  const auto pose = [&](int body) { return detail::present(frame_of(mechanism, body)); };
  const auto twist = [&](int body) {
    const double* rate = rates_.data() + 3 * body;
    return Twist<DesignScalar>{rate[0], rate[1], rate[2]};
  };
  std::size_t type = 0;
  for_each_list(plan_->forces, model.forces, [&](const auto& block, const auto& list, int) {
    using E = ElementOf<decltype(list)>;
    using Plain = typename std::remove_cvref_t<decltype(block)>::Element;
    const std::vector<int>& places = reached.forces_[type++];
    if constexpr (detail::is_differentiated<Plain>) {
      for (const int e : places) {
        const auto& entry = list[at(block.entry[at(e)])];
        const auto f = detail::design_frames<DesignScalar>(block, e, plan_->moving, origin_, pose);
        const auto values = detail::function_values<DesignScalar>(entry, mechanism.functions(), detail::no_law);
        const int bodies[2] = {block.body_i[at(e)], E::bodies == 2 ? block.body_j[at(e)] : plan_->bodies};
        const Twist<DesignScalar> u = twist(bodies[0]), v = twist(bodies[1]);
        Wrench<DesignScalar> on[2];
        entry.element.force(ForceArguments<DesignScalar>{f.i, f.j, u, v, values.data(), f.ground}, on[0], on[1]);
        for (int b = 0; b < E::bodies; ++b) {
          const std::size_t c = at(3 * bodies[b]);
          add_derivatives(1, on[b].fx, target(c));
          add_derivatives(1, on[b].fy, target(c + 1));
          add_derivatives(1, on[b].moment, target(c + 2));
        }
      }
    }
  });
}

void MechanismTangents::add_parameters(const DesignMechanism& mechanism, const Reached& reached,
                                       std::span<const double> lambda, std::span<const double> qdd, std::size_t first,
                                       std::size_t width, const TangentSums& sums) const {
  add_pin_parameters(reached, lambda, first, width, sums);
  const auto load = [&](int coordinate) { return sums.loads.data() + at(coordinate) * width + first; };
  if (!sums.loads.empty()) {
    for (const Reached::Mass& mass : reached.masses_) {
      const double pull = mass.pull - (qdd.empty() ? 0 : qdd[at(mass.coordinate)]);
      double* const out = load(mass.coordinate);
      (Lanes::load(out) + pull * Lanes::load(mass.by.data())).store(out);
    }
  }
  if (!reached.asks_mechanism()) return;
  if (reached.any_constraint_) add_constraint_parameters(mechanism, reached, lambda, first, width, sums);
  if (sums.loads.empty()) return;
  if (reached.any_force_) add_force_parameters(mechanism, reached, first, width, sums.loads);
  const Vec2<DesignScalar>& gravity = mechanism.model().gravity;
  for (int c = 0; c < 3 * plan_->moving && reached.gravity_; ++c) {
    if (c % 3 < 2) add_derivatives(mechanism.mass(c).v, c % 3 == 0 ? gravity.x : gravity.y, load(c));
  }
}

}  // namespace catena
