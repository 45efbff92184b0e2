// sensitivity: an analysis with derivatives of its rows and measures by parameters.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "catena/results/result_storage.hpp"
#include "catena/scene/designing/measured_design.hpp"
#include "catena/scene/designing/missing_derivatives.hpp"
#include "catena/scene/designing/no_rows.hpp"

namespace catena {
namespace {

// Differences of second order: the step that balances rounding (1e-12 of a run) with the cube of the step.
constexpr double part_of_parameter = 1e-4;
// Where derivatives are off by more than this the step may be too long for differences, as of cables as stiff as
// millimetres of elongation make them: then one shorter by this decides, whose rounding is 1e-6.
constexpr double suspicious = 1e-3, shorter = 1e-2;
// A column that is below this everywhere, in SI units, is rounding of zero, and so are its differences.
constexpr double no_output = 1e-13;
// Length scales or rad: a place that is an equilibrium is found again to this.
constexpr double same_place = 1e-6;
// Instants of rows are multiples of a step, rounded to 1e-16.
constexpr double same_instant = 1e-12;

/// Passes rows on and keeps them.
class KeptRows final : public RowSink {
 public:
  explicit KeptRows(RowSink* target) : target_(target) {}
  void begin(std::span<const ColumnInfo> columns) override {
    kept.begin(columns);
    if (target_) target_->begin(columns);
  }
  bool row(std::span<const double> values) override {
    kept.row(values);
    return !target_ || target_->row(values);
  }
  ResultStorage kept;

 private:
  RowSink* target_;
};

/// Derivatives against central differences: the largest deviation relative to the larger of the derivative and the size
/// of the output over that of the parameter.
class Comparison {
 public:
  /// `names` of the parameters by which was differentiated.
  Comparison(const AnalysisContext& context, const SystemState& start, const std::vector<std::string>& names,
             const AnalysisResult& result, const ResultStorage& rows)
      : context_(context), start_(start), names_(names), result_(result), rows_(rows) {
    find_place();
    const std::vector<double> values = context_.models->values(*context_.task.of.front().table, context_.seeds);
    for (std::size_t p = 0; p < names_.size(); ++p)
      compare(p, values[static_cast<std::size_t>(context_.task.design_parameters[p])]);
  }

  /// Nothing where there was nothing to compare.
  std::optional<double> deviation() const { return compared_ > 0 ? std::optional(largest_) : std::nullopt; }
  /// What could not be compared, in sentences.
  const std::vector<std::string>& doubts() const { return doubts_; }

 private:
  void doubt(const std::string& name, std::string_view why) {
    doubts_.push_back(fmt::format("\"verify\" of the derivatives by \"{}\": {}", name, why));
  }

  // Modes about an equilibrium that an analysis before left are those of its place, which moves with the parameters.
  void find_place() {
    const AnalysisTask& modes = context_.task.of.front();
    if (modes.type() != "modes" || start_.q.empty()) return;
    place_.description = find_analysis_type("equilibrium");
    place_.parameters = modes.parameters;
    place_.table = modes.table;
    place_.set_parameters = modes.set_parameters;
    SystemState state = start_;
    moves_ = go_to_place(context_.seeds, state);
    const double length = Equations(Plan::make(*context_.model), *context_.model).length_scale();
    for (std::size_t c = 0; moves_ && c < start_.q.size(); ++c)
      moves_ = std::abs(state.q[c] - start_.q[c]) <= same_place * (c % 3 == 2 ? 1 : length);
  }

  bool go_to_place(const ParameterSeeds& seeds, SystemState& state) {
    NoRows none;
    AnalysisResult found;
    InnerRun run{.seeds = seeds, .state = state, .rows = none};
    return run_inner(context_, place_, run, found) && found.report.ok();
  }

  /// The analysis with the parameter on either side; false, and told, where it cannot be analysed there.
  bool run_beside(std::size_t p, double value, double step, const AnalysisTask& task, std::array<KeptRows, 2>& rows,
                  std::array<AnalysisResult, 2>& shifted) {
    for (std::size_t side = 0; side < 2; ++side) {
      const double at = value + (side == 0 ? -step : step);
      ParameterSeeds seeds = context_.seeds;
      seeds.push_back({context_.task.design_parameters[p], at});
      SystemState state = start_;
      if (moves_ && !go_to_place(seeds, state)) {
        doubt(names_[p], fmt::format("at {:.12g} no equilibrium is found for the modes", at));
        return false;
      }
      InnerRun run{.seeds = seeds, .state = state, .rows = rows[side]};
      run_inner(context_, task, run, shifted[side]);
      if (shifted[side].report.ok()) continue;
      doubt(names_[p], fmt::format("at {:.12g} the analysis ends with {}: {}", at,
                                   to_string(shifted[side].report.status), shifted[side].report.message));
      return false;
    }
    return true;
  }

