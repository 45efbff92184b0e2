#include "catena/model/model.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "catena/elements/all.hpp"

namespace catena {
namespace {

/// The elements of kind gap that are friction of a joint, or those that are not.
template <class S>
std::vector<int> of_kind_gap(const BasicModel<S>& model, bool dry) {
  std::vector<int> found;
  for (std::size_t e = 0; e < model.elements.size(); ++e) {
    if (model.elements[e].kind != ElementKind::gap) continue;
    bool is_dry = false;
    with_list(model.constraints, model.elements[e].type,
              [&](const auto& list) { is_dry = Dry<ElementOf<decltype(list)>>; });
    if (is_dry == dry) found.push_back(static_cast<int>(e));
  }
  return found;
}

}  // namespace

template <class S>
BasicModel<S>::BasicModel() = default;
template <class S>
BasicModel<S>::BasicModel(const BasicModel&) = default;
template <class S>
BasicModel<S>::BasicModel(BasicModel&&) noexcept = default;
template <class S>
BasicModel<S>& BasicModel<S>::operator=(const BasicModel&) = default;
template <class S>
BasicModel<S>& BasicModel<S>::operator=(BasicModel&&) noexcept = default;
template <class S>
BasicModel<S>::~BasicModel() = default;

template <class S>
void BasicModel<S>::refuse_number(std::string_view what, int number, std::size_t count) {
  throw std::out_of_range("there is no " + std::string(what) + " number " + std::to_string(number) +
                          ": the model has " + std::to_string(count));
}

const Model& required(const std::shared_ptr<const Model>& model) {
  if (!model) throw std::invalid_argument("an analysis needs a model, and was given a null pointer");
  return *model;
}

template <class S>
int BasicModel<S>::claim_name(std::string_view name, int target) {
  if (name.empty()) return -1;
  if (name == "ground") throw ModelError("the name \"ground\" is taken");
  const int known = names.size();
  const int number = names.intern(name);
  if (number < known) throw ModelError("the name \"" + std::string(name) + "\" is used twice");
  name_target.push_back(target);
  return number;
}

template <class S>
int BasicModel<S>::add_body(std::string_view name, const BodyValues& values) {
  const std::pair<const char*, double> numbers[] = {{"mass", values.mass},
                                                    {"inertia", values.inertia},
                                                    {"position.x", values.position.x},
                                                    {"position.y", values.position.y},
                                                    {"angle", values.angle},
                                                    {"centroid.x", values.centroid.x},
                                                    {"centroid.y", values.centroid.y}};
  for (const auto& [key, value] : numbers) {
    if (!std::isfinite(value)) throw ModelError("body \"" + std::string(name) + "\": " + key + " is not finite");
  }
  BasicBody<S> body;
  const Frame<S> f = make_frame(S(values.position.x), S(values.position.y), S(values.angle));
  body.position = f.point(values.centroid);
  body.angle = f.phi;
  body.origin = {S(-values.centroid.x), S(-values.centroid.y)};
  body.has_mass = values.mass >= 0;
  body.has_inertia = values.inertia >= 0;
  if (body.has_mass) body.mass = S(values.mass);
  if (body.has_inertia) body.inertia = S(values.inertia);
  body.fixed = values.fixed;
  body.particle = values.particle;
  return append_body(name, body);
}

template <class S>
int BasicModel<S>::append_body(std::string_view name, const BasicBody<S>& body) {
  if (name.empty()) throw ModelError("a body needs a name");
  const int number = static_cast<int>(bodies.size());
  const int name_number = claim_name(name, number);
  bodies.push_back(body);
  bodies.back().name = name_number;
  bodies.back().first_point = -1;
  return number;
}

template <class S>
void BasicModel<S>::add_point(int body, std::string_view name, const Vec2<S>& local) {
  require_body(body);
  if (name.empty()) throw ModelError("a point of \"" + std::string(body_name(body)) + "\" needs a name");
  if (!std::isfinite(value_of(local.x)) || !std::isfinite(value_of(local.y))) {
    throw ModelError("point \"" + std::string(name) + "\" of \"" + std::string(body_name(body)) +
                     "\": a coordinate is not finite");
  }
  const int number = point_names.intern(name);
  int& head = body < 0 ? first_ground_point : bodies[static_cast<std::size_t>(body)].first_point;
  const Vec2<S> origin = body < 0 ? Vec2<S>{} : bodies[static_cast<std::size_t>(body)].origin;
  points.push_back({number, head, local + origin});
  head = static_cast<int>(points.size()) - 1;
}

template <class S>
const Vec2<S>* BasicModel<S>::find_point(int body, std::string_view name) const {
  require_body(body);
  const int number = point_names.find(name);
  if (number < 0) return nullptr;
  int k = body < 0 ? first_ground_point : bodies[static_cast<std::size_t>(body)].first_point;
  for (; k >= 0; k = points[static_cast<std::size_t>(k)].next) {
    if (points[static_cast<std::size_t>(k)].name == number) return &points[static_cast<std::size_t>(k)].local;
  }
  return nullptr;
}

template <class S>
Frame<S> BasicModel<S>::frame(int body) const {
  require_body(body);
  if (body < 0) return {};
  const BasicBody<S>& b = bodies[static_cast<std::size_t>(body)];
  return make_frame(b.position.x, b.position.y, b.angle);
}

template <class S>
std::string_view BasicModel<S>::element_type(int element) const {
  require_element(element);
  std::string_view type;
  const ElementRecord& record = elements[static_cast<std::size_t>(element)];
  const auto read = [&](const auto& list) { type = ElementOf<decltype(list)>::type; };
  if (record.kind == ElementKind::force) {
    with_list(forces, record.type, read);
  } else {
    with_list(constraints, record.type, read);
  }
  return type;
}

template <class S>
std::string BasicModel<S>::element_name(int element) const {
  require_element(element);
  const ElementRecord& record = elements[static_cast<std::size_t>(element)];
  if (record.name >= 0) return std::string(names[record.name]);
  return std::string(element_type(element)) + "#" + std::to_string(record.ordinal);
}

template <class S>
std::vector<int> BasicModel<S>::gaps() const {
  return of_kind_gap(*this, false);
}

template <class S>
std::vector<int> BasicModel<S>::frictions() const {
  return of_kind_gap(*this, true);
}

template <class S>
int BasicModel<S>::find_body(std::string_view name) const {
  if (name == "ground") return ground;
  const int number = names.find(name);
  const int target = number < 0 ? -2 : name_target[static_cast<std::size_t>(number)];
  return target >= 0 ? target : -2;
}

template <class S>
int BasicModel<S>::find_element(std::string_view name) const {
  const int number = names.find(name);
  if (number >= 0) {
    const int target = name_target[static_cast<std::size_t>(number)];
    return target <= -2 ? -2 - target : -1;
  }
  // `type#n`: n-th element of its type, rare enough for a scan.
  const std::size_t hash = name.rfind('#');
  if (hash == std::string_view::npos) return -1;
  for (std::size_t e = 0; e < elements.size(); ++e) {
    if (elements[e].name < 0 && element_name(static_cast<int>(e)) == name) return static_cast<int>(e);
  }
  return -1;
}

template <class S>
int BasicModel<S>::find_own_column(std::string_view name) const {
  for (std::size_t k = 0; k < own_columns.size(); ++k) {
    if (own_columns[k].name == name) return static_cast<int>(k);
  }
  return -1;
}

template class BasicModel<double>;
template class BasicModel<Dual<double, 4>>;

}  // namespace catena
