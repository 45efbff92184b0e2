#include "catena/results/csv_writer.hpp"

#include "catena/results/number_format.hpp"
#include "catena/results/status_word.hpp"

namespace catena {
namespace {

void append_field(std::string& line, const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) {
    line += text;
    return;
  }
  line += '"';
  for (char c : text) {
    if (c == '"') line += '"';
    line += c;
  }
  line += '"';
}

}  // namespace

void CsvWriter::begin(std::span<const ColumnInfo> columns) {
  line_.clear();
  is_status_.clear();
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (k > 0) line_ += ',';
    append_field(line_, columns[k].name);
    is_status_.push_back(columns[k].is_status);
  }
  line_ += "\r\n";
  output_.write(line_);
}

bool CsvWriter::row(std::span<const double> values) {
  line_.clear();
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (k > 0) line_ += ',';
    if (is_status_[k])
      line_ += status_word(values[k]);
    else
      append_exact(line_, values[k]);
  }
  line_ += "\r\n";
  output_.write(line_);
  return true;
}

}  // namespace catena
