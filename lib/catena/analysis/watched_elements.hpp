// Elements whose rows mean nothing at some configurations: contacts off their curve, gears whose centres coincide.
#pragma once

#include <vector>

#include "catena/assembly/evaluate.hpp"
#include "catena/base/status.hpp"

namespace catena {

class WatchedElements {
 public:
  explicit WatchedElements(const Evaluator& evaluator);

  /// `singular`, naming the first element that means nothing at the evaluator's configuration and time, and why.
  Report check() const;

 private:
  const Evaluator& evaluator_;
  std::vector<int> elements_;
};

}  // namespace catena
