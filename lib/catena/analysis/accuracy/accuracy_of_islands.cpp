#include "catena/analysis/accuracy/accuracy_of_islands.hpp"

#include <cmath>
#include <limits>
#include <optional>

#include "catena/columns/column_names.hpp"

namespace catena {

/// The columns of all that are named in a part, and their errors there.
class AccuracyOfIslands::Part final : public RowObserver {
 public:
  Part(DynamicsWithEvents& motion, std::span<const ColumnInfo> all, const ColumnSources& sources) {
    const Model& model = motion.evaluator().model();
    std::vector<std::string> names;
    std::vector<NamedColumn> found;
    for (std::size_t k = 0; k < all.size(); ++k) {
      found.clear();
      if (find_columns(model, all[k].name, found) || found.size() != 1) continue;
      names.push_back(all[k].name);
      in_all_.push_back(k);
    }
    if (names.empty() || motion.has_contacts()) return;
    columns_.emplace(ColumnSet::resolve(model, motion.plan(), names, sources));
    values_.resize(columns_->size());
    accuracy_.emplace(motion, *columns_);
  }

  bool observe(const Snapshot& snapshot) override {
    if (!accuracy_) return true;
    columns_->evaluate(snapshot, values_);
    accuracy_->take(snapshot, values_);
    return true;
  }
  /// Adds its errors to those of all columns, which are below zero where none is known yet.
  void add_errors(const AnalysisReport& report, std::span<const ColumnInfo> all, std::span<double> errors) {
    const ColumnErrors* known = accuracy_ ? accuracy_->errors(report) : nullptr;
    // Both lists have one order.
    for (std::size_t own = 0; own < in_all_.size(); ++own) {
      const std::size_t k = in_all_[own];
      const bool same = known && own < values_.size() && columns_->info()[own].name == all[k].name;
      const double error = same ? known->error(own) : std::numeric_limits<double>::quiet_NaN();
      errors[k] = errors[k] < 0 ? error : errors[k] + error;
    }
  }

 private:
  std::vector<std::size_t> in_all_;
  std::optional<ColumnSet> columns_;
  std::vector<double> values_;
  std::optional<MotionAccuracy> accuracy_;
};

AccuracyOfIslands::AccuracyOfIslands(DynamicsOfIslands& analysis, const ColumnSet& columns,
                                     const ColumnSources& sources)
    : analysis_(analysis), columns_(columns), errors_(columns.size()) {
  for (std::size_t p = 0; p < analysis.classes(); ++p) {
    parts_.push_back(std::make_unique<Part>(analysis.motion_of(p), columns.info(), sources));
    analysis.watch_rows_of(p, parts_.back().get());
  }
}

AccuracyOfIslands::~AccuracyOfIslands() {
  for (std::size_t p = 0; p < parts_.size(); ++p) analysis_.watch_rows_of(p, nullptr);
}

void AccuracyOfIslands::take(const Snapshot&, std::span<const double> values) {
  errors_.take_row(values.first(columns_.size()));
}

std::vector<double> AccuracyOfIslands::digits(const AnalysisReport& report) {
  std::vector<double> errors(columns_.size(), -1);
  for (const auto& part : parts_) part->add_errors(report, columns_.info(), errors);
  bool any = false;
  for (std::size_t k = 0; k < errors.size(); ++k) {
    any = any || errors[k] >= 0;
    if (!(errors[k] < 0)) errors_.take_error(k, errors[k]);
  }
  return any ? MotionAccuracy::claimed(errors_) : std::vector<double>{};
}

}  // namespace catena
