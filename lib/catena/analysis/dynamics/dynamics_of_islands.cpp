#include "catena/analysis/dynamics/dynamics_of_islands.hpp"

#include <algorithm>

#include "catena/analysis/run/report_parts.hpp"
#include "catena/analysis/run/state_conversion.hpp"
#include "catena/base/at.hpp"
#include "catena/base/flush_denormals.hpp"

namespace catena {
namespace {

void add(std::optional<int>& sum, const std::optional<int>& value) {
  if (value) sum = sum.value_or(0) + *value;
}

/// Outcome and facts of one class, into the report of all.
void merge(AnalysisReport& total, AnalysisReport part) {
  AnalysisReport sum = total;
  add(sum.rank, part.rank);
  add(sum.dof, part.dof);
  add(sum.mobility, part.mobility);
  sum.redundant.insert(sum.redundant.end(), part.redundant.begin(), part.redundant.end());
  sum.counters = part.counters;
  sum.warnings = part.warnings;
  if (sum.ok()) {
    sum.status = part.status;
    sum.message = part.message;
  }
  sum.seconds = 0;
  add_part(total, std::move(sum));
}

}  // namespace

/// One class of mechanisms, and where its numbers stand among those of all. Keeps the row it gave last.
class DynamicsOfIslands::Part final : public RowObserver {
 public:
  Part(DynamicsOfIslands& owner, ModelPart part, const PlanOptions& all, const DynamicsOptions& options)
      : owner_(owner),
        number_(owner.parts_.size()),
        part_(std::move(part)),
        model_(std::make_shared<const Model>(std::move(part_.model))),
        plan_options_(options_of(all)),
        options_(options),
        dynamics_(model_, plan_options_, options) {
    const Plan& plan = dynamics_.plan();
    for (int p = 0; p < plan.moving; ++p) {
      body_.push_back(owner.plan_->plan_body[at(part_.bodies[at(plan.model_body[at(p)])])]);
    }
    Evaluator &own = dynamics_.evaluator(), &all_evaluator = owner.evaluator_;
    own.set_configuration(own.given_configuration());
    for (int r = 0; r < plan.rows; ++r) {
      const int element = plan.row_element[at(r)], in_all = part_.elements[at(element)];
      // Rows of squared distances have a scale, which may depend on the size of the scene.
      factor_.push_back(own.element_jacobian(element).scale / all_evaluator.element_jacobian(in_all).scale);
      row_.push_back(owner.plan_->element_row[at(in_all)] + r - plan.element_row[at(element)]);
    }
  }

  Dynamics& dynamics() { return dynamics_; }

  void start_from(const SystemState& state) {
    SystemState own{state.t, {}, {}};
    for (const int body : part_.bodies) {
      const std::size_t first = 3 * at(body);
      for (std::size_t c = first; c < first + 3; ++c) {
        if (!state.q.empty()) own.q.push_back(state.q[c]);
        if (!state.qd.empty()) own.qd.push_back(state.qd[c]);
      }
    }
    dynamics_.start_from(own);
    start_ = std::move(own);
  }
  /// Gives the row at t of a motion that may have gone past it: from the start again. False: it does not come there.
  bool go_again_to(double t, const Needs& needs) {
    Dynamics again(model_, plan_options_, options_);
    if (start_) again.start_from(*start_);
    return again.run(TimeGrid::instant(t), needs, *this).ok();
  }
  std::vector<SingularPoint> singular_points() const {
    std::vector<SingularPoint> points = dynamics_.singular_points();
    for (SingularPoint& point : points) {
      if (point.driver >= 0) point.driver = part_.elements[at(point.driver)];
    }
    return points;
  }
  std::vector<Jolt> jolts() const {
    std::vector<Jolt> jolts = dynamics_.jolts();
    for (Jolt& jolt : jolts) {
      for (int& driver : jolt.drivers) driver = part_.elements[at(driver)];
      for (ConstraintImpulse& impulse : jolt.impulses) impulse.element = part_.elements[at(impulse.element)];
    }
    return jolts;
  }
  /// The instant at which its motion ended: of the dead point, where it locked.
  double end() const {
    const std::vector<SingularPoint>& points = dynamics_.singular_points();
    const bool locked = !points.empty() && points.back().kind == SingularPoint::Kind::lock_up;
    return locked ? points.back().t : dynamics_.time();
  }
  /// Reports the progress of all mechanisms to the observer as times between `from` and `to`.
  void go_through(double from, double to, RowObserver& watcher) {
    from_ = from;
    to_ = to;
    watcher_ = &watcher;
  }

