// Topics of `catena explain` besides elements and analyses: functions of time, curves, columns, the parts of a scene.
#pragma once

#include <span>
#include <string_view>
#include <vector>

namespace catena {

struct ExplainedTopic {
  std::vector<std::string_view> names;  ///< all that lead here
  std::string_view text;
};

std::span<const ExplainedTopic> explained_topics();

}  // namespace catena
