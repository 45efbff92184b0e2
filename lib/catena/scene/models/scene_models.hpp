// Models of a scene for any values of its parameters: in plain numbers, and with derivatives by some of them.
//
// A table is the scene's parameters with the `set` of an analysis applied; seeds give single parameters other values,
// and all that depends on them follows. Both must outlive nothing but the call.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "catena/analysis/sensitivity/state_derivatives.hpp"
#include "catena/scene/reading/analysis_task.hpp"
#include "catena/scene/reading/scene_template.hpp"

namespace catena {

using ParameterSeeds = std::vector<ParameterSeed<double>>;

class SceneModels {
 public:
  /// `scene` must outlive this object.
  SceneModels(const SceneTemplate& scene, std::int64_t max_elements) : scene_(scene), max_elements_(max_elements) {}

  const ParameterNames& names() const { return scene_.parameters.names(); }
  /// Values of all parameters; empty, with the first reason, where one has none or is outside of its limits.
  std::vector<double> values(const ParameterTable& table, const ParameterSeeds& seeds,
                             std::string* why = nullptr) const;
  /// Gives the task the parameters of its table and `seeds`, and its numbers that depend on them; returns why it cannot
  /// be made with them.
  std::optional<std::string> set_parameters(AnalysisTask& task, const ParameterSeeds& seeds) const;
  /// A number of an analysis and its derivative by a parameter.
  struct MovingNumber {
    TaskNumber number;
    double rate;
  };
  /// For each of `parameters`, the numbers of the task itself that change with it; tolerances do not count.
  std::vector<std::vector<MovingNumber>> moving_numbers(const AnalysisTask& task, const ParameterSeeds& seeds,
                                                        std::span<const int> parameters) const;
  /// Nothing, with the first reason, where the scene allows no such model.
  std::shared_ptr<const Model> model(const ParameterTable& table, const ParameterSeeds& seeds,
                                     std::string* why = nullptr) const;
  /// Values of all parameters with derivatives by `parameters`, by groups of four as in DesignModels.
  std::vector<std::vector<DesignScalar>> dual_values(const ParameterTable& table, const ParameterSeeds& seeds,
                                                     std::span<const int> parameters) const;
  /// The scene's tables at these values.
  std::vector<Formula<DesignScalar>::Table> tables(const ParameterTable& table,
                                                   std::span<const DesignScalar> values) const {
    return table.tables<DesignScalar>(scene_.expressions, values);
  }
  /// Models with derivatives by these parameters. Throws std::invalid_argument where there is none at these values.
  DesignModels designs(const ParameterTable& table, const ParameterSeeds& seeds, std::span<const int> parameters) const;

 private:
  const SceneTemplate& scene_;
  std::int64_t max_elements_;
};

}  // namespace catena