  bool observe(const Snapshot& s) override {
    for (std::size_t p = 0; p < body_.size(); ++p) {
      const std::size_t target = 3 * at(body_[p]);
      std::copy_n(&s.q[3 * p], 3, &owner_.q_[target]);
      std::copy_n(&s.qd[3 * p], 3, &owner_.qd_[target]);
      if (!s.qdd.empty()) std::copy_n(&s.qdd[3 * p], 3, &owner_.qdd_[target]);
    }
    for (std::size_t r = 0; r < std::min(row_.size(), s.lambda.size()); ++r) {
      owner_.lambda_[at(row_[r])] = factor_[r] * s.lambda[r];
    }
    // A part keeps account of work for its own checks, too, where no row is to show it.
    const std::size_t shown = owner_.driver_work_.empty() ? 0 : s.driver_work.size();
    for (std::size_t e = 0; e < shown; ++e) owner_.driver_work_[at(part_.elements[e])] = s.driver_work[e];
    residual = s.residual;
    work = s.work;
    dissipated = s.dissipated;
    initial_energy = s.initial_energy;
    return true;
  }
  bool proceed(double t) override {
    const auto number = static_cast<double>(number_);
    return watcher_->proceed(from_ + (number * (to_ - from_) + (t - from_)) / static_cast<double>(owner_.classes()));
  }

  double residual = 0, work = 0, dissipated = 0, initial_energy = 0;

 private:
  PlanOptions options_of(const PlanOptions& all) const {
    PlanOptions own;
    std::vector<int> wanted = all.keep_elements;
    std::sort(wanted.begin(), wanted.end());
    for (int e = 0; e < static_cast<int>(part_.elements.size()); ++e) {
      if (std::binary_search(wanted.begin(), wanted.end(), part_.elements[at(e)])) own.keep_elements.push_back(e);
    }
    return own;
  }

