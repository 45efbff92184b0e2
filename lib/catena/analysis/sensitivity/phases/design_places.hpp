// The places of contact_points.hpp with derivatives by design parameters, and models that have the equations of their
// slides.
//
// A model with derivatives gets the same equations behind its own elements as contact_points() appends to the plain
// one, so that both number their elements alike. Curves, points and radii of a slide then carry derivatives.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "catena/analysis/contact/contact_points.hpp"
#include "catena/assembly/design/design_mechanism.hpp"

namespace catena {

/// The numbers of a place with derivatives; symbols as in ContactPoint.
struct DesignPlace {
  DesignScalar restitution, k, c, exponent, mu, mu_static, smoothing, radius{1.0};
  DesignScalar half_length;  ///< of a guide
  bool has_length = false;   ///< its moment presses
  DesignScalar range;        ///< between the bounds of a stop that has both; of a cable 2 L
  bool has_range = false;
};

/// `model`, with the equations of slides of these contacts.
std::shared_ptr<const DesignModel> with_slides(std::shared_ptr<const DesignModel> model, const ContactModel& contacts);

/// One for each place.
std::vector<DesignPlace> design_places(const DesignModel& model, const std::vector<ContactPoint>& points);

/// Why parameters that reach a place have no derivatives, or nothing: they move a number at which it changes its kind.
std::string trouble_with_places(const DesignModel& model);

}  // namespace catena
