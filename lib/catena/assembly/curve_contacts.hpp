// Contacts of curves at a configuration: where each is, of all elements of a model that search for one.
//
//   contacts   type after type, element after element as the model lists them: ConstraintBlock::first_contact
//
// They are part of the state, since each is searched for from where it was found last, and of a Pose, in which they
// belong to its frames. The model's numbers may be of any scalar. Units: m.
#pragma once

#include <span>

#include "catena/assembly/plan.hpp"
#include "catena/base/at.hpp"
#include "catena/elements/body_curve.hpp"

namespace catena {

/// Of the k-th element in the model's list; no_contact where its type does not search.
template <class Block>
const CurvePlace& contact_of([[maybe_unused]] const Block& block, [[maybe_unused]] std::span<const CurvePlace> contacts,
                             [[maybe_unused]] int k) {
  if constexpr (SearchesCurve<typename Block::Element>) {
    return contacts[static_cast<std::size_t>(block.first_contact + k)];
  } else {
    return no_contact;
  }
}

/// Calls f(entry, contact) for all elements that search.
template <class Lists, class F>
void for_each_contact(const Plan& plan, const Lists& constraints, std::span<CurvePlace> contacts, F&& f) {
  if (contacts.empty()) return;
  for_each_list(plan.blocks, constraints, [&](const auto& block, const auto& list, int) {
    if constexpr (SearchesCurve<typename std::remove_cvref_t<decltype(block)>::Element>) {
      CurvePlace* contact = contacts.data() + block.first_contact;
      for (const auto& entry : list) f(entry, *contact++);
    }
  });
}

/// Where contacts are in the given configuration of the model.
template <class Lists>
void take_given_contacts(const Plan& plan, const Lists& constraints, std::span<CurvePlace> contacts) {
  for_each_contact(plan, constraints, contacts, [](const auto& entry, CurvePlace& contact) {
    contact = entry.element.place();
    contact.element = entry.id;
  });
}

/// Moves every contact on to where it is at the frames frame_of(plan body), relative to the origins. Elements see them
/// from the origin of a body that moves, as their equations do (ConstraintOperations).
template <class Lists, class FrameOf>
void follow_contacts(const Plan& plan, const Lists& constraints, std::span<const Vec2<double>> origin,
                     FrameOf&& frame_of, std::span<CurvePlace> contacts) {
  for_each_contact(plan, constraints, contacts, [&](const auto& entry, CurvePlace& contact) {
    const auto plan_body = [&](int body) { return body < 0 ? plan.bodies : plan.plan_body[at(body)]; };
    const int i = plan_body(entry.i), j = plan_body(entry.j);
    Frame<double> frame_i = frame_of(i), frame_j = frame_of(j);
    Frame<double>& moved = i < plan.moving ? frame_j : frame_i;
    const Vec2<double> by = i < plan.moving ? origin[at(j)] - origin[at(i)] : origin[at(i)] - origin[at(j)];
    moved.x += by.x;
    moved.y += by.y;
    entry.element.follow_contact(frame_i, frame_j, contact);
  });
}

}  // namespace catena
