// Reference values of problems whose solution is known independently, read from data/reference (high precision; each
// file names its own definition, method and cross-check).
#pragma once

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

namespace catena::testing {

/// The object "values" of data/reference/<name>.json: nearest doubles.
inline nlohmann::json reference_values(const std::string& name) {
  std::ifstream file(std::string(CATENA_DATA_DIR) + "/reference/" + name + ".json");
  return nlohmann::json::parse(file).at("values");
}

}  // namespace catena::testing
