#include "catena/linalg/frontal_factorization.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "catena/linalg/frontal_kernels.hpp"

namespace catena {
namespace {

std::size_t product(int a, int b) { return static_cast<std::size_t>(a) * static_cast<std::size_t>(b); }

}  // namespace

void FrontalFactorization::analyze(std::span<const MatrixEntry> entries, std::span<const int> order,
                                   std::span<const int> node_start, Counters& counters) {
  *this = FrontalFactorization();
  ++counters.symbolic;
  structure_ = FrontalStructure(entries, order, node_start);
  // Left as it comes: every panel is cleared when it is assembled.
  panels_ = std::make_unique_for_overwrite<double[]>(structure_.panel_entries);
  stack_.resize(structure_.stack_entries);
  pivots_.resize(order.size());
  work_.resize(order.size());
}

// The front's values of A and the updates of its children; the update's own place is above theirs.
void FrontalFactorization::assemble(int s, const double* values, double* panel) {
  const FrontalStructure::Front& front = structure_.fronts[s];
  const int height = front.height(), columns = front.columns, below = front.below;
  double* const update = stack_.data() + structure_.updates[s].formed;
  std::fill_n(panel, product(height, columns), 0.0);
  std::fill_n(update, product(below, below), 0.0);
  const int* const source = structure_.source.data();
  const int* const target = structure_.target.data();
  const int end = structure_.fronts[s + 1].values;
  for (int k = front.values; k < end; ++k) panel[target[k]] += values[source[k]];
  for (int n = structure_.child_start[s]; n < structure_.child_start[s + 1]; ++n) {
    const FrontalStructure::Update& child = structure_.updates[structure_.child[n]];
    const int* const relative = structure_.relative.data() + child.rows;
    const double* handed = stack_.data() + child.waiting;
    const int handed_rows = structure_.fronts[structure_.child[n]].below;
    for (int j = 0; j < handed_rows; ++j, handed += handed_rows) {
      const int to = relative[j];
      if (to < columns) {
        double* const column = panel + product(to, height);
        for (int i = j; i < handed_rows; ++i) column[relative[i]] += handed[i];
      } else {
        double* const column = update + product(to - columns, below);
        for (int i = j; i < handed_rows; ++i) column[relative[i] - columns] += handed[i];
      }
    }
  }
}

FactorResult FrontalFactorization::factorize(std::span<const double> values, Counters& counters) {
  if (values.size() != structure_.source.size())
    throw std::invalid_argument("FrontalFactorization: as many values as entries are needed");
  ++counters.factorizations;
  counters.refactorizations += factored_before_ ? 1 : 0;
  factored_before_ = true;
  factorized_ = false;
  double* panel = panels_.get();
  for (int s = 0; s < structure_.count(); ++s) {
    const FrontalStructure::Front& front = structure_.fronts[s];
    const FrontalStructure::Update& place = structure_.updates[s];
    assemble(s, values.data(), panel);
    double* const update = stack_.data() + place.formed;
    const int done = detail::eliminate_front(panel, front.height(), front.columns, &pivots_[front.first], update);
    if (done < front.columns) return {FactorStatus::singular, structure_.order[front.first + done]};
    // Down to where the children's updates were: the two may overlap.
    if (place.waiting != place.formed)
      std::copy_n(update, product(front.below, front.below), stack_.data() + place.waiting);
    panel += product(front.height(), front.columns);
  }
  int negative = 0;
  for (int k = 0; k < size(); ++k) {
    if (!std::isfinite(pivots_[k])) return {FactorStatus::not_finite, structure_.order[k]};
    negative += pivots_[k] < 0 ? 1 : 0;
  }
  negative_ = negative;
  factorized_ = true;
  return {};
}

void FrontalFactorization::solve(std::span<double> x, Counters& counters) {
  if (!factorized_) throw std::logic_error("FrontalFactorization: no valid factors to solve with");
  ++counters.solves;
  double* const y = work_.data();
  for (int k = 0; k < size(); ++k) y[k] = x[structure_.order[k]];
  const double* panel = panels_.get();
  const int* rows = structure_.rows.data();
  for (int s = 0; s < structure_.count(); ++s) {
    const FrontalStructure::Front& front = structure_.fronts[s];
    detail::solve_forward(panel, front.height(), front.columns, rows, y + front.first, y);
    panel += product(front.height(), front.columns);
    rows += front.below;
  }
  for (int s = structure_.count() - 1; s >= 0; --s) {
    const FrontalStructure::Front& front = structure_.fronts[s];
    panel -= product(front.height(), front.columns);
    rows -= front.below;
    detail::solve_backward(panel, front.height(), front.columns, rows, y + front.first, y);
  }
  for (int k = 0; k < size(); ++k) x[structure_.order[k]] = y[k];
}

double FrontalFactorization::pivot(int row) const {
  if (!factorized_) throw std::logic_error("FrontalFactorization: no valid factors");
  return pivots_[structure_.place[row]];
}

}  // namespace catena
