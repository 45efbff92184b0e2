#include "catena/analysis/batch/lane_columns.hpp"

#include <algorithm>

#include "catena/base/at.hpp"
#include "catena/model/attachment.hpp"

namespace catena {
namespace {

// The numbers of one body; `moves`: it has rates.
struct BodyView {
  const double *x, *y, *phi, *c, *s;
  const double *vx = nullptr, *vy = nullptr, *omega = nullptr;
  const double *ax = nullptr, *ay = nullptr, *alpha = nullptr;
  bool moves = false;
};

BodyView body_view(int body, int moving, const LaneView& view, const double* fixed) {
  const auto number = [](const double* base, int k) { return base + lane_count * k; };
  if (body >= moving) {
    const double* const f = number(fixed, 5 * body);
    return {f, number(f, 1), number(f, 2), number(f, 3), number(f, 4)};
  }
  const double *const q = number(view.q, 3 * body), *const v = number(view.qd, 3 * body);
  const double *const a = number(view.qdd, 3 * body), *const turned = number(view.turned, 2 * body);
  return {q, number(q, 1), number(q, 2), turned, number(turned, 1), v, number(v, 1), number(v, 2),
          a, number(a, 1), number(a, 2), true};
}

// Kinds of columns are told apart outside of the loops over lanes.
void evaluate(ColumnKind kind, const BodyView& b, const Vec2<double>& local, int first, int last, double* out) {
  const auto each = [&](auto&& value) {
    for (int k = first; k < last; ++k) out[k] = value(k);
  };
  const auto arm_x = [&](int k) { return b.c[k] * local.x - b.s[k] * local.y; };
  const auto arm_y = [&](int k) { return b.s[k] * local.x + b.c[k] * local.y; };
  switch (kind) {
    case ColumnKind::x:
      return each([&](int k) { return b.x[k] + arm_x(k); });
    case ColumnKind::y:
      return each([&](int k) { return b.y[k] + arm_y(k); });
    case ColumnKind::angle:
      return each([&](int k) { return b.phi[k]; });
    default:
      break;
  }
  if (!b.moves) return each([](int) { return 0.0; });
  switch (kind) {
    case ColumnKind::vx:
      return each([&](int k) { return b.vx[k] - b.omega[k] * arm_y(k); });
    case ColumnKind::vy:
      return each([&](int k) { return b.vy[k] + b.omega[k] * arm_x(k); });
    case ColumnKind::omega:
      return each([&](int k) { return b.omega[k]; });
    case ColumnKind::ax:
      return each([&](int k) { return b.ax[k] - b.alpha[k] * arm_y(k) - b.omega[k] * b.omega[k] * arm_x(k); });
    case ColumnKind::ay:
      return each([&](int k) { return b.ay[k] + b.alpha[k] * arm_x(k) - b.omega[k] * b.omega[k] * arm_y(k); });
    default:
      return each([&](int k) { return b.alpha[k]; });
  }
}

// What multipliers tell.
bool is_load(ColumnKind kind) {
  return kind == ColumnKind::load || kind == ColumnKind::power || kind == ColumnKind::multiplier ||
         kind == ColumnKind::reaction_x || kind == ColumnKind::reaction_y;
}

}  // namespace

std::optional<LaneColumns> LaneColumns::make(const LaneProgram& program, const Model& model,
                                             std::span<const std::string> names) {
  OwnInputs inputs(model.own_columns.size());
  std::vector<NamedColumn> named;
  for (const std::string& name : names) {
    if (find_columns(model, name, named)) return {};
    // What own columns and laws switch by is not computed in lanes.
    if (named.back().column.kind == ColumnKind::own && named.back().column.detail >= 0) return {};
    if (named.back().column.kind == ColumnKind::own && find_own_inputs(model, named.back().column.index, inputs))
      return {};
  }
  if (named.size() != names.size()) return {};
  LaneColumns columns(program, model, std::move(inputs));
  columns.inputs_.resize(columns.own_inputs_.size());
  for (const NamedColumn& one : named) {
    if (!columns.add(one.column, columns.columns_.emplace_back())) return {};
  }
  columns.values_ = LaneNumbers(static_cast<int>(columns.quantities_.size()));
  columns.fixed_ = LaneNumbers(5 * program.code().frames);
  return columns;
}

bool LaneColumns::add(const Column& column, Source& source) {
  if (column.kind == ColumnKind::own) {
    source = {true, at(column.index)};
    std::vector<Source> inputs;
    for (const Column& input : own_inputs_[source.number]) {
      if (!add(input, inputs.emplace_back())) return false;
    }
    inputs_[source.number] = std::move(inputs);
    return true;
  }
  if (column.kind != ColumnKind::time && !is_body_column(column.kind) && !is_load_in_lanes(column)) return false;
  const auto known = std::find_if(quantities_.begin(), quantities_.end(),
                                  [&](const Quantity& quantity) { return quantity.column == column; });
  source = {false, static_cast<std::size_t>(known - quantities_.begin())};
  if (known == quantities_.end()) quantities_.push_back({column});
  return true;
}

bool LaneColumns::is_load_in_lanes(const Column& column) const {
  if (!program_.has_loads() || !is_load(column.kind)) return false;
  const LaneNumbers none(program_.fields());
  const LaneProgram::Constraint constraint = program_.constraint(*model_, column.index, 0, none);
  const bool is_force = column.kind == ColumnKind::reaction_x || column.kind == ColumnKind::reaction_y;
  return constraint.row >= 0 && (!is_force || constraint.pin);
}

void LaneColumns::set_designs(const Model& model, const LaneSolver& solver) {
  model_ = &model;
  fixed_.copy(solver.frame());
  for (Quantity& quantity : quantities_) {
    const Column& column = quantity.column;
    if (is_load(column.kind)) quantity.constraint = program_.constraint(model, column.index, 0, solver.field());
    if (!is_body_column(column.kind)) continue;
    if (column.detail >= 0)
      quantity.local = model.points[at(column.detail)].local;
    else if (column.index >= 0)
      quantity.local = model.bodies[at(column.index)].origin;
  }
}

void LaneColumns::evaluate(const LaneView& view) {
  const Plan& plan = program_.plan();
  for (std::size_t k = 0; k < quantities_.size(); ++k) {
    const auto& [column, local, constraint] = quantities_[k];
    double* const out = values_[static_cast<int>(k)];
    if (column.kind == ColumnKind::time) {
      std::copy(view.t + view.first, view.t + view.last, out + view.first);
      continue;
    }
    if (is_load(column.kind)) {
      evaluate_load(quantities_[k], view, out);
      continue;
    }
    const int body = column.index < 0 ? plan.bodies : plan.plan_body[at(column.index)];
    const BodyView seen = body_view(body, program_.code().moving, view, fixed_.data());
    catena::evaluate(column.kind, seen, local, view.first, view.last, out);
  }
}

void LaneColumns::evaluate_load(const Quantity& quantity, const LaneView& view, double* out) const {
  const auto& [column, local, constraint] = quantity;
  const double* const lambda = view.lambda + lane_count * constraint.row;
  if (column.kind == ColumnKind::reaction_x || column.kind == ColumnKind::reaction_y)
    return evaluate_pin(column, lambda, view, out);
  if (column.kind == ColumnKind::multiplier) {
    for (int k = view.first; k < view.last; ++k) out[k] = constraint.scale * lambda[lane_count * column.detail + k];
    return;
  }
  for (int k = view.first; k < view.last; ++k) {
    const Taylor<double> c = constraint.value.function < 0
                                 ? Taylor<double>(constraint.value.constant)
                                 : model_->functions[at(constraint.value.function)].evaluate(view.t[k]);
    const double load = (constraint.squared ? -2 * c.f : -1) * constraint.scale * lambda[k];
    out[k] = column.kind == ColumnKind::load ? load : load * c.d;
  }
}

// The force of a pin on one of its bodies; in the joint's axes these are those of body i.
void LaneColumns::evaluate_pin(const Column& column, const double* lambda, const LaneView& view, double* out) const {
  const bool is_x = column.kind == ColumnKind::reaction_x;
  const double *const x = lambda, *const y = lambda + lane_count;
  if (column.detail != on_j_in_joint) {
    const double sign = column.detail == on_i ? 1 : -1;
    for (int k = view.first; k < view.last; ++k) out[k] = sign * (is_x ? x[k] : y[k]);
    return;
  }
  const int i = attachment_of(*model_, column.index).i;
  const Plan& plan = program_.plan();
  const BodyView seen =
      body_view(i < 0 ? plan.bodies : plan.plan_body[at(i)], program_.code().moving, view, fixed_.data());
  for (int k = view.first; k < view.last; ++k)
    out[k] = is_x ? -(seen.c[k] * x[k] + seen.s[k] * y[k]) : seen.s[k] * x[k] - seen.c[k] * y[k];
}

double LaneColumns::value_of(const Source& source, int lane) const {
  if (!source.is_own) return values_[static_cast<int>(source.number)][lane];
  const std::vector<Source>& inputs = inputs_[source.number];
  return model_->own_columns[source.number].formula.evaluate(
      [&](std::uint32_t input) { return value_of(inputs[input], lane); });
}

}  // namespace catena
