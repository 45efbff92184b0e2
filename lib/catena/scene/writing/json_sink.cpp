// The result document, written as results come: nothing but the row at hand is kept.
#include <cmath>
#include <limits>
#include <optional>

#include "catena/results/measure_gradient.hpp"
#include "catena/results/status_word.hpp"
#include "catena/scene/json/json_text.hpp"
#include "catena/scene/running/scene_runner.hpp"
#include "catena/scene/writing/field_json.hpp"

namespace catena {
namespace {

void append_json(std::string& out, const std::string& text) { catena::append_json(out, std::string_view(text)); }

void append_key(std::string& out, std::string_view key) {
  out += ", ";
  catena::append_json(out, key);
  out += ": ";
}

template <class Range, class F>
void append_list(std::string& out, const Range& range, F&& append) {
  out += '[';
  bool first = true;
  for (const auto& entry : range) {
    if (!first) out += ", ";
    first = false;
    append(entry);
  }
  out += ']';
}

/// {"name": value, ...}
template <class Pairs>
void append_object(std::string& out, const Pairs& pairs) {
  out += '{';
  bool first = true;
  for (const auto& [name, value] : pairs) {
    if (!first) out += ", ";
    first = false;
    append_json(out, name);
    out += ": ";
    catena::append_json(out, value);
  }
  out += '}';
}

struct FieldWriter {
  std::string& out;

  void operator()(bool value) const { catena::append_json(out, value); }
  void operator()(std::int64_t value) const { catena::append_json(out, value); }
  void operator()(double value) const { catena::append_json(out, value); }
  void operator()(const std::string& value) const { catena::append_json(out, std::string_view(value)); }
  void operator()(const std::vector<double>& list) const {
    append_list(out, list, [&](double value) { catena::append_json(out, value); });
  }
  void operator()(const std::vector<std::string>& list) const {
    append_list(out, list, [&](const std::string& value) { append_json(out, value); });
  }
  void operator()(const std::vector<FieldRecord>& records) const {
    append_list(out, records, [&](const FieldRecord& record) { (*this)(record); });
  }
  void operator()(const std::shared_ptr<const LongList>& list) const {
    out += '[';
    list->for_each([&, first = true](const FieldRecord& record) mutable {
      if (!first) out += ", ";
      first = false;
      (*this)(record);
      return true;
    });
    out += ']';
  }
  void operator()(const FieldRecord& record) const {
    out += '{';
    bool first = true;
    for (const auto& [name, value] : record) {
      if (!first) out += ", ";
      first = false;
      append_json(out, name);
      out += ": ";
      std::visit(*this, value);
    }
    out += '}';
  }
};

double value_or_none(const std::optional<double>& value) {
  return value.value_or(std::numeric_limits<double>::quiet_NaN());  // written as null
}

/// "measures": {"peak": {"value": 3.2, "unit": "N m", "t": 0.31}}, and "gradients": {"peak": {"a": 0.7}}.
void append_measures(std::string& out, const AnalysisResult& result) {
  if (result.measures.empty()) return;
  std::string gradients;
  append_key(out, "measures");
  for (const MeasureResult& measure : result.measures) {
    const bool first = &measure == &result.measures.front();
    for (std::string* text : {&out, &gradients}) {
      *text += first ? "{" : ", ";
      append_json(*text, measure.name);
    }
    FieldRecord record{{"value", value_or_none(measure.value)}, {"unit", measure.unit}};
    if (measure.t) record.emplace_back("t", *measure.t);
    out += ": ";
    FieldWriter{out}(record);
    gradients += ": ";
    append_object(gradients, named_gradient(result, measure));
  }
  out += '}';
  if (result.gradient_parameters.empty()) return;
  append_key(out, "gradients");
  out += gradients + '}';
}

/// "extremes": {"crank.x": {"least": 0, "least_t": 0.1, "largest": 1, "largest_t": 0.3}}.
void append_extremes(std::string& out, const AnalysisResult& result) {
  if (result.extremes.empty()) return;
  append_key(out, "extremes");
  const std::string_view kind = result.extremes_have_time ? "_t" : "_row";
  for (const ColumnExtreme& column : result.extremes) {
    out += &column == &result.extremes.front() ? "{" : ", ";
    append_json(out, column.name);
    out += ": ";
    FieldWriter{out}(FieldRecord{{"least", column.least},
                                 {"least" + std::string(kind), column.least_t},
                                 {"largest", column.largest},
                                 {"largest" + std::string(kind), column.largest_t}});
  }
  out += '}';
}

/// "digits": {"crank.angle": 13.2}, of the columns of which they are known.
void append_digits(std::string& out, const AnalysisResult& result) {
  if (result.digits.empty()) return;
  std::vector<std::pair<std::string, double>> known;
  for (std::size_t k = 0; k < result.digits.size(); ++k) {
    // Tenths, rounded down: more is not told by an estimate.
    if (std::isfinite(result.digits[k]))
      known.emplace_back(result.columns[k].name, std::floor(10 * result.digits[k]) / 10);
  }
  append_key(out, "digits");
  append_object(out, known);
}

void append_counters(std::string& out, const Counters& c) {
  const std::pair<std::string_view, std::int64_t> all[] = {{"symbolic", c.symbolic},
                                                           {"factorizations", c.factorizations},
                                                           {"refactorizations", c.refactorizations},
                                                           {"solves", c.solves},
                                                           {"iterations", c.iterations},
                                                           {"configurations", c.configurations},
                                                           {"phis", c.phis},
                                                           {"jacobians", c.jacobians},
                                                           {"nus", c.nus},
                                                           {"gammas", c.gammas},
                                                           {"forces", c.forces},
                                                           {"hessians", c.hessians},
                                                           {"fallbacks", c.fallbacks},
                                                           {"steps", c.steps},
                                                           {"rejected", c.rejected}};
  out += '{';
  bool first = true;
  for (const auto& [name, value] : all) {
    if (!first) out += ", ";
    first = false;
    catena::append_json(out, name);
    out += ": ";
    catena::append_json(out, value);
  }
  out += '}';
}

/// Names and units of columns; which of them are a status.
std::vector<bool> append_columns(std::string& out, std::span<const ColumnInfo> columns) {
  std::vector<bool> is_status;
  append_key(out, "columns");
  append_list(out, columns, [&](const ColumnInfo& column) { append_json(out, column.name); });
  for (const ColumnInfo& column : columns) is_status.push_back(column.is_status);
  append_key(out, "units");
  append_list(out, columns, [&](const ColumnInfo& column) { catena::append_json(out, column.unit_text()); });
  return is_status;
}

void append_row(std::string& out, std::span<const double> values, const std::vector<bool>& is_status) {
  std::size_t k = 0;
  append_list(out, values, [&](double value) {
    if (is_status[k++])
      catena::append_json(out, status_word(value));
    else
      catena::append_json(out, value);
  });
}

/// The rows of one analysis alone: {"catena": 1, "columns", "units", "rows"}.
class JsonRowWriter final : public RowWriter {
 public:
  explicit JsonRowWriter(TextOutput& output) : output_(output) {}

