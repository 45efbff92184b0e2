// Takes the rows of analyses inside of an optimisation or a sweep, which are not kept.
#pragma once

#include <span>

#include "catena/base/row_sink.hpp"

namespace catena {

class NoRows final : public RowSink {
 public:
  void begin(std::span<const ColumnInfo>) override {}
  bool row(std::span<const double>) override { return true; }
};

}  // namespace catena
