// DesignMechanism: forces and energy with derivatives.
#include "catena/assembly/design/element_motion.hpp"
#include "catena/assembly/law_values.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

using detail::DesignSeries;

/// What laws read: the state of a mechanism with derivatives.
class DesignView {
 public:
  DesignView(const DesignMechanism& mechanism, const std::vector<DesignSeries>& functions)
      : mechanism_(mechanism), functions_(functions) {}

  DesignScalar time() const { return mechanism_.time(); }
  Frame<DesignScalar> frame(int plan_body) const { return mechanism_.ground_frame(plan_body); }
  Twist<DesignScalar> twist(int plan_body) const {
    const Frame<DesignSeries>& m = mechanism_.motion(plan_body);
    return {m.x.d, m.y.d, m.phi.d};
  }
  DesignScalar function(int number) const { return functions_[at(number)].f; }

 private:
  const DesignMechanism& mechanism_;
  const std::vector<DesignSeries>& functions_;
};

}  // namespace

DesignScalar DesignMechanism::law_value(int law) const {
  const DesignView view(*this, function_);
  return LawValues<DesignScalar, DesignScalar, DesignView>(*model_, laws_, view).value(law);
}

void DesignMechanism::applied_forces(std::span<DesignScalar> Q) const {
  for (DesignScalar& load : Q) load = DesignScalar();
  for (int p = 0; p < plan_->moving; ++p) {
    Q[at(3 * p)] = mass(3 * p) * model_->gravity.x;
    Q[at(3 * p + 1)] = mass(3 * p) * model_->gravity.y;
  }
  const auto frame_in_ground = [&](int body) {
    const int p = body < 0 ? plan_->bodies : plan_->plan_body[at(body)];
    return detail::moved_by(motion_[at(p)], origin_[at(p)]);
  };
  const auto twist = [&](int body) {
    const Frame<DesignSeries>& m = motion_[at(body)];
    return Twist<DesignScalar>{m.x.d, m.y.d, m.phi.d};
  };
  for_each_list(plan_->forces, model_->forces, [&](const auto& block, const auto& list, int) {
    using E = ElementOf<decltype(list)>;
    std::vector<DesignScalar> tension;  // by element: what it shares with others
    if constexpr (Sharing<E>) {
      for (std::size_t head = 0; head < list.size(); head += at(list[head].element.pieces)) {
        const DesignScalar slack = rope_slack<DesignScalar>(
            list, static_cast<int>(head), [&](int body) { return detail::present(frame_in_ground(body)); });
        const DesignScalar pull = slack < DesignScalar(0.0) ? -slack * list[head].element.k : DesignScalar(0.0);
        tension.resize(head + at(list[head].element.pieces), pull);
      }
    }
    for (int e = 0; e < block.size(); ++e) {
      const auto& entry = list[at(block.entry[at(e)])];
      const auto f = detail::design_frames<DesignScalar>(block, e, plan_->moving, origin_,
                                                         [&](int body) { return detail::present(motion_[at(body)]); });
      const auto values =
          detail::function_values<DesignScalar>(entry, function_, [&](int law) { return law_value(law); });
      const int body_i = block.body_i[at(e)], body_j = E::bodies == 2 ? block.body_j[at(e)] : plan_->bodies;
      const Twist<DesignScalar> u = twist(body_i), v = twist(body_j);
      Wrench<DesignScalar> on_i, on_j;
      if constexpr (Sharing<E>) {
        const DesignScalar& pull = tension[at(block.entry[at(e)])];
        if (value_of(pull) > 0) entry.element.pull(pull, f.i, f.j, on_i, on_j);
      } else {
        entry.element.force(ForceArguments<DesignScalar>{f.i, f.j, u, v, values.data(), f.ground}, on_i, on_j);
      }
      const auto add = [&](int body, const Wrench<DesignScalar>& wrench) {
        Q[at(3 * body)] += wrench.fx;
        Q[at(3 * body + 1)] += wrench.fy;
        Q[at(3 * body + 2)] += wrench.moment;
      };
      add(body_i, on_i);
      if constexpr (E::bodies == 2) add(body_j, on_j);
    }
  });
}

Taylor<DesignScalar> DesignMechanism::potential() const {
  DesignSeries sum;
  for (int p = 0; p < plan_->bodies; ++p) {
    const auto& body = model_->bodies[at(plan_->model_body[at(p)])];
    const Frame<DesignSeries> m = detail::moved_by(motion_[at(p)], origin_[at(p)]);
    sum -= DesignSeries(body.mass) * (DesignSeries(model_->gravity.x) * m.x + DesignSeries(model_->gravity.y) * m.y);
  }
  const auto frame_in_ground = [&](int body) {
    const int p = body < 0 ? plan_->bodies : plan_->plan_body[at(body)];
    return detail::moved_by(motion_[at(p)], origin_[at(p)]);
  };
  const Twist<DesignSeries> rest;
  for_each_list(plan_->forces, model_->forces, [&](const auto& block, const auto& list, int) {
    if constexpr (Sharing<ElementOf<decltype(list)>>) {
      for (std::size_t head = 0; head < list.size(); head += at(list[head].element.pieces)) {
        const DesignSeries slack =
            rope_slack<DesignSeries>(list, static_cast<int>(head), [&](int body) { return frame_in_ground(body); });
        if (value_of(slack) < 0) sum += DesignSeries(DesignScalar(0.5) * list[head].element.k) * slack * slack;
      }
      return;
    }
    for (int e = 0; e < block.size(); ++e) {
      const auto& entry = list[at(block.entry[at(e)])];
      const auto f = detail::design_frames<DesignSeries>(block, e, plan_->moving, origin_,
                                                         [&](int body) { return motion_[at(body)]; });
      // Laws have no potential.
      const auto values = detail::function_values<DesignSeries>(entry, function_, detail::no_law);
      if constexpr (requires(const ForceArguments<DesignSeries>& a) { entry.element.potential(a); }) {
        if (is_conservative(entry.element)) {
          sum += entry.element.potential(ForceArguments<DesignSeries>{f.i, f.j, rest, rest, values.data(), f.ground});
        }
      }
    }
  });
  return sum;
}

}  // namespace catena
