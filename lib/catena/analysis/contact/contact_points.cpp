#include "catena/analysis/contact/contact_points.hpp"

#include "catena/analysis/contact/slide_law.hpp"
#include "catena/base/at.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/model_add.hpp"

namespace catena {
namespace {

/// What an element says of impacts and stiffness; not all have all.
template <class E>
ContactPoint point_of(const E& element, int number) {
  ContactPoint point;
  point.element = number;
  point.restitution = element.restitution;
  point.rest_speed = element.rest_speed;
  if constexpr (requires { element.in_angle(); }) point.turns = element.in_angle();
  if constexpr (requires { element.exponent; }) {
    point.k = element.k;
    point.c = element.c;
    point.exponent = element.exponent;
    if (point.k > 0) point.kind = ContactKind::compliant;
  }
  // A cable, or rope, whose stiffness is not that of a force (model/elastic_gaps.hpp).
  if constexpr (
      !requires { element.exponent; } && requires { element.k; }) {
    point.k = element.k;
    if (point.k > 0) point.kind = ContactKind::compliant;
  }
  if constexpr (requires { element.mu; }) {
    point.mu = element.mu;
    point.mu_static = element.mu_static >= 0 ? element.mu_static : element.mu;
    point.smoothing = element.vs;
  }
  return point;
}

/// Appends the equation of a contact's slide, with a name for messages; its value is zero where the contact is now.
int append_slide(Model& model, const ElementEntry<Contact<double>, double>& contact, int number) {
  const Contact<double>& element = contact.element;
  const auto [i, j] = given_frames<Contact<double>>(model, contact.i, contact.j);
  const double start = element.curve.nearest(i.to_local(j.point(element.s_j) - i.origin()));
  ElementEntry<CustomConstraint<double>, double> slide;
  slide.element =
      custom_constraint(SlideOnCurve<double>(element.curve, element.s_j, element.free_side() * element.radius, start));
  slide.i = contact.i;
  slide.j = contact.j;
  const std::string name = model.element_name(number) + " (friction)";
  return model.append(model.find_element(name) < 0 ? name : std::string(), slide, ElementKind::constraint);
}

/// The joint of a friction, with what presses and slides there.
ContactPoint point_of(const Friction<double>& friction, int number) {
  ContactPoint point;
  point.element = point.slide = number;
  point.kind = ContactKind::joint;
  point.joint = friction.joint;
  point.mu = friction.mu;
  point.mu_static = friction.mu_static >= 0 ? friction.mu_static : friction.mu;
  point.turns = friction.turns;
  // A pin's slip is an angle, its friction a torque.
  if (friction.turns) point.radius = friction.radius;
  point.smoothing = friction.turns && friction.vs > 0 ? friction.vs / friction.radius : friction.vs;
  if (friction.length > 0) point.half_length = friction.length / 2;
  return point;
}

/// Calls f(entry, point) for every place, in the order of the points of a ContactModel; `entry`: of its element.
template <class F>
void for_each_place(const Model& model, F&& f) {
  for (const int number : model.gaps()) {
    const ElementRecord& record = model.elements[at(number)];
    with_list(model.constraints, record.type, [&](const auto& list) {
      const auto& entry = list[at(record.index)];
      if constexpr (requires { entry.element.restitution; }) f(entry, point_of(entry.element, number));
    });
  }
  for (const int number : model.frictions()) {
    const auto& list = std::get<std::vector<ElementEntry<Friction<double>, double>>>(model.constraints);
    const auto& entry = list[at(model.elements[at(number)].index)];
    f(entry, point_of(entry.element, number));
  }
}

}  // namespace

std::vector<ContactPoint> joints_with_friction(const Model& model) {
  std::vector<ContactPoint> joints;
  for_each_place(model, [&](const auto&, const ContactPoint& point) {
    if (point.kind == ContactKind::joint && point.mu_static > 0) joints.push_back(point);
  });
  return joints;
}

int first_friction(const Model& model) {
  int first = -1;
  for_each_place(model, [&](const auto&, const ContactPoint& point) {
    if (first < 0 && point.mu_static > 0) first = point.element;
  });
  return first < 0 ? first_gripped_rope(model) : first;
}

namespace {

/// The places of grips, behind all others.
void append_grips(ContactModel& contacts) {
  for (const GrippedRope& rope : contacts.ropes) {
    auto places = std::make_shared<RopePlaces>();
    for (std::size_t k = 0; k < contacts.points.size() && !rope.elastic; ++k) {
      if (contacts.points[k].element == rope.element) places->head = static_cast<int>(k);
    }
    places->whole = rope.whole;
    if (rope.elastic) {
      const auto index = at(contacts.model->elements[at(rope.element)].index);
      places->k =
          std::get<std::vector<ElementEntry<ElasticRope<double>, double>>>(contacts.model->forces)[index].element.k;
    }
    for (const RopeGrip& grip : rope.grips) {
      places->grips.push_back(contacts.points.size());
      ContactPoint point;
      point.element = rope.element;
      point.kind = ContactKind::grip;
      point.mu = point.mu_static = 1;
      point.slide = grip.slide;
      point.rope = places;
      contacts.points.push_back(point);
    }
    contacts.places.push_back(std::move(places));
  }
}

}  // namespace

void lay_grips(ContactModel& contacts, const std::vector<RopeRoute>& routes,
               const std::function<std::vector<Frame<double>>(const RopeRoute&)>& frames) {
  if (contacts.ropes.empty()) return;
  const auto model = std::make_shared<Model>(*contacts.model);
  for (std::size_t r = 0; r < contacts.ropes.size(); ++r) {
    const RopeRoute& route = routes[at(contacts.ropes[r].route)];
    std::vector<GripLines> lines = lay_grips(*model, contacts.ropes[r], route, frames(route));
    for (std::size_t k = 0; k < lines.size(); ++k)
      contacts.points[contacts.places[r]->grips[k]].lines = std::make_shared<GripLines>(std::move(lines[k]));
  }
  contacts.model = model;
}

ContactModel contact_points(std::shared_ptr<const Model> model) {
  ContactModel result{model, {}};
  std::shared_ptr<Model> expanded;
  for_each_place(*model, [&](const auto& entry, ContactPoint point) {
    if (point.kind == ContactKind::joint && point.mu_static == 0) return;
    if constexpr (std::is_same_v<std::decay_t<decltype(entry)>, ElementEntry<Contact<double>, double>>) {
      if (point.mu_static > 0) {
        if (!expanded) expanded = std::make_shared<Model>(*model);
        point.slide = append_slide(*expanded, entry, point.element);
      }
    }
    result.points.push_back(point);
  });
  result.ropes = gripped_ropes(*model, expanded);
  if (expanded) result.model = expanded;
  append_grips(result);
  lay_grips(result, rope_routes(*model), [&](const RopeRoute& route) {
    std::vector<Frame<double>> frames;
    for (const RopePulley<double>& node : route.nodes) frames.push_back(model->frame(node.body));
    return frames;
  });
  return result;
}

}  // namespace catena
