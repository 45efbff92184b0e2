// DesignMechanism: constraints, their loads and what they measure, with derivatives.
#include <algorithm>

#include "catena/assembly/curve_contacts.hpp"
#include "catena/assembly/design/element_motion.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

using detail::DesignSeries;
using detail::value_of_entry;

/// Whether these multipliers of an element, with their derivatives, leave nothing of its equations.
bool weigh_nothing(std::span<const DesignScalar> lambda) {
  return std::all_of(lambda.begin(), lambda.end(), [](const DesignScalar& x) {
    return x.v == 0 && std::all_of(x.d.begin(), x.d.end(), [](double d) { return d == 0; });
  });
}

/// Phi_q of an element with derivatives, as published, row-major with six columns.
template <class E>
void derive(const E& element, const detail::DesignFrames<DesignScalar>& f, const DesignScalar& c,
            const CurvePlace& contact, DesignScalar* entries) {
  constexpr int columns = 3 * E::bodies;
  using D = Dual<DesignScalar, columns>;
  const Frame<D> i = seed<DesignScalar, columns>(f.i, 0);
  Frame<D> j;
  if constexpr (E::bodies == 2) j = seed<DesignScalar, columns>(f.j, 3);
  D rows[E::rows];
  element.phi(Arguments<D>{i, j, D(c), f.ground, &contact}, rows);
  for (int r = 0; r < E::rows; ++r) {
    for (int k = 0; k < columns; ++k) entries[6 * r + k] = rows[r].d[static_cast<std::size_t>(k)];
  }
}

}  // namespace

void DesignMechanism::go_to_curve_places(std::span<const CurvePlace> places) {
  for (const CurvePlace& place : places) {
    if (const int k = plan_->element_contact[at(place.element)]; k >= 0) contacts_[at(k)] = place;
  }
}

CurvePlace DesignMechanism::contact(int element) const {
  const int k = plan_->element_contact[at(element)];
  return k < 0 ? no_contact : contacts_[at(k)];
}

void DesignMechanism::rows(std::span<Taylor<DesignScalar>> out) const {
  for_each_list(plan_->blocks, model_->constraints, [&](const auto& block, const auto& list, int) {
    using E = ElementOf<decltype(list)>;
    for (int e = 0; e < block.size(); ++e) {
      const auto& entry = list[at(block.entry[at(e)])];
      const auto f = detail::design_frames<DesignSeries>(block, e, plan_->moving, origin_,
                                                         [&](int body) { return motion_[at(body)]; });
      DesignSeries* row = out.data() + block.row(e);
      if constexpr (Joining<E>) {
        DesignSeries part;
        entry.element.phi(Arguments<DesignSeries>{f.i, f.j, {}, f.ground}, &part);
        *row += part;
        continue;
      }
      const CurvePlace& contact = contact_of(block, contacts_, block.entry[at(e)]);
      entry.element.phi(Arguments<DesignSeries>{f.i, f.j, value_of_entry(entry, function_), f.ground, &contact}, row);
      if constexpr (HasSquaredValue<E>) row[0] *= DesignSeries(scale_[at(entry.id)]);
    }
  });
}

void DesignMechanism::add_constraint_loads(std::span<const DesignScalar> lambda, std::span<DesignScalar> Q) const {
  for_each_list(plan_->blocks, model_->constraints, [&](const auto& block, const auto& list, int) {
    using E = ElementOf<decltype(list)>;
    for (int e = 0; e < block.size(); ++e) {
      if (weigh_nothing(lambda.subspan(at(block.row(e)), E::rows))) continue;
      const auto& entry = list[at(block.entry[at(e)])];
      const auto f = detail::design_frames<DesignScalar>(block, e, plan_->moving, origin_,
                                                         [&](int body) { return detail::present(motion_[at(body)]); });
      DesignScalar entries[6 * E::rows];
      derive(entry.element, f, value_of_entry(entry, function_).f, contact_of(block, contacts_, block.entry[at(e)]),
             entries);
      for (int r = 0; r < E::rows; ++r) {
        const DesignScalar weight = DesignScalar(scale_[at(entry.id)]) * lambda[at(block.row(e) + r)];
        for (int k = 0; k < 3 * E::bodies; ++k) {
          const int body = k < 3 ? block.body_i[at(e)] : block.body_j[at(e)];
          Q[at(3 * body + k % 3)] += entries[6 * r + k] * weight;
        }
      }
    }
  });
}

DesignElementJacobian DesignMechanism::element_jacobian(int element) const {
  DesignElementJacobian result;
  const int e = place_[at(element)];
  const ElementRecord& record = model_->elements[at(element)];
  if (e < 0 || record.kind == ElementKind::force) return result;
  for_each_list(plan_->blocks, model_->constraints, [&](const auto& block, const auto& list, int type) {
    if (type != record.type) return;
    using E = ElementOf<decltype(list)>;
    const auto& entry = list[at(record.index)];
    const auto f = detail::design_frames<DesignScalar>(block, e, plan_->moving, origin_,
                                                       [&](int body) { return detail::present(motion_[at(body)]); });
    derive(entry.element, f, value_of_entry(entry, function_).f, contact_of(block, contacts_, record.index),
           result.entries);
    result.rows = E::rows;
    result.bodies = E::bodies;
    result.body_i = block.body_i[at(e)];
    if (E::bodies == 2) result.body_j = block.body_j[at(e)];
    result.scale = scale_[at(element)];
  });
  return result;
}

Taylor<DesignScalar> DesignMechanism::measure(int element) const {
  DesignSeries measured;
  const ElementRecord& record = model_->elements[at(element)];
  const auto frame = [&](int body) {
    const int p = body < 0 ? plan_->bodies : plan_->plan_body[at(body)];
    return detail::moved_by(motion_[at(p)], origin_[at(p)]);
  };
  with_list(model_->constraints, record.type, [&](const auto& list) {
    const auto& entry = list[at(record.index)];
    using E = ElementOf<decltype(list)>;
    if constexpr (Measuring<E>) measured = measure_of(entry.element, frame(entry.i), frame(entry.j), contact(element));
    if constexpr (HasParts<E>) {
      const auto& parts = std::get<std::vector<ElementEntry<typename E::Part, DesignScalar>>>(model_->constraints);
      for (int k = 0; k < entry.element.parts; ++k) {
        const auto& part = parts[at(entry.element.first_part + k)];
        measured += part.element.measure(frame(part.i), frame(part.j));
      }
    }
  });
  return measured;
}

Taylor<DesignScalar> DesignMechanism::element_value(int element) const {
  DesignSeries value;
  const ElementRecord& record = model_->elements[at(element)];
  with_list(model_->constraints, record.type,
            [&](const auto& list) { value = value_of_entry(list[at(record.index)], function_); });
  return value;
}

}  // namespace catena
