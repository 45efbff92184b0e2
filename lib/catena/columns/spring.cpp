#include "catena/columns/spring.hpp"

#include "catena/columns/attachment.hpp"
#include "catena/elements/all.hpp"

namespace catena {
namespace {

/// A body's pose and velocity in the ground frame.
struct Motion {
  Frame<double> frame;
  Twist<double> twist;

  Motion(const Snapshot& snapshot, int body) {
    const Plan& plan = snapshot.evaluator.plan();
    const int p = body < 0 ? plan.bodies : plan.plan_body[static_cast<std::size_t>(body)];
    frame = snapshot.evaluator.ground_frame(p);
    if (snapshot.qd.empty()) return;
    const double* v = snapshot.qd.data() + 3 * p;
    twist = {v[0], v[1], v[2]};
  }
};

}  // namespace

SpringLoads spring_loads(const Snapshot& snapshot, int element) {
  const Model& model = snapshot.evaluator.model();
  const ElementRecord& record = model.elements[static_cast<std::size_t>(element)];
  SpringLoads loads;
  with_list(model.forces, record.type, [&](const auto& list) {
    const auto& entry = list[static_cast<std::size_t>(record.index)];
    constexpr int functions = ElementOf<decltype(list)>::functions;
    double f[functions + 1] = {};  // one more, so that it is never empty
    for (std::size_t k = 0; k < entry.values.size(); ++k) {
      const auto& value = entry.values[k];
      f[k] = value.function < 0 ? value.constant
                                : model.functions[static_cast<std::size_t>(value.function)].evaluate(snapshot.t).f;
    }
    const Motion i(snapshot, entry.i), j(snapshot, entry.j);
    Wrench<double> on_i, on_j;
    entry.element.force(ForceArguments<double>{i.frame, j.frame, i.twist, j.twist, f, {}}, on_i, on_j);
    const Attachment attachment = attachment_of(entry);
    const Vec2<double> h = j.frame.point(attachment.point_j) - i.frame.point(attachment.point_i);
    const double length = norm(h);
    loads.tension = length > 0 ? dot(Vec2<double>{on_i.fx, on_i.fy}, h) / length : 0;
    loads.torque = on_i.moment;
    const auto in_i = [&](const Vec2<double>& v) {
      return Vec2<double>{dot(i.frame.axis(Vec2<double>{1, 0}), v), dot(i.frame.axis(Vec2<double>{0, 1}), v)};
    };
    loads.force_on_j = {on_j.fx, on_j.fy};
    loads.force_on_j_in_i = in_i(loads.force_on_j);
    loads.torque_on_j = on_j.moment - cross(j.frame.axis(attachment.point_j), loads.force_on_j);
    loads.offset = in_i(h);
    if constexpr (requires { entry.element.slack(i.frame, j.frame); }) {
      loads.slack = entry.element.slack(i.frame, j.frame);
    }
  });
  return loads;
}

}  // namespace catena
