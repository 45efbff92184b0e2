#include "catena/assembly/length_scale.hpp"

#include <algorithm>
#include <cmath>

#include "catena/assembly/attachment_points.hpp"
#include "catena/base/at.hpp"
#include "catena/elements/all.hpp"

namespace catena {
namespace {

double extent(const Model& model) {
  if (model.bodies.empty()) return 0;
  Vec2<double> low = model.bodies.front().position, high = low;
  for (const auto& body : model.bodies) {
    low = {std::min(low.x, body.position.x), std::min(low.y, body.position.y)};
    high = {std::max(high.x, body.position.x), std::max(high.y, body.position.y)};
  }
  return std::max(high.x - low.x, high.y - low.y);
}

// Of the points of force elements from the centroids of their bodies, of the ground's from the other body; 0 if none.
double mean_force_arm(const Model& model) {
  double sum = 0;
  std::int64_t count = 0;
  for_each_list(model.forces, [&](const auto& list, int) {
    for (const auto& entry : list) {
      const int other = entry.i >= 0 ? entry.i : entry.j;
      visit_points(entry, [&](const Vec2<double>& local, int body) {
        if (body < 0 && other < 0) return;
        sum += norm(body >= 0 ? local : local - model.bodies[at(other)].position);
        ++count;
      });
    }
  });
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

// Of the points of curves from the centroids of their bodies, of the ground's from their own middle; 0 if none.
double mean_curve_size(const Model& model) {
  double sum = 0;
  std::int64_t count = 0;
  const auto add = [&](const BodyCurve<double>& curve, bool on_ground) {
    if (!curve || curve.is_line()) return;
    const std::vector<double> places = curve.samples();
    Vec2<double> middle{};
    if (on_ground) {
      for (const double s : places) middle += curve.plain(s).p / static_cast<double>(places.size());
    }
    for (const double s : places) sum += norm(curve.plain(s).p - middle);
    count += static_cast<std::int64_t>(places.size());
  };
  for_each_list(model.constraints, [&](const auto& list, int) {
    using E = ElementOf<decltype(list)>;
    if constexpr (SearchesCurve<E>) {
      for (const auto& entry : list) {
        const auto visit = [&](const auto& field) {
          if constexpr (std::is_same_v<std::remove_cvref_t<decltype(entry.element.*field.member)>, BodyCurve<double>>)
            add(entry.element.*field.member, (field.body == 0 ? entry.i : entry.j) < 0);
        };
        std::apply([&](const auto&... field) { (visit(field), ...); }, E::fields());
      }
    }
  });
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

// Radius of gyration of bodies with mass and inertia; 0 if none: where nothing but free bodies moves.
double mean_gyration(const Model& model) {
  double sum = 0;
  int count = 0;
  for (const auto& body : model.bodies) {
    if (body.fixed || !(body.mass > 0) || !(body.inertia > 0)) continue;
    sum += std::sqrt(body.inertia / body.mass);
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

}  // namespace

double length_without_joints(const Model& model) {
  for (const auto length : {extent, mean_force_arm, mean_curve_size, mean_gyration}) {
    if (const double found = length(model); found != 0) return found;
  }
  return 1;
}

}  // namespace catena
