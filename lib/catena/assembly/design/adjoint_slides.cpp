// AdjointMechanism: equations of slides, which are evaluated in design scalars, four coordinates at a time.
#include "catena/assembly/curve_contacts.hpp"
#include "catena/assembly/design/adjoint_mechanism.hpp"
#include "catena/assembly/design/element_motion.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

using detail::DesignSeries;
using Slide = CustomConstraint<double>;

/// Coordinates of both bodies, of their poses first, then of their rates.
constexpr int poses = 6, poses_and_rates = 12;

/// Derivative s of the frame is that by a coordinate of its pose.
void seed_pose(Frame<DesignSeries>& f, int coordinate, std::size_t s) {
  if (coordinate < 2) {
    (coordinate == 0 ? f.x : f.y).f.d[s] = 1;
    return;
  }
  f.phi.f.d[s] = 1;
  f.c.f.d[s] = -f.s.f.v;
  f.c.d.d[s] = -f.s.d.v;
  f.c.dd.d[s] = -f.s.dd.v;
  f.s.f.d[s] = f.c.f.v;
  f.s.d.d[s] = f.c.d.v;
  f.s.dd.d[s] = f.c.dd.v;
}

/// By the rate of one, at a fixed pose and acceleration.
void seed_rate(Frame<DesignSeries>& f, int coordinate, std::size_t s) {
  if (coordinate < 2) {
    (coordinate == 0 ? f.x : f.y).d.d[s] = 1;
    return;
  }
  f.phi.d.d[s] = 1;
  f.c.d.d[s] = -f.s.f.v;
  f.c.dd.d[s] = -2 * f.s.d.v;
  f.s.d.d[s] = f.c.f.v;
  f.s.dd.d[s] = 2 * f.c.d.v;
}

/// Two bodies, of which the first `moving` ones of the plan move.
struct SlidingPair {
  std::array<int, 2> bodies;
  int moving;
  int body_of(int number) const { return bodies[number % poses < 3 ? 0 : 1]; }
};

/// Calls add(coordinate, by_rate, derivative of the slide) for the coordinates of the bodies that move, numbered as
/// `poses` and `poses_and_rates` have them, up to `count`.
template <class Add>
void differentiate_slide(const Slide& slide, const CurvePlace& place,
                         const detail::DesignFrames<Taylor<double>>& frames, const SlidingPair& pair, int count,
                         Add&& add) {
  std::array<int, parameters_at_once> number{};
  for (int next = 0; next < count;) {
    Frame<DesignSeries> i = detail::lifted(frames.i), j = detail::lifted(frames.j);
    std::size_t seeded = 0;
    for (; next < count && seeded < number.size(); ++next) {
      if (pair.body_of(next) >= pair.moving) continue;
      (next < poses ? seed_pose : seed_rate)(next % poses < 3 ? i : j, next % 3, seeded);
      number[seeded++] = next;
    }
    if (seeded == 0) return;
    const DesignSeries w = slide.measure(i, j, place);
    for (std::size_t s = 0; s < seeded; ++s) {
      const std::size_t c = at(3 * pair.body_of(number[s]) + number[s] % 3);
      add(c, number[s] >= poses, Taylor<double>{w.f.d[s], w.d.d[s], w.dd.d[s]});
    }
  }
}

}  // namespace

void AdjointMechanism::add_slides_by_q(const AdjointWeights& weights, std::span<double> by_q,
                                       std::span<double> by_qd) const {
  const auto& block = std::get<ConstraintBlock<Slide>>(plan_->blocks);
  const auto& list = std::get<std::vector<ElementEntry<Slide, double>>>(model_->constraints);
  for (int e = 0; e < block.size(); ++e) {
    const std::size_t row = at(block.row(e));
    const double bend = weights.bend.empty() ? 0 : weights.bend[row],
                 rate = weights.rate.empty() ? 0 : weights.rate[row];
    if (bend == 0 && rate == 0) continue;
    const auto frames =
        detail::design_frames<Series>(block, e, plan_->moving, origin_, [&](int body) { return motion_[at(body)]; });
    differentiate_slide(list[at(block.entry[at(e)])].element, contact_of(block, contacts_, block.entry[at(e)]), frames,
                        {{block.body_i[at(e)], block.body_j[at(e)]}, plan_->moving},
                        bend != 0 ? poses_and_rates : poses, [&](std::size_t c, bool by_rate, const Taylor<double>& w) {
                          if (by_rate)
                            by_qd[c] -= bend * w.dd;
                          else
                            by_q[c] -= bend * w.dd + rate * w.d;
                        });
  }
}

// w' along a motion with the weights as rates is Phi_q w.
void AdjointMechanism::add_slides_curvature(const AdjointWeights& weights, std::span<double> by_q) const {
  const auto& block = std::get<ConstraintBlock<Slide>>(plan_->blocks);
  const auto& list = std::get<std::vector<ElementEntry<Slide, double>>>(model_->constraints);
  const auto along = [&](int body) {
    const Frame<Series>& f = motion_[at(body)];
    const double* w = weights.w.data() + 3 * body;
    return moving(Frame<double>{f.x.f, f.y.f, f.phi.f, f.c.f, f.s.f}, w[0], w[1], w[2]);
  };
  for (int e = 0; e < block.size(); ++e) {
    const double lambda = weights.lambda[at(block.row(e))];
    if (lambda == 0) continue;
    const auto frames = detail::design_frames<Series>(block, e, plan_->moving, origin_, along);
    differentiate_slide(list[at(block.entry[at(e)])].element, contact_of(block, contacts_, block.entry[at(e)]), frames,
                        {{block.body_i[at(e)], block.body_j[at(e)]}, plan_->moving}, poses,
                        [&](std::size_t c, bool, const Taylor<double>& w) { by_q[c] -= lambda * w.d; });
  }
}

}  // namespace catena
