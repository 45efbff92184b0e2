// A state with derivatives by design parameters, as the templates over scalars see it (row_values.hpp).
//
// Values that an analysis sums up over time (work, dissipated energy) have no derivative here: it is not a number, so
// that nothing that is made of them looks differentiated.
#pragma once

#include <span>
#include <vector>

#include "catena/assembly/design/design_mechanism.hpp"
#include "catena/columns/reaction.hpp"
#include "catena/columns/snapshot.hpp"
#include "catena/columns/spring.hpp"

namespace catena {

/// ContactLoad with derivatives.
struct DesignContactLoad {
  DesignScalar force, friction, slip;
  bool glides = false;
};

/// What contacts do in a motion, by number of the element; empty where there are none.
struct DesignContacts {
  std::vector<DesignContactLoad> loads;
  DesignScalar energy;  ///< stored in them, J
};

class DesignState {
 public:
  using Scalar = DesignScalar;

  /// `mechanism` is set to the time and state of `snapshot`; all must outlive this object. Spans may be empty where the
  /// snapshot's are.
  DesignState(const DesignMechanism& mechanism, const Snapshot& snapshot, std::span<const DesignScalar> qdd,
              std::span<const DesignScalar> lambda, const DesignContacts* contacts = nullptr)
      : mechanism_(mechanism), snapshot_(snapshot), qdd_(qdd), lambda_(lambda), contacts_(contacts) {}

  const DesignModel& model() const { return mechanism_.model(); }
  const Plan& plan() const { return mechanism_.plan(); }
  DesignScalar time() const { return snapshot_.t; }
  Frame<DesignScalar> frame(int plan_body) const { return mechanism_.ground_frame(plan_body); }
  Twist<DesignScalar> twist(int plan_body) const {
    const auto& m = mechanism_.motion(plan_body);
    return {m.x.d, m.y.d, m.phi.d};
  }
  Twist<DesignScalar> acceleration(int plan_body) const {
    if (qdd_.empty() || plan_body >= plan().moving) return {};
    const DesignScalar* a = qdd_.data() + 3 * plan_body;
    return {a[0], a[1], a[2]};
  }

  CurvePlace foot(int element) const { return mechanism_.contact(element); }
  DesignScalar law_value(int law) const { return mechanism_.law_value(law); }
  DesignScalar residual() const { return snapshot_.residual; }
  DesignScalar work() const { return without_derivative(snapshot_.work); }
  DesignScalar dissipated() const { return without_derivative(snapshot_.dissipated); }
  DesignScalar initial_energy() const { return without_derivative(snapshot_.initial_energy); }
  DesignScalar driver_work(int element) const {
    return without_derivative(snapshot_.driver_work[static_cast<std::size_t>(element)]);
  }
  Taylor<DesignScalar> measured(int element) const { return mechanism_.measure(element); }
  Taylor<DesignScalar> prescribed(int element) const { return mechanism_.element_value(element); }
  BasicElementReactions<DesignScalar> reactions(int element) const;
  BasicSpringLoads<DesignScalar> spring_loads(int element) const;
  DesignScalar potential() const {
    const DesignScalar own = mechanism_.potential().f;
    return contacts_ ? own + contacts_->energy : own;
  }
  const DesignContactLoad* contact(int element) const {
    if (!contacts_ || contacts_->loads.empty()) return nullptr;
    return &contacts_->loads[static_cast<std::size_t>(element)];
  }

 private:
  static DesignScalar without_derivative(double value);

  const DesignMechanism& mechanism_;
  const Snapshot& snapshot_;
  std::span<const DesignScalar> qdd_, lambda_;
  const DesignContacts* contacts_;
};

}  // namespace catena
