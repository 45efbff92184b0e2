#include "catena/assembly/structure/elimination.hpp"

#include "catena/base/at.hpp"
#include "catena/elements/constraints/weld.hpp"

namespace catena {
namespace {

// The pose that the weld gives body j (or, followed backwards, body i) when the other one's is known.
Frame<double> welded_pose(const ElementEntry<Weld<double>, double>& weld, const Frame<double>& known, bool forward) {
  const Weld<double>& w = weld.element;
  const double angle = forward ? known.phi + w.angle : known.phi - w.angle;
  const Vec2<double> place = known.point(forward ? w.s_i : w.s_j);
  Frame<double> pose = make_frame(0.0, 0.0, angle);
  const Vec2<double> arm = pose.axis(forward ? w.s_j : w.s_i);
  pose.x = place.x - arm.x;
  pose.y = place.y - arm.y;
  return pose;
}

}  // namespace

Elimination eliminate_bodies(const Model& model, const std::vector<char>& keep_weld) {
  const auto& welds = std::get<std::vector<ElementEntry<Weld<double>, double>>>(model.constraints);
  const std::size_t bodies = model.bodies.size();
  Elimination result{std::vector<char>(bodies, 0), {}, std::vector<char>(welds.size(), 0)};
  result.pose.reserve(bodies);
  std::vector<int> queue = {ground};
  for (std::size_t b = 0; b < bodies; ++b) {
    result.pose.push_back(model.frame(static_cast<int>(b)));
    if (model.bodies[b].fixed) {
      result.immobile[b] = 1;
      queue.push_back(static_cast<int>(b));
    }
  }
  if (welds.empty()) return result;

  // Welds by body; the ground has the last place. Breadth first from everything that stands still.
  std::vector<std::vector<int>> welds_of(bodies + 1);
  const auto place_of = [&](int body) { return body < 0 ? bodies : at(body); };
  for (std::size_t k = 0; k < welds.size(); ++k) {
    if (!keep_weld.empty() && keep_weld[k]) continue;
    welds_of[place_of(welds[k].i)].push_back(static_cast<int>(k));
    welds_of[place_of(welds[k].j)].push_back(static_cast<int>(k));
  }
  for (std::size_t head = 0; head < queue.size(); ++head) {
    const int known = queue[head];
    const Frame<double> pose = known < 0 ? Frame<double>{} : result.pose[at(known)];
    for (int k : welds_of[place_of(known)]) {
      const bool forward = welds[at(k)].i == known;
      const int other = forward ? welds[at(k)].j : welds[at(k)].i;
      // A second weld between bodies that stand still already is a redundant constraint and stays one.
      if (other < 0 || result.immobile[at(other)]) continue;
      result.pose[at(other)] = welded_pose(welds[at(k)], pose, forward);
      result.immobile[at(other)] = 1;
      result.weld_eliminated[at(k)] = 1;
      queue.push_back(other);
    }
  }
  return result;
}

}  // namespace catena
