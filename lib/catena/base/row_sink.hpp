// Where an analysis sends its rows: storage, a file, a table. One virtual call a row.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "catena/base/unit_kind.hpp"

namespace catena {

/// Name and unit of a column.
struct ColumnInfo {
  std::string name;
  UnitKind unit = UnitKind::none;
  std::string own_unit = {};  ///< with UnitKind::own: SI, in the syntax of scenes; empty: not known
  bool is_status = false;     ///< its values number a Status, which is shown by its name
  /// Of a derivative by a parameter, whose own unit is not known: the SI unit of what is differentiated.
  std::string differentiated_unit = {};

  /// "m/s"; "1" of a pure number, empty where the unit is not known.
  std::string_view unit_text() const;
};

class RowSink {
 public:
  virtual ~RowSink() = default;
  /// Called once, before the first row.
  virtual void begin(std::span<const ColumnInfo> columns) = 0;
  /// One value a column. Returning false asks the analysis to stop; it then ends with Status::cancelled.
  virtual bool row(std::span<const double> values) = 0;
};

}  // namespace catena
