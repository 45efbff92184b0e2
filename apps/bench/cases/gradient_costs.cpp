#include "cases/gradient_costs.hpp"

#include <cmath>

#include "cases/pendulum_gradient.hpp"
#include "cases/resting_chains.hpp"
#include "catena/analysis/adjoint/kinematic_adjoint.hpp"
#include "catena/analysis/dynamics/dynamics.hpp"
#include "catena/analysis/kinematics/kinematics.hpp"
#include "catena/analysis/motion/stage_watcher.hpp"
#include "catena/analysis/sensitivity/kinematic_derivatives.hpp"
#include "catena/analysis/sensitivity/motion_adjoint.hpp"
#include "catena/analysis/sensitivity/motion_derivatives.hpp"
#include "catena/analysis/statics/equilibrium_gradient.hpp"
#include "catena/base/at.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/model_add.hpp"

namespace bench {

using namespace catena;

namespace {

constexpr double span_per_rod = 0.8;  // of the chains between pins

// ---- a chain at rest: the tension by all its lengths ----

/// By the lengths of a chain of equal rods of 1 m at rest: with t_k the tangents of their angles, H the tension and V
/// the force at the first pin, sum l_k / r_k = span, sum l_k t_k / r_k = 0, r = sqrt(1 + t^2), t_k = (V + ...) / H.
std::vector<long double> tension_by_lengths(int n, long double weight, long double tension) {
  long double xh = 0, xv = 0, yh = 0, yv = 0;
  std::vector<std::array<long double, 2>> direction;
  for (int k = 0; k < n; ++k) {
    const long double t = weight / tension * (k - 0.5L * (n - 1)), r = std::hypot(1.0L, t);
    direction.push_back({1 / r, t / r});
    const long double part = 1 / (r * r * r * tension);
    xh += t * t * part, xv -= t * part, yh -= t * part, yv += part;
  }
  const long double det = xh * yv - xv * yh;
  std::vector<long double> by(at(n));
  for (std::size_t k = 0; k < by.size(); ++k) by[k] = -(direction[k][0] * yv - direction[k][1] * xv) / det;
  return by;
}

std::vector<double> by_lengths(EquilibriumGradient& gradient, int rods) {
  if (!gradient.measure_multiplier(0, 0)) return {};
  const auto pins = gradient.by_constraints<Revolute>([](int, const Revolute<double>& pin) {
    return Revolute<DesignScalar>{{DesignScalar::variable(pin.s_i.x, 0), pin.s_i.y},
                                  {DesignScalar::variable(pin.s_j.x, 1), pin.s_j.y}};
  });
  std::vector<double> all(at(rods));
  for (std::size_t k = 0; k < all.size(); ++k)
    all[k] = (k + 1 < all.size() ? pins[k + 1][0] : pins[k + 1][1]) / 2 - pins[k][1] / 2;
  return all;
}

void chain_at_rest(Bench& bench, int rods) {
  Row row{.suite = "design", .problem = "chain between pins at rest", .method = "equilibrium", .bodies = rods};
  if (!bench.wants(row)) return;
  const auto model = chain_between_pins(rods, ChainStart::bent);
  bench.time(row, [&] { Equilibrium(model).solve(); });
  const double run = row.seconds;
  row.method = "tension by all lengths, after it";
  Equilibrium rest(model);
  const EquilibriumReport report = rest.solve();
  std::vector<double> found;
  const auto before = rest.evaluator().counters.factorizations;
  if (report.ok()) {
    bench.time(row, [&] {
      EquilibriumGradient gradient(rest);
      found = by_lengths(gradient, rods);
    });
  }
  if (!found.empty()) {
    const auto exact = tension_by_lengths(rods, model->bodies[0].mass * 9.81L, rest.lambda()[0]);
    long double worst = 0, largest = 0;
    for (std::size_t k = 0; k < found.size(); ++k) {
      worst = std::max(worst, std::abs(found[k] - exact[k]));
      largest = std::max(largest, std::abs(exact[k]));
    }
    row.error = static_cast<double>(worst / largest);
    row.allowed = 1e-10 * std::max(1.0, rods / 100.0);  // rounding grows with the length of the chain
  } else {
    row.failure = report.ok() ? "no gradient" : report.message;
  }
  row.error_of = "derivatives, relative";
  row.reference = "moments of rods, in 64 bits";
  row.counts = {{"run, us", 1e6 * run},
                {"runs", 1 + row.seconds / run},
                {"factorizations", static_cast<double>(rest.evaluator().counters.factorizations - before)}};
  bench.add(std::move(row));
}

// ---- chains that fall ----

template <class S>
std::shared_ptr<BasicModel<S>> falling_chain(const std::vector<S>& length, const std::vector<S>& mass) {
  auto model = std::make_shared<BasicModel<S>>();
  model->gravity = {S(0.0), S(-pendulum_gravity)};
  Vec2<S> end{};
  for (std::size_t k = 0; k < length.size(); ++k) {
    BasicBody<S> rod;
    const double angle = start_angle(k);
    const Vec2<S> half{length[k] * S(std::cos(angle) / 2), length[k] * S(std::sin(angle) / 2)};
    rod.mass = mass[k];
    rod.inertia = mass[k] * length[k] * length[k] / S(12.0);
    rod.has_mass = rod.has_inertia = true;
    rod.position = end + half;
    rod.angle = angle;
    const int body = model->append_body("rod" + std::to_string(k), rod);
    const S before = k == 0 ? S(0.0) : length[k - 1] / S(2.0);
    model->add("", Revolute<S>{{before, S(0.0)}, {-length[k] / S(2.0), S(0.0)}}, k == 0 ? ground : body - 1, body);
    end = rod.position + half;
  }
  return model;
}

/// Models with derivatives by these of all parameters.
DesignModels designs_of(int rods, std::span<const int> parameters) {
  DesignModels models;
  for (std::size_t first = 0; first < parameters.size(); first += parameters_at_once) {
    std::vector<DesignScalar> numbers(at(2 * rods), DesignScalar(1.0));
    for (std::size_t p = first; p < std::min(first + parameters_at_once, parameters.size()); ++p)
      numbers[at(parameters[p])] = DesignScalar::variable(1.0, static_cast<int>(p - first));
    models.push_back(falling_chain<DesignScalar>({numbers.begin(), numbers.begin() + rods},
                                                 {numbers.begin() + rods, numbers.end()}));
  }
  return models;
}

/// Passes steps on to the one that differentiates, if there is one, and keeps where the motion ended.
class Watcher final : public RowObserver {
 public:
  explicit Watcher(StateDerivatives* derivatives) : derivatives_(derivatives) {}
  StageWatcher* stage_watcher() override { return derivatives_ ? derivatives_->stage_watcher() : nullptr; }
  bool wants_stretches() const override { return derivatives_; }
  bool cover(const MotionStretch& stretch) override {
    derivatives_->cover(stretch);
    return true;
  }
  bool observe(const Snapshot& snapshot) override {
    found = derivatives_ && derivatives_->find(snapshot);
    q.assign(snapshot.q.begin(), snapshot.q.end());
    return true;
  }
  bool found = false;
  std::vector<double> q;