  void begin(std::span<const ColumnInfo> columns) override {
    text_ = "{\"catena\": 1";
    is_status_ = append_columns(text_, columns);
    append_key(text_, "rows");
    text_ += '[';
    output_.write(text_);
  }
  bool row(std::span<const double> values) override {
    text_ = any_ ? ",\n  " : "\n  ";
    any_ = true;
    append_row(text_, values, is_status_);
    output_.write(text_);
    return true;
  }
  void finish() override { output_.write(any_ ? "\n]}\n" : "]}\n"); }

 private:
  TextOutput& output_;
  std::string text_;
  std::vector<bool> is_status_;
  bool any_ = false;
};

class JsonSink final : public ResultSink, private RowSink {
 public:
  JsonSink(TextOutput& output, JsonRows rows) : output_(output), with_rows_(rows == JsonRows::written) {}

  void begin_run(const RunHeader& header) override {
    text_ = "{\"catena\": 1";
    append_key(text_, "scene");
    append_json(text_, header.scene);
    append_key(text_, "version");
    append_json(text_, header.version);
    append_key(text_, "gravity");
    append_list(text_, header.gravity, [&](double value) { catena::append_json(text_, value); });
    append_key(text_, "parameters");
    append_object(text_, header.parameters);
    append_key(text_, "set");
    append_object(text_, header.set);
    append_key(text_, "analyses");
    text_ += '[';
    send();
  }
  RowSink& begin_analysis(std::string_view type) override {
    text_ = count_++ > 0 ? ",\n  {\"type\": " : "\n  {\"type\": ";
    catena::append_json(text_, type);
    rows_ = -1;
    has_table_ = type != "check";
    send();
    return *this;
  }
  void end_analysis(const AnalysisResult& result) override {
    if (has_table_ && rows_ < 0) begin({});  // refused before its columns were known: a table without any
    text_.clear();
    if (rows_ >= 0 && with_rows_) text_ += rows_ > 0 ? "\n  ]" : "]";
    append_report(result);
    if (!result.set.empty()) {
      append_key(text_, "set");
      append_object(text_, result.set);
    }
    append_digits(text_, result);
    append_measures(text_, result);
    append_extremes(text_, result);
    for (const NamedField& field : result.fields) {
      append_key(text_, field.name);
      if (const auto* list = std::get_if<std::shared_ptr<const LongList>>(&field.value)) {
        send_list(**list);
      } else {
        append_field(text_, field.value);
      }
    }
    text_ += '}';
    send();
  }
  void end_run() override {
    text_ = count_ > 0 ? "\n]}\n" : "]}\n";
    send();
    output_.flush();
  }