  DynamicsOfIslands& owner_;
  std::size_t number_;  // among the classes
  ModelPart part_;
  std::shared_ptr<const Model> model_;
  PlanOptions plan_options_;
  DynamicsOptions options_;
  std::optional<SystemState> start_;
  Dynamics dynamics_;
  std::vector<int> body_, row_;  // in the plan of all: of a moving body of the part, of a row
  std::vector<double> factor_;   // of multipliers, by row of the part
  double from_ = 0, to_ = 0;
  RowObserver* watcher_ = nullptr;
};

DynamicsOfIslands::DynamicsOfIslands(std::shared_ptr<const Model> model, const PlanOptions& plan_options,
                                     const DynamicsOptions& options, const std::vector<std::vector<int>>& classes)
    : model_(std::move(model)), plan_(Plan::make(required(model_), plan_options)), evaluator_(plan_, *model_) {
  q_ = evaluator_.given_configuration();
  qd_.assign(q_.size(), 0.0);
  qdd_.assign(q_.size(), 0.0);
  lambda_.assign(at(plan_->rows), 0.0);
  evaluator_.set_configuration(q_);
  for (const std::vector<int>& bodies : classes) {
    parts_.push_back(std::make_unique<Part>(*this, part_of(*model_, bodies), plan_options, options));
  }
}

DynamicsOfIslands::~DynamicsOfIslands() = default;

void DynamicsOfIslands::start_from(const SystemState& state) {
  t_ = state.t;
  take_over_places(evaluator_, state, q_);
  for (const auto& part : parts_) part->start_from(state);
}

SystemState DynamicsOfIslands::state() const { return state_of(evaluator_, t_, q_, qd_); }

std::vector<IntegrationMethod> DynamicsOfIslands::methods() const {
  std::vector<IntegrationMethod> methods;
  for (const auto& part : parts_) methods.push_back(part->dynamics().method());
  return methods;
}

AnalysisReport DynamicsOfIslands::run(const TimeGrid& grid, const Needs& needs, RowObserver& observer) {
  const ProcessTimer timer;
  const FlushDenormals flush;
  driver_work_.assign(needs.work ? model_->elements.size() : 0, 0.0);
  for (const auto& part : parts_) part->dynamics().begin(grid, needs);
  singular_points_.clear();
  bool cancelled = false;
  // Of those that cannot go on before a row the one that ends first.
  const Part* ended = nullptr;
  for (std::int64_t row = 0; row < grid.size() && !ended && !cancelled; ++row) {
    for (const auto& part : parts_) {
      part->go_through(t_, grid[row], observer);
      if (!part->dynamics().go_on(row + 1, *part) && (!ended || part->end() < ended->end())) ended = part.get();
    }
    if (!ended) cancelled = !give_row(grid[row], needs, observer);
  }
  AnalysisReport total;
  total.bodies = plan_->bodies;
  total.rows = plan_->rows;
  total.islands = plan_->islands;
  collect_points_in_time(ended ? ended->end() : grid.last());
  std::vector<Part*> in_order;
  for (const auto& part : parts_) in_order.push_back(part.get());
  std::stable_partition(in_order.begin(), in_order.end(), [&](const Part* part) { return part == ended; });
  for (Part* part : in_order) merge(total, part->dynamics().end());
  if (cancelled && total.ok()) {
    total.status = Status::cancelled;
    total.message = "stopped; the rows so far are kept";
  }
  if (ended && total.status == Status::lock_up) give_row_at_lock_up(*ended, needs, observer);
  total.counters += evaluator_.counters;
  total.seconds = timer.seconds();
  return total;
}

// The others are elsewhere when one locks, and some have gone past that instant.
void DynamicsOfIslands::give_row_at_lock_up(const Part& locked, const Needs& needs, RowObserver& observer) {
  const double t = locked.end();
  for (const auto& part : parts_) {
    if (part.get() != &locked && !part->go_again_to(t, needs)) return;
  }
  give_row(t, needs, observer);
}

// Singular points and jolts up to an instant, in their order in time: some mechanisms have gone past it.
void DynamicsOfIslands::collect_points_in_time(double until) {
  for (const auto& part : parts_) {
    for (SingularPoint& point : part->singular_points()) {
      if (point.t <= until) singular_points_.push_back(std::move(point));
    }
  }
  const auto earlier = [](const auto& a, const auto& b) { return a.t < b.t; };
  std::stable_sort(singular_points_.begin(), singular_points_.end(), earlier);
  jolts_.clear();
  for (const auto& part : parts_) {
    for (Jolt& jolt : part->jolts()) {
      if (jolt.t <= until) jolts_.push_back(std::move(jolt));
    }
  }
  std::stable_sort(jolts_.begin(), jolts_.end(), earlier);
}

// The mechanisms together at an instant at which each of them gave its row.
bool DynamicsOfIslands::give_row(double t, const Needs& needs, RowObserver& observer) {
  t_ = t;
  evaluator_.set_time(t);
  evaluator_.set_configuration(q_);
  Snapshot s{.evaluator = evaluator_, .t = t, .q = q_, .qd = qd_};
  if (needs.acceleration || needs.multipliers) s.qdd = qdd_;
  if (needs.multipliers) s.lambda = lambda_;
  for (const auto& part : parts_) {
    s.residual = std::max(s.residual, part->residual);
    s.work += part->work;
    s.dissipated += part->dissipated;
    s.initial_energy += part->initial_energy;
  }
  s.driver_work = driver_work_;
  return observer.observe(s);
}

}  // namespace catena
