#include "catena/results/terminal/text_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "catena/results/number_format.hpp"
#include "catena/results/status_word.hpp"

namespace catena {
namespace {

constexpr std::size_t no_limit = std::numeric_limits<std::size_t>::max() / 4;
constexpr std::size_t narrowest_column = 4;  // one digit, the gap, and a name

/// Characters, not bytes: bytes that continue a UTF-8 character don't count.
std::size_t width_of(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

/// The cells of a column.
std::vector<std::string> cells_of(const ColumnInfo& column, const std::vector<double>& values, double error) {
  if (!column.is_status) return format_column(values, std::vector<double>(values.size(), error));
  std::vector<std::string> words;
  for (const double value : values) words.emplace_back(status_word(value));
  return words;
}

/// Pure numbers need none.
std::string_view shown_unit(const ColumnInfo& column) {
  return column.unit == UnitKind::none ? std::string_view() : column.unit_text();
}

void append_right(std::string& out, std::string_view text, std::size_t width) {
  out.append(width - std::min(width, width_of(text)), ' ');
  out += text;
}

void append_left(std::string& out, std::string_view text, std::size_t width) {
  out += text;
  out.append(width - std::min(width, width_of(text)), ' ');
}

std::string more(std::uint64_t count, const char* what) {
  return "  ... " + std::to_string(count) + " more " + what + (count == 1 ? "\n" : "s\n");
}

struct TableColumn {
  std::string_view name, unit;
  std::vector<std::string> cells;
  std::size_t width = 0;
};

}  // namespace

TableLimits TableLimits::none() { return {no_limit, 0, no_limit, no_limit}; }

void TextTable::begin(std::span<const ColumnInfo> columns) {
  all_columns_ = columns.size();
  kept_columns_ = std::min(all_columns_, std::max(limits_.list_lines, limits_.width / narrowest_column));
  columns_.assign(columns.begin(), columns.begin() + static_cast<std::ptrdiff_t>(kept_columns_));
  rows_ = 0;
  values_.clear();
  largest_.assign(kept_columns_, 0.0);
}

bool TextTable::row(std::span<const double> values) {
  const auto kept = values.first(kept_columns_);
  for (std::size_t k = 0; k < kept_columns_; ++k) {
    if (std::abs(kept[k]) > largest_[k]) largest_[k] = std::abs(kept[k]);
  }
  if (rows_ < limits_.first_rows + limits_.last_rows) {
    values_.insert(values_.end(), kept.begin(), kept.end());
  } else if (limits_.last_rows > 0) {
    const std::size_t place = limits_.first_rows + (rows_ - limits_.first_rows) % limits_.last_rows;
    std::copy(kept.begin(), kept.end(), values_.begin() + static_cast<std::ptrdiff_t>(place * kept_columns_));
  }
  ++rows_;
  return true;
}

std::vector<double> TextTable::shown(std::size_t column) const {
  std::vector<double> values;
  const std::size_t kept = kept_rows();
  const std::size_t first = std::min(kept, limits_.first_rows);
  for (std::size_t r = 0; r < kept; ++r) {
    // The ring's oldest row is the one that the next row would replace.
    const std::size_t ring = r < first || rows_ <= kept ? 0 : rows_ - limits_.first_rows;
    const std::size_t at = r < first ? r : first + (r - first + ring) % limits_.last_rows;
    values.push_back(values_[at * kept_columns_ + column]);
  }
  return values;
}

TextTable::Text TextTable::text(std::span<const double> digits) const {
  if (all_columns_ == 0) return {};
  return rows_ == 1 ? list(digits) : grid(digits);
}

double TextTable::error_of(std::size_t column, std::span<const double> digits) const {
  if (column >= digits.size() || std::isnan(digits[column])) return 0;
  return largest_[column] * std::pow(10.0, -digits[column]);
}

TextTable::Text TextTable::list(std::span<const double> digits) const {
  const std::size_t lines = std::min(kept_columns_, limits_.list_lines);
  // Numbers of one unit share their decimals, so that rounding errors beside a large one read 0.
  std::map<UnitKind, std::vector<double>> of_unit, errors;
  for (std::size_t k = 0; k < lines; ++k) {
    of_unit[columns_[k].unit].push_back(values_[k]);
    errors[columns_[k].unit].push_back(error_of(k, digits));
  }
  std::map<UnitKind, std::vector<std::string>> texts;
  for (const auto& [unit, values] : of_unit) texts[unit] = format_column(values, errors[unit]);

  std::map<UnitKind, std::size_t> next;
  std::vector<std::string> numbers;
  std::size_t name_width = 0, number_width = 0;
  for (std::size_t k = 0; k < lines; ++k) {
    numbers.push_back(texts[columns_[k].unit][next[columns_[k].unit]++]);
    if (columns_[k].is_status) numbers.back() = status_word(values_[k]);
    name_width = std::max(name_width, width_of(columns_[k].name));
    number_width = std::max(number_width, numbers.back().size());
  }
  std::string out;
  for (std::size_t k = 0; k < lines; ++k) {
    out += "  ";
    append_left(out, columns_[k].name, name_width + 2);
    append_right(out, numbers[k], number_width);
    if (!shown_unit(columns_[k]).empty()) out += ' ' + std::string(shown_unit(columns_[k]));
    out += '\n';
  }
  const bool shortened = all_columns_ > lines;
  if (shortened) out += more(all_columns_ - lines, "column");
  return {out, shortened};
}

TextTable::Text TextTable::grid(std::span<const double> digits) const {
  std::vector<TableColumn> table;
  std::size_t width = 0;
  for (std::size_t k = 0; k < kept_columns_; ++k) {
    TableColumn column{columns_[k].name, shown_unit(columns_[k]), cells_of(columns_[k], shown(k), error_of(k, digits)),
                       0};
    column.width = std::max(width_of(column.name), width_of(column.unit));
    for (const std::string& cell : column.cells) column.width = std::max(column.width, cell.size());
    width += column.width + 2;
    if (width > limits_.width && !table.empty()) break;
    table.push_back(std::move(column));
  }
  std::string out;
  const auto line = [&](auto&& cell) {
    for (const TableColumn& column : table) append_right(out, cell(column), column.width + 2);
    out.erase(out.find_last_not_of(' ') + 1);
    out += '\n';
  };
  line([](const TableColumn& column) { return column.name; });
  line([](const TableColumn& column) { return column.unit; });
  const std::size_t kept = kept_rows();
  for (std::size_t r = 0; r <= kept; ++r) {
    if (rows_ > kept && r == limits_.first_rows) out += more(rows_ - kept, "row");
    if (r < kept) line([&](const TableColumn& column) { return std::string_view(column.cells[r]); });
  }
  const bool clipped = all_columns_ > table.size();
  if (clipped) out += more(all_columns_ - table.size(), "column");
  return {out, clipped || rows_ > kept};
}

}  // namespace catena
