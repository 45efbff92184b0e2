#include "catena/scene/reading/data_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "catena/scene/json/near_miss.hpp"
#include "catena/scene/numbers/decimal.hpp"
#include "catena/scene/numbers/quantity.hpp"

namespace catena {
namespace {

constexpr std::array<std::string_view, 4> keys{"file", "columns", "unit", "smooth"};

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r"), last = text.find_last_not_of(" \t\r");
  return first == text.npos ? std::string_view() : text.substr(first, last - first + 1);
}

/// The entries of a list; of anything else itself, `count` times.
std::vector<JsonValue> entries(const JsonValue& value, std::size_t count) {
  if (!value.is(JsonKind::array)) return std::vector<JsonValue>(count, value);
  std::vector<JsonValue> all;
  for (const JsonValue& entry : value.elements()) all.push_back(entry);
  return all;
}

/// The fields of a line, and where each begins in it. Blanks around other separators count with them.
struct Fields {
  std::vector<std::string_view> text;
  std::vector<std::size_t> begin;
};
Fields split(std::string_view line) {
  const std::size_t found = line.find_first_of(",;\t");
  const char separator = found == line.npos ? ' ' : line[found];
  Fields fields;
  for (std::size_t at = 0; at <= line.size();) {
    std::size_t end = std::min(line.find(separator, at), line.size());
    const std::string_view field = trimmed(line.substr(at, end - at));
    if (separator != ' ' || !field.empty()) {
      fields.text.push_back(field);
      fields.begin.push_back(field.empty() ? at : static_cast<std::size_t>(field.data() - line.data()));
    }
    at = end + 1;
  }
  return fields;
}

/// A number that is the whole text; nothing else.
std::optional<double> number_of(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const Decimal number = read_decimal(text);
  if (number.length == 0 || number.length != text.size() || number.too_large) return {};
  return number.value;
}

class DataFile {
 public:
  DataFile(const JsonValue& object, const FieldName& field, SceneTemplate& scene, Diagnostics& diagnostics)
      : object_(object), field_(field.text()), scene_(scene), diagnostics_(diagnostics) {}

  DataColumns read(std::span<const ExpectedDimension> dimensions, std::span<const std::string_view> beside) {
    std::vector<std::string_view> all(keys.begin(), keys.end());
    all.insert(all.end(), beside.begin(), beside.end());
    std::vector<JsonValue> v(all.size());
    if (!read_members(object_, all, field_, v, diagnostics_)) return {};
    if (!open(v[0])) return {};
    std::vector<std::vector<double>> rows = read_lines();
    if (rows.empty()) return {};
    const std::vector<std::size_t> places = find_columns(v[1], dimensions.size(), rows.front().size());
    const std::vector<double> factors = find_units(v[2], dimensions);
    if (places.empty() || factors.empty()) return {};
    DataColumns columns{std::vector<std::vector<double>>(dimensions.size())};
    for (std::size_t c = 0; c < columns.values.size(); ++c) {
      for (const std::vector<double>& row : rows) columns.values[c].push_back(factors[c] * row[places[c]]);
    }
    if (v[3]) read_smoothing(v[3], dimensions.back(), factors.back(), columns);
    return columns;
  }

 private:
  bool open(const JsonValue& path) {
    const std::string name(read_string(path, {"file", field_}, diagnostics_));
    if (!path.is(JsonKind::string)) return false;
    const std::filesystem::path folder = std::filesystem::path(scene_.source->name()).parent_path();
    try {
      scene_.data_files.push_back(std::make_unique<SourceText>(SourceText::read((folder / name).string())));
    } catch (const FileError& error) {
      report(path, fmt::format("{}: {}", field_, error.what()), diagnostics_);
      return false;
    }
    return true;
  }

  /// Empty, with a report, unless every line is good.
  std::vector<std::vector<double>> read_lines() {
    const SourceText& file = *scene_.data_files.back();
    const std::string_view text = file.text();
    std::vector<std::vector<double>> rows;
    bool first = true;
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = std::min(text.find('\n', at), text.size());
      const std::string_view line = text.substr(at, end - at);
      const std::size_t begin = at;
      at = end + 1;
      if (trimmed(line).empty() || trimmed(line).starts_with('#')) continue;
      const Fields fields = split(line);
      std::vector<double> row;
      for (std::size_t k = 0; k < fields.text.size(); ++k) {
        const std::optional<double> number = number_of(fields.text[k]);
        if (!number && first && k == 0) break;
        if (!number) {
          diagnostics_.error(file, begin + fields.begin[k],
                             fmt::format("{} is not a number, wanted for {}", in_quotes(fields.text[k]), field_));
          return {};
        }
        row.push_back(*number);
      }
      if (first && row.empty()) {
        names_.assign(fields.text.begin(), fields.text.end());
        first = false;
        continue;
      }
      first = false;
      const std::size_t wanted = rows.empty() ? row.size() : rows.front().size();
      if (row.size() != wanted) {
        diagnostics_.error(file, begin,
                           fmt::format("this line has {} numbers, those before have {}", row.size(), wanted));
        return {};
      }
      rows.push_back(std::move(row));
    }
    if (rows.empty())
      report(object_, fmt::format("{}: {} holds no numbers", field_, in_quotes(file.name())), diagnostics_);
    return rows;
  }

