// Which reactions are not unique where constraints depend on each other: known cases, and random mechanisms against the
// null space of Phi_q^T by dense singular value decomposition.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <set>
#include <string>

#include "analysis/linkages.hpp"
#include "analysis/random_mechanisms.hpp"
#include "catena/analysis/kinematics/kinematics.hpp"
#include "catena/analysis/pose/minimum_norm.hpp"
#include "catena/elements/constraints/absolute_angle.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/elements/constraints/weld.hpp"
#include "references/dense.hpp"

namespace catena::testing {
namespace {

using Names = std::set<std::string>;

Names names_of(const Model& model, const std::vector<int>& elements) {
  Names names;
  for (int element : elements) names.insert(std::string(model.element_name(element)));
  return names;
}

Names ambiguous(Evaluator& evaluator) {
  MinimumNorm least(evaluator);
  EXPECT_TRUE(least.factorize());
  return names_of(evaluator.model(), least.find_ambiguous());
}

/// The names in quotes in the warning of inverse dynamics, and the multipliers of its last row.
struct Reported {
  Names names;
  AnalysisReport report;
  std::vector<double> lambda;
};
Reported inverse_dynamics(const std::shared_ptr<Model>& model) {
  Kinematics kinematics(model, {}, {.inverse_dynamics = true});
  Reported reported;
  RowFunction keep([&](const Snapshot& s) {
    reported.lambda.assign(s.lambda.begin(), s.lambda.end());
    return true;
  });
  reported.report =
      kinematics.run(TimeGrid::range(0, 0.5, 0.1), {.velocity = true, .acceleration = true, .multipliers = true}, keep);
  for (const std::string& warning : reported.report.warnings) {
    if (warning.find("not unique") == std::string::npos) continue;
    for (std::size_t open = warning.find('"'); open != std::string::npos;) {
      const std::size_t close = warning.find('"', open + 1);
      reported.names.insert(warning.substr(open + 1, close - open - 1));
      open = warning.find('"', close + 1);
    }
  }
  return reported;
}

/// With the reactions of all elements asked for.
Names ambiguous(const Model& model) {
  PlanOptions options;
  for (std::size_t e = 0; e < model.elements.size(); ++e) options.keep_elements.push_back(static_cast<int>(e));
  EvaluationWork work;
  Evaluator evaluator(Plan::make(model, options), model, work);
  evaluator.set_time(0);
  evaluator.set_configuration(evaluator.given_configuration());
  return ambiguous(evaluator);
}

TEST(AmbiguousReactions, OfADoubledJointBothAndNoOther) {
  auto model = driven_four_bar({}, ramp(1, 1));
  pin(*model, "A again", model->find_body("crank"), "to", model->find_body("coupler"), "from");
  const Names expected{"A", "A again"};
  EXPECT_EQ(ambiguous(*model), expected);
  const Reported reported = inverse_dynamics(model);
  ASSERT_TRUE(reported.report.ok()) << reported.report.message;
  EXPECT_EQ(reported.names, expected);
  // The least of all is half each.
  const auto row = [&](const char* name) {
    const auto plan = Plan::make(*model);
    return static_cast<std::size_t>(plan->element_row[static_cast<std::size_t>(model->find_element(name))]);
  };
  for (std::size_t k = 0; k < 2; ++k) {
    const double one = reported.lambda[row("A") + k], other = reported.lambda[row("A again") + k];
    EXPECT_NEAR(one, other, 1e-10 * std::abs(one));
    EXPECT_GT(std::abs(one), 1e-6);
  }
}

// A second coupler beside the first: they may push against each other along their common direction.
TEST(AmbiguousReactions, OfADoubledRodThePinsOfBoth) {
  auto model = driven_four_bar({}, ramp(1, 1));
  const Vec2<double> from = model->frame(model->find_body("crank")).point(*model->find_point(0, "to"));
  const Vec2<double> to = model->frame(model->find_body("rocker")).point(*model->find_point(2, "to"));
  const int second = add_rod(*model, "coupler again", from, to);
  pin(*model, "A again", model->find_body("crank"), "to", second, "from");
  pin(*model, "B again", second, "to", model->find_body("rocker"), "to");
  const Names expected{"A", "A again", "B", "B again"};
  EXPECT_EQ(ambiguous(*model), expected);
  const Reported reported = inverse_dynamics(model);
  ASSERT_TRUE(reported.report.ok()) << reported.report.message;
  EXPECT_EQ(reported.names, expected);
}

// Three cranks may pull at their coupler along themselves and be in balance; their driver has no part in it.
TEST(AmbiguousReactions, OfAParallelogramWithThreeCranksAllPins) {
  for (double scale : {1e-3, 1.0, 1e3}) {
    const FourBar f{scale, 3 * scale, scale, 3 * scale};
    auto model = driven_four_bar(f, ramp(0.7, 1));
    const Vec2<double> foot{1.5 * scale, 0}, tip = foot + scale * Vec2<double>{std::cos(0.7), std::sin(0.7)};
    const int middle = add_rod(*model, "middle", foot, tip);
    pin(*model, "D", foot, middle, "from");
    model->add("E", Revolute<>{{}, *model->find_point(middle, "to")}, model->find_body("coupler"), middle);
    const Names expected{"O", "A", "B", "C", "D", "E"};
    EXPECT_EQ(ambiguous(*model), expected) << scale;
    const Reported reported = inverse_dynamics(model);
    ASSERT_TRUE(reported.report.ok()) << reported.report.message;
    EXPECT_EQ(reported.names, expected) << scale;
  }
}

TEST(AmbiguousReactions, OfAFrameAllThatCloseIt) {
  // A beam on two pins; beside it one on a pin and a rope of its own, which is determined.
  auto model = std::make_shared<Model>();
  const int beam = add_rod(*model, "beam", {0, 0}, {2, 0}), other = add_rod(*model, "other", {0, 1}, {2, 1});
  pin(*model, "left", {0, 0}, beam, "from");
  pin(*model, "right", {2, 0}, beam, "to");
  pin(*model, "hinge", {0, 1}, other, "from");
  model->add("hold", AbsoluteAngle<>{}, other, ground, 0.0);
  EXPECT_EQ(ambiguous(*model), (Names{"left", "right"}));
  EXPECT_EQ(inverse_dynamics(model).names, (Names{"left", "right"}));
  // A portal of three welded members.
  auto portal = std::make_shared<Model>();
  const int post = add_rod(*portal, "post", {0, 0}, {0, 1}), top = add_rod(*portal, "top", {0, 1}, {2, 1}),
            leg = add_rod(*portal, "leg", {2, 1}, {2, 0});
  const auto end = [&](int body, const char* name) { return *portal->find_point(body, name); };
  portal->add("foot left", Weld<>{{0, 0}, end(post, "from"), 0}, ground, post);
  portal->add("corner left", Weld<>{end(post, "to"), end(top, "from"), 0}, post, top);
  portal->add("corner right", Weld<>{end(top, "to"), end(leg, "from"), 0}, top, leg);
  portal->add("foot right", Weld<>{{2, 0}, end(leg, "to"), 0}, ground, leg);
  EXPECT_EQ(ambiguous(*portal), (Names{"foot left", "corner left", "corner right", "foot right"}));
}

/// Rows of every element in the left null space of Phi_q with displacements in length scales and rows of length one:
/// their largest entry, 1 at most; and the rank. Empty where singular values leave the rank in doubt.
struct NullSpace {
  int rank = 0;
  std::vector<double> share;
};
std::optional<NullSpace> left_null_space(Evaluator& evaluator) {
  const Plan& plan = evaluator.plan();
  std::vector<double> values(static_cast<std::size_t>(plan.trash_slot()) + 1);
  evaluator.start_jacobian(values);
  evaluator.jacobian(values);
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(plan.rows, plan.columns);
  for (int c = 0; c < plan.columns; ++c) {
    const bool angle = plan.coordinate[static_cast<std::size_t>(c)] % 3 == 2;
    for (int k = plan.jacobian.column_start[static_cast<std::size_t>(c)];
         k < plan.jacobian.column_start[static_cast<std::size_t>(c) + 1]; ++k) {
      a(plan.jacobian.row_index[static_cast<std::size_t>(k)], c) +=
          values[static_cast<std::size_t>(k)] * (angle ? 1 : evaluator.length_scale());
    }
  }
  for (int r = 0; r < plan.rows; ++r) a.row(r).normalize();
  const SingularValues svd = singular_values(a, true);
  const Eigen::VectorXd& sigma = svd.values;
  NullSpace space;
  for (int k = 0; k < sigma.size(); ++k) {
    if (sigma[k] > 1e-13 && sigma[k] < 1e-4) return std::nullopt;
    space.rank += sigma[k] >= 1e-4;
  }
  const Eigen::MatrixXd null = svd.u.rightCols(plan.rows - space.rank);
  space.share.assign(evaluator.model().elements.size(), 0.0);
  for (int r = 0; r < plan.rows; ++r) {
    double& share = space.share[static_cast<std::size_t>(plan.row_element[static_cast<std::size_t>(r)])];
    share = std::max(share, null.row(r).norm());
  }
  return space;
}

TEST(AmbiguousReactions, OfRandomMechanismsAreThoseInTheNullSpace) {
  std::mt19937 random(7);
  int compared = 0, with_some = 0;
  for (int run = 0; run < 400; ++run) {
    Recipe recipe = RandomMechanism(static_cast<unsigned>(run + 1), run % 7).recipe();
    // A few joints twice, and stays between bodies that cannot move towards each other any more.
    const int more = 1 + run % 3;
    for (int k = 0; k < more; ++k) {
      const auto pick = [&](std::size_t count) {
        return std::uniform_int_distribution<std::size_t>(0, count - 1)(random);
      };
      if (random() % 2 == 0) {
        const Joint joint = recipe.joints[pick(recipe.joints.size())];
        if (!joint.drives()) recipe.joints.push_back(joint);
      } else if (recipe.place.size() > 1) {
        const auto i = pick(recipe.place.size()), j = pick(recipe.place.size());
        if (i == j) continue;
        recipe.joints.push_back({Joint::Kind::coupler, static_cast<int>(i), static_cast<int>(j),
                                 recipe.place[i] + 0.3 * recipe.extent() * unit(1.0 + k), recipe.place[j]});
      }
    }
    const auto model = build(recipe, {});
    EvaluationWork work;
    Evaluator evaluator(Plan::make(*model), *model, work);
    evaluator.set_time(0);
    evaluator.set_configuration(evaluator.given_configuration());
    const auto space = left_null_space(evaluator);
    if (!space) continue;
    const bool doubtful = std::any_of(space->share.begin(), space->share.end(),
                                      [](double share) { return share > 1e-11 && share < 1e-3; });
    if (doubtful) continue;
    Names expected;
    for (std::size_t e = 0; e < space->share.size(); ++e) {
      if (space->share[e] >= 1e-3) expected.insert(std::string(model->element_name(static_cast<int>(e))));
    }
    EXPECT_EQ(ambiguous(evaluator), expected) << run;
    const MobilityReport mobility = analyse_mobility(evaluator, evaluator.given_configuration());
    EXPECT_EQ(mobility.rank, space->rank) << run;
    // What is called redundant and what it follows from are the same elements.
    Names reported = names_of(*model, mobility.redundant_elements);
    for (const auto& others : mobility.dependent_on) reported.merge(names_of(*model, others));
    EXPECT_EQ(reported, expected) << run;
    ++compared;
    with_some += !expected.empty();
  }
  EXPECT_GT(compared, 100);
  EXPECT_GT(with_some, 50);
  RecordProperty("compared", compared);
}

}  // namespace
}  // namespace catena::testing
