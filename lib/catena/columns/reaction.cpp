#include "catena/columns/reaction.hpp"

#include "catena/columns/attachment.hpp"

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

}  // namespace

ElementReactions element_reactions(const Snapshot& snapshot, int element) {
  const Evaluator& evaluator = snapshot.evaluator;
  const ElementJacobian jacobian = evaluator.element_jacobian(element);
  const Attachment attachment = attachment_of(evaluator.model(), element);
  const auto first_row = static_cast<std::size_t>(evaluator.plan().element_row[static_cast<std::size_t>(element)]);
  const auto frame = [&](int body) { return evaluator.frames()[static_cast<std::size_t>(body)]; };

  ElementReactions result;
  for (int row = 0; row < jacobian.rows; ++row)
    result.multiplier[row] = jacobian.scale * snapshot.lambda[first_row + static_cast<std::size_t>(row)];
  const Frame<double> frame_i = frame(jacobian.body_i);
  result.joint_x = frame_i.axis(attachment.axis_i);
  result.on_i = reaction_on(jacobian, result.multiplier, 0, frame_i.axis(attachment.point_i));
  result.on_j = jacobian.bodies == 1
                    ? result.on_i
                    : reaction_on(jacobian, result.multiplier, 3, frame(jacobian.body_j).axis(attachment.point_j));
  return result;
}

}  // namespace catena
