// Some bodies of a mechanism as a model of their own, with the elements that touch them: names and given places stay.
//
// Fixed bodies are included where an element ties them to the part. Functions of time that no element of the part reads
// are left out, as are points, which only columns need.
#pragma once

#include <span>
#include <vector>

#include "catena/model/model.hpp"

namespace catena {

struct ModelPart {
  Model model;
  std::vector<int> bodies, elements;  ///< numbers in the whole, by number in the part
};

ModelPart part_of(const Model& whole, std::span<const int> bodies);

/// Groups of bodies that no constraint and no force ties to each other. Fixed bodies tie nothing and are in none.
std::vector<std::vector<int>> separate_groups(const Model& model);

}  // namespace catena
