// Evaluation of single elements: measured quantities, their part of Phi_q.
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "catena/assembly/constraint_operations.hpp"
#include "catena/assembly/curve_contacts.hpp"
#include "catena/assembly/equations.hpp"
#include "catena/base/at.hpp"
#include "catena/elements/all.hpp"
#include "catena/elements/gap_element.hpp"
#include "catena/model/model_part.hpp"

namespace catena {
namespace {

// Calls f(number) for every element that joins this one.
template <class F>
void for_each_part(const Model& model, int element, F&& f) {
  const ElementRecord& record = model.elements[at(element)];
  if (record.kind != ElementKind::gap) return;
  with_list(model.constraints, record.type, [&](const auto& list) {
    using E = ElementOf<decltype(list)>;
    if constexpr (HasParts<E>) {
      const auto& parts = std::get<std::vector<ElementEntry<typename E::Part, double>>>(model.constraints);
      const auto& head = list[at(record.index)].element;
      for (int k = 0; k < head.parts; ++k) f(parts[at(head.first_part + k)].id);
    }
  });
}

}  // namespace

// Calls f(block, data, e) where the element is the block's e-th; not at all for one that is in no block.
template <class F>
void Equations::with_element(int element, F&& f) const {
  const int e = place(element);
  if (e < 0 || model_->elements[at(element)].kind == ElementKind::force) return;
  with_list(plan_->blocks, model_->elements[at(element)].type, [&](const auto& block) {
    using E = typename std::remove_cvref_t<decltype(block)>::Element;
    f(block, std::get<ConstraintData<E>>(constraints_), e);
  });
}

// A constraint that does not hold for the time being is in no block, but its measured quantity can be evaluated all the
// same; at rest, where nothing but its value is asked for, in plain numbers.
Measured Equations::measure_released(const Pose& pose, int element, std::span<const double> qd) const {
  Measured result;
  const ElementRecord& record = model_->elements[at(element)];
  const auto motion = [&](int body) {
    const int p = body < 0 ? plan_->bodies : plan_->plan_body[at(body)];
    return moving(ground_frame(pose, p), qd[at(3 * p)], qd[at(3 * p) + 1], qd[at(3 * p) + 2]);
  };
  const auto place = [&](int body) {
    return ground_frame(pose, body < 0 ? plan_->bodies : plan_->plan_body[at(body)]);
  };
  with_list(model_->constraints, record.type, [&](const auto& list) {
    const auto& entry = list[at(record.index)];
    using E = ElementOf<decltype(list)>;
    if constexpr (Measuring<E>) {
      const CurvePlace& contact = contact_of(std::get<ConstraintBlock<E>>(plan_->blocks), pose.contacts, record.index);
      if (qd.empty()) {
        result.value = measure_of(entry.element, place(entry.i), place(entry.j), contact);
        return;
      }
      const Taylor<double> m = measure_of(entry.element, motion(entry.i), motion(entry.j), contact);
      result = {m.f, m.d, m.dd};
    }
  });
  return result;
}

Equations::ScalarMotion Equations::scalar_motion(const Pose& pose, int element, std::span<const double> qd) const {
  ScalarMotion result;
  const ElementRecord& record = model_->elements[at(element)];
  with_list(model_->constraints, record.type, [&](const auto& list) {
    using E = ElementOf<decltype(list)>;
    if constexpr (E::rows == 1 && E::bodies == 2) {
      const auto& entry = list[at(record.index)];
      const CurvePlace& contact = contact_of(std::get<ConstraintBlock<E>>(plan_->blocks), pose.contacts, record.index);
      const auto plan_body = [&](int body) { return body < 0 ? plan_->bodies : plan_->plan_body[at(body)]; };
      const int i = result.body_i = plan_body(entry.i), j = result.body_j = plan_body(entry.j);
      // About the origin of body i, so that rounding does not grow with the distance from the ground's.
      const Frame<double> frame_i = pose.frames[at(i)];
      const Frame<double> frame_j = detail::shifted(pose.frames[at(j)], origin_[at(j)] - origin_[at(i)]);
      const auto measure = [&]<class T>(const Frame<T>& fi, const Frame<T>& fj) {
        if constexpr (OneSided<E> && !Dry<E>) {
          return measure_of(entry.element, fi, fj, contact);
        } else {
          T row;
          T c(0.0);
          if constexpr (E::functions == 1) c = T(entry.values[0].constant);
          entry.element.phi(Arguments<T>{fi, fj, c, {}, &contact}, &row);
          return row;
        }
      };
      const auto rate = [&](int body, int k) { return qd.empty() ? 0.0 : qd[at(3 * body + k)]; };
      const Taylor<double> along = measure(moving(frame_i, rate(i, 0), rate(i, 1), rate(i, 2)),
                                           moving(frame_j, rate(j, 0), rate(j, 1), rate(j, 2)));
      const Dual<double, 6> by = measure(seed<double, 6>(frame_i, 0), seed<double, 6>(frame_j, 3));
      result.value = along.f;
      result.rate = along.d;
      result.bend = along.dd;
      for (std::size_t k = 0; k < 6; ++k) result.gradient[k] = by.d[k];
    }
  });
  for_each_part(*model_, element, [&](int part) {
    const ScalarMotion more = scalar_motion(pose, part, qd);
    result.value += more.value;
    result.rate += more.rate;
    result.bend += more.bend;
    result.parts.push_back({more.body_i, more.body_j});
    std::copy(std::begin(more.gradient), std::end(more.gradient), result.parts.back().gradient);
  });
  return result;
}

Measured Equations::measure(const Pose& pose, int element, std::span<const double> qd,
                            std::span<const double> qdd) const {
  Measured result;
  if (plan_->is_released(element)) {
    result = measure_released(pose, element, qd);
  } else {
    with_element(element, [&](const auto& block, const auto& data, int e) {
      using E = typename std::remove_cvref_t<decltype(block)>::Element;
      result = ConstraintOperations<E>::measure(block, data, pose, qd.empty() ? nullptr : qd.data(),
                                                qdd.empty() ? nullptr : qdd.data(), e);
    });
  }
  for_each_part(*model_, element, [&](int part) {
    const Measured more = measure(pose, part, qd, qdd);
    result.value += more.value;
    result.rate += more.rate;
    result.second += more.second;
  });
  return result;
}

Equations::ElementJacobian Equations::element_jacobian(const Pose& pose, int element) const {
  ElementJacobian result;
  with_element(element, [&](const auto& block, const auto& data, int e) {
    using E = typename std::remove_cvref_t<decltype(block)>::Element;
    const LocalJacobian<E> local = ConstraintOperations<E>::local_jacobian(block, data, pose, e);
    result.rows = E::rows;
    result.bodies = E::bodies;
    result.body_i = block.body_i[at(e)];
    result.body_j = block.body_j[at(e)];
    result.scale = local.scale;
    for (int r = 0; r < E::rows; ++r) {
      for (int k = 0; k < 3 * E::bodies; ++k) result.entries[6 * r + k] = local.entries[at(r * 3 * E::bodies + k)];
    }
  });
  return result;
}

const char* Equations::trouble(const Pose& pose, int element) const {
  const char* phrase = nullptr;
  with_element(element, [&](const auto& block, const auto& data, int e) {
    using E = typename std::remove_cvref_t<decltype(block)>::Element;
    phrase = ConstraintOperations<E>::trouble(block, data, pose, e);
  });
  return phrase;
}

std::optional<CurveUse> Equations::curve_use(const Pose& pose, int element) const {
  std::optional<CurveUse> use;
  int body[2] = {plan_->bodies, plan_->bodies};
  const auto take = [&]<class E>(const auto& block, int e, std::optional<CurveUse> found, std::type_identity<E>) {
    use = found;
    body[0] = block.body_i[at(e)];
    if constexpr (E::bodies == 2) body[1] = block.body_j[at(e)];
  };
  const int e = place(element);
  if (e >= 0 && model_->elements[at(element)].kind == ElementKind::force) {
    with_list(plan_->forces, model_->elements[at(element)].type, [&](const auto& block) {
      using E = typename std::remove_cvref_t<decltype(block)>::Element;
      const auto& data = std::get<ForceData<E>>(forces_);
      take(block, e, ForceOperations<E>::curve_use(block, data, pose, e), std::type_identity<E>{});
    });
  } else {
    with_element(element, [&](const auto& block, const auto& data, int k) {
      using E = typename std::remove_cvref_t<decltype(block)>::Element;
      take(block, k, ConstraintOperations<E>::curve_use(block, data, pose, k), std::type_identity<E>{});
    });
  }
  if (use && use->end) use->end = ground_frame(pose, body[use->body]).point(*use->end);
  return use;
}

void Equations::follow(const Pose& pose, std::span<CurvePlace> contacts) const {
  follow_contacts(
      *plan_, model_->constraints, origin_, [&pose](int body) { return pose.frames[at(body)]; }, contacts);
}

void Equations::find_contacts(Pose& pose) const {
  pose.contacts = pose.starts;
  follow(pose, pose.contacts);
}

CurvePlace Equations::contact(const Pose& pose, int element) const {
  const int k = plan_->element_contact[at(element)];
  return k < 0 ? no_contact : pose.contacts[at(k)];
}

void Equations::go_to_curve_places(Pose& pose, std::span<const CurvePlace> places) const {
  bool moved = false;
  for (const CurvePlace& place : places) {
    if (place.element < 0 || at(place.element) >= place_.size())
      throw std::invalid_argument("a place on a curve is that of element number " + std::to_string(place.element) +
                                  ", which the model does not have: it has " + std::to_string(place_.size()));
    const int k = plan_->element_contact[at(place.element)];
    if (k < 0) continue;
    CurvePlace& start = pose.starts[at(k)];
    moved = moved || start.s_i != place.s_i || start.s_j != place.s_j;
    start = place;
  }
  if (moved) find_contacts(pose);
}

void Equations::go_to_given_curve_places(Pose& pose) const {
  take_given_contacts(*plan_, model_->constraints, pose.starts);
  find_contacts(pose);
}

Taylor<double> Equations::element_value(const Pose& pose, int element) const {
  Taylor<double> value;
  with_element(element, [&](const auto& block, const auto&, int e) {
    using E = typename std::remove_cvref_t<decltype(block)>::Element;
    if constexpr (E::functions > 0) value = pose.values[at(block.first_value + e)];
  });
  return value;
}

}  // namespace catena
