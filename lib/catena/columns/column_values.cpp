// ColumnSet::evaluate: the values of a row in plain numbers.
#include <stdexcept>
#include <string>

#include "catena/columns/column_set.hpp"
#include "catena/columns/energy.hpp"
#include "catena/columns/row_values.hpp"
#include "catena/columns/snapshot_state.hpp"

namespace catena {
namespace {

/// A snapshot as columns see it.
class ColumnState : public SnapshotState {
 public:
  ColumnState(const Snapshot& snapshot, bool only_angles) : SnapshotState(snapshot), only_angles_(only_angles) {}

  double residual() const {
    return only_angles_ ? snapshot().residual / evaluator().length_scale() : snapshot().residual;
  }
  double work() const { return snapshot().work; }
  double dissipated() const { return snapshot().dissipated; }
  double initial_energy() const { return snapshot().initial_energy; }
  double driver_work(int element) const { return snapshot().driver_work[static_cast<std::size_t>(element)]; }
  Taylor<double> measured(int element) const {
    const Measured m = evaluator().measure(element, snapshot().qd, {});
    return {m.value, m.rate, m.second};
  }
  Taylor<double> prescribed(int element) const { return evaluator().element_value(element); }
  ElementReactions reactions(int element) const { return element_reactions(snapshot(), element); }
  SpringLoads spring_loads(int element) const { return catena::spring_loads(snapshot(), element); }
  double potential() const { return evaluator().potential_energy() + snapshot().contact_energy; }
  const ContactLoad* contact(int element) const {
    return snapshot().contacts.empty() ? nullptr : &snapshot().contacts[static_cast<std::size_t>(element)];
  }

 private:
  const Evaluator& evaluator() const { return snapshot().evaluator; }
  bool only_angles_;
};

}  // namespace

void ColumnSet::evaluate(const Snapshot& snapshot, std::span<double> out) const {
  if (out.size() < columns_.size()) throw std::invalid_argument("columns: there is no room for all values of a row");
  if (static_cast<std::size_t>(snapshot.evaluator.plan().coordinates()) != coordinates_)
    throw std::invalid_argument("columns: the row is of another model than the one they were resolved for");
  const auto require = [](bool needed, std::span<const double> values, std::size_t size, const char* what) {
    if (needed && values.size() < size)
      throw std::invalid_argument(std::string("columns: the row has no ") + what +
                                  "; an analysis must compute needs()");
  };
  require(needs_.velocity, snapshot.qd, coordinates_, "velocities");
  require(needs_.acceleration, snapshot.qdd, coordinates_, "accelerations");
  // Rows of released constraints are missing while they are.
  const auto rows = static_cast<std::size_t>(snapshot.evaluator.plan().rows);
  require(needs_.multipliers, snapshot.lambda, rows, "multipliers");
  require(needs_.work, snapshot.driver_work, snapshot.evaluator.model().elements.size(), "work");
  const ColumnState state(snapshot, only_angles_);
  RowValues<ColumnState> row(state, own_inputs_);
  for (std::size_t k = 0; k < columns_.size(); ++k) out[k] = row.value(columns_[k]);
}

}  // namespace catena
