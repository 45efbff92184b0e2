// Ropes: what the stretches of an elastic one share, and where ropes leave their pulleys.
#include <algorithm>
#include <limits>
#include <numbers>

#include "catena/assembly/constraint_operations.hpp"
#include "catena/assembly/evaluate.hpp"
#include "catena/assembly/rope_ways.hpp"
#include "catena/base/at.hpp"
#include "catena/elements/all.hpp"

namespace catena {
namespace {

// Angles of contact are known to rounding; a rope that only touches its pulley has not left it. rad.
constexpr double left = 1e-9;
// Of a rope's length: one with less slack than this is taut.
constexpr double taut = 1e-9;
// From its given direction a stretch at a circle may turn so far, rad: beyond half a turn the arc that it winds would
// be taken for one a whole turn shorter, and between two looks it turns by less than the rest, 0.3 rad.
constexpr double most_turned = most_turned_between_places;

}  // namespace

void Equations::stretch_ropes(Pose& pose) const {
  using E = ElasticRope<double>;
  const auto& block = std::get<ForceBlock<E>>(plan_->forces);
  if (block.size() == 0) return;
  const auto& list = std::get<std::vector<ElementEntry<E, double>>>(model_->forces);
  const auto& data = std::get<ForceData<E>>(forces_);
  for (std::size_t head = 0; head < list.size(); head += at(list[head].element.pieces)) {
    const auto piece = [&](int n) { return at(place_[at(list[head + at(n)].id)]); };
    const int pieces = list[head].element.pieces;
    double stretch = -data.element[piece(0)].length;
    for (int n = 0; n < pieces; ++n) pose.stretches[piece(n)] = {};
    for (int n = 0; n < pieces; ++n) {
      const std::size_t e = piece(n);
      const E& span = data.element[e];
      if (span.bridge) continue;
      const Frame<double> i = detail::shifted(pose.frames[at(block.body_i[e])], data.shift[e].i),
                          j = detail::shifted(pose.frames[at(block.body_j[e])], data.shift[e].j);
      stretch += span.extent(i, j);
      double entries[6];
      span.gradient(PairGeometry(Arguments<double>{i, j, 0, {}}, span.s_i, span.s_j), entries);
      const auto add = [&](int body, const double* part) {
        for (int m = 0; m < pieces; ++m) {
          const std::size_t of = piece(m);
          if (block.body_i[of] == body) {
            for (int k = 0; k < 3; ++k) pose.stretches[of].g_i[k] += part[k];
          }
          if (block.body_j[of] == body) {
            for (int k = 0; k < 3; ++k) pose.stretches[of].g_j[k] += part[k];
          }
        }
      };
      add(block.body_i[e], entries);
      add(block.body_j[e], entries + 3);
    }
    for (int n = 0; n < pieces; ++n) pose.stretches[piece(n)].stretch = std::max(stretch, 0.0);
  }
}

namespace {

// Follows the stretches of a rope and compares their directions where they meet on a circle.
class Wraps {
 public:
  template <class E>
  void add(const E& span, const Frame<double>& i, const Frame<double>& j) {
    const Vec2<double> h = separation(i, j, span.s_i, span.s_j);
    exists_ = exists_ && span.exists(h);
    const double offset = span.radius_j - span.radius_i;
    const double room = squared_norm(h) / (offset * offset) - 1;
    if (offset != 0 && !(room >= room_)) room_ = room;
    const double theta = span.heading(span.line(h).along);
    const double before = span.next_to.follows ? theta_ : span.next_to.before + i.phi;
    const bool winds = span.radius_i != 0 || span.radius_j != 0;
    turned_ = turned_ || (winds && std::abs(theta - span.angle) > most_turned);
    look(span.radius_i, theta - before);
    look(span.radius_j, span.next_to.after + j.phi - theta);
    theta_ = theta;
  }
  bool leaves() const { return leaves_; }
  double widest() const { return widest_; }
  double room() const { return room_; }
  const char* trouble(bool holds) const {
    if (!exists_) return "an end or a pulley of it is inside the circle of the next pulley";
    if (turned_)
      return "a stretch of it at a pulley has turned nearly half a turn from its given direction: how far it winds is "
             "not "
             "followed beyond; end the analysis before, or give the rope from a later place";
    if (holds && leaves_)
      return "it leaves a pulley, its angle of contact there has come to zero; end the analysis before, or leave the "
             "pulley out";
    return nullptr;
  }

