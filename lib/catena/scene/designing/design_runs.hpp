// The analyses of one design, run for an optimisation: measures and their gradients, or why there are none.
//
// A search without derivatives asks for many designs, one after the other. Where lanes know the mechanism
// (lane_designs.hpp) each is computed there, alone: what is looked at between its rows is, at several instants at once.
#pragma once

#include <map>
#include <mutex>

#include "catena/analysis/design/design_problem.hpp"
#include "catena/scene/designing/lane_designs.hpp"
#include "catena/scene/designing/measured_design.hpp"

namespace catena {

class DesignRuns {
 public:
  /// `context` is that of the optimisation, whose task has the analyses and the goal; it must outlive this object.
  /// `by_values`: the search asks for no gradients.
  explicit DesignRuns(const AnalysisContext& context, bool by_values = false);

  /// Objective and constraints of a design, the values of the variables in the order of the goal. Several threads may
  /// ask at once, each with a record of its own: what adjoints did in the designs of one search, in their order, is the
  /// same for any number of threads.
  DesignEvaluation evaluate(std::span<const double> x, bool gradients, AdjointRecord& record);
  /// The values of all parameters of a design: the context's, with the variables put in.
  ParameterSeeds seeds_of(std::span<const double> x) const;
  /// Measures whose derivatives were missing in some design, each once, with the reason, in the order of their names.
  std::vector<std::string> doubts() const;

 private:
  struct Measured {
    double value;
    std::vector<double> gradient;
  };
  /// Runs all analyses in order; a reason where one fails.
  std::string measure(const ParameterSeeds& seeds, bool gradients, std::vector<Measured>& measures,
                      AdjointRecord& record);
  /// The measures of a design in a lane; nothing where it is to be analysed by itself.
  std::optional<std::vector<double>> measure_in_lane(const ParameterSeeds& seeds);
  std::string take_measures(const AnalysisTask& inner, const AnalysisResult& result, bool gradients,
                            std::vector<Measured>& measures);
  /// A formula's value with derivatives by the variables of every group.
  std::vector<DesignScalar> evaluate_formula(const DesignFormula& formula,
                                             const std::vector<std::vector<DesignScalar>>& parameters,
                                             const std::vector<Measured>& measures) const;

  const AnalysisContext& context_;
  const DesignGoal& goal_;
  DesignRequest request_;
  std::mutex mutex_;
  bool try_lanes_;
  std::vector<std::unique_ptr<LaneDesigns>> idle_lanes_;
  std::map<std::string, std::string> doubts_;  // what lacks a derivative: why, of several reasons the first by letters
};

}  // namespace catena
