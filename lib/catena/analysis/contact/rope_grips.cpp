#include "catena/analysis/contact/rope_grips.hpp"

#include <algorithm>

#include "catena/base/at.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/rope_layout.hpp"

namespace catena {
namespace {

RopeLayout<double> as_laid(const Model& model, const RopeRoute& route, const std::vector<Frame<double>>& frames) {
  RopeLayout<double> layout(model, route.nodes, frames);
  layout.off = route.off;
  return layout;
}

std::vector<Frame<double>> given_frames_of(const Model& model, const RopeRoute& route) {
  std::vector<Frame<double>> frames;
  for (const RopePulley<double>& node : route.nodes) frames.push_back(model.frame(node.body));
  return frames;
}

/// The grips of a route without stiffness: runs of nodes that move together, with friction, and without an end.
std::vector<RopeGrip> rigid_grips(const RopeLayout<double>& layout) {
  std::vector<RopeGrip> grips;
  for (int first = 0, last = 0; first <= layout.last(); first = ++last) {
    while (last < layout.last() && layout.together(last, last + 1)) ++last;
    if (first == 0 || last == layout.last()) continue;
    const auto begin = layout.nodes().begin();
    if (std::any_of(begin + first, begin + last + 1, [](const RopePulley<double>& node) { return node.mu > 0; }))
      grips.push_back({first, last});
  }
  return grips;
}

/// Those of an elastic one: what is between two pulleys yields, so that each slips on its own.
std::vector<RopeGrip> elastic_grips(const RopeLayout<double>& layout) {
  std::vector<RopeGrip> grips;
  for (int k = 1; k < layout.last(); ++k) {
    if (layout.nodes()[at(k)].mu > 0) grips.push_back({k, k});
  }
  return grips;
}

/// The last node of a grip that the rope touches; -1: none.
int last_touched(const RopeGrip& grip, const RopeRoute& route) {
  for (int k = grip.last; k >= grip.first; --k) {
    if (!route.off[at(k)]) return k;
  }
  return -1;
}

GripLines lines_of(const RopeGrip& grip, const RopeRoute& route, const RopeLayout<double>& layout) {
  GripLines lines;
  int a = layout.before(grip.first + 1);
  if (a >= grip.first) a = layout.before(a);
  double theta = 0, factor = 0;
  const auto add = [&](int from, int to, double more) {
    GripLines::Line line{route.nodes[at(from)].body, route.nodes[at(to)].body, layout.line(from, to), factor + more};
    if (!lines.lines.empty()) line.span.angle = theta;
    theta = line.span.angle;
    lines.lines.push_back(line);
  };
  for (int k = layout.after(a); k <= grip.last; k = layout.after(k)) {
    const double by_turn = route.nodes[at(k)].mu * route.nodes[at(k)].side;
    add(a, k, -by_turn);
    theta += route.nodes[at(k)].side * route.memory.contact[at(k)];
    factor = by_turn;
    a = k;
  }
  add(a, layout.after(a), 0);
  return lines;
}

}  // namespace

Taylor<double> GripLines::exponent(const Evaluator& evaluator, std::span<const double> qd) const {
  const Plan& plan = evaluator.plan();
  const auto motion = [&](int body) {
    const int p = body < 0 ? plan.bodies : plan.plan_body[at(body)];
    const double* v = qd.empty() ? nullptr : &qd[at(3 * p)];
    return moving(evaluator.ground_frame(p), v ? v[0] : 0, v ? v[1] : 0, v ? v[2] : 0);
  };
  Taylor<double> sum(0.0);
  for (const Line& line : lines) {
    const Vec2<Taylor<double>> h = separation(motion(line.i), motion(line.j), line.span.s_i, line.span.s_j);
    sum += Taylor<double>(line.factor) * line.span.heading(line.span.line(h).along);
  }
  return sum;
}

std::vector<GrippedRope> gripped_ropes(const Model& model, std::shared_ptr<Model>& expanded) {
  std::vector<GrippedRope> ropes;
  if (first_gripped_rope(model) < 0) return ropes;
  const std::vector<RopeRoute> routes = rope_routes(model);
  for (std::size_t r = 0; r < routes.size(); ++r) {
    const RopeRoute& route = routes[r];
    const std::vector<Frame<double>> frames = given_frames_of(model, route);
    GrippedRope rope{.route = static_cast<int>(r), .element = route.element, .elastic = route.elastic};
    const RopeLayout<double> layout = as_laid(model, route, frames);
    rope.grips = route.elastic ? elastic_grips(layout) : rigid_grips(layout);
    if (rope.grips.empty()) continue;
    if (!expanded) expanded = std::make_shared<Model>(model);
    for (RopeGrip& grip : rope.grips) {
      if (!layout.skeleton(grip.last, layout.last()).straight.empty())
        grip.slide = append_behind(*expanded, route, grip.last, frames);
    }
    if (rope.elastic) {
      rope.whole = append_behind(*expanded, route, 0, frames);
      const auto index = at(model.elements[at(route.element)].index);
      const auto& of = std::get<std::vector<ElementEntry<ElasticRope<double>, double>>>(model.forces)[index];
      auto& heads = std::get<std::vector<ElementEntry<Rope<double>, double>>>(expanded->constraints);
      heads[at(expanded->elements[at(rope.whole)].index)].element.length = of.element.length;
    }
    ropes.push_back(std::move(rope));
  }
  return ropes;
}

std::vector<GripLines> lay_grips(Model& model, const GrippedRope& rope, const RopeRoute& route,
                                 const std::vector<Frame<double>>& frames) {
  const RopeLayout<double> layout = as_laid(model, route, frames);
  std::vector<GripLines> lines;
  for (const RopeGrip& grip : rope.grips) {
    GripLines& of_grip = lines.emplace_back();
    const int node = last_touched(grip, route);
    if (node < 0) continue;
    if (grip.slide >= 0) lay_behind(model, route, grip.slide, node, grip.last, frames);
    of_grip = lines_of(grip, route, layout);
  }
  if (rope.elastic) lay_behind(model, route, rope.whole, 0, 0, frames);
  return lines;
}

std::vector<double> part_yields(const Model& model, const GrippedRope& rope, const RopeRoute& route,
                                const std::vector<Frame<double>>& frames) {
  const double whole = length_behind(model, route, 0, frames);
  std::vector<double> ends{whole};  // how much of the way is behind each end of a part
  for (const RopeGrip& grip : rope.grips) {
    const int node = last_touched(grip, route);
    if (node < 0) {
      ends.push_back(ends.back());
      continue;
    }
    const double arc = route.nodes[at(node)].radius * route.memory.contact[at(node)];
    ends.push_back(length_behind(model, route, node, frames) + arc / 2);
  }
  ends.push_back(0);
  const auto index = at(model.elements[at(rope.element)].index);
  const double k = std::get<std::vector<ElementEntry<ElasticRope<double>, double>>>(model.forces)[index].element.k;
  std::vector<double> yields;
  for (std::size_t n = 0; n + 1 < ends.size(); ++n) yields.push_back((ends[n] - ends[n + 1]) / whole / k);
  return yields;
}

int first_gripped_rope(const Model& model) {
  for (const RopePath& path : model.rope_paths) {
    if (std::any_of(path.nodes.begin(), path.nodes.end(), [](const RopeNode& node) { return node.mu > 0; }))
      return path.element;
  }
  return -1;
}

}  // namespace catena
