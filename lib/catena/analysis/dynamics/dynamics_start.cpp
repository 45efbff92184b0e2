// Dynamics of a driven mechanism that is given in a singular position: nothing but its branches say how it moves there.
#include <algorithm>
#include <cmath>

#include "catena/analysis/dynamics/dynamics.hpp"
#include "catena/analysis/motion/initial_velocities.hpp"
#include "catena/analysis/pose/departure.hpp"
#include "catena/linalg/rank/dependence.hpp"

namespace catena {
namespace {

// A branch is the one that given velocities mean if they are nearer to it than by this part of the way to the next.
constexpr double clearly_nearer = 0.3;
// Drivers that begin to move: accelerations of the branch are taken for those of the motion until these have come so
// far, rad or length scales. They are off by this part, and places by its square; projection mends both from there on.
constexpr double first_way = 1e-4;

}  // namespace

// Nothing: the mechanism is not driven, or not singular where it starts. What contacts hold has come there with
// velocities of its own.
std::optional<SingularStart> Dynamics::singular_start() {
  const int lasting = plan_->rows - (attached_.contacts ? attached_.contacts->rows() : 0);
  if (lasting == 0 || lasting < plan_->columns) return {};
  equations_.leave_out({});
  if (!equations_.factorize(t_, Side::after, q_) || equations_.smallest_pivot_ratio() > dependence::independent)
    return {};
  SingularPoint point = find_branches(evaluator_, q_, {}, dependence::follows_at_start);
  if (point.nullity == 0 || !point.held_to_second_order) return {};
  const int branch = branch_of_given_velocities(point);
  return decide_start(evaluator_, std::move(point), branch, 1, "give bodies the velocities of one of them");
}

// The branch that velocities of the model, or of an earlier analysis, mean, from 1; 0: none clearly.
int Dynamics::branch_of_given_velocities(const SingularPoint& point) {
  const bool given = !origin_.given_qd.empty() ||
                     std::any_of(model_->bodies.begin(), model_->bodies.end(),
                                 [](const auto& body) { return body.velocity_given || body.angular_velocity_given; });
  if (!given || point.tangents.size() < 2) return 0;
  std::vector<double> qd(q_.size());
  if (!find_initial_velocities(equations_, q_, origin_.given_qd, qd).ok()) return 0;
  std::vector<double> apart;
  for (const std::vector<double>& tangent : point.tangents) {
    std::vector<double> difference(qd);
    for (std::size_t k = 0; k < qd.size(); ++k) difference[k] -= tangent[k];
    apart.push_back(rate_of(evaluator_, difference));
  }
  const auto nearest = std::min_element(apart.begin(), apart.end());
  const int branch = static_cast<int>(nearest - apart.begin()) + 1;
  const double distance = *nearest;
  *nearest = HUGE_VAL;
  return distance < clearly_nearer * *std::min_element(apart.begin(), apart.end()) ? branch : 0;
}

// A place a little along the branch, assembled; nothing where functions of time do not go on so far.
std::optional<RedundantRows::GenericPlace> Dynamics::place_along(const SingularStart& start) {
  const std::vector<double>& tangent = start.point.tangents[static_cast<std::size_t>(start.branch - 1)];
  const double way = RedundantRows::probe_distance / rate_of(evaluator_, tangent);
  const bool rests = start.point.kind == SingularPoint::Kind::rest;
  const double later = rests ? time_to_depart(evaluator_, t_, 1, way) : way;
  std::optional<RedundantRows::GenericPlace> place;
  if (std::isfinite(later) && functions_exist_at(evaluator_, t_ + later)) {
    place = RedundantRows::GenericPlace{t_ + later, q_};
    for (std::size_t k = 0; k < tangent.size(); ++k) place->q[k] += way * tangent[k];
    evaluator_.set_time(place->t);
    if (!Assembler(evaluator_).assemble(place->q).ok()) place.reset();
  }
  evaluator_.set_time(t_);
  return place;
}

// Whether drivers that rest begin to move here; until they have come first_way the motion is that along the branch, in
// step with the one that leads,  q'' = s'' z.  Multipliers have no bound there, but what they do together has: the
// drivers do  (M q'' - Q) . q',  which counts as the leading one's.
bool Dynamics::know_start_from_rest() {
  if (!origin_.singular || origin_.singular->point.kind != SingularPoint::Kind::rest) return false;
  const std::vector<double>& z =
      origin_.singular->point.tangents[static_cast<std::size_t>(origin_.singular->branch - 1)];
  const double later = t_ + time_to_depart(evaluator_, t_, 1, first_way / rate_of(evaluator_, z));
  if (!std::isfinite(later)) return false;
  const auto departure = std::make_shared<const Departure>(evaluator_, t_, 1);
  const int leader = departure->leader(later);
  const auto slope = [this, z, departure, later, leader, qd = z](double t, std::span<double> out) mutable {
    const Taylor<double> s = departure->rates(t, later);
    for (std::size_t k = 0; k < z.size(); ++k) out[k] = s.dd * z[k];
    if (!work_.account) return;
    for (std::size_t k = 0; k < z.size(); ++k) qd[k] = s.d * z[k];
    const std::span<const double> loads = equations_.applied_forces();
    const std::vector<double>& mass = equations_.masses().mass;
    double power = 0;
    for (std::size_t k = 0; k < mass.size(); ++k) power += (mass[k] * out[k] - loads[k]) * qd[k];
    work_.account->powers_of_one(qd, leader, power, out.subspan(z.size()));
    under_way_.motion->add_losses(out.subspan(z.size()));
  };
  under_way_.motion->depart(later, slope);
  return true;
}

}  // namespace catena
