#include "catena/analysis/contact/contact_points.hpp"

#include "catena/analysis/contact/slide_law.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/model_add.hpp"

namespace catena {
namespace {

std::size_t at(int k) { return static_cast<std::size_t>(k); }

/// What an element says of impacts and stiffness; not all have all.
template <class E>
ContactPoint point_of(const E& element, int number) {
  ContactPoint point;
  point.element = number;
  point.restitution = element.restitution;
  point.rest_speed = element.rest_speed;
  if constexpr (requires { element.exponent; }) {
    point.k = element.k;
    point.c = element.c;
    point.exponent = element.exponent;
    if (point.k > 0) point.kind = ContactKind::compliant;
  }
  if constexpr (requires { element.mu; }) {
    point.mu = element.mu;
    point.mu_static = element.mu_static >= 0 ? element.mu_static : element.mu;
    point.smoothing = element.vs;
  }
  return point;
}

/// Appends the equation of a contact's slide; its value is zero where the contact is now.
int append_slide(Model& model, const ElementEntry<Contact<double>, double>& contact) {
  const Contact<double>& element = contact.element;
  const auto [i, j] = given_frames<Contact<double>>(model, contact.i, contact.j);
  const double start = element.curve.nearest(i.to_local(j.point(element.s_j) - i.origin()));
  ElementEntry<CustomConstraint<double>, double> slide;
  slide.element =
      custom_constraint(SlideOnCurve(element.curve, element.s_j, element.free_side() * element.radius, start));
  slide.i = contact.i;
  slide.j = contact.j;
  return model.append({}, slide, ElementKind::constraint);
}

/// The joint of a friction, with what presses and slides there.
ContactPoint point_of(const Friction<double>& friction, int number) {
  ContactPoint point;
  point.element = point.slide = number;
  point.kind = ContactKind::joint;
  point.joint = friction.joint;
  point.mu = friction.mu;
  point.mu_static = friction.mu_static >= 0 ? friction.mu_static : friction.mu;
  // A pin's slip is an angle, its friction a torque.
  if (friction.turns) point.radius = friction.radius;
  point.smoothing = friction.turns && friction.vs > 0 ? friction.vs / friction.radius : friction.vs;
  if (friction.length > 0) point.half_length = friction.length / 2;
  return point;
}

}  // namespace

ContactModel contact_points(std::shared_ptr<const Model> model) {
  ContactModel result{model, {}};
  std::shared_ptr<Model> expanded;
  for (const int number : model->gaps()) {
    const ElementRecord& record = model->elements[at(number)];
    with_list(model->constraints, record.type, [&](const auto& list) {
      const auto& entry = list[at(record.index)];
      if constexpr (requires { entry.element.restitution; }) {
        result.points.push_back(point_of(entry.element, number));
        if constexpr (requires { entry.element.mu; }) {
          ContactPoint& point = result.points.back();
          if (point.mu_static == 0) return;
          if (!expanded) expanded = std::make_shared<Model>(*model);
          point.slide = append_slide(*expanded, entry);
        }
      }
    });
  }
  for (const int number : model->frictions()) {
    const ElementRecord& record = model->elements[at(number)];
    const auto& list = std::get<std::vector<ElementEntry<Friction<double>, double>>>(model->constraints);
    const ContactPoint point = point_of(list[at(record.index)].element, number);
    if (point.mu_static > 0) result.points.push_back(point);
  }
  if (expanded) result.model = expanded;
  return result;
}

}  // namespace catena
