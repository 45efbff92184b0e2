// Which contacts parameters reach: those whose equation reads what they move. What presses and rubs is not in it.
#include <gtest/gtest.h>

#include "catena/assembly/design/adjoint_mechanism.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/model_add.hpp"

namespace catena::testing {
namespace {

/// Numbers of a contact between a wavy curve of the ground and a disc.
template <class S>
struct Numbers {
  S radius{0.05}, mu{0.2}, stiffness{1e4}, height{0.1}, point{0.01};
};

template <class S>
std::shared_ptr<BasicModel<S>> disc_on_a_curve(const Numbers<S>& n) {
  auto model = std::make_shared<BasicModel<S>>();
  BasicBody<S> disc;
  disc.mass = S(1.0);
  disc.inertia = S(1.0);
  disc.position = {S(0.5), S(0.6)};
  model->append_body("disc", disc);
  const std::vector<Vec2<S>> points{{S(-1.0), S(0.0)}, {S(0.0), n.height}, {S(1.0), S(0.0)}, {S(2.0), S(0.1)}};
  Contact<S> contact;
  contact.curve = Curve<S>::spline(points, SplineEnd::natural, Beyond::line);
  contact.s_j = {n.point, S(0.0)};
  contact.radius = n.radius;
  contact.k = n.stiffness;
  contact.mu = n.mu;
  model->add("floor", contact, ground, 0);
  return model;
}

int reached_by(DesignScalar Numbers<DesignScalar>::*number) {
  const Numbers<double> plain;
  Numbers<DesignScalar> lifted;
  (lifted.*number).d[0] = 1;
  const auto model = disc_on_a_curve(plain);
  EvaluationWork work;
  const Evaluator evaluator(Plan::make(*model, {.one_sided = true}), *model, work);
  const AdjointMechanism adjoint(evaluator);
  return AdjointMechanism::Reached(adjoint, DesignMechanism(evaluator, disc_on_a_curve(lifted))).elements();
}

TEST(ReachedContacts, AreThoseWhoseEquationsMove) {
  using Lifted = Numbers<DesignScalar>;
  EXPECT_EQ(reached_by(&Lifted::radius), 1);
  EXPECT_EQ(reached_by(&Lifted::point), 1);
  EXPECT_EQ(reached_by(&Lifted::height), 1);  // a single point of the curve
  EXPECT_EQ(reached_by(&Lifted::mu), 0);
  EXPECT_EQ(reached_by(&Lifted::stiffness), 0);
}

}  // namespace
}  // namespace catena::testing
