#include "catena/assembly/state_laws.hpp"

#include <algorithm>

#include "catena/base/at.hpp"
#include "catena/base/design_scalar.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/attachment.hpp"

namespace catena {
namespace {

template <class S>
LawInput<S> compile_input(const BasicModel<S>& model, const Column& column, const Plan& plan) {
  const auto plan_body = [&](int body) { return body < 0 ? plan.bodies : plan.plan_body[at(body)]; };
  LawInput<S> input;
  input.kind = column.kind;
  if (column.kind == ColumnKind::time) return input;
  if (is_body_column(column.kind)) {
    input.i = plan_body(column.index);
    if (column.detail >= 0) {
      input.point_i = model.points[at(column.detail)].local;
    } else if (column.index >= 0) {
      input.point_i = model.bodies[at(column.index)].origin;
    }
    return input;
  }
  const BasicAttachment<S> attachment = attachment_of(model, column.index);
  input.element = column.index;
  input.i = plan_body(attachment.i);
  input.j = plan_body(attachment.j);
  input.point_i = attachment.point_i;
  input.point_j = attachment.point_j;
  input.axis = attachment.axis_i;
  return input;
}

/// Calls f(law) for the laws that are functions of a force element.
template <class S, class F>
void visit_laws_of(const BasicModel<S>& model, int element, F&& f) {
  with_entry(model, element, [&](const auto& entry) {
    for (const auto& value : entry.values) {
      if (value.law >= 0) f(value.law);
    }
  });
}

/// The moving bodies that a law reads, through other laws too.
template <class S>
void collect_bodies(const BasicModel<S>& model, std::span<const CompiledLaw<S>> laws, int law, const Plan& plan,
                    std::vector<int>& bodies) {
  for (const LawInput<S>& input : laws[at(law)].inputs) {
    for (const int body : {input.i, input.j}) {
      if (body >= 0 && body < plan.moving) bodies.push_back(body);
    }
    if (input.kind != ColumnKind::tension && input.kind != ColumnKind::spring_torque) continue;
    visit_laws_of(model, input.element, [&](int other) { collect_bodies(model, laws, other, plan, bodies); });
  }
}

}  // namespace

template <class S>
std::vector<CompiledLaw<S>> compile_laws(const BasicModel<S>& model, std::span<const StateLaw<double>> structure,
                                         const Plan& plan) {
  std::vector<CompiledLaw<S>> laws;
  for (std::size_t k = 0; k < structure.size(); ++k) {
    const StateLaw<double>& bound = structure[k];
    if (bound.element < 0 || bound.inputs.size() != bound.names.size())
      throw ModelError("a law of state reads columns that were not looked up: bind_state_laws() does");
    CompiledLaw<S>& law = laws.emplace_back();
    law.element = bound.element;
    law.place = bound.place;
    law.formula = model.laws[k].formula;
    for (const Column& column : bound.inputs) law.inputs.push_back(compile_input(model, column, plan));
    const BasicAttachment<S> attachment = attachment_of(model, law.element);
    const auto plan_body = [&](int body) { return body < 0 ? plan.bodies : plan.plan_body[at(body)]; };
    law.i = plan_body(attachment.i);
    if (attachment.bodies == 2) law.j = plan_body(attachment.j);
  }
  for (std::size_t k = 0; k < laws.size(); ++k) {
    std::vector<int>& bodies = laws[k].bodies;
    collect_bodies<S>(model, laws, static_cast<int>(k), plan, bodies);
    std::sort(bodies.begin(), bodies.end());
    bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
  }
  return laws;
}

template std::vector<CompiledLaw<double>> compile_laws(const Model&, std::span<const StateLaw<double>>, const Plan&);
template std::vector<CompiledLaw<DesignScalar>> compile_laws(const BasicModel<DesignScalar>&,
                                                             std::span<const StateLaw<double>>, const Plan&);

}  // namespace catena
