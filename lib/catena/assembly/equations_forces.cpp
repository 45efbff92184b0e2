// Evaluation over bodies and force elements: loads, energies, second derivatives.
#include <algorithm>
#include <numeric>

#include "catena/assembly/equations.hpp"
#include "catena/base/at.hpp"
#include "catena/elements/all.hpp"

namespace catena {
namespace {

template <std::size_t n>
constexpr bool has_places(const std::array<HessianEntry, n>& written) {
  return std::any_of(written.begin(), written.end(), [](const HessianEntry& e) { return e.row % 3 != 2; });
}

/// Adds the blocks of one type's elements to their slots: `add(convex, slot, out)` adds them as they are, or their
/// nearest ones without negative eigenvalues. What is nearest depends on what a radian counts beside a metre: one
/// length scale of the mechanism, whatever the unit.
template <std::size_t n, class Add>
void add_second_derivatives(const std::array<HessianEntry, n>& written, bool convex, double length,
                            const std::vector<int>& slots, Add&& add, std::span<double> values) {
  if (!convex || !has_places(written)) return add(convex, slots.data(), values.data());
  std::vector<int> in_order(slots.size());
  std::iota(in_order.begin(), in_order.end(), 0);
  std::vector<double> blocks(slots.size(), 0.0);
  add(false, in_order.data(), blocks.data());
  int rows = 0;
  while (static_cast<std::size_t>(rows * (rows + 1) / 2) < n) ++rows;
  std::array<double, n> unit;
  for (std::size_t k = 0; k < n; ++k)
    unit[k] = (written[k].row % 3 == 2 ? length : 1) * (written[k].column % 3 == 2 ? length : 1);
  for (std::size_t first = 0; first < blocks.size(); first += n) {
    double* const block = blocks.data() + first;
    for (std::size_t k = 0; k < n; ++k) block[k] /= unit[k];
    keep_positive_part(block, rows);
    for (std::size_t k = 0; k < n; ++k) values[at(slots[first + k])] += unit[k] * block[k];
  }
}

}  // namespace

void Equations::applied_forces(const MovingPose& moving, std::span<double> Q) const {
  const Plan& plan = *plan_;
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
      ForceOperations<E>::add_forces(block, std::get<ForceData<E>>(forces_), moving, Q.data());
    }
  });
}

double Equations::potential_energy(const Pose& pose) const {
  const Vec2<double> g = model_->gravity;
  double sum = 0;
  for (int p = 0; p < plan_->bodies; ++p) sum -= mass_[at(p)] * dot(g, ground_frame(pose, p).origin());
  for_each_list(plan_->forces, [&](const auto& block, int) {
    using E = typename std::remove_cvref_t<decltype(block)>::Element;
    sum += ForceOperations<E>::potential(block, std::get<ForceData<E>>(forces_), pose);
  });
  return sum;
}

double Equations::dissipation(const MovingPose& moving) const {
  double sum = 0;
  for_each_list(plan_->forces, [&](const auto& block, int) {
    using E = typename std::remove_cvref_t<decltype(block)>::Element;
    sum += ForceOperations<E>::dissipation(block, std::get<ForceData<E>>(forces_), moving);
  });
  return sum;
}

double Equations::load_power(const MovingPose& moving) const {
  double sum = 0;
  for_each_list(plan_->forces, [&](const auto& block, int) {
    using E = typename std::remove_cvref_t<decltype(block)>::Element;
    sum += ForceOperations<E>::load_power(block, std::get<ForceData<E>>(forces_), moving);
  });
  return sum;
}

bool Equations::conservative() const {
  bool all = true;
  for_each_list(forces_, [&](const auto& data, int) {
    using E = typename std::remove_cvref_t<decltype(data.element)>::value_type;
    all = all && ForceOperations<E>::conservative(data);
  });
  return all;
}

void Equations::add_hessians(const MovingPose& moving, std::span<const double> lambda, Curvature curvature,
                             const HessianSlots& slots, std::span<double> values) const {
  const bool convex = curvature == Curvature::convex;
  for_each_list(plan_->blocks, [&](const auto& block, int type) {
    using E = typename std::remove_cvref_t<decltype(block)>::Element;
    const auto add = [&](bool own, const int* slot, double* out) {
      ConstraintOperations<E>::add_hessians(block, std::get<ConstraintData<E>>(constraints_), moving.pose,
                                            lambda.data(), own, slot, out);
    };
    constexpr auto written = written_hessian<E>();
    add_second_derivatives(written, convex, length_scale_, slots.constraints[at(type)], add, values);
  });
  for_each_list(plan_->forces, [&](const auto& block, int type) {
    using E = typename std::remove_cvref_t<decltype(block)>::Element;
    if (slots.forces[at(type)].empty()) return;
    const auto add = [&](bool own, const int* slot, double* out) {
      ForceOperations<E>::add_stiffness(block, std::get<ForceData<E>>(forces_), moving, own, slot, out);
    };
    constexpr auto written = written_stiffness<E>();
    add_second_derivatives(written, convex, length_scale_, slots.forces[at(type)], add, values);
  });
}

}  // namespace catena