  std::vector<std::size_t> find_columns(const JsonValue& list, std::size_t wanted, std::size_t there) {
    const auto wrong = [&](const JsonValue& at, const std::string& message) {
      report(at, FieldName{"columns", field_}.text() + " " + message, diagnostics_);
      return std::vector<std::size_t>();
    };
    std::vector<std::size_t> places;
    const std::vector<JsonValue> given = list ? entries(list, 1) : std::vector<JsonValue>();
    if (list && given.size() != wanted)
      return wrong(list,
                   fmt::format("must be a list of {}: numbers from 1, or names in the file's first line", wanted));
    if (list) {
      for (const JsonValue& value : given) {
        std::size_t place = there;
        if (value.is(JsonKind::string)) {
          place = static_cast<std::size_t>(std::find(names_.begin(), names_.end(), value.text()) - names_.begin());
          if (place >= names_.size())
            return wrong(value, fmt::format("names {}, which the file's first line does not{}", in_quotes(value.text()),
                                            NearMiss(value.text()).consider_all(names_).hint()));
        } else if (value.is(JsonKind::number) && value.number() >= 1 && value.number() == std::floor(value.number())) {
          place = static_cast<std::size_t>(value.number()) - 1;
        } else {
          return wrong(value, "are numbers from 1, or names");
        }
        if (place >= there) return wrong(value, fmt::format("has a number beyond the {} columns of the file", there));
        places.push_back(place);
      }
    } else {
      for (std::size_t k = 0; k < wanted; ++k) places.push_back(k);
    }
    if (there < wanted) return wrong(object_, fmt::format("must be {}; the file has {}", wanted, there));
    return places;
  }

  /// The SI value of one unit of every column.
  std::vector<double> find_units(const JsonValue& list, std::span<const ExpectedDimension> dimensions) {
    std::vector<double> factors(dimensions.size(), 1.0);
    if (!list) return factors;
    const std::vector<JsonValue> given = entries(list, dimensions.size());
    if (given.size() != dimensions.size()) {
      report(list, fmt::format("{} must be a list of {} units", FieldName{"unit", field_}.text(), dimensions.size()),
             diagnostics_);
      return {};
    }
    std::size_t k = 0;
    for (const JsonValue& value : given) {
      const std::string_view text = read_string(value, {"unit", field_}, diagnostics_);
      if (!value.is(JsonKind::string)) return {};
      const Parsed<Quantity> quantity = parse_quantity("1 " + std::string(text));
      if (!quantity || (dimensions[k] && !(quantity->dimension == *dimensions[k]))) {
        report(value,
               quantity ? fmt::format("{}: {} is not a unit of {}", field_, in_quotes(text), describe(*dimensions[k]))
                        : fmt::format("{}: {}", field_, quantity.error.message),
               diagnostics_);
        return {};
      }
      factors[k++] = quantity->value;
    }
    return factors;
  }

  void read_smoothing(const JsonValue& value, const ExpectedDimension& dimension, double unit, DataColumns& columns) {
    const std::string wanted = fmt::format(
        "{}: \"smooth\" must be the root mean square by which values may be moved, as a quantity or a number in the "
        "unit of the last column, not negative",
        field_);
    columns.smooth_place = value;
    if (value.is(JsonKind::number)) {
      columns.smooth = unit * value.number();
    } else if (value.is(JsonKind::string)) {
      const Parsed<Quantity> quantity = parse_quantity(value.text());
      if (!quantity || (dimension && !(quantity->dimension == *dimension))) return report(value, wanted, diagnostics_);
      columns.smooth = quantity->value;
    } else {
      return report(value, wanted, diagnostics_);
    }
    if (!(columns.smooth >= 0)) report(value, wanted, diagnostics_);
  }

  const JsonValue& object_;
  std::string field_;
  SceneTemplate& scene_;
  Diagnostics& diagnostics_;
  std::vector<std::string> names_;  // in the first line
};

}  // namespace

bool is_data_file(const JsonValue& value) { return value.is(JsonKind::object) && value.find("file"); }

DataColumns read_data_file(const JsonValue& object, std::span<const ExpectedDimension> dimensions,
                           const FieldName& field, SceneTemplate& scene, Diagnostics& diagnostics,
                           std::span<const std::string_view> beside) {
  return DataFile(object, field, scene, diagnostics).read(dimensions, beside);
}

bool read_members_or_file(const JsonValue& object, std::span<const std::string_view> keys, std::size_t pairs,
                          std::string_view owner, std::span<JsonValue> out, Diagnostics& diagnostics) {
  if (!is_data_file(object)) return read_members(object, keys, owner, out, diagnostics);
  for (std::size_t k = 0; k < keys.size(); ++k) out[k] = object.find(keys[k]);
  if (out[pairs])
    report(out[pairs], fmt::format("{} has {} or \"file\", not both", owner, in_quotes(keys[pairs])), diagnostics);
  out[pairs] = object;
  return true;
}

}  // namespace catena