 private:
  StateDerivatives* derivatives_;
};

/// d(mean height)/dq: of rod k's middle and angle its far end is made.
std::vector<double> height_by_q(std::span<const double> q, int rods) {
  std::vector<double> by(q.size(), 0.0);
  for (int k = 0; k < rods; ++k) {
    by[at(3 * k + 1)] = 1.0 / rods;
    by[at(3 * k + 2)] = 0.5 * std::cos(q[at(3 * k + 2)]) / rods;
  }
  return by;
}
/// And by the lengths at fixed q.
double height_by_length(std::span<const double> q, int rods, int parameter) {
  return parameter < rods ? 0.5 * std::sin(q[at(3 * parameter + 2)]) / rods : 0;
}

struct FallingChain {
  const PendulumProblem& of;
  std::shared_ptr<Model> model =
      falling_chain<double>(std::vector<double>(at(of.rods), 1.0), std::vector<double>(at(of.rods), 1.0));
  DynamicsOptions options{};

  Report run(Dynamics& motion, Watcher& watcher) const {
    return motion.run(TimeGrid::instant(of.duration), {}, watcher);
  }
  std::vector<double> adjoint(const DesignModels& designs, int parameters) const {
    Dynamics motion(model, {}, options);
    MotionAdjoint derivatives(motion.evaluator(), designs, parameters, {});
    Watcher watcher(&derivatives);
    if (!run(motion, watcher).ok()) return {};
    std::vector<double> gradient =
        derivatives.gradient({{of.duration, height_by_q(watcher.q, of.rods), {}}}).value_or(std::vector<double>{});
    for (std::size_t p = 0; p < gradient.size(); ++p)
      gradient[p] += height_by_length(watcher.q, of.rods, static_cast<int>(p));
    return gradient;
  }
  std::vector<double> forward(const DesignModels& designs, std::span<const int> parameters) const {
    Dynamics motion(model, {}, options);
    MotionDerivatives derivatives(motion.evaluator(), designs, static_cast<int>(parameters.size()), {});
    Watcher watcher(&derivatives);
    if (!run(motion, watcher).ok() || !watcher.found) return {};
    const std::vector<double> by_q = height_by_q(watcher.q, of.rods);
    std::vector<double> gradient;
    for (std::size_t p = 0; p < parameters.size(); ++p) {
      double sum = height_by_length(watcher.q, of.rods, parameters[p]);
      for (std::size_t c = 0; c < by_q.size(); ++c)
        sum += by_q[c] * derivatives.configuration(p / parameters_at_once)[c].d[p % parameters_at_once];
      gradient.push_back(sum);
    }
    return gradient;
  }
};

void falling(Bench& bench, const PendulumProblem& of) {
  Row row{.suite = "design", .problem = of.name, .bodies = of.rods};
  row.reference = "least coordinates, complex steps in 64 bits, order 16";
  const auto chosen = compared(of.rods);
  std::vector<int> all(at(2 * of.rods));
  for (std::size_t p = 0; p < all.size(); ++p) all[p] = static_cast<int>(p);
  if (!bench.wants(row)) return;
  const auto exact = pendulum_gradient(of.rods, of.duration);
  const DesignModels of_all = designs_of(of.rods, all), of_chosen = designs_of(of.rods, chosen);
  FallingChain chain{of};
  for (const double tolerance : {1e-5, 1e-7, 1e-9, 1e-11}) {
    chain.options.tolerance = tolerance;
    row.setting = tolerance_text(tolerance);
    row.error = not_measured;
    row.counts.clear();
    row.method = "motion";
    bench.time(row, [&] {
      Dynamics motion(chain.model, {}, chain.options);
      Watcher nobody(nullptr);
      chain.run(motion, nobody);
    });
    const double run = row.seconds;
    row.error_of = "derivatives, relative";
    row.allowed = 10 * tolerance;
    std::vector<double> found;
    const auto take = [&](std::span<const int> places) {
      std::array<double, compared_parameters> four{};
      for (std::size_t p = 0; p < four.size() && !found.empty(); ++p) four[p] = found[at(places[p])];
      row.error = found.empty() ? not_measured : gradient_error(four, exact);
      row.failure = found.empty() ? "no gradient" : "";
    };
    row.method = "adjoint, all lengths and masses";
    bench.time(row, [&] { found = chain.adjoint(of_all, 2 * of.rods); });
    take(chosen);
    row.counts = {{"parameters", 2.0 * of.rods}, {"run, us", 1e6 * run}, {"runs", row.seconds / run}};
    bench.add(row);
    row.method = "forward, four of them";
    bench.time(row, [&] { found = chain.forward(of_chosen, chosen); });
    const int places[] = {0, 1, 2, 3};
    take(places);
    row.counts = {{"parameters", 4}, {"run, us", 1e6 * run}, {"runs a parameter", (row.seconds / run - 1) / 4}};
    bench.add(row);
  }
}

// ---- a four-bar, solved again ----

constexpr int positions = 37, pin_numbers = 8;
constexpr std::array<double, 4> links{1, 2.5, 2, 3};  // crank, coupler, rocker, ground

/// The rocker's angle where the crank is at `crank`: two triangles.
template <class Real>
Real rocker_angle(const std::array<Real, 4>& link, Real crank) {
  const Real x = link[3] - link[0] * std::cos(crank), y = -link[0] * std::sin(crank), r2 = x * x + y * y;
  const Real coupler =
      std::atan2(y, x) + std::acos((link[1] * link[1] + r2 - link[2] * link[2]) / (2 * link[1] * std::sqrt(r2)));
  return std::atan2(link[1] * std::sin(coupler) - y, link[1] * std::cos(coupler) - x);
}

/// Numbers: x of the pins on crank, coupler, rocker and ground, the links' lengths, then their y.
template <class S>
std::shared_ptr<BasicModel<S>> four_bar(const std::array<S, pin_numbers>& n) {
  auto model = std::make_shared<BasicModel<S>>();
  const double rocker = rocker_angle<double>(links, 0);
  const double coupler = std::atan2(links[2] * std::sin(rocker), links[3] + links[2] * std::cos(rocker) - links[0]);
  const std::array<std::array<double, 3>, 3> pose{{{0, 0, 0}, {links[0], 0, coupler}, {links[3], 0, rocker}}};
  for (std::size_t b = 0; b < pose.size(); ++b) {
    BasicBody<S> body;
    body.position = {S(pose[b][0]), S(pose[b][1])};
    body.angle = pose[b][2];
    model->append_body("body" + std::to_string(b), body);
  }
  const Vec2<S> none{};
  model->add("", Revolute<S>{none, none}, ground, 0);
  model->add("", Revolute<S>{{n[0], n[4]}, none}, 0, 1);
  model->add("", Revolute<S>{{n[1], n[5]}, {n[2], n[6]}}, 1, 2);
  model->add("", Revolute<S>{{n[3], n[7]}, none}, ground, 2);
  const std::vector<S> turning{S(0.0), S(2 * std::acos(-1.0))};
  model->add_driver("drive", AbsoluteAngle<S>{}, 0, ground, TimeFunction<S>::polynomial(turning));
  return model;
}

/// d(sum of the rocker's angles)/d(link) by differences of order 4 in 64 bits.
double by_link(std::size_t link) {
  constexpr long double h = 1e-3L;
  const auto sum = [&](long double by) {
    std::array<long double, 4> moved{links[0], links[1], links[2], links[3]};
    moved[link] += by;
    long double all = 0;
    for (int k = 0; k < positions; ++k)
      all += rocker_angle<long double>(moved, 2 * std::acos(-1.0L) * k / (positions - 1));
    return all;
  };
  return static_cast<double>((sum(-2 * h) - 8 * sum(-h) + 8 * sum(h) - sum(2 * h)) / (12 * h));
}

void four_bar_again(Bench& bench) {
  Row row{.suite = "design", .problem = "four-bar, 37 positions again", .method = "run", .bodies = 3};
  if (!bench.wants(row)) return;
  std::array<double, pin_numbers> numbers{links[0], links[1], links[2], links[3]};
  DesignModels designs;
  for (int first = 0; first < pin_numbers; first += parameters_at_once) {
    std::array<DesignScalar, pin_numbers> lifted;
    for (int k = 0; k < pin_numbers; ++k)
      lifted[at(k)] = k >= first && k < first + parameters_at_once ? DesignScalar::variable(numbers[at(k)], k - first)
                                                                   : DesignScalar(numbers[at(k)]);
    designs.push_back(four_bar<DesignScalar>(lifted));
  }
  Kinematics kinematics(four_bar<double>(numbers));
  const SystemState start = kinematics.state();
  const TimeGrid grid = TimeGrid::range(0, 1, 1.0 / (positions - 1));
  RowFunction nothing([](const Snapshot&) { return true; });
  bench.time(row, [&] {
    kinematics.start_from(start);
    kinematics.run(grid, {}, nothing);
  });
  const double run = row.seconds;
  KinematicDerivatives derivatives(kinematics.evaluator(), designs, pin_numbers);
  std::array<double, pin_numbers> gradient{};
  const std::size_t rocker = at(3 * kinematics.plan().plan_body[2] + 2);
  RowFunction differentiated([&](const Snapshot& snapshot) {
    if (!derivatives.find(snapshot)) return false;
    for (std::size_t p = 0; p < gradient.size(); ++p)
      gradient[p] += derivatives.configuration(p / parameters_at_once)[rocker].d[p % parameters_at_once];
    return true;
  });
  KinematicAdjoint adjoint(kinematics.evaluator(), designs, pin_numbers);
  std::vector<double> slopes(at(kinematics.plan().coordinates()), 0.0);
  slopes[rocker] = 1;
  RowFunction gone_back([&](const Snapshot& snapshot) { return adjoint.add_gradient(snapshot, slopes, gradient); });
  row.allowed = 1e-9;
  row.error_of = "derivatives, rad/m";
  row.reference = "two triangles, differences in 64 bits";
  const auto measure = [&](const char* method, RowObserver& observer) {
    row.method = method;
    bool ok = true;
    bench.time(row, [&] {
      gradient.fill(0);
      kinematics.start_from(start);
      ok = ok && kinematics.run(grid, {}, observer).ok();
    });
    row.error = 0;
    for (std::size_t p = 0; p < links.size(); ++p) row.error = std::max(row.error, std::abs(gradient[p] - by_link(p)));
    row.counts = {{"run, us", 1e6 * run}, {"runs", row.seconds / run}};
    row.failure = ok ? "" : "no gradient";
    bench.add(row);
  };
  measure("run and gradient by eight numbers, forward", differentiated);
  measure("run and gradient by eight numbers, adjoint", gone_back);
}

}  // namespace

void gradient_costs(Bench& bench) {
  four_bar_again(bench);
  for (const int rods : bench.brief() ? std::vector{20} : std::vector{100, 10000, 100000}) chain_at_rest(bench, rods);
  for (const PendulumProblem& of : pendulum_problems) {
    if (!bench.brief() || of.rods <= 2) falling(bench, of);
  }
}

}  // namespace bench