  /// The task with its rows at the instants that they have now, whatever the parameters; nothing where none move.
  std::optional<AnalysisTask> with_fixed_rows(std::size_t p) const {
    AnalysisTask task = context_.task.of.front();
    const auto is_of_rows = [](const TaskNumber& number) {
      return number.place == TaskNumber::Place::instant ||
             (number.place == TaskNumber::Place::key &&
              (number.key->name == "every" || number.key->name == "until" || number.key->name == "at"));
    };
    if (context_.models->set_parameters(task, context_.seeds)) return std::nullopt;
    const int parameters[] = {context_.task.design_parameters[p]};
    const auto moving = context_.models->moving_numbers(task, context_.seeds, parameters);
    const bool any = std::any_of(moving.front().begin(), moving.front().end(),
                                 [&](const SceneModels::MovingNumber& one) { return is_of_rows(one.number); });
    if (!any) return std::nullopt;
    std::erase_if(task.varying, is_of_rows);
    return task;
  }

  // A wrong derivative is off from differences of any step, a right one from those of steps that are too long for it.
  void compare(std::size_t p, double value) {
    const double size = value != 0 ? std::abs(value) : 1, before = std::exchange(largest_, 0.0);
    compare_at_distance(p, value, size, part_of_parameter * size);
    if (largest_ > suspicious) {
      const std::vector<std::string> doubts = doubts_;
      const std::int64_t compared = std::exchange(compared_, 0);
      const double longer = std::exchange(largest_, 0.0);
      compare_at_distance(p, value, size, shorter * part_of_parameter * size);
      if (compared_ == 0 || largest_ > longer) largest_ = longer;
      doubts_ = doubts;
      compared_ = compared;
    }
    largest_ = std::max(largest_, before);
  }

  void compare_at_distance(std::size_t p, double value, double size, double step) {
    std::array<KeptRows, 2> rows{KeptRows(nullptr), KeptRows(nullptr)};
    std::array<AnalysisResult, 2> shifted;
    if (!run_beside(p, value, step, context_.task.of.front(), rows, shifted)) return;
    const std::int64_t before = compared_;
    const auto take = [&](double derivative, double below, double above, double scale) {
      const double difference = (above - below) / (2 * step);
      if (!std::isfinite(derivative) || !std::isfinite(difference)) return;
      ++compared_;
      const double unit = std::max({std::abs(derivative), std::abs(difference), scale / size});
      if (unit > 0) largest_ = std::max(largest_, std::abs(derivative - difference) / unit);
    };
    // What is rounding of zero agrees, with its differences.
    const auto take_measure = [&](double derivative, double below, double above, double scale) {
      const double largest = std::max({std::abs(derivative), scale, std::abs(below), std::abs(above)});
      if (largest > no_output)
        take(derivative, below, above, scale);
      else
        ++compared_;
    };
    for (std::size_t m = 0; m < result_.measures.size(); ++m) {
      if (m >= shifted[0].measures.size() || m >= shifted[1].measures.size()) break;
      const auto &below = shifted[0].measures[m].value, &above = shifted[1].measures[m].value;
      if (below && above && result_.measures[m].value && p < result_.measures[m].gradient.size())
        take_measure(result_.measures[m].gradient[p], *below, *above, std::abs(*result_.measures[m].value));
    }
    // Derivatives of rows are those at fixed instants.
    if (const std::optional<AnalysisTask> fixed = with_fixed_rows(p)) {
      rows = {KeptRows(nullptr), KeptRows(nullptr)};
      shifted = {};
      if (!run_beside(p, value, step, *fixed, rows, shifted)) return;
    }
    compare_rows(names_[p], rows[0].kept, rows[1].kept, take);
    if (compared_ == before) doubt(names_[p], "there was nothing to compare: no derivative that is a number");
  }

  /// The row of `rows` at the instant of row r of the run itself: that of the same number where there is no time;
  /// nothing where there is no such row, as that of an event which came elsewhere.
  std::optional<std::size_t> row_like(const ResultStorage& rows, std::size_t r) const {
    const auto t = rows_.find("t"), other = rows.find("t");
    if (!t || !other) return rows.rows() == rows_.rows() ? std::optional(r) : std::nullopt;
    // It has the same number or, beside a row that only one of the two has, nearly the same: outwards from there.
    const std::size_t count = rows.rows();
    for (std::size_t n = 0; n < count; ++n) {
      const std::size_t away = (n + 1) / 2, k = (r % count + (n % 2 == 0 ? away : count - away)) % count;
      const double here = rows_.at(r, *t), there = rows.at(k, *other);
      if (std::abs(here - there) <= same_instant * std::max(std::abs(here), std::abs(there))) return k;
    }
    return std::nullopt;
  }

