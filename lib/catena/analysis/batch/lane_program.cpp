#include "catena/analysis/batch/lane_program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "catena/analysis/batch/lane_lists.hpp"
#include "catena/analysis/run/watched_elements.hpp"
#include "catena/base/at.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/rope_routes.hpp"

namespace catena {
namespace {

#define CATENA_LANE_IS(Type) || std::is_same_v<E, Type<double>>
template <class E>
inline constexpr bool in_lanes = false CATENA_LANE_ELEMENTS(CATENA_LANE_IS);
template <class E>
inline constexpr bool force_in_lanes = false CATENA_LANE_FORCES(CATENA_LANE_IS);
#undef CATENA_LANE_IS

// Whether kernels have formulas for all forces of a model.
bool are_in_lanes(const Model& model) {
  bool all = model.laws.empty();
  for_each_list(model.forces, [&](const auto& list, int) {
    using E = ElementOf<decltype(list)>;
    if (!force_in_lanes<E>) all = all && list.empty();
    if constexpr (requires(const E& element) { element.curve; }) {
      for (const auto& entry : list) all = all && !entry.element.curve;
    }
  });
  return all;
}

// Dense algebra in lanes pays up to here: a plan of twelve bodies.
constexpr int most_static_columns = 36;

/// Empty, or what lanes do not do for any purpose.
std::string obstacle_in(const Plan& plan, const Evaluator& evaluator) {
  if (!plan.contiguous) return "it has particles, which are not computed in lanes";
  if (WatchedElements(evaluator).has_ends())
    return "it has curves or tables that end, which are watched along the motion";
  return {};
}

/// The same for equilibria.
std::string static_obstacle_in(const Plan& plan, const Model& model, const Evaluator& evaluator) {
  if (!plan.gap_rows.empty()) return "it has one-sided elements, which lanes do not open and close";
  if (plan.columns != 3 * plan.moving) return "some of its bodies have fewer than three coordinates";
  if (plan.columns == 0 || plan.columns > most_static_columns)
    return fmt::format("it has {} coordinates: lanes find equilibria with up to {}", plan.columns, most_static_columns);
  if (plan.rows > plan.columns)
    return fmt::format("it has {} equations for {} coordinates, some of them redundant", plan.rows, plan.columns);
  if (!are_in_lanes(model)) return "it has forces that lanes have no potential of";
  if (!evaluator.conservative()) return "some of its forces have no potential";
  if (!rope_routes(model).empty()) return "it has ropes over pulleys, whose ways are found pass by pass";
  return {};
}

}  // namespace

std::unique_ptr<const LaneProgram> LaneProgram::make_static(const Model& model, std::shared_ptr<const Plan> plan,
                                                            std::string& why_not) {
  std::unique_ptr<LaneProgram> program(new LaneProgram);
  program->plan_ = std::move(plan);
  program->has_loads_ = true;
  EvaluationWork work;
  const Evaluator evaluator(program->plan_, model, work);
  why_not = obstacle_in(*program->plan_, evaluator);
  if (why_not.empty()) why_not = static_obstacle_in(*program->plan_, model, evaluator);
  if (!why_not.empty() || !program->list_elements(model, why_not)) return nullptr;
  if (!program->searched_row_.empty()) {
    why_not = "it has contacts of curves, whose equilibria are not found in lanes";
    return nullptr;
  }
  program->elimination_.initial = program->constant_entries();
  program->list_forces(model);
  program->list_masses();
  program->close();
  return program;
}

std::unique_ptr<const LaneProgram> LaneProgram::make(const Model& model, std::shared_ptr<const Plan> plan, bool loads,
                                                     std::string& why_not) {
  if (loads && !model.frictions().empty()) {
    why_not = "it has joints with friction, which is found together with their reactions";
    return nullptr;
  }
  std::unique_ptr<LaneProgram> program(new LaneProgram);
  program->plan_ = std::move(plan);
  program->has_loads_ = loads;
  const Plan& p = *program->plan_;
  if (p.rows != p.columns || p.columns == 0) {
    why_not = fmt::format(
        "it has {} equations for {} coordinates: only mechanisms whose drivers and constraints determine the motion, "
        "none of them redundant, are computed in lanes",
        p.rows, p.columns);
    return nullptr;
  }
  EvaluationWork work;
  why_not = obstacle_in(p, Evaluator(program->plan_, model, work));
  if (!why_not.empty()) return nullptr;
  program->is_watched_ = !rope_routes(model).empty() || !model.laws.empty();
  program->takes_forces_ = loads && !are_in_lanes(model);
  if (!program->list_elements(model, why_not) || !program->list_steps(model, why_not)) return nullptr;
  if (loads && !program->takes_forces_) program->list_forces(model);
  if (loads) program->list_masses();
  program->close();
  return program;
}

bool LaneProgram::list_elements(const Model& model, std::string& why_not) {
  const Plan& plan = *plan_;
  for_each_list(plan.blocks, [&](const auto& block, int) {
    using E = typename std::remove_cvref_t<decltype(block)>::Element;
    if (in_lanes<E> || LaneSearchedElements::has<E> || block.size() == 0 || !why_not.empty()) return;
    const int row = Joining<E> ? block.row(0) : block.first_row;
    const int element = plan.row_element[at(row)];
    why_not = fmt::format("{} \"{}\" is of a type that is not computed in lanes", model.element_type(element),
                          model.element_name(element));
  });
  if (!why_not.empty()) return false;
  has_immobile_ = plan.moving < plan.bodies;
  int type = 0;
  for_each_lane_type(plan, model, [&](const auto& block, const auto& list) {
    using E = ElementOf<decltype(list)>;
    if (block.size() > 0) of_type_.push_back({static_cast<LaneType>(type), block.size()});
    ++type;
    constexpr int varying = varying_entries<E>();
    for (int e = 0; e < block.size(); ++e) {
      const auto& entry = list[at(block.entry[at(e)])];
      LaneElement lane{block.row(e),
                       block.body_i[at(e)],
                       block.body_j[at(e)],
                       fields_,
                       -1,
                       -1,
                       static_cast<int>(slot_.size()),
                       choice(entry.element),
                       false};
      visit_numbers(entry.element, [&](double, bool) { ++fields_; });
      if constexpr (HasSquaredValue<E>) lane.scale = fields_++;
      if constexpr (E::functions > 0) {
        lane.function = functions_;
        lane.timed = entry.values[0].function >= 0;
        if (lane.timed) timed_.push_back({functions_, entry.values[0].function});
        functions_ += 3;
      }
      slot_.insert(slot_.end(), block.slot.begin() + e * varying, block.slot.begin() + (e + 1) * varying);
      element_.push_back(lane);
    }
    constant_slot_.insert(constant_slot_.end(), block.constant_slot.begin(), block.constant_slot.end());
    constant_.insert(constant_.end(), block.constant.begin(), block.constant.end());
  });
  list_searched(model);
  return true;
}

void LaneProgram::list_searched(const Model& model) {
  std::size_t type = 0;
  LaneSearchedElements::for_each([&]<class E>(std::type_identity<E>) {
    std::vector<LaneSearched>& searched = searched_.of_type[type++];
    const auto& block = std::get<ConstraintBlock<E>>(plan_->blocks);
    const auto& list = std::get<std::vector<ElementEntry<E, double>>>(model.constraints);
    static_assert(E::rows == 1 && varying_entries<E>() == 6 && E::functions == 0);
    for (int e = 0; e < block.size(); ++e) {
      const auto& entry = list[at(block.entry[at(e)])];
      LaneSearched code{block.row(e), block.body_i[at(e)], block.body_j[at(e)], {}, block.entry[at(e)], entry.id};
      std::copy_n(block.slot.begin() + 6 * e, 6, code.slot);
      searched.push_back(code);
      searched_row_.push_back(code.row);
    }
  });
}

void LaneProgram::list_forces(const Model& model) {
  int type = 0;
  for_each_lane_force(*plan_, model, [&](const auto& block, const auto& list) {
    using E = ElementOf<decltype(list)>;
    if (block.size() > 0) of_force_type_.push_back({static_cast<LaneForceType>(type), block.size()});
    ++type;
    for (int e = 0; e < block.size(); ++e) {
      const auto& entry = list[at(block.entry[at(e)])];
      force_.push_back({block.body_i[at(e)], block.body_j[at(e)], fields_, E::functions > 0 ? functions_ : -1,
                        choice(entry.element)});
      visit_numbers(entry.element, [&](double, bool) { ++fields_; });
      for (std::size_t k = 0; k < entry.values.size(); ++k, functions_ += 3) {
        if (entry.values[k].function >= 0) timed_.push_back({functions_, entry.values[k].function});
      }
    }
  });
}

void LaneProgram::list_masses() {
  code_.loads.masses = fields_;
  code_.loads.gravity = fields_ + 2 * plan_->moving;
  fields_ = code_.loads.gravity + 2;
}

// Of every slot of the plan.
std::vector<double> LaneProgram::constant_entries() const {
  std::vector<double> constant(at(plan_->trash_slot()) + 1, 0.0);
  for (std::size_t k = 0; k < constant_.size(); ++k) constant[at(constant_slot_[k])] += constant_[k];
  return constant;
}

bool LaneProgram::list_steps(const Model& model, std::string& why_not) {
  std::vector<int> varying = slot_;
  for (const auto& type : searched_.of_type) {
    for (const LaneSearched& code : type) varying.insert(varying.end(), std::begin(code.slot), std::end(code.slot));
  }
  return elimination_.choose(*plan_, model, varying, constant_entries(), why_not);
}

void LaneProgram::close() {
  const LaneElimination& e = elimination_;
  code_.moving = plan_->moving;
  code_.frames = plan_->bodies + 1;
  code_.rows = plan_->rows;
  code_.slots = static_cast<int>(e.initial.size());
  code_.element = element_.data();
  code_.of_type = of_type_.data();
  code_.types = static_cast<int>(of_type_.size());
  for (const int slot : slot_) place_.push_back(lane_count * slot);
  code_.place = place_.data();
  code_.factor = e.factor.data();
  code_.factor_runs = static_cast<int>(e.factor.size());
  code_.solve = e.solve.data();
  code_.solve_runs = static_cast<int>(e.solve.size());
  code_.transposed = e.transposed.data();
  code_.transposed_runs = static_cast<int>(e.transposed.size());
  code_.loads.force = force_.data();
  code_.loads.of_type = of_force_type_.data();
  code_.loads.types = static_cast<int>(of_force_type_.size());
  code_.step = e.step.data();
  code_.reset = e.reset.data();
  code_.resets = static_cast<int>(e.reset.size());
  code_.tail = e.tail.data();
  code_.tails = static_cast<int>(e.tail.size());
  code_.unknown = e.unknown.data();
  code_.lengths = e.lengths;
  code_.searched = searched_row_.data();
  code_.searched_rows = static_cast<int>(searched_row_.size());
}

}  // namespace catena
