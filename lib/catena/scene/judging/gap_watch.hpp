// One-sided elements in a motion that does not treat them: how far they are violated at its rows.
//
// A driven mechanism goes where its drivers ask for, whatever stops and contacts are in the way: the motion goes on,
// its columns show the gaps, and a warning names the element, the instant and the depth. Units: m, rad, s.
#pragma once

#include <string>
#include <vector>

#include "catena/columns/snapshot.hpp"

namespace catena {

class GapWatch {
 public:
  explicit GapWatch(const Model& model);

  void observe(const Snapshot& row);
  /// One sentence an element that was violated, ten at most.
  std::vector<std::string> warnings() const;

 private:
  struct Worst {
    int element;
    double depth = 0, t = 0, first = 0;  // deepest, when, and when it was violated first
  };
  const Model& model_;
  std::vector<Worst> worst_;
};

/// Those that the evaluator's configuration violates, which was assembled without them: one sentence each, ten at most.
std::vector<std::string> violated_gaps(const Evaluator& evaluator);

}  // namespace catena
