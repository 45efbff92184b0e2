// Evaluator::element_jacobian, the raw material of reactions: every two-body constraint between two bodies, and with
// the ground as i and as j. The ground's columns are those it would have if it could move.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "catena/assembly/evaluate.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/model_add.hpp"

namespace catena {
namespace {

/// Where the three bodies stand; the ground has the pose of the second one, so that i or j may be exchanged for it.
struct Pose {
  double x, y, phi;
};
constexpr Pose pose_a{0.4, -0.3, 0.6}, pose_b{1.1, 0.9, -0.8};

/// Elements that are not singular at these poses.
template <class E>
E example() {
  E element;
  const auto set = [&](const auto& field) {
    if constexpr (requires { element.*field.member = Vec2<double>{}; }) {
      if constexpr (requires { field.body; })
        element.*field.member = field.body == 0 ? Vec2<double>{0.3, -0.2} : Vec2<double>{-0.1, 0.5};
      else
        element.*field.member = {2.0, 0.7};
    } else if constexpr (requires { element.*field.member = Curve<double>::circle({}, 1.0); }) {
      element.*field.member = Curve<double>::circle({0.1, 0.2}, 0.3 + 0.2 * field.body);
    } else if constexpr (requires { field.domain; }) {
      element.*field.member = 0.4 + 0.05 * static_cast<double>(field.key.size());
    }
  };
  std::apply([&](const auto&... field) { (set(field), ...); }, E::fields());
  return element;
}

int add_body(Model& model, const char* name, const Pose& p) {
  BodyValues values;
  values.position = {p.x, p.y};
  values.angle = p.phi;
  return model.add_body(name, values);
}

template <class E>
struct Evaluated {
  Model model;
  EvaluationWork work;
  std::unique_ptr<Evaluator> evaluator;

  /// bodies: which of a, b take part; the other one's side is the ground.
  Evaluated(bool body_i, bool body_j) {
    const int a = add_body(model, "a", pose_a), b = add_body(model, "b", pose_b);
    model.add("", example<E>(), body_i ? a : ground, body_j ? b : ground);
    // A weld to the ground would be eliminated if its reaction were not asked for.
    evaluator = std::make_unique<Evaluator>(Plan::make(model, {.keep_elements = {0}, .one_sided = true}), model, work);
    evaluator->set_configuration(evaluator->given_configuration());
  }
};

template <class E>
class ElementJacobian : public ::testing::Test {};

struct Names {
  template <class E>
  static std::string GetName(int) {
    return std::string(E::type);
  }
};

template <class... Types>
struct ListOf {
  using type = ::testing::Types<Types...>;
};
template <class First, class... Types>
struct ListOf<First, Types...> {
  using type = ::testing::Types<Types...>;
};
#define CATENA_TYPE(Type) , Type<double>
// Stops have bounds in place of fields: see gap_elements_test.cpp.
TYPED_TEST_SUITE(ElementJacobian,
                 ListOf<void CATENA_CONSTRAINTS(CATENA_TYPE) CATENA_TYPE(Cable) CATENA_TYPE(Contact)>::type, Names);
#undef CATENA_TYPE

/// Phi_q as it is solved with, dense, in plan columns.
std::vector<double> assembled(Evaluator& evaluator) {
  const Plan& plan = evaluator.plan();
  std::vector<double> values(static_cast<std::size_t>(plan.trash_slot()) + 1);
  evaluator.start_jacobian(values);
  evaluator.jacobian(values);
  std::vector<double> dense(static_cast<std::size_t>(plan.rows * plan.columns));
  for (int c = 0; c < plan.columns; ++c) {
    for (int k = plan.jacobian.column_start[static_cast<std::size_t>(c)];
         k < plan.jacobian.column_start[static_cast<std::size_t>(c) + 1]; ++k) {
      const int row = plan.jacobian.row_index[static_cast<std::size_t>(k)];
      dense[static_cast<std::size_t>(row * plan.columns + c)] = values[static_cast<std::size_t>(k)];
    }
  }
  return dense;
}

/// Multiplied by its scale, the dense form is what the solver sees of the moving bodies.
template <class E>
void expect_assembled(Evaluated<E>& x) {
  const Evaluator::ElementJacobian local = x.evaluator->element_jacobian(0);
  const Plan& plan = x.evaluator->plan();
  ASSERT_EQ(local.rows, E::rows);
  ASSERT_EQ(local.bodies, E::bodies);
  const std::vector<double> dense = assembled(*x.evaluator);
  std::vector<double> expected(dense.size());
  for (int r = 0; r < local.rows; ++r) {
    for (int k = 0; k < 3 * local.bodies; ++k) {
      const int body = k < 3 ? local.body_i : local.body_j;
      if (body < plan.bodies)
        expected[static_cast<std::size_t>(r * plan.columns + plan.column[static_cast<std::size_t>(3 * body + k % 3)])] =
            local.scale * local.entries[6 * r + k];
    }
  }
  for (std::size_t k = 0; k < dense.size(); ++k) EXPECT_NEAR(dense[k], expected[k], 1e-14) << k;
}

TYPED_TEST(ElementJacobian, IsWhatIsSolvedWith) {
  Evaluated<TypeParam> x(true, true);
  expect_assembled(x);
}

// A rigid motion of both bodies together changes no row of a relative constraint: per row, the columns of i and j
// belong to opposite forces, and their moments about any point cancel. With the ground as i or j the same holds.
TYPED_TEST(ElementJacobian, BalancesTheGround) {
  using E = TypeParam;
  if constexpr (E::bodies == 1) {
    GTEST_SKIP() << "acts on one body";
  } else {
    for (const bool ground_is_i : {false, true}) {
      SCOPED_TRACE(ground_is_i ? "ground is i" : "ground is j");
      Evaluated<E> x(!ground_is_i, ground_is_i);
      expect_assembled(x);
      const Evaluator& evaluator = *x.evaluator;
      const Evaluator::ElementJacobian local = evaluator.element_jacobian(0);
      const int ground_body = evaluator.plan().bodies;
      EXPECT_EQ(local.body_i, ground_is_i ? ground_body : evaluator.plan().plan_body[0]);
      EXPECT_EQ(local.body_j, ground_is_i ? evaluator.plan().plan_body[1] : ground_body);
      const Vec2<double> at_i = evaluator.ground_frame(local.body_i).origin();
      const Vec2<double> at_j = evaluator.ground_frame(local.body_j).origin();
      // Rows along the ground's axes are components of h, which turns with the bodies: no balance of moments there.
      const bool ground_axes =
          E::type == "relative_x" || E::type == "relative_y" || E::type == "revolute" || E::type == "weld";
      for (int r = 0; r < local.rows; ++r) {
        const double* e = local.entries + 6 * r;
        EXPECT_NEAR(e[0] + e[3], 0, 1e-14);
        EXPECT_NEAR(e[1] + e[4], 0, 1e-14);
        if (ground_axes && r < 2) continue;
        const double turned = e[2] + e[5] + at_i.x * e[1] - at_i.y * e[0] + at_j.x * e[4] - at_j.y * e[3];
        EXPECT_NEAR(turned, 0, 1e-13) << "row " << r;
      }
    }
  }
}

}  // namespace
}  // namespace catena
