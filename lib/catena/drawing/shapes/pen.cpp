#include "catena/drawing/shapes/pen.hpp"

#include <cmath>

#include "catena/drawing/shapes/symbols.hpp"

namespace catena {

void Pen::span(const Vec2<double>& s_i, const Vec2<double>& s_j, DrawnSymbol look) {
  builder_.add(
      {.anchor = Anchor::span, .element = element_, .body_i = i_, .body_j = j_, .point_i = s_i, .point_j = s_j},
      std::move(look));
}

void Pen::point(int body, const Vec2<double>& local, int axis_body, const Vec2<double>& axis, DrawnSymbol look) {
  const double length = norm(axis);
  builder_.add({.anchor = Anchor::point,
                .element = element_,
                .body_i = body,
                .body_j = axis_body,
                .point_i = local,
                .point_j = length > 0 ? axis / length : Vec2<double>{1, 0}},
               std::move(look));
}

void Pen::pin(const Vec2<double>& s_i, const Vec2<double>& s_j) {
  builder_.attach(i_, s_i);
  builder_.attach(j_, s_j);
  builder_.add_pin(i_, j_, j_ < 0 ? i_ : j_, j_ < 0 ? s_i : s_j);
  if (i_ < 0) point(ground, s_i, ground, {1, 0}, ground_pin_symbol());
  if (j_ < 0) point(ground, s_j, ground, {1, 0}, ground_pin_symbol());
  point(j_ < 0 ? i_ : j_, j_ < 0 ? s_i : s_j, ground, {1, 0}, pin_symbol());
}

void Pen::weld(const Vec2<double>& s_i, const Vec2<double>& s_j) {
  builder_.attach(i_, s_i);
  builder_.attach(j_, s_j);
  if (i_ < 0) point(ground, s_i, ground, {1, 0}, ground_weld_symbol());
  if (j_ < 0) point(ground, s_j, ground, {1, 0}, ground_weld_symbol());
  point(j_ < 0 ? i_ : j_, j_ < 0 ? s_i : s_j, j_ < 0 ? i_ : j_, {1, 0}, weld_symbol());
}

void Pen::slide(const Vec2<double>& s_i, const Vec2<double>& axis_i, const Vec2<double>& s_j,
                const Vec2<double>& axis_j) {
  constexpr double between_rails = 1.7;
  builder_.add_guide({.body_i = i_, .body_j = j_, .point_i = s_i, .axis_i = axis_i, .point_j = s_j},
                     {.anchor = Anchor::span, .element = element_, .body_i = i_, .body_j = i_}, guide_symbol(i_ < 0),
                     between_rails);
  builder_.attach(i_, s_i);
  if (j_ < 0) return point(ground, s_j, ground, axis_j, block_symbol());
  builder_.attach(j_, s_j);
  builder_.has_look(j_);
  point(j_, s_j, j_, axis_j, block_symbol());
}

void Pen::slot(const Vec2<double>& s_i, const Vec2<double>& axis_i, const Vec2<double>& s_j) {
  constexpr double around_slot = 3;
  builder_.add_guide({.body_i = i_, .body_j = j_, .point_i = s_i, .axis_i = axis_i, .point_j = s_j},
                     {.anchor = Anchor::span, .element = element_, .body_i = i_, .body_j = i_}, slot_symbol(i_ < 0),
                     around_slot);
  builder_.attach(i_, s_i);
  builder_.attach(j_, s_j);
  if (j_ < 0) point(ground, s_j, ground, {1, 0}, ground_pin_symbol());
  point(j_, s_j, ground, {1, 0}, pin_symbol());
}

void Pen::rod(const Vec2<double>& s_i, const Vec2<double>& s_j) {
  builder_.attach(i_, s_i);
  builder_.attach(j_, s_j);
  span(s_i, s_j, driver_ ? cylinder_symbol() : bar_symbol(1.0, Role::rod));
  for (const auto& [body, local] : {std::pair(i_, s_i), std::pair(j_, s_j)}) {
    if (body < 0) point(body, local, ground, {1, 0}, ground_pin_symbol());
    point(body, local, ground, {1, 0}, pin_symbol());
  }
}

void Pen::rod_to_ground(const Vec2<double>& s_i, const Vec2<double>& place) {
  j_ = ground;
  rod(s_i, place);
}

void Pen::roller(const Vec2<double>& s_i, const Vec2<double>& normal) {
  builder_.attach(i_, s_i);
  point(i_, s_i, ground, -perpendicular(normal), roller_symbol());
  point(i_, s_i, ground, {1, 0}, pin_symbol());
}

void Pen::turn(const Vec2<double>& s_i) {
  if (driver_) builder_.add_at_pin(element_, ground, i_, s_i, turn_symbol());
}

void Pen::turn(const Vec2<double>& s_i, const Vec2<double>& s_j) {
  if (!driver_) return;
  if (j_ < 0) return turn(s_i);
  builder_.add_at_pin(element_, i_, j_, s_j, turn_symbol());
}

void Pen::measured_along(const Vec2<double>& s_i, const Vec2<double>& axis_i, const Vec2<double>& s_j) {
  builder_.attach(i_, s_i);
  builder_.attach(j_, s_j);
  if (!driver_) return;
  builder_.add_guide({.body_i = i_, .body_j = j_, .point_i = s_i, .axis_i = axis_i, .point_j = s_j},
                     {.anchor = Anchor::span, .element = element_, .body_i = i_, .body_j = i_},
                     bar_symbol(0, Role::measure));
}

void Pen::tie(const Vec2<double>& s_i, const Vec2<double>& s_j) {
  builder_.attach(i_, s_i);
  builder_.attach(j_, s_j);
  span(s_i, s_j, bar_symbol(0, Role::measure));
}

void Pen::face_on_j(const Vec2<double>& s_j, const Vec2<double>& axis_j) {
  builder_.attach(j_, s_j);
  builder_.has_look(j_);
  builder_.follow(element_, j_, s_j);
  point(j_, s_j, j_, axis_j, face_symbol());
}

void Pen::spring(const Vec2<double>& s_i, const Vec2<double>& s_j, bool elastic, bool damped) {
  builder_.attach(i_, s_i);
  builder_.attach(j_, s_j);
  span(s_i, s_j, spring_symbol(elastic, damped));
  if (i_ < 0) point(ground, s_i, ground, {1, 0}, ground_pin_symbol());
  if (j_ < 0) point(ground, s_j, ground, {1, 0}, ground_pin_symbol());
}

void Pen::spiral_spring(const Vec2<double>&, const Vec2<double>& s_j) {
  builder_.add_at_pin(element_, i_, j_, s_j, spiral_symbol());
}

void Pen::cable(const Vec2<double>& s_i, const Vec2<double>& s_j) {
  builder_.attach(i_, s_i);
  builder_.attach(j_, s_j);
  span(s_i, s_j, bar_symbol(0, Role::cable));
  if (i_ < 0) point(ground, s_i, ground, {1, 0}, ground_pin_symbol());
  if (j_ < 0) point(ground, s_j, ground, {1, 0}, ground_pin_symbol());
}

void Pen::bushing(const Vec2<double>& s_i, const Vec2<double>& s_j) {
  builder_.attach(i_, s_i);
  builder_.attach(j_, s_j);
  if (i_ < 0) point(ground, s_i, ground, {1, 0}, ground_pin_symbol());
  point(j_ < 0 ? i_ : j_, j_ < 0 ? s_i : s_j, j_ < 0 ? i_ : j_, {1, 0}, bushing_symbol());
}

void Pen::force(const Vec2<double>& s_i, bool in_body_axes) {
  builder_.attach(i_, s_i);
  builder_.add_load({element_, i_, s_i, in_body_axes});
}

void Pen::limits(const Vec2<double>& s_i, const Vec2<double>& axis_i, double low, double high) {
  for (const double end : {low, high}) {
    if (std::isfinite(end)) point(i_, s_i + (end / norm(axis_i)) * axis_i, i_, axis_i, limit_symbol());
  }
}

}  // namespace catena
