// The results of an analysis apart from its rows, which went to a sink: its outcome and its named results.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "catena/analysis/measures/measure.hpp"
#include "catena/analysis/run/analysis_report.hpp"
#include "catena/results/column_extremes.hpp"

namespace catena {

using FieldScalar = std::variant<bool, std::int64_t, double, std::string, std::vector<std::string>>;

/// One object in a list of results: {"kind": "limit", "value": 12.5, "row": 40}.
using FieldRecord = std::vector<std::pair<std::string, FieldScalar>>;

/// A list of objects that may be longer than memory should hold: given one after the other, in order.
class LongList {
 public:
  virtual ~LongList() = default;
  virtual std::int64_t size() const = 0;
  /// Until `take` returns false.
  virtual void for_each(const std::function<bool(const FieldRecord&)>& take) const = 0;
};

using FieldValue = std::variant<bool, std::int64_t, double, std::string, std::vector<double>, std::vector<std::string>,
                                std::vector<FieldRecord>, FieldRecord, std::shared_ptr<const LongList>>;

/// A named result: "stable", "iterations", "events". Names and meanings: apps/manual/scenes.md#results.
struct NamedField {
  std::string name;
  FieldValue value;
};

struct AnalysisResult {
  std::string type;  ///< "kinematics"
  AnalysisReport report;
  bool has_rows = false;  ///< a table belongs to it, be it empty
  std::vector<ColumnInfo> columns;
  std::vector<double> digits{};                       ///< that are right, by column; NaN: not known; empty: of none
  std::int64_t rows = 0;                              ///< how many went to the sink
  std::vector<NamedField> fields;                     ///< in the order in which they are written
  std::vector<std::pair<std::string, double>> set{};  ///< parameters that it had a value of its own for
  std::vector<MeasureResult> measures{};
  std::vector<std::string> gradient_parameters{};  ///< of the measures' gradients; empty: there are none
  std::vector<ColumnExtreme> extremes{};
  bool extremes_have_time = false;  ///< else their instants are numbers of rows
};

}  // namespace catena
