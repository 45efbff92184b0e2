#include "catena/assembly/design/force_slopes.hpp"

#include "catena/assembly/design/element_motion.hpp"
#include "catena/assembly/law_values.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

/// Along the direction.
using Along = Dual<DesignScalar, 1>;

Along along_rate(const Taylor<DesignScalar>& x) { return {x.f, {x.d}}; }
Frame<Along> along_rate(const Frame<Taylor<DesignScalar>>& f) {
  return {along_rate(f.x), along_rate(f.y), along_rate(f.phi), along_rate(f.c), along_rate(f.s)};
}

/// What laws read: the mechanism at rest, moved along the direction.
class AlongView {
 public:
  AlongView(const Evaluator& evaluator, const DesignMechanism& mechanism)
      : evaluator_(evaluator), mechanism_(mechanism) {}

  Along time() const { return Along(mechanism_.time()); }
  Frame<Along> relative(int plan_body) const { return along_rate(mechanism_.motion(plan_body)); }
  Frame<Along> frame(int plan_body) const {
    const Vec2<double> origin = plan_body < mechanism_.plan().bodies ? evaluator_.origin(plan_body) : Vec2<double>{};
    return detail::moved_by(relative(plan_body), origin);
  }
  Twist<Along> twist(int) const { return {}; }
  Along function(int number) const { return Along(mechanism_.functions()[at(number)].f); }

 private:
  const Evaluator& evaluator_;
  const DesignMechanism& mechanism_;
};

}  // namespace

ForceSlopes::~ForceSlopes() = default;

ForceSlopes::ForceSlopes(const Evaluator& evaluator, const DesignMechanism& mechanism)
    : evaluator_(evaluator), mechanism_(mechanism) {
  laws_ = compile_laws<DesignScalar>(mechanism.model(), evaluator.model().laws, mechanism.plan());
}

// Gravity is the same everywhere.
void ForceSlopes::along(std::span<DesignScalar> out) const {
  std::fill(out.begin(), out.end(), DesignScalar());
  const Plan& plan = mechanism_.plan();
  const DesignModel& model = mechanism_.model();
  const AlongView view(evaluator_, mechanism_);
  const LawValues<Along, DesignScalar, AlongView> laws(model, laws_, view);
  std::vector<Vec2<double>> origin;
  for (int p = 0; p <= plan.bodies; ++p) origin.push_back(p < plan.bodies ? evaluator_.origin(p) : Vec2<double>{});
  const auto add = [&](int body, const Wrench<Along>& wrench) {
    out[at(3 * body)] += wrench.fx.d[0];
    out[at(3 * body + 1)] += wrench.fy.d[0];
    out[at(3 * body + 2)] += wrench.moment.d[0];
  };
  for_each_list(plan.forces, model.forces, [&](const auto& block, const auto& list, int) {
    using E = ElementOf<decltype(list)>;
    std::vector<Along> tension;  // by element: what it shares with others
    if constexpr (Sharing<E>) {
      for (std::size_t head = 0; head < list.size(); head += at(list[head].element.pieces)) {
        const Along slack = rope_slack<Along>(list, static_cast<int>(head), [&](int body) {
          return view.frame(body < 0 ? plan.bodies : plan.plan_body[at(body)]);
        });
        const Along pull = value_of(slack) < 0 ? -slack * Along(list[head].element.k) : Along();
        tension.resize(head + at(list[head].element.pieces), pull);
      }
    }
    if constexpr (!std::is_same_v<E, CustomForce<DesignScalar>>) {
      for (int e = 0; e < block.size(); ++e) {
        const auto& entry = list[at(block.entry[at(e)])];
        const auto f =
            detail::design_frames<Along>(block, e, plan.moving, origin, [&](int body) { return view.relative(body); });
        const int body_i = block.body_i[at(e)], body_j = E::bodies == 2 ? block.body_j[at(e)] : plan.bodies;
        Wrench<Along> on_i, on_j;
        if constexpr (Sharing<E>) {
          const Along& pull = tension[at(block.entry[at(e)])];
          if (value_of(pull) > 0) entry.element.pull(pull, f.i, f.j, on_i, on_j);
        } else {
          const auto values =
              detail::function_values<Along>(entry, mechanism_.functions(), [&](int law) { return laws.value(law); });
          const Twist<Along> rest{};
          entry.element.force(ForceArguments<Along>{f.i, f.j, rest, rest, values.data(), f.ground}, on_i, on_j);
        }
        add(body_i, on_i);
        if constexpr (E::bodies == 2) add(body_j, on_j);
      }
    }
  });
}

}  // namespace catena
