// Evaluation over bodies and force elements: loads, energies, second derivatives.
#include <algorithm>

#include "catena/assembly/evaluate.hpp"
#include "catena/base/at.hpp"

namespace catena {

void Evaluator::applied_forces(std::span<const double> qd, std::span<double> Q) {
  ++counters.forces;
  const Plan& plan = *plan_;
  if (!laws_.empty()) read_laws(qd);
  std::fill(Q.begin(), Q.end(), 0.0);
  const Vec2<double> g = model_->gravity;
  if (g.x != 0 || g.y != 0) {
    for (int p = 0; p < plan.moving; ++p) {
      const double mass = mass_[at(p)];
      Q[at(3 * p)] = mass * g.x;
      Q[at(3 * p + 1)] = mass * g.y;
    }
  }
  for_each_list(plan.forces, [&](const auto& block, int) {
    using E = typename std::remove_cvref_t<decltype(block)>::Element;
    if (block.size() > 0) {
      ForceOperations<E>::add_forces(block, std::get<ForceData<E>>(force_values_), frames_.data(), qd.data(), Q.data());
    }
  });
}

double Evaluator::potential_energy() const {
  const Vec2<double> g = model_->gravity;
  double sum = 0;
  for (int p = 0; p < plan_->bodies; ++p) sum -= mass_[at(p)] * dot(g, ground_frame(p).origin());
  for_each_list(plan_->forces, [&](const auto& block, int) {
    using E = typename std::remove_cvref_t<decltype(block)>::Element;
    sum += ForceOperations<E>::potential(block, std::get<ForceData<E>>(force_values_), frames_.data());
  });
  return sum;
}

double Evaluator::dissipation(std::span<const double> qd) const {
  double sum = 0;
  for_each_list(plan_->forces, [&](const auto& block, int) {
    using E = typename std::remove_cvref_t<decltype(block)>::Element;
    sum += ForceOperations<E>::dissipation(block, std::get<ForceData<E>>(force_values_), frames_.data(), qd.data());
  });
  return sum;
}

double Evaluator::load_power(std::span<const double> qd) {
  if (!laws_.empty()) read_laws(qd);
  double sum = 0;
  for_each_list(plan_->forces, [&](const auto& block, int) {
    using E = typename std::remove_cvref_t<decltype(block)>::Element;
    sum += ForceOperations<E>::load_power(block, std::get<ForceData<E>>(force_values_), frames_.data(), qd.data());
  });
  return sum;
}

bool Evaluator::conservative() const {
  bool all = true;
  for_each_list(force_values_, [&](const auto& data, int) {
    using E = typename std::remove_cvref_t<decltype(data.element)>::value_type;
    all = all && ForceOperations<E>::conservative(data);
  });
  return all;
}

void Evaluator::add_hessians(std::span<const double> lambda, Curvature curvature, const HessianSlots& slots,
                             std::span<double> values) {
  ++counters.hessians;
  const bool convex = curvature == Curvature::convex;
  for_each_list(plan_->blocks, [&](const auto& block, int type) {
    using E = typename std::remove_cvref_t<decltype(block)>::Element;
    ConstraintOperations<E>::add_hessians(block, std::get<ConstraintData<E>>(values_), frames_.data(), lambda.data(),
                                          convex, slots.constraints[at(type)].data(), values.data());
  });
  for_each_list(plan_->forces, [&](const auto& block, int type) {
    using E = typename std::remove_cvref_t<decltype(block)>::Element;
    if (slots.forces[at(type)].empty()) return;
    ForceOperations<E>::add_stiffness(block, std::get<ForceData<E>>(force_values_), frames_.data(), convex,
                                      slots.forces[at(type)].data(), values.data());
  });
}

}  // namespace catena
