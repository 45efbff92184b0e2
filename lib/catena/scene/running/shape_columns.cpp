#include "catena/scene/running/shape_columns.hpp"

#include <algorithm>
#include <map>

#include "catena/columns/column_names.hpp"

namespace catena {
namespace {

/// The column whose value is the rate of change of another: its share in a motion is the other's in a shape.
const std::map<ColumnKind, ColumnKind>& rates() {
  static const std::map<ColumnKind, ColumnKind> all{{ColumnKind::x, ColumnKind::vx},
                                                    {ColumnKind::y, ColumnKind::vy},
                                                    {ColumnKind::angle, ColumnKind::omega},
                                                    {ColumnKind::value, ColumnKind::rate},
                                                    {ColumnKind::joint_angle, ColumnKind::joint_omega},
                                                    {ColumnKind::slide, ColumnKind::slide_rate},
                                                    {ColumnKind::length, ColumnKind::length_rate}};
  return all;
}

/// The name of the column that shows the rate of `column`: that with the ending of its kind.
std::string rate_name(const NamedColumn& column, const Model& model) {
  const auto rate = rates().find(column.column.kind);
  if (rate == rates().end()) return {};
  static const std::map<ColumnKind, std::string_view> endings{{ColumnKind::vx, "vx"},
                                                              {ColumnKind::vy, "vy"},
                                                              {ColumnKind::omega, "omega"},
                                                              {ColumnKind::rate, "rate"},
                                                              {ColumnKind::joint_omega, "omega"},
                                                              {ColumnKind::slide_rate, "slide_rate"},
                                                              {ColumnKind::length_rate, "rate"}};
  const std::string& name = column.info.name;
  const std::string named = name.substr(0, name.rfind('.') + 1) + std::string(endings.at(rate->second));
  std::vector<NamedColumn> found;
  return find_columns(model, named, found) ? std::string() : named;
}

}  // namespace

ShapeColumns::ShapeColumns(const Model& model, const Plan& plan, const std::vector<std::string>& outputs,
                           std::string_view analysis)
    : plan_(plan), qd_(static_cast<std::size_t>(plan.coordinates()), 0.0) {
  std::vector<NamedColumn> named;
  if (outputs.empty()) named = default_columns(model);
  for (const std::string& name : outputs) find_columns(model, name, named);
  std::vector<std::string> rate_names;
  std::string first_left_out;
  int left_out = 0;
  for (NamedColumn& column : named) {
    std::string rate = rate_name(column, model);
    if (rate.empty()) {
      if (left_out++ == 0) first_left_out = column.info.name;
      continue;
    }
    if (std::find(rate_names.begin(), rate_names.end(), rate) != rate_names.end()) continue;
    rate_names.push_back(std::move(rate));
    info_.push_back(std::move(column.info));
  }
  if (left_out > 0) {
    note_ = "left out " + first_left_out + (left_out > 1 ? " and " + std::to_string(left_out - 1) + " more" : "") +
            ": shapes show positions, angles and lengths only";
  }
  // Without names the default columns would come.
  if (!rate_names.empty())
    columns_ = ColumnSet::resolve(model, plan, rate_names, {.analysis = analysis, .velocity = true});
}

void ShapeColumns::evaluate(const Evaluator& evaluator, std::span<const double> q, std::span<const double> shape,
                            std::span<double> out) {
  if (!columns_) return;
  for (std::size_t c = 0; c < shape.size(); ++c) qd_[static_cast<std::size_t>(plan_.coordinate[c])] = shape[c];
  columns_->evaluate({.evaluator = evaluator, .t = evaluator.time(), .q = q, .qd = qd_}, out);
}

}  // namespace catena
