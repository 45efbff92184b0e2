#include "catena/scene/numbers/evaluation.hpp"

#include <fmt/format.h>

namespace catena {

void report_in_block(const SourceText& source, std::size_t place, std::string_view message,
                     std::span<const std::string> loop_names, std::span<const double> loop_values,
                     Diagnostics& diagnostics) {
  if (!loop_names.empty() && diagnostics.reported(source, place)) return;
  std::string text(message);
  for (std::size_t i = 0; i < loop_names.size() && i < loop_values.size(); ++i) {
    text += fmt::format("{}{} = {}", i == 0 ? " (at " : ", ", loop_names[i], loop_values[i]);
  }
  if (text.size() > message.size()) text += ")";
  diagnostics.error(source, place, std::move(text));
}

}  // namespace catena
