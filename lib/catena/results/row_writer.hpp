// Writes the rows of one analysis to a file, in some format. Failures are kept by the output and do not stop the
// analysis.
#pragma once

#include <functional>
#include <memory>

#include "catena/base/row_sink.hpp"
#include "catena/results/text_output.hpp"

namespace catena {

class RowWriter : public RowSink {
 public:
  virtual ~RowWriter() = default;
  /// After the last row.
  virtual void finish() {}
};

/// Makes a writer to an output that outlives it.
using MakeRowWriter = std::function<std::unique_ptr<RowWriter>(TextOutput&)>;

}  // namespace catena
