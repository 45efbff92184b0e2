// Evaluation of laws of state: their values, derivatives and effects.
#include <cmath>

#include "catena/assembly/equations.hpp"
#include "catena/assembly/law_values.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

using D6 = Dual<double, 6>;

/// A pose and its velocities in plain numbers.
class PlainState {
 public:
  PlainState(const Equations& equations, const Pose& pose, std::span<const double> qd)
      : equations_(equations), pose_(pose), qd_(qd) {}

  double time() const { return pose_.time; }
  Frame<double> frame(int plan_body) const { return equations_.ground_frame(pose_, plan_body); }
  Twist<double> twist(int plan_body) const {
    if (qd_.empty()) return {};
    const double* v = &qd_[at(3 * plan_body)];
    return {v[0], v[1], v[2]};
  }
  double function(int number) const { return pose_.functions[at(number)].f; }

 private:
  const Equations& equations_;
  const Pose& pose_;
  std::span<const double> qd_;
};

/// The same with the coordinates of one body as variables 0 ... 2 and their rates as variables 3 ... 5.
class SeededState {
 public:
  SeededState(const PlainState& state, int body) : state_(state), body_(body) {}

  D6 time() const { return state_.time(); }
  Frame<D6> frame(int plan_body) const {
    const Frame<double> f = state_.frame(plan_body);
    return plan_body == body_ ? seed<double, 6>(f, 0) : constant_frame<D6>(f);
  }
  Twist<D6> twist(int plan_body) const {
    const Twist<double> v = state_.twist(plan_body);
    if (plan_body != body_) return {D6(v.vx), D6(v.vy), D6(v.omega)};
    return {D6::variable(v.vx, 3), D6::variable(v.vy, 4), D6::variable(v.omega, 5)};
  }
  D6 function(int number) const { return state_.function(number); }

 private:
  const PlainState& state_;
  int body_;
};

}  // namespace

double Equations::law_value(const Pose& pose, int law, std::span<const double> qd) const {
  const PlainState state(*this, pose, qd);
  return LawValues<double, double, PlainState>(*model_, laws_, state).value(law);
}

std::array<double, 6> Equations::law_gradient(const Pose& pose, int law, int body, std::span<const double> qd) const {
  const PlainState plain(*this, pose, qd);
  const SeededState state(plain, body);
  return LawValues<D6, double, SeededState>(*model_, laws_, state).value(law).d;
}

const NamedTable<double>* Equations::left_table(const Pose& pose, int law, std::span<const double> qd,
                                                double& where) const {
  const PlainState state(*this, pose, qd);
  const LawValues<double, double, PlainState> values(*model_, laws_, state);
  const CompiledLaw<double>& compiled = laws_[at(law)];
  const NamedTable<double>* left = nullptr;
  compiled.formula.evaluate_with([&](std::uint32_t k) { return values.input(compiled.inputs[k]); },
                                 [&](const NamedTable<double>& table, double x) {
                                   const Spline<double>& curve = table.curve;
                                   // What iterations and interpolation leave on a place that is exactly an end.
                                   const double rounding = 1e-9 * (curve.last() - curve.first());
                                   const bool outside = x < curve.first() - rounding || x > curve.last() + rounding;
                                   if (!left && outside && !curve.covers(x)) {
                                     left = &table;
                                     where = x;
                                   }
                                   return curve.evaluate(x).f;
                                 });
  return left;
}

void Equations::law_values(const Pose& pose, std::span<const double> qd, std::span<double> out) const {
  for (std::size_t k = 0; k < laws_.size(); ++k) out[k] = law_value(pose, static_cast<int>(k), qd);
}

int Equations::law_without_value(std::span<const double> laws) const {
  int found = -1;
  for_each_list(forces_, [&](const auto& data, int) {
    for (const auto& lawful : data.lawful) {
      if (found < 0 && !std::isfinite(laws[at(lawful.law)])) found = lawful.law;
    }
  });
  return found;
}

std::span<const double> Equations::rates(const MovingPose& moving) const {
  return {moving.qd, moving.qd ? at(plan_->coordinates()) : 0};
}

std::array<double, 6> Equations::law_effect(const MovingPose& moving, int law) const {
  std::array<double, 6> effect{};
  const CompiledLaw<double>& compiled = laws_[at(law)];
  const int e = place(compiled.element);
  if (e < 0) return effect;
  with_list(plan_->forces, model_->elements[at(compiled.element)].type, [&](const auto& block) {
    using E = typename std::remove_cvref_t<decltype(block)>::Element;
    effect = ForceOperations<E>::by_function(block, std::get<ForceData<E>>(forces_), moving, e, compiled.place);
  });
  return effect;
}

}  // namespace catena
