#include "catena/analysis/sensitivity/phases/design_places.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "catena/analysis/contact/slide_law.hpp"
#include "catena/base/at.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/model_add.hpp"

namespace catena {
namespace {

/// A slide whose curve, point and disc carry derivatives; in plain numbers it is that of the plain model.
class DesignSlide final : public EquationLaw {
 public:
  DesignSlide(SlideOnCurve<DesignScalar> slide, std::shared_ptr<const EquationLaw> plain)
      : slide_(std::move(slide)), plain_(std::move(plain)) {}

  CurvePlace place() const override { return plain_->place(); }
  void follow_contact(const Frame<double>& i, const Frame<double>& j, CurvePlace& place) const override {
    plain_->follow_contact(i, j, place);
  }
  double measure(const Frame<double>& i, const Frame<double>& j, const CurvePlace& place) const override {
    return plain_->measure(i, j, place);
  }
  Taylor<double> measure(const Frame<Taylor<double>>& i, const Frame<Taylor<double>>& j,
                         const CurvePlace& place) const override {
    return plain_->measure(i, j, place);
  }
  Gradient measure(const Frame<Gradient>& i, const Frame<Gradient>& j, const CurvePlace& place) const override {
    return plain_->measure(i, j, place);
  }
  Second measure(const Frame<Second>& i, const Frame<Second>& j, const CurvePlace& place) const override {
    return plain_->measure(i, j, place);
  }
  DesignScalar measure(const Frame<DesignScalar>& i, const Frame<DesignScalar>& j,
                       const CurvePlace& place) const override {
    return slide_.measure(i, j, place);
  }
  Taylor<DesignScalar> measure(const Frame<Taylor<DesignScalar>>& i, const Frame<Taylor<DesignScalar>>& j,
                               const CurvePlace& place) const override {
    return slide_.measure(i, j, place);
  }
  DesignGradient measure(const Frame<DesignGradient>& i, const Frame<DesignGradient>& j,
                         const CurvePlace& place) const override {
    return slide_.measure(i, j, place);
  }

 private:
  SlideOnCurve<DesignScalar> slide_;
  std::shared_ptr<const EquationLaw> plain_;
};

template <class S>
const auto& entry_of_contact(const BasicModel<S>& model, int element) {
  return std::get<std::vector<ElementEntry<Contact<S>, S>>>(model.constraints)[at(model.elements[at(element)].index)];
}

/// What an element says of stiffness, impacts and friction; not all have all.
template <class E>
void take_numbers(const E& element, DesignPlace& place) {
  if constexpr (requires { element.restitution; }) place.restitution = element.restitution;
  if constexpr (requires { element.exponent; }) {
    place.k = element.k;
    place.c = element.c;
    place.exponent = element.exponent;
  }
  if constexpr (
      !requires { element.exponent; } && requires { element.k; }) {
    place.k = element.k;
    place.exponent = 1.0;
  }
  // Psi = (L^2 - |h|^2) / (2 L) is g (1 - g / (2 L)), g = L - |h|: that of a stop between bounds 2 L apart.
  if constexpr (std::is_same_v<E, Cable<DesignScalar>>) {
    place.has_range = true;
    place.range = DesignScalar(2.0) * element.length;
  }
  if constexpr (requires { element.mu; }) {
    place.mu = element.mu;
    place.mu_static = element.mu_static.v >= 0 ? element.mu_static : element.mu;
    place.smoothing = element.vs;
  }
  if constexpr (requires { element.quantity; }) {
    place.has_range = std::isfinite(element.min.v) && std::isfinite(element.max.v);
    if (place.has_range) place.range = element.max - element.min;
  }
  if constexpr (requires { element.turns; }) {
    if (element.turns) place.radius = element.radius;
    if (element.turns && element.vs.v > 0) place.smoothing = element.vs / element.radius;
    place.has_length = element.length.v > 0;
    if (place.has_length) place.half_length = element.length / DesignScalar(2.0);
  }
}

bool moves_with_parameters(const DesignScalar& x) {
  return std::any_of(x.d.begin(), x.d.end(), [](double d) { return d != 0; });
}

}  // namespace

std::shared_ptr<const DesignModel> with_slides(std::shared_ptr<const DesignModel> model, const ContactModel& contacts) {
  std::shared_ptr<DesignModel> expanded;
  for (const ContactPoint& point : contacts.points) {
    if (point.slide < static_cast<int>(model->elements.size()) || point.kind == ContactKind::joint) continue;
    if (!expanded) expanded = std::make_shared<DesignModel>(*model);
    const ElementEntry<Contact<double>, double>& plain = entry_of_contact(*contacts.model, point.element);
    const ElementEntry<Contact<DesignScalar>, DesignScalar>& contact = entry_of_contact(*model, point.element);
    const auto [i, j] = given_frames<Contact<double>>(*contacts.model, plain.i, plain.j);
    const double start = plain.element.curve.nearest(i.to_local(j.point(plain.element.s_j) - i.origin()));
    const auto& laws =
        std::get<std::vector<ElementEntry<CustomConstraint<double>, double>>>(contacts.model->constraints);
    ElementEntry<CustomConstraint<DesignScalar>, DesignScalar> slide;
    slide.element.law = std::make_shared<const DesignSlide>(
        SlideOnCurve<DesignScalar>(contact.element.curve, contact.element.s_j,
                                   DesignScalar(contact.element.free_side()) * contact.element.radius, start),
        laws[at(contacts.model->elements[at(point.slide)].index)].element.law);
    slide.i = contact.i;
    slide.j = contact.j;
    if (expanded->append({}, slide, ElementKind::constraint) != point.slide)
      throw std::logic_error("the slides of a model with derivatives are not numbered as those of the plain one");
  }
  return expanded ? std::shared_ptr<const DesignModel>(expanded) : model;
}

std::vector<DesignPlace> design_places(const DesignModel& model, const std::vector<ContactPoint>& points) {
  std::vector<DesignPlace> places(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    const ElementRecord& record = model.elements[at(points[k].element)];
    with_list(model.constraints, record.type,
              [&](const auto& list) { take_numbers(list[at(record.index)].element, places[k]); });
  }
  return places;
}

std::string trouble_with_places(const DesignModel& model) {
  std::string why;
  for_each_list(model.constraints, [&](const auto& list, int) {
    for (const auto& entry : list) {
      const auto none = [&](const char* key, const char* reason) {
        why = fmt::format("the {} of \"{}\" is 0 and moves with the parameters: {}", key, model.element_name(entry.id),
                          reason);
      };
      if constexpr (requires { entry.element.restitution; }) {
        const DesignScalar& e = entry.element.restitution;
        if (e.v == 0 && moves_with_parameters(e)) none("restitution", "what stays would come back with any other one");
      }
      if constexpr (requires { entry.element.mu_static; }) {
        const DesignScalar& mu = entry.element.mu;
        if (mu.v == 0 && moves_with_parameters(mu)) none("mu", "friction would begin with any other one");
      }
    }
  });
  return why;
}

}  // namespace catena
