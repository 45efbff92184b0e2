#include "cases/economy_cases.hpp"

#include <cmath>

#include "cases/resting_chains.hpp"
#include "catena/analysis/dynamics/dynamics_of_islands.hpp"
#include "catena/analysis/dynamics/paces.hpp"
#include "catena/analysis/kinematics/kinematics.hpp"
#include "catena/analysis/statics/equilibrium.hpp"
#include "catena/elements/constraints/absolute_angle.hpp"
#include "catena/elements/constraints/absolute_x.hpp"
#include "catena/elements/constraints/absolute_y.hpp"
#include "catena/elements/constraints/relative_angle.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/elements/constraints/weld.hpp"
#include "catena/elements/forces/spring_damper.hpp"
#include "catena/model/model_add.hpp"
#include "documents/bench_row.hpp"
#include "mechanisms.hpp"
#include "moving_mechanisms.hpp"

namespace bench {

using namespace catena;

namespace {

using ModelPointer = std::shared_ptr<Model>;

/// Runs and keeps the last row of the first so many bodies.
template <class Analysis>
EconomyOutcome last_row(Analysis& analysis, const TimeGrid& grid, const Needs& needs, std::size_t bodies) {
  EconomyOutcome outcome;
  RowFunction keep([&](const Snapshot&) { return true; });
  const AnalysisReport report = analysis.run(grid, needs, keep);
  outcome.counts = named_counts(report.counters);
  outcome.failure = report.message;
  outcome.answer = analysis.state().q;
  outcome.answer.resize(std::min(outcome.answer.size(), 3 * bodies));
  return outcome;
}

EconomyWork driven(const ModelPointer& model, const Needs& needs, std::size_t bodies) {
  return [=] {
    Kinematics kinematics(model);
    return last_row(kinematics, TimeGrid::range(0, 1, 0.001), needs, bodies);
  };
}

EconomyWork positions_alone() { return driven(dyad_ladder(5), {}, 11); }
EconomyWork all_columns() {
  return driven(dyad_ladder(5), {.velocity = true, .acceleration = true, .multipliers = true, .work = true}, 11);
}

EconomyWork falling(const TimeGrid& grid) {
  return [=, model = straight_chain(10)] {
    Dynamics dynamics(model);
    return last_row(dynamics, grid, {}, 10);
  };
}
EconomyWork one_row() { return falling(TimeGrid::instant(1)); }
EconomyWork many_rows() { return falling(TimeGrid::range(0, 1, 0.001)); }

EconomyWork without_furniture() { return driven(dyad_ladder(5), {}, 11); }
EconomyWork with_furniture() {
  const ModelPointer model = dyad_ladder(5);
  for (int k = 0; k < 200; ++k) {
    const Vec2<double> at{0.01 * k, 1};
    const int frame = model->add_body("frame" + std::to_string(k), {.position = at});
    model->add("weld" + std::to_string(k), Weld<>{at, {0, 0}}, ground, frame);
    model->add_body("wall" + std::to_string(k), {.position = at, .fixed = true});
  }
  return driven(model, {}, 11);
}

EconomyWork without_forces() { return driven(dyad_ladder(5), {}, 11); }
EconomyWork with_forces() {
  const ModelPointer model = dyad_ladder(5);
  model->gravity = {0, -9.81};
  for (int k = 0; k + 1 < 11; ++k) {
    SpringDamper<> spring;
    spring.k = 100;
    spring.length = 0.1;
    model->add_force("", spring, k, k + 1);
  }
  return driven(model, {}, 11);
}

/// Discs whose angles follow each other; held at their centres by equations whose derivatives never change, or by pins
/// beside their centres. The answer is their angles.
EconomyWork turning_discs(bool constant) {
  auto model = std::make_shared<Model>();
  for (int k = 0; k < 50; ++k) {
    const int disc = model->add_body("disc" + std::to_string(k), {.position = {1.0 * k, 0}});
    if (constant) {
      model->add("", AbsoluteX<>{}, disc);
      model->add("", AbsoluteY<>{}, disc);
    } else {
      model->add("", Revolute<>{{k + 0.1, 0}, {0.1, 0}}, ground, disc);
    }
    if (k > 0) model->add("", RelativeAngle<>{}, disc - 1, disc);
  }
  model->add_driver("drive", AbsoluteAngle<>{}, 0, ground, TimeFunction<double>::harmonic(0.5, 3));
  return [work = driven(model, {}, 50)] {
    EconomyOutcome outcome = work();
    for (std::size_t k = 0; 3 * k < outcome.answer.size(); ++k) outcome.answer[k] = outcome.answer[3 * k + 2];
    outcome.answer.resize(outcome.answer.size() / 3);
    return outcome;
  };
}
EconomyWork constant_jacobian() { return turning_discs(true); }
EconomyWork varying_jacobian() { return turning_discs(false); }

/// A chain of forty rods, and beside it a mass on a spring that swings fifty times a second.
ModelPointer two_paces() {
  const ModelPointer model = straight_chain(40);
  const int mass = model->add_body("mass", {.mass = 1, .position = {-4, -5}, .particle = true});
  model->add("", AbsoluteY<>{}, mass, ground, -5.0);
  SpringDamper<> spring;
  spring.s_i = {-5, -5};
  spring.k = 1e5;
  spring.length = 0.9;
  model->add_force("", spring, ground, mass);
  return model;
}
constexpr double two_paces_tolerance = 1e-9;
EconomyWork paces_apart() {
  return [model = two_paces()] {
    DynamicsOfIslands motion(model, {}, {.tolerance = two_paces_tolerance}, classes_of_pace(model));
    EconomyOutcome outcome = last_row(motion, TimeGrid::instant(0.5), {}, 41);
    if (motion.classes() != 2) outcome.failure = "the two were not integrated apart";
    return outcome;
  };
}
EconomyWork paces_together() {
  return [model = two_paces()] {
    Dynamics motion(model, {}, {.tolerance = two_paces_tolerance});
    return last_row(motion, TimeGrid::instant(0.5), {}, 41);
  };
}

/// The left half of a chain becomes heavier by a tenth.
ModelPointer heavier_chain(double factor) {
  const ModelPointer model = chain_between_pins(1000, ChainStart::bent);
  for (std::size_t b = 0; b < 500; ++b) model->bodies[b].mass *= factor;
  return model;
}
EconomyOutcome rest_of(Equilibrium& chain) {
  const auto before = named_counts(chain.evaluator().counters);
  EconomyOutcome outcome;
  outcome.failure = chain.solve().message;
  outcome.counts = named_counts(chain.evaluator().counters);
  // What this solution added.
  for (auto& [name, value] : outcome.counts) {
    for (const auto& [old_name, old_value] : before) {
      if (name == old_name) value -= old_value;
    }
  }
  std::erase_if(outcome.counts, [](const auto& count) { return count.second == 0; });
  outcome.answer = chain.state().q;
  return outcome;
}
/// The heavier chain and the even one in turn, the heavier one first.
EconomyWork changed_model() {
  struct Chains {
    ModelPointer even = heavier_chain(1), heavy = heavier_chain(1.1);
    Equilibrium chain{even};
    bool ok = chain.solve().ok(), is_heavy = false;
  };
  return [chains = std::make_shared<Chains>()] {
    chains->is_heavy = !chains->is_heavy;
    chains->chain.set_model(chains->is_heavy ? chains->heavy : chains->even);
    EconomyOutcome outcome = rest_of(chains->chain);
    if (!chains->ok) outcome.failure = "the first chain has no equilibrium";
    return outcome;
  };
}
EconomyWork new_model() {
  return [model = heavier_chain(1.1)] {
    Equilibrium chain(model);
    return rest_of(chain);
  };
}

}  // namespace

const std::vector<EconomyCase>& economy_cases() {
  // To the last bit where the same steps are made, to the tolerance of positions where others are.
  static const std::vector<EconomyCase> cases{
      {"columns that are not asked for",
       {"positions alone", positions_alone},
       {"all columns", all_columns},
       "places after 1 s",
       1e-12},
      {"rows do not shorten steps", {"1 row", one_row}, {"1001 rows", many_rows}, "places after 1 s", 0},
      {"bodies that do not move",
       {"none", without_furniture},
       {"200 fixed, 200 welded", with_furniture},
       "places after 1 s",
       1e-12},
      {"forces where none are asked for",
       {"none", without_forces},
       {"gravity and 10 springs", with_forces},
       "places after 1 s",
       0},
      {"equations with constant derivatives",
       {"constant", constant_jacobian},
       {"may vary", varying_jacobian},
       "angles after 1 s",
       1e-12},
      // Ten times the tolerance of the slow chain, whose length is 40 m, from either run.
      {"mechanisms of different pace",
       {"apart", paces_apart},
       {"together", paces_together},
       "places after 0.5 s",
       20 * 40 * two_paces_tolerance},
      // 1e-11 of the largest force over the softest stiffness, from either run, over 800 m.
      {"a parameter changes",
       {"goes on from the last solution", changed_model},
       {"anew", new_model},
       "places at rest",
       1e-5}};
  return cases;
}

}  // namespace bench

/// Found by its name in the program's table of symbols.
extern "C" [[gnu::noinline]] void catena_bench_measured_work(const bench::EconomyWork& work);
extern "C" void catena_bench_measured_work(const bench::EconomyWork& work) { work(); }

namespace bench {

bool run_economy_variant(const std::string& name) {
  for (const EconomyCase& c : economy_cases()) {
    for (const EconomyVariant& v : {c.lean, c.full}) {
      if (name != c.feature + std::string(" / ") + v.name) continue;
      catena_bench_measured_work(v.prepare());
      return true;
    }
  }
  return false;
}

}  // namespace bench
