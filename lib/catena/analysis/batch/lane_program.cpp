#include "catena/analysis/batch/lane_program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

#include "catena/base/at.hpp"
#include "catena/elements/all.hpp"
#include "catena/linalg/factorization/factorization.hpp"
#include "catena/model/rope_routes.hpp"

namespace catena {
namespace {

#define CATENA_LANE_IS(Type) || std::is_same_v<E, Type<double>>
template <class E>
inline constexpr bool in_lanes = false CATENA_LANE_ELEMENTS(CATENA_LANE_IS);
#undef CATENA_LANE_IS

/// Calls f(number, is_place) for every parameter of an element, in the order in which kernels read them. `is_place`: of
/// a point or an axis; others may be missing.
template <class E, class F>
void visit_numbers(const E& element, F&& f) {
  std::apply(
      [&](const auto&... field) {
        const auto visit = [&](const auto& one) {
          if constexpr (requires { one.member; }) {
            const auto& member = element.*one.member;
            if constexpr (requires { member.x; }) {
              f(member.x, true);
              f(member.y, true);
            } else {
              f(member, false);
            }
          }
        };
        (visit(field), ...);
      },
      E::fields());
  if constexpr (requires { element.angle; }) f(element.angle, true);
}

/// Calls f(block, list) for the types of lanes, in their order.
template <class F>
void for_each_lane_type(const Plan& plan, const Model& model, F&& f) {
#define CATENA_LANE_CALL(Type)                            \
  f(std::get<ConstraintBlock<Type<double>>>(plan.blocks), \
    std::get<std::vector<ElementEntry<Type<double>, double>>>(model.constraints));
  CATENA_LANE_ELEMENTS(CATENA_LANE_CALL)
#undef CATENA_LANE_CALL
}

/// One diagonal block while its pivots are chosen.
class BlockElimination {
 public:
  struct Cell {
    int slot;
    double constant;  // of an entry that is +1 or -1 whatever the design; else 0
  };
  std::vector<int> rows, columns;
  std::map<std::pair<int, int>, Cell> cells;

  /// The constant entry of least fill-in; false if there is none.
  bool choose(int& row, int& column) const {
    int least = -1;
    for (const auto& [place, cell] : cells) {
      if (cell.constant == 0 || !has(rows, place.first) || !has(columns, place.second)) continue;
      const int fill = (count_in_row(place.first) - 1) * (count_in_column(place.second) - 1);
      if (least >= 0 && fill >= least) continue;
      least = fill;
      row = place.first;
      column = place.second;
    }
    return least >= 0;
  }
  Cell* find(int row, int column) {
    const auto found = cells.find({row, column});
    return found == cells.end() ? nullptr : &found->second;
  }
  const Cell* find(int row, int column) const {
    const auto found = cells.find({row, column});
    return found == cells.end() ? nullptr : &found->second;
  }

