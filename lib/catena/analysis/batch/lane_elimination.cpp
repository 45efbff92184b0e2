#include "catena/analysis/batch/lane_elimination.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "catena/analysis/batch/lane_steps.hpp"
#include "catena/linalg/factorization/factorization.hpp"

namespace catena {
namespace {

struct Cell {
  int slot;
  bool varies;
  double constant;  ///< of one that does not vary

  bool is_unit() const { return !varies && std::abs(constant) == 1; }
};

/// A pivot +1 or -1, and the entries to the right of it when it was chosen, with their columns.
struct Pivot {
  int row;
  double value;
  std::vector<std::pair<Cell, int>> right;
  std::vector<std::pair<Cell, int>> below;  // with their rows
};

/// One diagonal block while its pivots are chosen.
class BlockElimination {
 public:
  std::vector<int> rows, columns;
  std::map<std::pair<int, int>, Cell> cells;

  /// The unit entry of least fill-in; false if there is none.
  bool choose(int& row, int& column) const {
    int least = -1;
    for (const auto& [place, cell] : cells) {
      if (!cell.is_unit() || !has(rows, place.first) || !has(columns, place.second)) continue;
      const int fill = (count_in_row(place.first) - 1) * (count_in_column(place.second) - 1);
      if (least >= 0 && fill >= least) continue;
      least = fill;
      row = place.first;
      column = place.second;
    }
    return least >= 0;
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

class Chooser {
 public:
  Chooser(const Plan& plan, LaneElimination& out, std::vector<double> constant)
      : plan_(plan),
        out_(out),
        constant_(std::move(constant)),
        row_of_(at(plan.columns), -1),
        units_{new_slot(1), new_slot(-1), new_slot(-2)},
        factor_(units_, true),
        solve_(units_, false) {}

  void sort_into_blocks(const Factorization& form, const std::vector<int>& varying);
  /// False where the tail of a block is too large.
  bool eliminate(const Model& model, std::string& why_not);
  void finish();

 private:
  struct Entry {
    Cell cell;
    int row, column;
  };
  struct Block {
    BlockElimination elimination;
    std::vector<Pivot> pivots;
    std::vector<Entry> outside;  // in rows of earlier blocks
    int tail = -1;
  };
  int new_slot(double constant = 0) {
    constant_.push_back(constant);
    return static_cast<int>(constant_.size()) - 1;
  }
  void take_pivot(Block& block, int row, int column);
  void subtract_product(BlockElimination& block, double sign, const Cell& m, const Cell& s, int row, int column);
  void add_tail(Block& block);
  static void subtract(LaneSteps& steps, double sign, const Cell& m, int target, int source);
  void list_solution(const Block& block);

  const Plan& plan_;
  LaneElimination& out_;
  std::vector<double> constant_;  // of every slot
  std::vector<Block> blocks_;
  std::vector<int> row_of_;  // with the pivot of a column
  LaneUnits units_;
  LaneSteps factor_, solve_;
};

void Chooser::sort_into_blocks(const Factorization& form, const std::vector<int>& varying) {
  std::vector<char> varies(constant_.size(), false);
  for (const int slot : varying) varies[at(slot)] = true;
  blocks_.resize(at(form.blocks()));
  for (int c = 0; c < plan_.columns; ++c) {
    blocks_[at(form.block_of_column()[at(c)])].elimination.columns.push_back(c);
    blocks_[at(form.block_of_row()[at(c)])].elimination.rows.push_back(c);
  }
  for (int c = 0; c < plan_.columns; ++c) {
    Block& block = blocks_[at(form.block_of_column()[at(c)])];
    for (int k = plan_.jacobian.column_start[at(c)]; k < plan_.jacobian.column_start[at(c) + 1]; ++k) {
      const int row = plan_.jacobian.row_index[at(k)];
      const bool inside = form.block_of_row()[at(row)] == form.block_of_column()[at(c)];
      if (!varies[at(k)] && constant_[at(k)] == 0) continue;
      const Cell cell{k, varies[at(k)] != 0, constant_[at(k)]};
      if (inside)
        block.elimination.cells.emplace(std::pair(row, c), cell);
      else
        block.outside.push_back({cell, row, c});
    }
  }
}

// t -= sign m s, of right-hand sides or entries.
void Chooser::subtract(LaneSteps& steps, double sign, const Cell& m, int target, int source) {
  if (m.is_unit())
    steps.append_sum(sign * m.constant > 0 ? -1 : 1, target, source);
  else
    steps.append(sign > 0 ? LaneAct::subtract_product : LaneAct::add_product, target, source, m.slot);
}

void Chooser::subtract_product(BlockElimination& block, double sign, const Cell& m, const Cell& s, int row,
                               int column) {
  const std::pair place(row, column);
  auto found = block.cells.find(place);
  if (!m.varies && !s.varies && (found == block.cells.end() || !found->second.varies)) {
    if (found == block.cells.end()) found = block.cells.emplace(place, Cell{new_slot(), false, 0}).first;
    double& constant = found->second.constant;
    constant -= sign * m.constant * s.constant;
    constant_[at(found->second.slot)] = constant;
    if (constant == 0) block.cells.erase(found);
    return;
  }
  if (found == block.cells.end()) found = block.cells.emplace(place, Cell{new_slot(), false, 0}).first;
  Cell& cell = found->second;
  if (!cell.varies) out_.reset.push_back({lane_count * cell.slot, cell.constant});
  cell.varies = true;
  const bool exchanged = !m.is_unit() && s.is_unit();
  subtract(factor_, sign, exchanged ? s : m, cell.slot, exchanged ? m.slot : s.slot);
}

void Chooser::take_pivot(Block& block, int row, int column) {
  BlockElimination& e = block.elimination;
  std::erase(e.rows, row);
  std::erase(e.columns, column);
  row_of_[at(column)] = row;
  Pivot pivot{row, e.find(row, column)->constant, {}, {}};
  for (const int r : e.rows) {
    if (const Cell* cell = e.find(r, column)) pivot.below.emplace_back(*cell, r);
  }
  for (const int c : e.columns) {
    if (const Cell* cell = e.find(row, c)) pivot.right.emplace_back(*cell, c);
  }
  for (const auto& [m, r] : pivot.below) {
    for (const auto& [s, c] : pivot.right) subtract_product(e, pivot.value, m, s, r, c);
  }
  block.pivots.push_back(std::move(pivot));
}

void Chooser::add_tail(Block& block) {
  const BlockElimination& e = block.elimination;
  LaneTail tail{};
  const int n = tail.size = static_cast<int>(e.rows.size());
  for (int r = 0; r < n; ++r) {
    tail.row[r] = e.rows[at(r)];
    row_of_[at(e.columns[at(r)])] = e.rows[at(r)];
    tail.length_row[r] = !plan_.row_is_angle[at(e.rows[at(r)])];
    tail.length_column[r] = plan_.coordinate[at(e.columns[at(r)])] % 3 != 2;
    for (int c = 0; c < n; ++c) {
      const Cell* cell = e.find(e.rows[at(r)], e.columns[at(c)]);
      tail.slot[n * r + c] = cell ? cell->slot : new_slot();
    }
  }
  block.tail = static_cast<int>(out_.tail.size());
  out_.tail.push_back(tail);
}

bool Chooser::eliminate(const Model& model, std::string& why_not) {
  for (Block& block : blocks_) {
    const std::size_t bodies = block.elimination.columns.size() / 3;
    int row = 0, column = 0;
    while (block.elimination.choose(row, column)) take_pivot(block, row, column);
    const std::vector<int>& left = block.elimination.rows;
    if (left.size() > at(largest_tail)) {
      why_not = fmt::format(
          "{} of its bodies hang together so closely that {} "
          "equations must be solved at once; lanes solve {}: most "
          "concerned: \"{}\"",
          bodies, left.size(), largest_tail, model.element_name(plan_.row_element[at(left.front())]));
      return false;
    }
    if (!left.empty()) add_tail(block);
  }
  return true;
}

void Chooser::list_solution(const Block& block) {
  for (const Pivot& pivot : block.pivots) {
    for (const auto& [m, row] : pivot.below) subtract(solve_, pivot.value, m, row, pivot.row);
  }
  if (block.tail >= 0) solve_.append_tail(block.tail, out_.tail[at(block.tail)]);
  for (auto pivot = block.pivots.rbegin(); pivot != block.pivots.rend(); ++pivot) {
    if (pivot->value < 0) solve_.append_sum(-2, pivot->row, pivot->row);
    for (const auto& [m, column] : pivot->right) subtract(solve_, pivot->value, m, pivot->row, row_of_[at(column)]);
  }
  for (const auto& [cell, row, column] : block.outside) subtract(solve_, 1, cell, row, row_of_[at(column)]);
}

void Chooser::finish() {
  for (auto block = blocks_.rbegin(); block != blocks_.rend(); ++block) list_solution(*block);
  out_.factor = factor_.finish(out_.step);
  out_.solve = solve_.finish(out_.step);
  out_.transposed = solve_.transposed(out_.tail).finish(out_.step);
  for (const bool angles : {false, true}) {
    for (int c = 0; c < plan_.columns; ++c) {
      const int coordinate = plan_.coordinate[at(c)];
      if ((coordinate % 3 == 2) == angles)
        out_.unknown.push_back({lane_count * row_of_[at(c)], lane_count * coordinate});
    }
    if (!angles) out_.lengths = static_cast<int>(out_.unknown.size());
  }
  for (LaneTail& tail : out_.tail) {
    for (int& row : tail.row) row *= lane_count;
    for (int& slot : tail.slot) slot *= lane_count;
  }
  out_.initial = std::move(constant_);
}

}  // namespace

bool LaneElimination::choose(const Plan& plan, const Model& model, const std::vector<int>& varying,
                             std::vector<double> constant, std::string& why_not) {
  Counters counters;
  Factorization form;
  if (!form.analyze(plan.jacobian, Kernel::klu, counters).ok()) {
    why_not = "its constraints and drivers do not determine all coordinates";
    return false;
  }
  Chooser chooser(plan, *this, std::move(constant));
  chooser.sort_into_blocks(form, varying);
  if (!chooser.eliminate(model, why_not)) return false;
  chooser.finish();
  return true;
}

}  // namespace catena
