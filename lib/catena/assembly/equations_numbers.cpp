// The numbers of a model in the order of its plan, and the poses that are made from them.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "catena/assembly/curve_contacts.hpp"
#include "catena/assembly/equations.hpp"
#include "catena/assembly/length_scale.hpp"
#include "catena/assembly/same_structure.hpp"
#include "catena/base/at.hpp"
#include "catena/elements/all.hpp"

namespace catena {
namespace {

// Calls f(block, data, list) for every constraint type.
template <class Blocks, class Values, class Lists, class F>
void for_each_block(Blocks& blocks, Values& values, Lists& lists, F&& f) {
  for_each_list(lists, [&](auto& list, int) {
    using E = ElementOf<decltype(list)>;
    f(std::get<ConstraintBlock<E>>(blocks), std::get<ConstraintData<E>>(values), list);
  });
}

// A function's value; before a table begins its first one, after it ends its last.
Taylor<double> value_near(const TimeFunction<double>& function, double t) {
  const TimeRange domain = function.domain();
  return function.evaluate(std::clamp(t, domain.first, domain.last));
}

// Per weld: whether it joins two bodies that stay apart, since it has equations or is released.
std::vector<char> kept_welds(const Model& model, const Plan& plan) {
  std::vector<char> kept;
  for (const auto& weld : std::get<std::vector<ElementEntry<Weld<double>, double>>>(model.constraints))
    kept.push_back(plan.element_row[at(weld.id)] >= 0 || plan.is_released(weld.id));
  return kept;
}

// The shift of frames to a common origin, that of a body that moves: the sum of the other one is a constant.
template <class E, class Shift>
void set_shift(Shift& shift, int body_i, int body_j, std::span<const Vec2<double>> origin, int moving) {
  const Vec2<double> oi = origin[at(body_i)], oj = origin[at(body_j)];
  if constexpr (E::bodies == 1) {
    shift.i = oi;
  } else if (body_i >= moving) {
    shift = {oi - oj, {}};
  } else {
    shift = {{}, oj - oi};
  }
}

template <class Block, class Data, class List>
void load_constraints(const Block& block, Data& data, const List& list, std::span<const Vec2<double>> origin,
                      int moving) {
  using E = ElementOf<decltype(list)>;
  const std::size_t n = at(block.size());
  data.element.resize(n);
  data.shift.resize(n);
  data.timed.clear();
  if constexpr (HasSquaredValue<E>) data.scale.assign(n, 1.0);
  for (std::size_t e = 0; e < n; ++e) {
    const auto& entry = list[at(block.entry[e])];
    data.element[e] = entry.element;
    set_shift<E>(data.shift[e], block.body_i[e], block.body_j[e], origin, moving);
    if constexpr (E::functions > 0) {
      if (entry.values[0].function >= 0) data.timed.push_back({static_cast<int>(e), entry.values[0].function});
    }
  }
}

template <class Block, class Data, class List>
void load_forces(const Block& block, Data& data, const List& list, std::span<const Vec2<double>> origin, int moving) {
  using E = ElementOf<decltype(list)>;
  const std::size_t n = at(block.size()), functions = at(E::functions);
  data.element.resize(n);
  data.shift.resize(n);
  data.timed.clear();
  data.lawful.clear();
  data.law.clear();
  data.supplied.clear();
  for (std::size_t e = 0; e < n; ++e) {
    const auto& entry = list[at(block.entry[e])];
    data.element[e] = entry.element;
    set_shift<E>(data.shift[e], block.body_i[e], block.body_j[e], origin, moving);
    for (std::size_t k = 0; k < functions; ++k) {
      const auto& value = entry.values[k];
      const int place = static_cast<int>(e * functions + k);
      if (value.function >= 0) data.timed.push_back({place, value.function});
      if (value.law >= 0) data.lawful.push_back({place, value.law});
    }
    const auto given = [](const auto& value) { return value.function >= 0 || value.law >= 0; };
    if (is_conservative(entry.element) && std::any_of(entry.values.begin(), entry.values.end(), given))
      data.supplied.push_back(static_cast<int>(e));
  }
  if (!data.lawful.empty()) data.law.assign(n * functions, -1);
  for (const auto& lawful : data.lawful) data.law[at(lawful.place)] = lawful.law;
}

}  // namespace

Equations::Equations(const Equations&) = default;
Equations::Equations(Equations&&) noexcept = default;
Equations& Equations::operator=(const Equations&) = default;
Equations& Equations::operator=(Equations&&) noexcept = default;
Equations::~Equations() = default;

Equations::Equations(std::shared_ptr<const Plan> plan, const Model& model) : plan_(std::move(plan)), model_(&model) {
  if (!plan_) throw std::invalid_argument("an evaluator needs a plan, and was given a null pointer");
  require_same_count(plan_->plan_body.size(), model.bodies.size(), "bodies");
  require_same_count(plan_->element_row.size(), model.elements.size(), "elements");
  place_.assign(model.elements.size(), -1);
  for_each_block(plan_->blocks, constraints_, model.constraints, [&](const auto& block, auto&, const auto& list) {
    for (int e = 0; e < block.size(); ++e) place_[at(list[at(block.entry[at(e)])].id)] = e;
  });
  for_each_list(model.forces, [&](const auto& list, int) {
    const auto& block = std::get<ForceBlock<ElementOf<decltype(list)>>>(plan_->forces);
    for (int e = 0; e < block.size(); ++e) place_[at(list[at(block.entry[at(e)])].id)] = e;
  });
  load_numbers(0);
}

void Equations::set_model(const Model& model, double time) {
  require_same_structure(*model_, model, *plan_);
  model_ = &model;
  load_numbers(time);
}

void Equations::load_numbers(double time) {
  const Elimination given = eliminate_bodies(*model_, kept_welds(*model_, *plan_));
  mass_.resize(at(plan_->bodies));
  origin_.assign(at(plan_->bodies) + 1, {});
  fixed_.assign(at(plan_->bodies - plan_->moving) + 1, {});
  for (int p = 0; p < plan_->bodies; ++p) {
    const std::size_t body = at(plan_->model_body[at(p)]);
    mass_[at(p)] = model_->bodies[body].mass;
    // Places are relative to where the body was given.
    Frame<double> pose = given.pose[body];
    origin_[at(p)] = pose.origin();
    pose.x = pose.y = 0;
    if (p >= plan_->moving) fixed_[at(p - plan_->moving)] = pose;
  }
  for_each_block(plan_->blocks, constraints_, model_->constraints,
                 [&](const auto& block, auto& data, const auto& list) {
                   load_constraints(block, data, list, origin_, plan_->moving);
                 });
  for_each_list(model_->forces, [&](const auto& list, int) {
    using E = ElementOf<decltype(list)>;
    load_forces(std::get<ForceBlock<E>>(plan_->forces), std::get<ForceData<E>>(forces_), list, origin_, plan_->moving);
  });
  laws_ = compile_laws<double>(*model_, model_->laws, *plan_);
  attachment_radii(&length_scale_);
  if (length_scale_ == 0) length_scale_ = length_without_joints(*model_);
  scale_squared_forms(time);
}

void Equations::scale_squared_forms(double time) {
  for_each_block(
      plan_->blocks, constraints_, model_->constraints, [&](const auto& block, auto& data, const auto& list) {
        if constexpr (HasSquaredValue<ElementOf<decltype(list)>>) {
          for (std::size_t e = 0; e < data.scale.size(); ++e) {
            const auto& value = list[at(block.entry[e])].values[0];
            const double c = std::abs(value.function < 0 ? value.constant
                                                         : value_near(model_->functions[at(value.function)], time).f);
            data.scale[e] = 0.5 / (c > 0 ? c : length_scale_);
          }
        }
      });
}

std::vector<double> Equations::given_configuration() const {
  std::vector<double> q(at(plan_->coordinates()), 0.0);
  for (int p = 0; p < plan_->bodies; ++p) {
    const bool solved = p < plan_->moving;
    q[at(3 * p + 2)] = solved ? model_->bodies[at(plan_->model_body[at(p)])].angle : fixed_[at(p - plan_->moving)].phi;
  }
  return q;
}

Pose Equations::given_pose() const {
  Pose pose;
  pose.starts.resize(at(plan_->in_pose.contacts));
  take_given_contacts(*plan_, model_->constraints, pose.starts);
  place_bodies(pose);
  pose.contacts = pose.starts;
  return pose;
}

void Equations::renew(Pose& pose) const {
  place_bodies(pose);
  find_contacts(pose);
}

void Equations::place_bodies(Pose& pose) const {
  pose.frames.resize(at(plan_->bodies) + 1);
  for (int p = 0; p < plan_->moving; ++p) {
    Frame<double>& frame = pose.frames[at(p)];
    frame = model_->frame(plan_->model_body[at(p)]);
    frame.x = frame.y = 0;
  }
  std::copy(fixed_.begin(), fixed_.end(), pose.frames.begin() + plan_->moving);
  pose.stretches.assign(at(std::get<ForceBlock<ElasticRope<double>>>(plan_->forces).size()), {});
  pose.functions.resize(model_->functions.size());
  // Until an analysis sets its time.
  for (std::size_t k = 0; k < pose.functions.size(); ++k)
    pose.functions[k] = value_near(model_->functions[k], pose.time);
  spread_constants(pose);
  spread_functions(pose);
}

void Equations::spread_constants(Pose& pose) const {
  pose.values.resize(at(plan_->in_pose.values));
  for_each_list(plan_->blocks, model_->constraints, [&](const auto& block, const auto& list, int) {
    if constexpr (ElementOf<decltype(list)>::functions > 0) {
      for (int e = 0; e < block.size(); ++e)
        pose.values[at(block.first_value + e)] = {list[at(block.entry[at(e)])].values[0].constant, 0, 0};
    }
  });
  pose.load_rates.assign(at(plan_->in_pose.loads), 0.0);
  pose.loads.resize(at(plan_->in_pose.loads));
  for_each_list(plan_->forces, model_->forces, [&](const auto& block, const auto& list, int) {
    auto next = pose.loads.begin() + block.first_value;
    for (int k : block.entry) {
      for (const auto& value : list[at(k)].values) *next++ = value.law < 0 ? value.constant : 0;
    }
  });
}

}  // namespace catena