 private:
  static bool has(const std::vector<int>& list, int k) { return std::find(list.begin(), list.end(), k) != list.end(); }
  int count_in_row(int row) const {
    return static_cast<int>(std::count_if(columns.begin(), columns.end(), [&](int c) { return find(row, c); }));
  }
  int count_in_column(int column) const {
    return static_cast<int>(std::count_if(rows.begin(), rows.end(), [&](int r) { return find(r, column); }));
  }
};

}  // namespace

std::unique_ptr<const LaneProgram> LaneProgram::make(const Model& model, std::shared_ptr<const Plan> plan,
                                                     std::string& why_not) {
  if (!rope_routes(model).empty()) {
    why_not = "it has a rope over a pulley, whose way may change along the motion";
    return nullptr;
  }
  if (!model.laws.empty()) {
    why_not = "it has forces by laws of state, which are checked along the motion";
    return nullptr;
  }
  std::unique_ptr<LaneProgram> program(new LaneProgram);
  program->plan_ = std::move(plan);
  const Plan& p = *program->plan_;
  if (p.rows != p.columns || p.columns == 0) {
    why_not = fmt::format(
        "it has {} equations for {} coordinates: only mechanisms whose drivers and constraints determine the motion, "
        "none of them redundant, are computed in lanes",
        p.rows, p.columns);
    return nullptr;
  }
  if (!p.contiguous) {
    why_not = "it has particles, which are not computed in lanes";
    return nullptr;
  }
  if (!program->list_elements(model, why_not) || !program->list_pivots(model, why_not)) return nullptr;
  program->close();
  return program;
}

bool LaneProgram::list_elements(const Model& model, std::string& why_not) {
  const Plan& plan = *plan_;
  for_each_list(plan.blocks, [&](const auto& block, int) {
    using E = typename std::remove_cvref_t<decltype(block)>::Element;
    if (in_lanes<E> || block.size() == 0 || !why_not.empty()) return;
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
    code_.first_of_type[type++] = static_cast<int>(element_.size());
    constexpr int varying = varying_entries<E>();
    for (int e = 0; e < block.size(); ++e) {
      const auto& entry = list[at(block.entry[at(e)])];
      LaneElement lane{
          block.row(e), block.body_i[at(e)], block.body_j[at(e)], fields_, -1, -1, static_cast<int>(slot_.size()),
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
  code_.first_of_type[type] = static_cast<int>(element_.size());
  return true;
}

bool LaneProgram::list_pivots(const Model& model, std::string& why_not) {
  const Plan& plan = *plan_;
  Counters counters;
  Factorization form;
  if (!form.analyze(plan.jacobian, Kernel::klu, counters).ok()) {
    why_not = "its constraints and drivers do not determine all coordinates";
    return false;
  }
  int slots = plan.trash_slot() + 1;
  std::vector<double> constant(at(slots), 0.0);
  for (std::size_t k = 0; k < constant_.size(); ++k) constant[at(constant_slot_[k])] += constant_[k];
  for (const int slot : slot_) constant[at(slot)] = 0;
  std::vector<BlockElimination> blocks(at(form.blocks()));
  for (int c = 0; c < plan.columns; ++c) {
    blocks[at(form.block_of_column()[at(c)])].columns.push_back(c);
    blocks[at(form.block_of_row()[at(c)])].rows.push_back(c);
  }
  std::vector<std::array<int, 3>> outside;  // slot, row, column
  for (int c = 0; c < plan.columns; ++c) {
    for (int k = plan.jacobian.column_start[at(c)]; k < plan.jacobian.column_start[at(c) + 1]; ++k) {
      const int row = plan.jacobian.row_index[at(k)], block = form.block_of_column()[at(c)];
      const double value = std::abs(constant[at(k)]) == 1 ? constant[at(k)] : 0.0;
      if (form.block_of_row()[at(row)] == block)
        blocks[at(block)].cells[{row, c}] = {k, value};
      else
        outside.push_back({k, row, c});
    }
  }
  std::vector<int> row_of(at(plan.columns), -1);  // with the pivot of a column
  for (int b = 0; b < form.blocks(); ++b) {
    BlockElimination& block = blocks[at(b)];
    LaneBlock lane{static_cast<int>(pivot_.size()), 0, -1, 0, 0};
    const std::vector<int> columns = block.columns;
    std::vector<std::vector<int>> right_columns;  // of every pivot
    int row = 0, column = 0;
    while (block.choose(row, column)) {
      std::erase(block.rows, row);
      std::erase(block.columns, column);
      row_of[at(column)] = row;
      LanePivot pivot{row, 0, 0, static_cast<int>(list_.size()), 1 / block.find(row, column)->constant};
      std::vector<int> below, right;
      for (const int r : block.rows) {
        if (const auto* cell = block.find(r, column))
          below.push_back(r), list_.push_back(cell->slot), list_.push_back(r);
      }
      for (const int c : block.columns) {
        // Its row is known once its own pivot is: the column stands here until then.
        if (const auto* cell = block.find(row, c)) right.push_back(c), list_.push_back(cell->slot), list_.push_back(c);
      }
      for (const int r : below) {
        for (const int c : right) {
          auto* cell = block.find(r, c);
          if (!cell) cell = &(block.cells[{r, c}] = {slots++, 0});
          cell->constant = 0;
          list_.push_back(cell->slot);
        }
      }
      pivot.below = static_cast<int>(below.size());
      pivot.right = static_cast<int>(right.size());
      pivot_.push_back(pivot);
      ++lane.pivots;
    }
    const int n = static_cast<int>(block.rows.size());
    if (n > largest_tail) {
      why_not = fmt::format(
          "{} of its bodies hang together so closely that {} equations must be solved at once; lanes solve {}: most "
          "concerned: \"{}\"",
          columns.size() / 3, n, largest_tail, model.element_name(plan.row_element[at(block.rows.front())]));
      return false;
    }
    if (n > 0) {
      LaneTail tail{};
      tail.size = n;
      for (int r = 0; r < n; ++r) {
        tail.row[r] = block.rows[at(r)];
        row_of[at(block.columns[at(r)])] = block.rows[at(r)];
        tail.length_row[r] = !plan.row_is_angle[at(block.rows[at(r)])];
        tail.length_column[r] = plan.coordinate[at(block.columns[at(r)])] % 3 != 2;
        for (int c = 0; c < n; ++c) {
          const auto* cell = block.find(block.rows[at(r)], block.columns[at(c)]);
          tail.slot[n * r + c] = cell ? cell->slot : slots++;
        }
      }
      lane.tail = static_cast<int>(tail_.size());
      tail_.push_back(tail);
    }
    for (const LanePivot* pivot = pivot_.data() + lane.first_pivot; pivot < pivot_.data() + pivot_.size(); ++pivot) {
      int* right = list_.data() + pivot->list + 2 * pivot->below;
      for (int j = 0; j < pivot->right; ++j, right += 2) right[1] = row_of[at(right[1])];
    }
    lane.first_outside = static_cast<int>(outside_.size());
    for (const auto& [slot, outer_row, c] : outside) {
      if (form.block_of_column()[at(c)] != b) continue;
      outside_.insert(outside_.end(), {slot, outer_row, row_of[at(c)]});
      ++lane.outside;
    }
    block_.push_back(lane);
  }
  coordinate_.resize(at(plan.rows));
  for (int c = 0; c < plan.columns; ++c) coordinate_[at(row_of[at(c)])] = plan.coordinate[at(c)];
  code_.slots = slots;
  initial_.assign(at(slots), 0.0);
  for (std::size_t k = 0; k < constant_.size(); ++k) initial_[at(constant_slot_[k])] += constant_[k];
  return true;
}

void LaneProgram::close() {
  code_.moving = plan_->moving;
  code_.frames = plan_->bodies + 1;
  code_.rows = plan_->rows;
  code_.element = element_.data();
  code_.slot = slot_.data();
  code_.initial = initial_.data();
  code_.blocks = static_cast<int>(block_.size());
  code_.tails = static_cast<int>(tail_.size());
  code_.block = block_.data();
  code_.pivot = pivot_.data();
  code_.list = list_.data();
  code_.tail = tail_.data();
  code_.outside = outside_.data();
  code_.coordinate = coordinate_.data();
}

Frame<double> LaneProgram::given_pose(const Model& model, int plan_body) const {
  const auto& body = model.bodies[at(plan_->model_body[at(plan_body)])];
  Frame<double> pose;
  pose.x = body.position.x - code_.origin_x;
  pose.y = body.position.y - code_.origin_y;
  pose.phi = body.angle;
  return pose;
}

bool LaneProgram::put(const Model& model, double length_scale, int lane, LaneNumbers& field, LaneNumbers& function,
                      LaneNumbers& frame) const {
  const Plan& plan = *plan_;
  std::size_t next = 0;
  bool finite = true;
  for_each_lane_type(plan, model, [&](const auto& block, const auto& list) {
    using E = ElementOf<decltype(list)>;
    for (int e = 0; e < block.size(); ++e) {
      const auto& entry = list[at(block.entry[at(e)])];
      const LaneElement& code = element_[next++];
      int place = code.field;
      visit_numbers(entry.element, [&](double number, bool is_place) {
        field[place++][lane] = number;
        finite = finite && (!is_place || std::isfinite(number));
      });
      if constexpr (E::functions > 0) {
        double c = entry.values[0].constant;
        if (code.timed) {
          const auto& law = model.functions[at(entry.values[0].function)];
          c = law.evaluate(std::clamp(0.0, law.domain().first, law.domain().last)).f;
        }
        if constexpr (HasSquaredValue<E>)
          field[code.scale][lane] = 0.5 / (std::abs(c) > 0 ? std::abs(c) : length_scale);
        function[code.function][lane] = c;
        finite = finite && std::isfinite(c);
      }
    }
  });
  const auto put_frame = [&](int number, const Frame<double>& pose) {
    const double values[] = {pose.x - code_.origin_x, pose.y - code_.origin_y, pose.phi, pose.c, pose.s};
    for (int k = 0; k < 5; ++k) frame[5 * number + k][lane] = values[k];
  };
  put_frame(plan.bodies, {});
  if (!has_immobile_) return finite;
  std::vector<char> keep_weld;
  for (const auto& weld : std::get<std::vector<ElementEntry<Weld<double>, double>>>(model.constraints))
    keep_weld.push_back(plan.element_row[at(weld.id)] >= 0 || plan.is_released(weld.id));
  const Elimination elimination = eliminate_bodies(model, keep_weld);
  for (int p = plan.moving; p < plan.bodies; ++p) put_frame(p, elimination.pose[at(plan.model_body[at(p)])]);
  return finite;
}

void LaneProgram::put_functions(const Model& model, double t, int lane, LaneNumbers& function) const {
  for (const Timed& timed : timed_) {
    const Taylor<double> value = model.functions[at(timed.function)].evaluate(t);
    function[timed.place][lane] = value.f;
    function[timed.place + 1][lane] = value.d;
    function[timed.place + 2][lane] = value.dd;
  }
}

void LaneProgram::spread_functions(LaneNumbers& function) const {
  for (const Timed& timed : timed_) {
    for (int k = timed.place; k < timed.place + 3; ++k)
      std::fill(function[k] + 1, function[k] + lane_count, *function[k]);
  }
}

}  // namespace catena
