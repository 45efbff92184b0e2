#include "catena/scene/models/scene_models.hpp"

#include <algorithm>
#include <stdexcept>

#include "catena/elements/all.hpp"
#include "catena/scene/building/build_model.hpp"
#include "catena/scene/reading/task_numbers.hpp"

namespace catena {
namespace {

void tell(const Diagnostics& diagnostics, std::string* why) {
  if (why && !diagnostics.items().empty()) *why = diagnostics.items().front().message;
}

}  // namespace

std::vector<double> SceneModels::values(const ParameterTable& table, const ParameterSeeds& seeds,
                                        std::string* why) const {
  Diagnostics diagnostics(1);
  std::vector<double> values = table.evaluate<double>(scene_.expressions, diagnostics, seeds);
  if (diagnostics.ok()) return values;
  tell(diagnostics, why);
  return {};
}

std::optional<std::string> SceneModels::set_parameters(AnalysisTask& task, const ParameterSeeds& seeds) const {
  std::string why;
  task.parameters = values(*task.table, seeds, &why);
  if (!why.empty()) return why;
  return evaluate_numbers(task, scene_.expressions, task.parameters);
}

std::shared_ptr<const Model> SceneModels::model(const ParameterTable& table, const ParameterSeeds& seeds,
                                                std::string* why) const {
  const std::vector<double> values = this->values(table, seeds, why);
  if (values.empty() && names().size() > 0) return nullptr;
  Diagnostics diagnostics(1);
  auto model = std::make_shared<Model>(build_model<double>(scene_, values, {max_elements_}, diagnostics));
  if (diagnostics.ok()) return model;
  tell(diagnostics, why);
  return nullptr;
}

std::vector<std::vector<DesignScalar>> SceneModels::dual_values(const ParameterTable& table,
                                                                const ParameterSeeds& seeds,
                                                                std::span<const int> parameters) const {
  Diagnostics diagnostics(1);
  const std::vector<double> plain = table.evaluate<double>(scene_.expressions, diagnostics, seeds);
  std::vector<std::vector<DesignScalar>> groups;
  for (std::size_t first = 0; first < parameters.size(); first += parameters_at_once) {
    std::vector<ParameterSeed<DesignScalar>> dual;
    for (const ParameterSeed<double>& seed : seeds) dual.push_back({seed.index, DesignScalar(seed.value)});
    const std::size_t count = std::min<std::size_t>(parameters_at_once, parameters.size() - first);
    for (std::size_t k = 0; k < count; ++k) {
      const int index = parameters[first + k];
      const bool given = std::any_of(seeds.begin(), seeds.end(), [&](const auto& seed) { return seed.index == index; });
      dual.push_back(
          {index, DesignScalar::variable(plain[static_cast<std::size_t>(index)], static_cast<int>(k)), !given});
    }
    groups.push_back(table.evaluate<DesignScalar>(scene_.expressions, diagnostics, dual));
  }
  return groups;
}

std::vector<std::vector<SceneModels::MovingNumber>> SceneModels::moving_numbers(const AnalysisTask& task,
                                                                                const ParameterSeeds& seeds,
                                                                                std::span<const int> parameters) const {
  std::vector<std::vector<MovingNumber>> moving(parameters.size());
  if (task.varying.empty()) return moving;
  const auto groups = dual_values(*task.table, seeds, parameters);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const std::vector<Formula<DesignScalar>::Table> tables_here = tables(*task.table, groups[g]);
    for (const TaskNumber& number : task.varying) {
      if (number.place == TaskNumber::Place::key && number.key->name == "tolerance") continue;
      const auto value =
          evaluate<DesignScalar>(number.value, scene_.expressions, groups[g], number.loop_values, tables_here);
      for (std::size_t k = 0; k < parameters_at_once && parameters_at_once * g + k < parameters.size(); ++k) {
        if (value.d[k] != 0) moving[parameters_at_once * g + k].push_back({number, value.d[k]});
      }
    }
  }
  return moving;
}

DesignModels SceneModels::designs(const ParameterTable& table, const ParameterSeeds& seeds,
                                  std::span<const int> parameters) const {
  DesignModels models;
  for (const std::vector<DesignScalar>& values : dual_values(table, seeds, parameters)) {
    Diagnostics diagnostics(1);
    auto model = std::make_shared<DesignModel>(build_model<DesignScalar>(scene_, values, {max_elements_}, diagnostics));
    if (!diagnostics.ok()) throw std::invalid_argument(diagnostics.items().front().message);
    models.push_back(std::move(model));
  }
  return models;
}

}  // namespace catena