  template <class Take>
  void compare_rows(const std::string& parameter, const ResultStorage& below, const ResultStorage& above, Take&& take) {
    // Rows that have partners on both sides.
    std::vector<std::array<std::size_t, 3>> matched;
    for (std::size_t r = 0; r < rows_.rows(); ++r) {
      const auto low = row_like(below, r), high = row_like(above, r);
      if (low && high) matched.push_back({r, *low, *high});
    }
    bool has_derivatives = false;
    for (std::size_t c = 0; c < below.columns().size(); ++c) {
      const std::string& name = below.columns()[c].name;
      const auto column = rows_.find(fmt::format("d({})/d({})", name, parameter)), plain = rows_.find(name);
      const auto other = above.find(name);
      if (!column || !plain || !other) continue;
      has_derivatives = true;
      double scale = 0;
      for (std::size_t r = 0; r < rows_.rows(); ++r) scale = std::max(scale, std::abs(rows_.at(r, *plain)));
      const auto is_none = [&](const auto& rows) { return std::abs(rows_.at(rows[0], *column)) <= no_output; };
      if (scale <= no_output && std::all_of(matched.begin(), matched.end(), is_none)) continue;
      for (const auto& [r, low, high] : matched)
        take(rows_.at(r, *column), below.at(low, c), above.at(high, *other), scale);
    }
    if (has_derivatives && matched.size() < rows_.rows()) {
      doubt(parameter, fmt::format("{} of {} rows were not compared: they lie at instants that move with it",
                                   rows_.rows() - matched.size(), rows_.rows()));
    }
  }

  const AnalysisContext& context_;
  const SystemState& start_;
  AnalysisTask place_{};  // the equilibrium about which modes are
  bool moves_ = false;    // whether there is one
  const std::vector<std::string>& names_;
  const AnalysisResult& result_;
  const ResultStorage& rows_;
  double largest_ = 0;
  std::int64_t compared_ = 0;  // pairs of numbers
  std::vector<std::string> doubts_;
};

}  // namespace

void run_sensitivity(AnalysisContext& context, AnalysisResult& result) {
  const AnalysisTask& inner = context.task.of.front();
  const auto mode = static_cast<GradientMode>(context.task.word("mode"));
  DesignRequest design{context.task.design_parameters, {}, mode != GradientMode::adjoint, mode};
  for (const int parameter : design.parameters)
    design.names.push_back(context.models->names().all()[static_cast<std::size_t>(parameter)]);
  if (inner.from_initial) context.state = {};
  const SystemState start = context.state;
  const bool verify = context.task.number("verify", 0) != 0;
  KeptRows kept(&context.rows);
  InnerRun run{.seeds = context.seeds,
               .state = context.state,
               .rows = verify ? static_cast<RowSink&>(kept) : context.rows,
               .design = &design,
               .is_shown = true,
               .poses = context.poses};
  if (!run_inner(context, inner, run, result)) return;
  result.fields.push_back({"mode", std::string(run.went_back ? "adjoint" : "forward")});
  MissingDerivatives(*context.models, design).complete(inner, context.seeds, result);
  context.values_at_end = std::move(run.values_at_end);
  result.gradient_parameters = design.names;
  const bool has_rows = std::any_of(result.columns.begin(), result.columns.end(),
                                    [](const ColumnInfo& column) { return column.name.starts_with("d("); });
  if (design.rows && result.rows > 0 && !has_rows) {
    result.report.warnings.push_back(fmt::format(
        "derivatives: the rows of {} have none; what it reports has, as a measure {{\"field\": ...}}", inner.type()));
  }
  if (!verify || !result.report.ok()) return;
  const Comparison comparison(context, start, design.names, result, kept.kept);
  if (const std::optional<double> deviation = comparison.deviation())
    result.fields.push_back({"deviation", *deviation});
  if (context.cancel && context.cancel->load()) {
    result.report.status = Status::cancelled;
    result.report.message = "stopped while derivatives were verified; they stand";
    return;
  }
  for (const std::string& doubt : comparison.doubts()) result.report.warnings.push_back(doubt);
}

}  // namespace catena