 private:
  // A comparison with NaN, where nothing meets, is false.
  void look(double radius, double turn) {
    leaves_ = leaves_ || radius * turn < -left * std::abs(radius);
    if (radius != 0 && std::abs(turn) > widest_) widest_ = std::abs(turn);
  }
  double theta_ = 0, widest_ = 0, room_ = std::numeric_limits<double>::infinity();
  bool exists_ = true, leaves_ = false, turned_ = false;
};

template <class FrameOf>
Wraps wraps_of(const Model& model, int element, FrameOf&& frame) {
  const ElementRecord& record = model.elements[at(element)];
  Wraps wraps;
  const auto follow = [&](const auto& list, int first, int count) {
    for (int n = first; n < first + count; ++n) {
      const auto& entry = list[at(n)];
      if (!entry.element.bridge) wraps.add(entry.element, frame(entry.i), frame(entry.j));
    }
  };
  if (record.kind == ElementKind::force) {
    const auto& list = std::get<std::vector<ElementEntry<ElasticRope<double>, double>>>(model.forces);
    follow(list, record.index, list[at(record.index)].element.pieces);
    return wraps;
  }
  const auto& head = std::get<std::vector<ElementEntry<Rope<double>, double>>>(model.constraints)[at(record.index)];
  wraps.add(head.element, frame(head.i), frame(head.j));
  follow(std::get<std::vector<ElementEntry<RopePart<double>, double>>>(model.constraints), head.element.first_part,
         head.element.parts);
  return wraps;
}

}  // namespace

namespace {

Wraps present_wraps(const Evaluator& evaluator, int rope) {
  const Plan& plan = evaluator.plan();
  return wraps_of(evaluator.model(), rope,
                  [&](int body) { return evaluator.ground_frame(body < 0 ? plan.bodies : plan.plan_body[at(body)]); });
}

}  // namespace

std::vector<Frame<double>> frames_of(const Evaluator& evaluator, const RopeRoute& route) {
  const Plan& plan = evaluator.plan();
  std::vector<Frame<double>> frames;
  for (const RopePulley<double>& node : route.nodes)
    frames.push_back(evaluator.ground_frame(node.body < 0 ? plan.bodies : plan.plan_body[at(node.body)]));
  return frames;
}

int rope_at_circle(const Evaluator& evaluator) {
  constexpr double near = 1e-2;
  int found = -1;
  const auto look = [&](int rope) {
    if (found < 0 && !(present_wraps(evaluator, rope).room() >= near)) found = rope;
  };
  const Model& model = evaluator.model();
  for (const auto& entry : std::get<std::vector<ElementEntry<Rope<double>, double>>>(model.constraints)) look(entry.id);
  for (const auto& entry : std::get<std::vector<ElementEntry<ElasticRope<double>, double>>>(model.forces)) {
    if (entry.element.pieces > 0) look(entry.id);
  }
  return found;
}

double widest_contact(const Model& model, int rope) {
  return wraps_of(model, rope, [&](int body) { return model.frame(body); }).widest();
}

const char* Equations::rope_trouble(const Pose& pose, int element) const {
  const ElementRecord& record = model_->elements[at(element)];
  const auto frame = [&](int body) {
    return ground_frame(pose, body < 0 ? plan_->bodies : plan_->plan_body[at(body)]);
  };
  const Wraps wraps = wraps_of(*model_, element, frame);
  if (record.kind == ElementKind::force) {
    const auto& list = std::get<std::vector<ElementEntry<ElasticRope<double>, double>>>(model_->forces);
    return wraps.trouble(rope_slack<double>(list, record.index, frame) < 0);
  }
  const auto& head = std::get<std::vector<ElementEntry<Rope<double>, double>>>(model_->constraints)[at(record.index)];
  const double slack = measure(pose, element, {}, {}).value;
  if (head.element.k > 0) return wraps.trouble(slack < 0);
  const bool may_hold = plan_->element_row[at(element)] >= 0;
  return wraps.trouble(may_hold && slack < taut * head.element.length);
}

}  // namespace catena
