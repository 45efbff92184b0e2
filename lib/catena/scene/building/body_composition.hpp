// Mass, centroid and inertia of a body made of parts: masses, and shapes of uniform density.
//
//   m = sum m_k     c = sum m_k c_k / m     J = sum (J_k + m_k |c_k - c|^2)
//   rectangle J_k = m_k (w^2 + h^2) / 12     disc J_k = m_k r^2 / 2     polygon: by triangles from its first corner
//
// All in the author's frame of the body; kg, m, kg m^2. A negative mass cuts a hole. Templated on the scalar of the
// parameters.
#pragma once

#include <span>

#include "catena/base/vec2.hpp"
#include "catena/scene/reading/scene_template.hpp"

namespace catena {

template <class S>
class BodyComposition {
 public:
  /// Adds a part, its numbers as in PartTemplate. Returns an error as a phrase, or nullptr.
  const char* add(PartTemplate::Shape shape, const S& mass, std::span<const S> n);

  const S& mass() const { return mass_; }
  Vec2<S> centroid() const { return moment_ / mass_; }
  S inertia() const { return about_origin_ - squared_norm(moment_) / mass_; }

 private:
  /// A part with the inertia `own` about its centroid.
  void add_mass(const S& mass, const Vec2<S>& centroid, const S& own) {
    mass_ += mass;
    moment_ += mass * centroid;
    about_origin_ += own + mass * squared_norm(centroid);
  }
  const char* add_polygon(const S& mass, std::span<const S> n);

  S mass_{};
  Vec2<S> moment_{};
  S about_origin_{};
};

template <class S>
const char* BodyComposition<S>::add(PartTemplate::Shape shape, const S& mass, std::span<const S> n) {
  if (n.size() < 3) return nullptr;  // reported by the reader
  const Vec2<S> centre{n[0], n[1]};
  switch (shape) {
    case PartTemplate::Shape::mass:
      add_mass(mass, centre, n[2]);
      return value_of(n[2]) < 0 && value_of(mass) > 0 ? "has a negative inertia" : nullptr;
    case PartTemplate::Shape::rectangle:
      add_mass(mass, centre, mass * (n[2] * n[2] + n[3] * n[3]) / S(12.0));
      return value_of(n[2]) <= 0 || value_of(n[3]) <= 0 ? "is a rectangle without area" : nullptr;
    case PartTemplate::Shape::disc:
      add_mass(mass, centre, mass * n[2] * n[2] * S(0.5));
      return value_of(n[2]) <= 0 ? "is a disc without area" : nullptr;
    case PartTemplate::Shape::polygon:
      return add_polygon(mass, n);
  }
  return nullptr;
}

// A triangle (0, a, b) has the area a x b / 2, the centroid (a + b) / 3 and the polar second moment
// (a x b) (a.a + a.b + b.b) / 12 about its corner 0; signed areas make any simple polygon of them.
template <class S>
const char* BodyComposition<S>::add_polygon(const S& mass, std::span<const S> n) {
  const Vec2<S> corner{n[0], n[1]};
  S area{}, second{};
  Vec2<S> first{};
  for (std::size_t k = 2; k + 3 < n.size(); k += 2) {
    const Vec2<S> a = Vec2<S>{n[k], n[k + 1]} - corner, b = Vec2<S>{n[k + 2], n[k + 3]} - corner;
    const S twice = cross(a, b);
    area += twice * S(0.5);
    first += (a + b) * (twice / S(6.0));
    second += twice * (dot(a, a) + dot(a, b) + dot(b, b)) / S(12.0);
  }
  if (value_of(area) == 0) return "is a polygon without area";
  const Vec2<S> centroid = first / area;
  add_mass(mass, corner + centroid, mass * (second / area - squared_norm(centroid)));
  return nullptr;
}

}  // namespace catena
