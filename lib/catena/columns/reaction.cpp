#include "catena/columns/reaction.hpp"

#include "catena/columns/attachment.hpp"
#include "catena/elements/all.hpp"

namespace catena {
namespace {

using ElementJacobian = Evaluator::ElementJacobian;

/// Reaction on the body whose three columns begin at `first`, about the end of `arm` = A s'P.
Reaction reaction_on(const ElementJacobian& jacobian, const double* multiplier, int first, const Vec2<double>& arm) {
  double load[3] = {0, 0, 0};  // Phi_q^T lambda of this body
  for (int row = 0; row < jacobian.rows; ++row) {
    for (int k = 0; k < 3; ++k) load[k] += jacobian.entries[6 * row + first + k] * multiplier[row];
  }
  const Vec2<double> force{-load[0], -load[1]};
  return {force, -load[2] - dot(perpendicular(arm), force)};
}

/// From each body's origin to where the reaction on it is reported.
struct Arms {
  Vec2<double> i, j;
};

Arms arms_of(const Model& model, int element, const Attachment& attachment, const Frame<double>& frame_i,
             const Frame<double>& frame_j) {
  Arms arms{frame_i.axis(attachment.point_i), frame_j.axis(attachment.point_j)};
  const ElementRecord& record = model.elements[static_cast<std::size_t>(element)];
  with_list(model.constraints, record.type, [&](const auto& list) {
    const auto& joint = list[static_cast<std::size_t>(record.index)].element;
    if constexpr (requires { joint.reaction_point(frame_i, frame_j); }) {
      const Vec2<double> place = joint.reaction_point(frame_i, frame_j);
      arms = {place - frame_i.origin(), place - frame_j.origin()};
    }
  });
  return arms;
}

}  // namespace

ElementReactions element_reactions(const Snapshot& snapshot, int element) {
  const Evaluator& evaluator = snapshot.evaluator;
  if (evaluator.plan().is_released(element)) return {};  // what does not hold exerts nothing
  const ElementJacobian jacobian = evaluator.element_jacobian(element);
  const Attachment attachment = attachment_of(evaluator.model(), element);
  const auto first_row = static_cast<std::size_t>(evaluator.plan().element_row[static_cast<std::size_t>(element)]);
  const Frame<double> frame_i = evaluator.ground_frame(jacobian.body_i);
  const Frame<double> frame_j =
      evaluator.ground_frame(jacobian.bodies == 1 ? evaluator.plan().bodies : jacobian.body_j);

  ElementReactions result;
  for (int row = 0; row < jacobian.rows; ++row)
    result.multiplier[row] = jacobian.scale * snapshot.lambda[first_row + static_cast<std::size_t>(row)];
  result.joint_x = frame_i.axis(attachment.axis_i);
  const Arms arms = arms_of(evaluator.model(), element, attachment, frame_i, frame_j);
  result.on_i = reaction_on(jacobian, result.multiplier, 0, arms.i);
  result.on_j = jacobian.bodies == 1 ? result.on_i : reaction_on(jacobian, result.multiplier, 3, arms.j);
  return result;
}

}  // namespace catena