 private:
  void begin(std::span<const ColumnInfo> columns) override {
    text_.clear();
    is_status_ = append_columns(text_, columns);
    if (with_rows_) {
      append_key(text_, "rows");
      text_ += '[';
    }
    rows_ = 0;
    send();
  }
  bool row(std::span<const double> values) override {
    if (!with_rows_) return true;
    text_ = rows_++ > 0 ? ",\n    " : "\n    ";
    append_row(text_, values, is_status_);
    send();
    return true;
  }

  void append_report(const AnalysisResult& result) {
    const AnalysisReport& report = result.report;
    append_key(text_, "status");
    catena::append_json(text_, to_string(report.status));
    append_key(text_, "message");
    append_json(text_, report.message);
    append_key(text_, "warnings");
    append_list(text_, report.warnings, [&](const std::string& warning) { append_json(text_, warning); });
    const auto append_count = [&](std::string_view name, const std::optional<int>& value) {
      if (!value) return;
      append_key(text_, name);
      catena::append_json(text_, std::int64_t{*value});
    };
    const bool structure = !result.has_rows && report.bodies > 0;  // a table has its rows, a refused analysis nothing
    if (structure) {
      append_count("bodies", report.bodies);
      append_count("rows", report.rows);
      append_count("rank", report.rank);
    }
    append_count("dof", report.dof);
    append_count("mobility", report.mobility);
    append_key(text_, "redundant");
    append_list(text_, report.redundant, [&](const std::string& name) { append_json(text_, name); });
    if (structure) append_count("islands", report.islands);
    append_key(text_, "seconds");
    catena::append_json(text_, report.seconds);
    append_key(text_, "counters");
    append_counters(text_, report.counters);
  }
  /// A line a record, each sent as it comes.
  void send_list(const LongList& list) {
    text_ += '[';
    list.for_each([&, first = true](const FieldRecord& record) mutable {
      text_ += first ? "\n    " : ",\n    ";
      first = false;
      FieldWriter{text_}(record);
      send();
      text_.clear();
      return output_.ok();
    });
    text_ += ']';
  }
  void send() { output_.write(text_); }

  TextOutput& output_;
  bool with_rows_;
  std::string text_;             // what goes out next; kept for its memory
  int count_ = 0;                // analyses so far
  std::vector<bool> is_status_;  // by column
  std::int64_t rows_ = -1;
  bool has_table_ = false;
};

}  // namespace

void append_field(std::string& out, const FieldValue& value) { std::visit(FieldWriter{out}, value); }

std::unique_ptr<ResultSink> json_result_sink(TextOutput& output, JsonRows rows) {
  return std::make_unique<JsonSink>(output, rows);
}

std::unique_ptr<RowWriter> json_row_writer(TextOutput& output) { return std::make_unique<JsonRowWriter>(output); }

std::string invalid_json(const SceneOutcome& outcome) {
  std::string out = "{\"catena\": 1, \"status\": \"invalid\", \"errors\": ";
  append_list(out, outcome.errors, [&](const Diagnostic& error) {
    out += "\n  {\"file\": ";
    append_json(out, error.file);
    append_key(out, "line");
    catena::append_json(out, std::int64_t{error.line});
    append_key(out, "column");
    catena::append_json(out, std::int64_t{error.column});
    append_key(out, "message");
    append_json(out, error.message);
    out += '}';
  });
  return out + "}\n";
}

}  // namespace catena
