// Some bodies of a mechanism as a model of their own, with the elements that touch them: names and given places stay.
//
// Fixed bodies are included where an element ties them to the part, or a law of state reads them. Functions of time
// that no element of the part reads are left out, as are points, which only columns need, but for those that laws read.
#pragma once

#include <span>
#include <vector>

#include "catena/model/attachment.hpp"

namespace catena {

/// Calls f(body) for every body of the model that a column of a law of state shows, the ground among them. Not those
/// that further laws read through the force of a spring.
template <class F>
void visit_read_bodies(const Model& model, const Column& input, F&& f) {
  if (input.kind == ColumnKind::time) return;
  if (is_body_column(input.kind)) return f(input.index);
  const Attachment attachment = attachment_of(model, input.index);
  f(attachment.i);
  if (attachment.bodies == 2) f(attachment.j);
}

struct ModelPart {
  Model model;
  std::vector<int> bodies, elements;  ///< numbers in the whole, by number in the part
};

ModelPart part_of(const Model& whole, std::span<const int> bodies);
/// A part for each of the groups, no two of which an element ties to each other: in time linear in the whole.
std::vector<ModelPart> parts_of(const Model& whole, std::span<const std::vector<int>> groups);

/// Groups of bodies that no constraint and no force ties to each other; a law of state ties the bodies that it reads
/// and acts on. Fixed bodies tie nothing and are in none.
std::vector<std::vector<int>> separate_groups(const Model& model);

}  // namespace catena
