#include "catena/columns/reaction.hpp"

#include "catena/columns/reaction_of.hpp"
#include "catena/columns/snapshot_state.hpp"

namespace catena {

ElementReactions element_reactions(const Snapshot& snapshot, int element) {
  const Evaluator& evaluator = snapshot.evaluator;
  if (evaluator.plan().is_released(element)) return {};  // what does not hold exerts nothing
  const auto first_row = static_cast<std::size_t>(evaluator.plan().element_row[static_cast<std::size_t>(element)]);
  return reactions_of(SnapshotState(snapshot), element, evaluator.element_jacobian(element),
                      snapshot.lambda.data() + first_row);
}

}  // namespace catena
