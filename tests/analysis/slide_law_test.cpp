// Slides of contacts: a disc about a round cam, of which both the length along the cam and the turn have closed forms.
#include "catena/analysis/contact/slide_law.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "catena/analysis/contact/contact_points.hpp"
#include "catena/assembly/evaluate.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/model_add.hpp"

namespace catena {
namespace {

constexpr double cam = 0.5, disc = 0.1;

/// A disc outside of a cam that is the ground's, with friction between them.
ContactModel disc_on_cam() {
  auto model = std::make_shared<Model>();
  const int wheel = model->add_body("wheel", {.mass = 1, .inertia = 0.1, .position = {cam + disc, 0}});
  Contact<double> contact;
  contact.curve = Curve<double>::circle({0, 0}, cam);
  contact.radius = disc;
  contact.mu = 0.5;
  model->add("touch", contact, ground, wheel);
  return contact_points(model);
}

/// Where the wheel is at the angle `round` about the cam, turned by `turn`.
std::vector<double> place(const Evaluator& evaluator, double round, double turn) {
  std::vector<double> q = evaluator.given_configuration();
  q[0] = (cam + disc) * std::cos(round) - evaluator.origin(0).x;
  q[1] = (cam + disc) * std::sin(round) - evaluator.origin(0).y;
  q[2] = turn;
  return q;
}

// The contact passes cam x round on the cam; the disc's material passes it by disc x (turn - round).
TEST(SlideLaw, CountsWholeTurnsAboutAClosedCurve) {
  const ContactModel contacts = disc_on_cam();
  const int slide = contacts.points.front().slide;
  EvaluationWork work, other_work;
  PlanOptions options;
  options.one_sided = true;
  Evaluator evaluator(Plan::make(*contacts.model, options), *contacts.model, work);
  Evaluator stays(evaluator.shared_plan(), *contacts.model, other_work);
  const auto slide_at = [&](Evaluator& e, double round, double turn) {
    e.set_configuration(place(e, round, turn));
    return e.scalar_motion(slide, {}).value;
  };
  for (int k = 0; k <= 40; ++k) {
    const double round = 0.5 * k, turn = 0.3 * k;
    EXPECT_NEAR(slide_at(evaluator, round, turn), cam * round - disc * (turn - round), 1e-12) << k;
  }
  // Another evaluator of the same model never left; a third goes on from a state of the first.
  EXPECT_NEAR(slide_at(stays, 0.2, 0.1), cam * 0.2 - disc * (0.1 - 0.2), 1e-13);
  EvaluationWork third_work;
  Evaluator third(evaluator.shared_plan(), *contacts.model, third_work);
  third.go_to_curve_places(evaluator.curve_places());
  EXPECT_EQ(slide_at(third, 20.1, 6), slide_at(evaluator, 20.1, 6));
  // A rejected trial leaves no trace, however far it went.
  const std::vector<CurvePlace> accepted = evaluator.curve_places();
  for (int k = 1; k < 20; ++k) slide_at(evaluator, 20.1 + 0.8 * k, 6);
  evaluator.go_to_curve_places(accepted);
  EXPECT_NEAR(slide_at(evaluator, 20.2, 6), cam * 20.2 - disc * (6 - 20.2), 1e-12);
}

}  // namespace
}  // namespace catena
