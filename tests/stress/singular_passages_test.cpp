// Mechanisms that pass a singular position at a distance of 1e-2 ... 1e-12, by every method at tolerances 1e-4 ...
// 1e-12, with redundant joints or without, against their known motion (oracles/known_motion.hpp).
//
// Crank and rod of a slider are of lengths r and r (1 + d), the crank and rocker of a four-bar of r (1 - d) and r: both
// turn through a position in which, for d = 0, another motion begins, and turn a corner there of a width of sqrt(2 d)
// rad (integrators/branch_keeping.hpp). None may go straight on in silence. From 1e-8 on all turn; closer by motions
// may go straight on and say so, or end with a status: shares of both are printed by distance and tolerance.
#include <cstdlib>
#include <map>

#include "oracles/redundant_trials.hpp"
#include "stress/cases.hpp"

namespace catena::testing {
namespace {

/// The slider's side of the crank does not change: at the passage it turns back.
void near_slider(RandomMechanism& m, double d, bool doubled) {
  const double crank = m.size * m.uniform(0.3, 1), rod = crank * (1 + d);
  m.body(crank);
  m.body(rod);
  m.body(crank);
  m.motion.places = [=](const JetCoordinates& z) {
    const JetPoint pin = turned(z[0], {crank, 0});
    const Jet across = (1 / Real(rod)) * pin.y, level = (1 / Real(rod)) * pin.x;
    // 1 - across^2 as a sum of squares: as a difference it would leave no digits in the passage.
    const Real part = Real(crank) / Real(rod), short_by = Real(rod) - Real(crank);
    const Jet along = sqrt(level * level + Jet{short_by / Real(rod) * (1 + part)});
    const Jet angle{-std::atan2(across.f, along.f), -across.d / along.f,
                    -(across.dd + across.d * across.d * across.f / (along.f * along.f)) / along.f};
    return std::vector<JetPlace>{{turned(z[0], {crank / 2, 0}), z[0]},
                                 {{pin.x + Real(rod) / 2 * along, pin.y - Real(rod) / 2 * across}, angle},
                                 {{pin.x + Real(rod) * along, Jet{}}, Jet{}}};
  };
  m.motion.z[0] = m.uniform(0, 1);
  m.motion.rate[0] = m.uniform(3, 5) * m.motion.pace;
  m.place_bodies();
  for (int n = 0; n < (doubled ? 2 : 1); ++n) m.pin(ground, {0, 0}, 0, {-crank / 2, 0});
  m.pin(0, {crank / 2, 0}, 1, {-rod / 2, 0});
  for (int n = 0; n < (doubled ? 2 : 1); ++n) m.pin(1, {rod / 2, 0}, 2, {0, 0});
  m.motion.model->add("", Translational<>{{0, 0}, {0, 0}, {1, 0}, {1, 0}}, ground, 2);
}

/// The coupler is above the line from the crank's pin to the rocker's foot.
void near_parallelogram(RandomMechanism& m, double d, bool doubled) {
  const double rocker = m.size * m.uniform(0.3, 0.8), crank = rocker * (1 - d), base = m.size * m.uniform(0.9, 1.4);
  m.body(crank);
  m.body(base);
  m.body(rocker);
  m.motion.places = [=](const JetCoordinates& z) {
    const JetPoint pin = turned(z[0], {crank, 0}), span = fixed_point({base, 0}) - pin;
    const Jet square = span.x * span.x + span.y * span.y;
    // Parts of the coupler along the span and across, times its length.
    const Real a = crank, b = rocker, c = base, short_by = b - a;
    const Jet along = Real(0.5) * (square + Jet{c * c - b * b});
    // 16 times the squared area of the triangle of span, coupler and rocker, (b + c)^2 - s^2 times s^2 - (b - c)^2,
    // each without a difference of what is nearly alike in a flat position: 1 +- cos z by the half angle.
    const JetPoint half_turn = turned(Real(0.5) * z[0], {1, 0});
    const Jet open = Jet{short_by * (b + a + 2 * c)} + (4 * c * a) * (half_turn.x * half_turn.x);
    const Jet folded = Jet{short_by * (2 * c - b - a)} + (4 * c * a) * (half_turn.y * half_turn.y);
    const Jet across = Real(0.5) * sqrt(open * folded);
    const Jet over{1 / square.f, -square.d / (square.f * square.f),
                   (2 * square.d * square.d / square.f - square.dd) / (square.f * square.f)};
    const JetPoint coupler{over * (along * span.x - across * span.y), over * (along * span.y + across * span.x)};
    const JetPoint end = pin + coupler, arm = end - fixed_point({base, 0});
    const auto angle_of = [](const JetPoint& p) {
      const Real r2 = p.x.f * p.x.f + p.y.f * p.y.f, w = (p.x.f * p.y.d - p.y.f * p.x.d) / r2;
      return Jet{std::atan2(p.y.f, p.x.f), w,
                 (p.x.f * p.y.dd - p.y.f * p.x.dd - 2 * w * (p.x.f * p.x.d + p.y.f * p.y.d)) / r2};
    };
    const auto half = [](const JetPoint& p) { return JetPoint{Real(0.5) * p.x, Real(0.5) * p.y}; };
    return std::vector<JetPlace>{{turned(z[0], {crank / 2, 0}), z[0]},
                                 {pin + half(coupler), angle_of(coupler)},
                                 {fixed_point({base, 0}) + half(arm), angle_of(arm)}};
  };
  m.motion.z[0] = m.uniform(1, 2);
  m.motion.rate[0] = m.uniform(3, 5) * m.motion.pace;
  m.place_bodies();
  for (int n = 0; n < (doubled ? 2 : 1); ++n) m.pin(ground, {0, 0}, 0, {-crank / 2, 0});
  m.pin(0, {crank / 2, 0}, 1, {-base / 2, 0});
  for (int n = 0; n < (doubled ? 2 : 1); ++n) m.pin(1, {base / 2, 0}, 2, {rocker / 2, 0});
  m.pin(ground, {base, 0}, 2, {-rocker / 2, 0});
}

struct PassageKind {
  const char* name;
  void (*make)(RandomMechanism&, double, bool);
};
constexpr PassageKind passage_kinds[] = {{"slider-crank", near_slider}, {"four-bar", near_parallelogram}};

KnownMotion passage(int kind, unsigned seed, double distance, bool doubled) {
  RandomMechanism m(seed * 157u + static_cast<unsigned>(kind));
  m.size = std::pow(10.0, m.uniform(-2, 2));
  m.mass = std::pow(10.0, m.uniform(-2, 2));
  m.motion.kind = passage_kinds[kind].name;
  m.motion.length = m.size;
  m.motion.pace = std::sqrt(9.81 / m.size);
  // Slower than what moves, so that nothing stops there.
  m.motion.model->gravity = {0, -m.uniform(0, 1)};
  m.motion.until = m.uniform(0.6, 0.8) / m.motion.pace;
  passage_kinds[kind].make(m, distance, doubled);
  return m.motion;
}

// The distance from which on every method turns.
constexpr double told_apart = 1e-8;

class SingularPassages : public ::testing::TestWithParam<std::tuple<int, bool>> {};

TEST_P(SingularPassages, FollowTheKnownMotion) {
  const auto [kind, doubled] = GetParam();
  const std::vector<IntegrationMethod> methods = {IntegrationMethod::automatic, IntegrationMethod::rk8,
                                                  IntegrationMethod::rk5,       IntegrationMethod::adams,
                                                  IntegrationMethod::baumgarte, IntegrationMethod::partitioning};
  const std::vector<double> tolerances = {1e-4, 1e-6, 1e-8, 1e-10, 1e-12};
  std::printf("%s%s\n  distance, then tolerance: runs / wrong / straight on and told / refused\n",
              passage_kinds[kind].name, doubled ? ", joints given twice" : "");
  for (const double distance : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
    std::printf("  %.0e", distance);
    // All tolerances at once: where the corner is narrow the reference takes longer than the runs.
    struct Outcomes {
      int wrong = 0, told = 0, refused = 0;
    };
    std::map<double, Outcomes> seen;
    const auto note = [&](unsigned seed, IntegrationMethod method, double tolerance, const TrialOutcome& outcome) {
      Outcomes& of = seen[tolerance];
      of.wrong += outcome.wrong;
      of.told += outcome.told;
      of.refused += !outcome.ok;
      show_refusal(seed, std::string(to_string(method)) +
                             (outcome.wrong  ? " WRONG "
                              : outcome.told ? " told "
                                             : " ") +
                             outcome.message + " ratio " + std::to_string(outcome.ratio));
    };
    TrialCounts counts;
    run_known_trials([&](unsigned seed) { return std::optional(passage(kind, seed, distance, doubled)); }, first_case(),
                     stress_cases(2), methods, tolerances, counts, note);
    int runs = 0;
    for (const auto& [method, count] : counts) runs += count.runs;
    for (const double tolerance : tolerances) {
      const Outcomes& of = seen[tolerance];
      std::printf("  %.0e: %d/%d/%d/%d", tolerance, runs / static_cast<int>(tolerances.size()), of.wrong, of.told,
                  of.refused);
      if (distance >= told_apart) {
        EXPECT_EQ(of.told, 0) << "at a distance of " << distance;
      }
      EXPECT_EQ(of.wrong, 0) << "at a distance of " << distance << ", tolerance " << tolerance;
    }
    std::printf("\n");
    std::fflush(stdout);
  }
}

/// What becomes of a passage with a motor on its crank, which turns evenly.
struct DrivenOutcome {
  bool ok = false, told = false;
  double misplaced = 0;  ///< the largest error of a place, lengths of the mechanism or rad
  double mistaken = 0;   ///< of the motor's work, compared with the largest kinetic energy
  std::string message;
};

/// The motor's work is what kinetic and potential energy have changed by.
DrivenOutcome run_driven_passage(const KnownMotion& motion, const DynamicsOptions& options) {
  DrivenOutcome outcome;
  auto model = std::make_shared<Model>(*motion.model);
  const double turn[] = {static_cast<double>(motion.z[0]), static_cast<double>(motion.rate[0])};
  model->add_driver("motor", AbsoluteAngle<>{}, 0, ground, TimeFunction<double>::polynomial(turn));
  Dynamics dynamics(model, {}, options);
  double first = 0, largest = 0, off = 0;
  RowFunction compare([&](const Snapshot& s) {
    const Coordinates z{motion.z[0] + motion.rate[0] * s.t};
    const std::vector<JetPlace> places = motion.places_of(z, motion.rate);
    double kinetic = 0, potential = 0;
    for (std::size_t b = 0; b < places.size(); ++b) {
      const JetPlace& place = places[b];
      const Frame<double> f = s.evaluator.ground_frame(s.evaluator.plan().plan_body[b]);
      outcome.misplaced =
          std::max({outcome.misplaced, static_cast<double>(std::abs(f.phi - place.phi.f)),
                    static_cast<double>(std::hypot(f.x - place.r.x.f, f.y - place.r.y.f)) / motion.length});
      const BasicBody<double>& body = model->bodies[b];
      const double vx = static_cast<double>(place.r.x.d), vy = static_cast<double>(place.r.y.d);
      const double turning = static_cast<double>(place.phi.d);
      kinetic += (body.mass * (vx * vx + vy * vy) + body.inertia * turning * turning) / 2;
      potential -= body.mass * (model->gravity.x * static_cast<double>(place.r.x.f) +
                                model->gravity.y * static_cast<double>(place.r.y.f));
    }
    if (s.t == 0) first = kinetic + potential;
    largest = std::max(largest, kinetic);
    off = std::max(off, std::abs(s.work - (kinetic + potential - first)));
    return true;
  });
  const AnalysisReport report =
      dynamics.run(TimeGrid::range(0, motion.until, motion.until / 40), {.work = true}, compare);
  outcome.ok = report.ok();
  outcome.told = std::any_of(report.warnings.begin(), report.warnings.end(), [](const std::string& warning) {
    return warning.find("went straight on where two branches pass") != std::string::npos;
  });
  outcome.mistaken = off / largest;
  outcome.message = std::string(to_string(report.status)) + ": " + report.message;
  return outcome;
}

// Driven over the same passages: places follow from the constraints, and work from the energy. From 1e-8 on all end
// well; rounding of places is magnified by the corner's width.
TEST_P(SingularPassages, AreDriven) {
  const auto [kind, doubled] = GetParam();
  std::printf("%s%s, driven\n  distance, then tolerance: runs / wrong / straight on and told / refused\n",
              passage_kinds[kind].name, doubled ? ", joints given twice" : "");
  for (const double distance : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
    std::printf("  %.0e", distance);
    for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
      const double permitted = 30 * tolerance + 1e-14 / std::sqrt(2 * distance);
      int runs = 0, wrong = 0, told = 0, refused = 0;
      for (unsigned seed = first_case(); seed <= last_case(2); ++seed) {
        const KnownMotion motion = passage(kind, seed, distance, doubled);
        for (const IntegrationMethod method :
             {IntegrationMethod::rk8, IntegrationMethod::rk5, IntegrationMethod::adams, IntegrationMethod::baumgarte}) {
          const DrivenOutcome outcome =
              run_driven_passage(motion, {.method = method, .tolerance = tolerance, .max_steps = 100'000});
          ++runs;
          const bool off = !(outcome.misplaced <= permitted) || !(outcome.mistaken <= 10 * permitted);
          refused += !outcome.ok;
          told += outcome.ok && outcome.told;
          wrong += outcome.ok && !outcome.told && off;
          if (!outcome.ok || off)
            show_refusal(seed, std::string(to_string(method)) + " " + outcome.message + ", places off by " +
                                   std::to_string(outcome.misplaced / permitted) + ", work by " +
                                   std::to_string(outcome.mistaken / permitted));
        }
      }
      std::printf("  %.0e: %d/%d/%d/%d", tolerance, runs, wrong, told, refused);
      EXPECT_EQ(wrong, 0) << "at a distance of " << distance << ", tolerance " << tolerance;
      if (distance >= told_apart) {
        EXPECT_EQ(told + refused, 0) << "at a distance of " << distance << ", tolerance " << tolerance;
      }
    }
    std::printf("\n");
    std::fflush(stdout);
  }
}
INSTANTIATE_TEST_SUITE_P(Kinds, SingularPassages,
                         ::testing::Combine(::testing::Range(0, static_cast<int>(std::size(passage_kinds))),
                                            ::testing::Bool()));

}  // namespace
}  // namespace catena::testing
