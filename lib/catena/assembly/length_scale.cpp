#include "catena/assembly/length_scale.hpp"

#include <algorithm>
#include <cmath>

#include "catena/assembly/attachment_points.hpp"
#include "catena/assembly/equations.hpp"
#include "catena/base/at.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/elastic_gaps.hpp"
#include "catena/model/given_frames.hpp"
#include "catena/model/model_part.hpp"

namespace catena {
namespace {

// Configurations are given to some seven digits: a gap below this part of what it is a difference of is closed.
constexpr double given_rounding = 1e-6;

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
    if constexpr (HasCurve<E>) {
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

// A dimension of an element that one of its fields gives; 0 where it gives another thing.
template <class E, class Field>
double dimension(const E& element, const Field& field) {
  if constexpr (requires { field.unit, field.unless; }) {
    if (field.unit == UnitKind::length) return element.*field.member;
  }
  return 0;
}

// The gap of an element as it is given; 0 where it is closed, an angle, or told by no pair of points.
template <class E>
double given_gap(const Model& model, const ElementEntry<E, double>& entry) {
  const auto frames = given_frames<E>(model, entry.i, entry.j);
  const auto &i = frames[0], &j = frames[1];
  double gap = 0, from = 0;
  if constexpr (HasCurve<E>) {
    const CurvePlace place = entry.element.place();
    const Vec2<double> point = i.to_local(j.point(entry.element.s_j) - i.origin());
    gap = entry.element.measure(i, j, place);
    from = norm(point - entry.element.curve.plain(0).p);
  } else if constexpr (requires { entry.element.value(i, j); }) {
    if (entry.element.in_angle()) return 0;
    gap = entry.element.measure(i, j);
    from = std::abs(entry.element.value(i, j));
  }
  return std::abs(gap) > given_rounding * from ? std::abs(gap) : 0;
}

// The largest length of a one-sided element: how far it is open, the points of its bodies from their centroids and of
// the ground from the other body, its own dimensions; 0 if none.
double size_of_gaps(const Model& model) {
  double largest = 0;
  const auto take = [&](double length) { largest = std::max(largest, length); };
  for_each_list(model.constraints, [&](const auto& list, int) {
    using E = ElementOf<decltype(list)>;
    if constexpr (OneSided<E>) {
      for (const auto& entry : list) {
        if constexpr (!Dry<E>) take(given_gap(model, entry));
        const int other = entry.i >= 0 ? entry.i : entry.j;
        visit_points(entry, [&](const Vec2<double>& local, int body) {
          // Where a curve is fixed in the ground, it has no point there.
          if (body >= 0) return take(norm(local));
          if (!HasCurve<E> && other >= 0) take(norm(local - model.bodies[at(other)].position));
        });
        std::apply([&](const auto&... field) { (take(dimension(entry.element, field)), ...); }, E::fields());
      }
    }
  });
  return largest;
}

// The largest length that a constraint keeps, or a force element has, as a spring without force; 0 if none.
double size_of_elements(const Model& model) {
  double largest = 0;
  const auto take = [&](double length) {
    if (std::isfinite(length)) largest = std::max(largest, std::abs(length));
  };
  for_each_list(model.constraints, [&](const auto& list, int) {
    if constexpr (HasSquaredValue<ElementOf<decltype(list)>>) {
      for (const auto& entry : list) take(entry.values[0].function < 0 ? entry.values[0].constant : 0);
    }
  });
  for_each_list(model.forces, [&](const auto& list, int) {
    for (const auto& entry : list)
      std::apply([&](const auto&... field) { (take(dimension(entry.element, field)), ...); },
                 ElementOf<decltype(list)>::fields());
  });
  return largest;
}

// Where the weight stops or turns what moves: v^2 / g; 0 where nothing moves, or has weight.
double way_against_weight(const Model& model) {
  double fastest = 0;
  for (const auto& body : model.bodies) fastest = std::max(fastest, squared_norm(body.velocity));
  const double weight = norm(model.gravity);
  return weight > 0 ? fastest / weight : 0;
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

/// Distances of points from the centroid of their body.
struct PointRadii {
  double squares = 0, sum = 0;
  int count = 0;
  void add(double square) {
    squares += square;
    sum += std::sqrt(square);
    ++count;
  }
};

/// By plan body: points of constraints, and of force elements and what acts like them; whether curves touch it.
struct AttachedRadii {
  std::vector<PointRadii> held, forced;
  std::vector<char> on_curve;
  PointRadii all;  // of constraints

  AttachedRadii(const Model& model, const Plan& plan)
      : held(at(plan.bodies)), forced(held.size()), on_curve(held.size(), 0) {
    for_each_list(model.constraints, [&](const auto& list, int) {
      for (const auto& entry : list) {
        const bool pulls = is_elastic_gap(model, entry);
        visit_points(entry, [&](const Vec2<double>& local, int body) {
          if (body < 0) return;
          const double square = squared_norm(local);
          (pulls ? forced : held)[at(plan.plan_body[at(body)])].add(square);
          if (!pulls) all.add(square);
        });
        if constexpr (HasCurve<ElementOf<decltype(list)>>) {
          for (const int body : {entry.i, entry.j}) {
            if (body >= 0) on_curve[at(plan.plan_body[at(body)])] = 1;
          }
        }
      }
    });
    for_each_list(model.forces, [&](const auto& list, int) {
      for (const auto& entry : list) {
        visit_points(entry, [&](const Vec2<double>& local, int body) {
          if (body >= 0) forced[at(plan.plan_body[at(body)])].add(squared_norm(local));
        });
      }
    });
  }
};

}  // namespace

double given_length(const Model& model) {
  for (const auto length :
       {extent, mean_force_arm, mean_curve_size, mean_gyration, size_of_gaps, size_of_elements, way_against_weight}) {
    if (const double found = length(model); found != 0) return found;
  }
  return 0;
}

double length_without_joints(const Model& model) {
  const double found = given_length(model);
  return found != 0 ? found : 1;
}

bool lacks_length(const Equations& equations) {
  if (given_length(equations.model()) != 0) return false;
  double arms = 0;
  equations.attachment_radii(&arms);
  return arms == 0;
}

// Points of constraints; where all points of a body are at its centroid, those of force elements; else the mean of what
// it hangs together with, or the length scale. Every length comes from the scene, and from the same mechanism: what
// stands beside it does not change where it is assembled.
std::vector<double> Equations::attachment_radii(double* mean) const {
  const AttachedRadii points(*model_, *plan_);
  std::vector<double> radius(points.held.size(), 0.0);
  bool lacks = false;
  for (std::size_t b = 0; b < radius.size(); ++b) {
    const PointRadii& of = points.held[b].squares > 0 ? points.held[b] : points.forced[b];
    if (of.squares > 0) radius[b] = std::sqrt(of.squares / of.count);
    lacks = lacks || (radius[b] == 0 && !model_->bodies[at(plan_->model_body[b])].particle);
  }
  if (lacks) {
    const std::vector<std::vector<int>> groups = separate_groups(*model_);
    for (const std::vector<int>& group : groups) {
      PointRadii own;
      for (const int body : group) {
        const PointRadii& of = points.held[at(plan_->plan_body[at(body)])];
        own.sum += of.sum;
        own.count += of.count;
      }
      if (own.sum == 0) {
        // Held by curves alone: as where nothing stands beside it.
        const bool curves = std::any_of(group.begin(), group.end(),
                                        [&](int body) { return points.on_curve[at(plan_->plan_body[at(body)])] != 0; });
        if (curves && groups.size() > 1)
          own = {.sum = length_without_joints(part_of(*model_, group).model), .count = 1};
        if (own.sum == 0) continue;
      }
      for (const int body : group) {
        double& r = radius[at(plan_->plan_body[at(body)])];
        if (r == 0) r = own.sum / own.count;
      }
    }
  }
  for (double& r : radius) {
    if (r == 0) r = length_scale_;
  }
  if (mean) *mean = points.all.count > 0 ? points.all.sum / points.all.count : 0;
  return radius;
}

}  // namespace catena
