// Columns of a file of numbers, wherever a scene has a list of numbers or of pairs:
//
//   {"file": "cam.csv", "columns": [1, 2], "unit": ["deg", "mm"], "smooth": 0.02}
//
// The path is relative to the scene's folder. Columns are counted from 1, or named as in the file's first line; left
// out, they are the first ones. Values are in SI and radians unless a unit is given. Lines hold numbers separated by
// commas, semicolons, tabs or blanks; empty ones, those that begin with #, and a first line that holds names are not
// read as numbers. Every line must have as many numbers as the first.
//
// "smooth" is the root mean square by which values may be moved to make the curve through them smoother (see
// scene/reading/smoothing.hpp), as a quantity or in the unit of the last column.
#pragma once

#include "catena/scene/reading/scene_reading.hpp"

namespace catena {

/// Whether the value stands for columns of a file.
bool is_data_file(const JsonValue& value);

/// The members of an object with pairs under keys[pairs], or with a file's keys in place of them, beside the others:
/// {"file": "cam.csv", "end": "periodic"}. out[pairs] is the object itself then. Otherwise as read_members.
bool read_members_or_file(const JsonValue& object, std::span<const std::string_view> keys, std::size_t pairs,
                          std::string_view owner, std::span<JsonValue> out, Diagnostics& diagnostics);

struct DataColumns {
  std::vector<std::vector<double>> values;  ///< in SI, column after column; empty if they could not be read
  double smooth = 0;                        ///< in SI
  JsonValue smooth_place{};                 ///< where it was asked for, if it was

  bool empty() const { return values.empty(); }
};

/// `dimensions.size()` columns, each in its dimension. Empty, with a report, if they cannot be read. `beside`: keys
/// that the object may have besides those of a file.
DataColumns read_data_file(const JsonValue& object, std::span<const ExpectedDimension> dimensions,
                           const FieldName& field, SceneTemplate& scene, Diagnostics& diagnostics,
                           std::span<const std::string_view> beside = {});

}  // namespace catena
