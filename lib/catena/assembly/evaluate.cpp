#include "catena/assembly/evaluate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "catena/assembly/curve_contacts.hpp"
#include "catena/assembly/length_scale.hpp"
#include "catena/assembly/same_structure.hpp"
#include "catena/base/at.hpp"
#include "catena/base/sincos.hpp"
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

// The same for those that have elements.
template <class Blocks, class Values, class Lists, class F>
void for_each_present_block(Blocks& blocks, Values& values, Lists& lists, F&& f) {
  for_each_block(blocks, values, lists, [&](auto& block, auto& data, auto& list) {
    if (block.size() > 0) f(block, data, list);
  });
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
  if constexpr (E::functions > 0) data.value.resize(n);
  if constexpr (HasSquaredValue<E>) data.scale.assign(n, 1.0);
  for (std::size_t e = 0; e < n; ++e) {
    const auto& entry = list[at(block.entry[e])];
    data.element[e] = entry.element;
    set_shift<E>(data.shift[e], block.body_i[e], block.body_j[e], origin, moving);
    if constexpr (E::functions > 0) {
      data.value[e] = {entry.values[0].constant, 0, 0};
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
  data.value.resize(n * functions);
  data.rate.assign(n * functions, 0.0);
  data.timed.clear();
  data.lawful.clear();
  data.by_law.clear();
  data.supplied.clear();
  for (std::size_t e = 0; e < n; ++e) {
    const auto& entry = list[at(block.entry[e])];
    data.element[e] = entry.element;
    set_shift<E>(data.shift[e], block.body_i[e], block.body_j[e], origin, moving);
    for (std::size_t k = 0; k < functions; ++k) {
      const auto& value = entry.values[k];
      const int place = static_cast<int>(e * functions + k);
      data.value[at(place)] = value.constant;
      if (value.function >= 0) data.timed.push_back({place, value.function});
      if (value.law >= 0) data.lawful.push_back({place, value.law});
    }
    const auto given = [](const auto& value) { return value.function >= 0 || value.law >= 0; };
    if (is_conservative(entry.element) && std::any_of(entry.values.begin(), entry.values.end(), given))
      data.supplied.push_back(static_cast<int>(e));
  }
  if (!data.lawful.empty()) data.by_law.assign(n * functions, 0);
  for (const auto& lawful : data.lawful) data.by_law[at(lawful.place)] = 1;
}

}  // namespace

Evaluator::Evaluator(const Evaluator&) = default;
Evaluator::Evaluator(Evaluator&&) noexcept = default;
Evaluator& Evaluator::operator=(const Evaluator&) = default;
Evaluator& Evaluator::operator=(Evaluator&&) noexcept = default;
Evaluator::~Evaluator() = default;

Evaluator::Evaluator(std::shared_ptr<const Plan> plan, const Model& model) : plan_(std::move(plan)), model_(&model) {
  if (!plan_) throw std::invalid_argument("an evaluator needs a plan, and was given a null pointer");
  require_same_count(plan_->plan_body.size(), model.bodies.size(), "bodies");
  require_same_count(plan_->element_row.size(), model.elements.size(), "elements");
  place_.assign(model.elements.size(), -1);
  for_each_block(plan_->blocks, values_, model.constraints, [&](const auto& block, auto&, const auto& list) {
    for (int e = 0; e < block.size(); ++e) place_[at(list[at(block.entry[at(e)])].id)] = e;
  });
  for_each_list(model.forces, [&](const auto& list, int) {
    const auto& block = std::get<ForceBlock<ElementOf<decltype(list)>>>(plan_->forces);
    for (int e = 0; e < block.size(); ++e) place_[at(list[at(block.entry[at(e)])].id)] = e;
  });
  starts_.resize(at(plan_->contacts));
  load_values();
  take_given_contacts(*plan_, model.constraints, starts_);
  contacts_ = starts_;
}

void Evaluator::set_model(const Model& model) {
  require_same_structure(*model_, model, *plan_);
  model_ = &model;
  load_values();
  find_contacts();
}

void Evaluator::load_values() {
  const Elimination given = eliminate_bodies(*model_, kept_welds(*model_, *plan_));
  mass_.resize(at(plan_->bodies));
  origin_.assign(at(plan_->bodies) + 1, {});
  frames_.assign(at(plan_->bodies) + 1, {});
  for (int p = 0; p < plan_->bodies; ++p) {
    const std::size_t body = at(plan_->model_body[at(p)]);
    mass_[at(p)] = model_->bodies[body].mass;
    // Places are relative to where the body was given.
    Frame<double> pose = given.pose[body];
    origin_[at(p)] = pose.origin();
    pose.x = pose.y = 0;
    frames_[at(p)] = pose;
  }
  for_each_block(plan_->blocks, values_, model_->constraints, [&](const auto& block, auto& data, const auto& list) {
    load_constraints(block, data, list, origin_, plan_->moving);
  });
  for_each_list(model_->forces, [&](const auto& list, int) {
    using E = ElementOf<decltype(list)>;
    load_forces(std::get<ForceBlock<E>>(plan_->forces), std::get<ForceData<E>>(force_values_), list, origin_,
                plan_->moving);
  });
  laws_ = compile_laws<double>(*model_, model_->laws, *plan_);
  attachment_radii(&length_scale_);
  if (length_scale_ == 0) length_scale_ = length_without_joints(*model_);
  function_.resize(model_->functions.size());
  // Until an analysis sets its time; tables that begin later give their first value.
  for (std::size_t k = 0; k < function_.size(); ++k) {
    const TimeRange domain = model_->functions[k].domain();
    function_[k] = model_->functions[k].evaluate(std::clamp(time_, domain.first, domain.last));
  }
  spread_functions();
  // Squared forms are scaled once, by the value at the start, to rows that measure a length.
  for_each_list(values_, [&](auto& data, int) {
    for (std::size_t e = 0; e < data.scale.size(); ++e) {
      const double c = std::abs(data.value[e].f);
      data.scale[e] = 0.5 / (c > 0 ? c : length_scale_);
    }
  });
}

std::vector<double> Evaluator::given_configuration() const {
  std::vector<double> q(at(plan_->coordinates()), 0.0);
  for (int p = 0; p < plan_->bodies; ++p) {
    const bool solved = p < plan_->moving;
    q[at(3 * p + 2)] = solved ? model_->bodies[at(plan_->model_body[at(p)])].angle : frames_[at(p)].phi;
  }
  return q;
}

void Evaluator::set_time(double t, Side side) {
  if (t < run_.first) return set_time_along(t, run_.first);
  if (t > run_.last) return set_time_along(t, run_.last);
  time_ = t;
  if (model_->functions.empty()) return;
  for (std::size_t k = 0; k < function_.size(); ++k) function_[k] = model_->functions[k].evaluate(t, side);
  spread_functions();
}

void Evaluator::set_time_along(double t, double from) {
  time_ = t;
  if (model_->functions.empty()) return;
  from = std::clamp(from, run_.first, run_.last);
  // At the end of a run the piece that holds before it, everywhere else the one that begins.
  const Side side = from == run_.last && run_.first < run_.last ? Side::before : Side::after;
  for (std::size_t k = 0; k < function_.size(); ++k) function_[k] = model_->functions[k].continue_from(from, side, t);
  spread_functions();
}

void Evaluator::spread_functions() {
  for_each_list(values_, [&](auto& data, int) {
    for (const auto& timed : data.timed) data.value[at(timed.element)] = function_[at(timed.function)];
  });
  for_each_list(force_values_, [&](auto& data, int) {
    for (const auto& timed : data.timed) {
      data.value[at(timed.place)] = function_[at(timed.function)].f;
      data.rate[at(timed.place)] = function_[at(timed.function)].d;
    }
  });
}

void Evaluator::set_configuration(std::span<const double> q) {
  ++counters.configurations;
  update_frames(q.first(at(3 * plan_->moving)), std::span(frames_).first(at(plan_->moving)));
  for (std::size_t b = 0; b < turns_.size(); ++b) frames_[b].phi += turns_[b] * (2 * std::numbers::pi);
  stretch_ropes();
  if (!starts_.empty()) {
    follow(starts_);
    contacts_ = starts_;
  }
}

void Evaluator::take_turns(std::span<double> q) {
  constexpr double low_part = 2.4492935982947064e-16;  // of 2 pi, below the double
  turns_.reserve(at(plan_->moving));                   // now, not in the middle of a run
  for (int b = 0; b < plan_->moving; ++b) {
    double& angle = q[at(3 * b + 2)];
    if (!(std::abs(angle) > 1.5 * std::numbers::pi)) continue;
    if (turns_.empty()) turns_.assign(at(plan_->moving), 0);
    const double turns = std::round(angle / (2 * std::numbers::pi));
    if (!(std::abs(turns_[at(b)] + turns) < std::numeric_limits<int>::max())) continue;
    angle = (angle - turns * (2 * std::numbers::pi)) - turns * low_part;
    turns_[at(b)] += static_cast<int>(turns);
  }
}

void Evaluator::add_turns(std::span<double> q) const {
  for (std::size_t b = 0; b < turns_.size(); ++b) q[3 * b + 2] += turns_[b] * (2 * std::numbers::pi);
}

Frame<double> Evaluator::ground_frame(int plan_body) const {
  Frame<double> f = frames_[at(plan_body)];
  f.x += origin_[at(plan_body)].x;
  f.y += origin_[at(plan_body)].y;
  return f;
}

void Evaluator::leave_out(std::span<const int> rows) {
  left_out_.assign(rows.begin(), rows.end());
  left_out_slot_.clear();
  if (rows.empty()) return;
  std::vector<char> is_out(at(plan_->rows), 0);
  for (int r : rows) is_out[at(r)] = 1;
  for (int k = 0; k < plan_->jacobian.entries(); ++k) {
    if (is_out[at(plan_->jacobian.row_index[at(k)])]) left_out_slot_.push_back(k);
  }
}

void Evaluator::phi(std::span<double> out) {
  ++counters.phis;
  for_each_present_block(plan_->blocks, values_, model_->constraints,
                         [&](const auto& block, auto& data, const auto& list) {
                           ConstraintOperations<ElementOf<decltype(list)>>::phi(block, data, pose(), out.data());
                         });
  for (int r : left_out_) out[at(r)] = 0;
}

void Evaluator::start_jacobian(std::span<double> values) const {
  std::fill(values.begin(), values.end(), 0.0);
  for_each_list(plan_->blocks, [&](const auto& block, int) {
    for (std::size_t k = 0; k < block.constant.size(); ++k) values[at(block.constant_slot[k])] += block.constant[k];
  });
}

void Evaluator::jacobian(std::span<double> values) {
  ++counters.jacobians;
  for_each_list(plan_->blocks, [&](const auto& block, int) {
    // They add to what others write.
    if constexpr (Joining<typename std::remove_cvref_t<decltype(block)>::Element>) {
      for (int slot : block.slot) values[at(slot)] = 0;
    }
  });
  for_each_present_block(
      plan_->blocks, values_, model_->constraints, [&](const auto& block, auto& data, const auto& list) {
        ConstraintOperations<ElementOf<decltype(list)>>::jacobian(block, data, pose(), values.data());
      });
  for (int k : left_out_slot_) values[at(k)] = 0;
}

void Evaluator::nu(std::span<double> out) {
  ++counters.nus;
  std::fill(out.begin(), out.end(), 0.0);
  for_each_present_block(plan_->blocks, values_, model_->constraints,
                         [&](const auto& block, auto& data, const auto& list) {
                           ConstraintOperations<ElementOf<decltype(list)>>::nu(block, data, pose(), out.data());
                         });
}

void Evaluator::gamma(std::span<const double> qd, std::span<double> out) {
  ++counters.gammas;
  for_each_present_block(
      plan_->blocks, values_, model_->constraints, [&](const auto& block, auto& data, const auto& list) {
        ConstraintOperations<ElementOf<decltype(list)>>::gamma(block, data, pose(), qd.data(), out.data());
      });
}

}  // namespace catena
