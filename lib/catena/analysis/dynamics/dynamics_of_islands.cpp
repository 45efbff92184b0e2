#include "catena/analysis/dynamics/dynamics_of_islands.hpp"

#include <algorithm>
#include <deque>
#include <utility>

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
  sum.rows += part.rows;
  sum.seconds = 0;
  add_part(total, std::move(sum));
}

/// Equations of contacts, which come and go, are those of the parts alone.
std::shared_ptr<const Plan> plan_of_all(const Model& model, PlanOptions options) {
  const std::vector<int> gaps = model.gaps();
  options.released_elements.insert(options.released_elements.end(), gaps.begin(), gaps.end());
  return Plan::make(model, options);
}

}  // namespace

/// One class of mechanisms, and where its numbers stand among those of all.
class DynamicsOfIslands::Part final : public RowObserver {
 public:
  Part(DynamicsOfIslands& owner, ModelPart part, const PlanOptions& all, const DynamicsOptions& options)
      : owner_(owner),
        number_(owner.parts_.size()),
        part_(std::move(part)),
        model_(std::make_shared<const Model>(std::move(part_.model))),
        plan_options_(options_of(all)),
        options_(options),
        dynamics_(model_, plan_options_, options, {}, {}) {
    const Plan& plan = dynamics_.plan();
    for (int p = 0; p < plan.moving; ++p) {
      body_.push_back(owner.plan_->plan_body[at(part_.bodies[at(plan.model_body[at(p)])])]);
    }
    Evaluator &own = dynamics_.evaluator(), &all_evaluator = owner.evaluator_;
    own.set_configuration(own.given_configuration());
    for (int r = 0; r < plan.rows; ++r) {
      const int element = plan.row_element[at(r)], in_all = part_.elements[at(element)];
      const int within = r - plan.element_row[at(element)];
      // Rows of squared distances have a scale, which may depend on the size of the scene.
      const double factor = own.element_jacobian(element).scale / all_evaluator.element_jacobian(in_all).scale;
      row_.push_back({element, within, owner.plan_->element_row[at(in_all)] + within, factor});
    }
  }

  DynamicsWithEvents& dynamics() { return dynamics_; }
  void watch_rows(RowObserver* observer) { own_rows_ = observer; }

  void start_from(const SystemState& state) {
    SystemState own{state.t, {}, {}};
    for (const int body : part_.bodies) {
      const std::size_t first = 3 * at(body);
      for (std::size_t c = first; c < first + 3; ++c) {
        if (!state.q.empty()) own.q.push_back(state.q[c]);
        if (!state.qd.empty()) own.qd.push_back(state.qd[c]);
      }
    }
    for (const CurvePlace& place : state.curves) {
      const auto found = std::find(part_.elements.begin(), part_.elements.end(), place.element);
      if (found == part_.elements.end()) continue;
      own.curves.push_back(place);
      own.curves.back().element = static_cast<int>(found - part_.elements.begin());
    }
    dynamics_.start_from(own);
    start_ = std::move(own);
  }
  void begin(const TimeGrid& grid, const Needs& needs, const std::shared_ptr<std::int64_t>& steps) {
    ahead_.clear();
    dynamics_.begin(grid, needs, steps);
  }
  /// Puts row number `row` of the grid among those of all. False: it does not come any more.
  bool go_to(std::int64_t row) {
    if (ahead_.empty() && !dynamics_.go_on(row + 1, *this)) return false;
    show(ahead_.front());
    spare_ = std::move(ahead_.front());
    ahead_.pop_front();
    return true;
  }
  /// Gives the row at t of a motion that may have gone past it: from the start again. False: it does not come there.
  bool go_again_to(double t, const Needs& needs) {
    DynamicsWithEvents again(model_, plan_options_, options_, {}, {});
    if (start_) again.start_from(*start_);
    ahead_.clear();
    // Who sees the rows of this part has seen those before.
    RowObserver* const seen = std::exchange(own_rows_, nullptr);
    const bool comes_there = again.run(TimeGrid::instant(t), needs, *this).ok();
    own_rows_ = seen;
    if (!comes_there) return false;
    show(ahead_.back());
    return true;
  }
  /// The row that a motion gave last, where it ended in a dead point.
  void show_last() {
    if (!ahead_.empty()) show(ahead_.back());
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
  std::vector<ContactEvent> contact_events() const {
    std::vector<ContactEvent> events = dynamics_.contact_events();
    for (ContactEvent& event : events) event.element = part_.elements[at(event.element)];
    return events;
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
    if (own_rows_ && !own_rows_->observe(s)) return false;
    Row& row = ahead_.emplace_back(std::exchange(spare_, {}));
    const auto take = [&](std::vector<double>& values, std::span<const double> of) {
      values.clear();
      if (!of.empty()) values.assign(of.begin(), of.begin() + static_cast<std::ptrdiff_t>(3 * body_.size()));
    };
    row.curves = s.evaluator.curve_places();
    // Slides of contacts, which the part has behind its elements, are no elements of the whole.
    std::erase_if(row.curves, [this](const CurvePlace& place) { return at(place.element) >= part_.elements.size(); });
    for (CurvePlace& place : row.curves) place.element = part_.elements[at(place.element)];
    take(row.q, s.q);
    take(row.qd, s.qd);
    take(row.qdd, s.qdd);
    row.lambda.clear();
    for (std::size_t r = 0; r < row_.size() && !s.lambda.empty(); ++r) {
      // Rows of contacts come and go between them.
      const std::size_t own = at(s.evaluator.plan().element_row[at(row_[r].element)] + row_[r].within);
      row.lambda.push_back(row_[r].factor * s.lambda[own]);
    }
    // A part keeps account of work for its own checks, too, where no row is to show it.
    const std::size_t shown = owner_.driver_work_.empty() || s.driver_work.empty() ? 0 : part_.elements.size();
    row.driver_work.assign(s.driver_work.begin(), s.driver_work.begin() + static_cast<std::ptrdiff_t>(shown));
    const std::size_t touching = std::min(part_.elements.size(), s.contacts.size());
    row.contacts.assign(s.contacts.begin(), s.contacts.begin() + static_cast<std::ptrdiff_t>(touching));
    row.sums = {s.residual, s.work, s.dissipated, s.initial_energy, s.contact_energy};
    return true;
  }
  bool proceed(double t) override {
    const auto number = static_cast<double>(number_);
    return watcher_->proceed(from_ + (number * (to_ - from_) + (t - from_)) / static_cast<double>(owner_.classes()));
  }

  /// What a row of all is the sum or, of residuals, the largest of.
  struct Sums {
    double residual = 0, work = 0, dissipated = 0, initial_energy = 0, contact_energy = 0;
  };
  Sums sums;  ///< of the row that was shown last

 private:
  /// A row of the part, by its bodies, equations and elements.
  struct Row {
    std::vector<double> q, qd, qdd, lambda, driver_work;
    std::vector<CurvePlace> curves;  // by elements of all
    std::vector<ContactLoad> contacts;
    Sums sums;
  };
  /// An equation that always holds.
  struct Equation {
    int element, within;  // of the part; among the rows of the element
    int in_all;           // row of the plan of all
    double factor;        // of its multiplier there
  };

  void show(const Row& row) {
    const auto scatter = [&](const std::vector<double>& values, std::vector<double>& all) {
      for (std::size_t p = 0; 3 * p < values.size(); ++p) std::copy_n(&values[3 * p], 3, &all[3 * at(body_[p])]);
    };
    owner_.evaluator_.go_to_curve_places(row.curves);
    scatter(row.q, owner_.q_);
    scatter(row.qd, owner_.qd_);
    scatter(row.qdd, owner_.qdd_);
    for (std::size_t r = 0; r < row.lambda.size(); ++r) owner_.lambda_[at(row_[r].in_all)] = row.lambda[r];
    for (std::size_t e = 0; e < row.driver_work.size(); ++e)
      owner_.driver_work_[at(part_.elements[e])] = row.driver_work[e];
    for (std::size_t e = 0; e < row.contacts.size(); ++e) owner_.contacts_[at(part_.elements[e])] = row.contacts[e];
    sums = row.sums;
  }

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
  DynamicsWithEvents dynamics_;
  std::vector<int> body_;  // in the plan of all: of a moving body of the part
  std::vector<Equation> row_;
  std::deque<Row> ahead_;  // given by the part, and not by all of them yet
  Row spare_;              // its memory serves the next row
  double from_ = 0, to_ = 0;
  RowObserver *watcher_ = nullptr, *own_rows_ = nullptr;
};

DynamicsOfIslands::DynamicsOfIslands(std::shared_ptr<const Model> model, const PlanOptions& plan_options,
                                     const DynamicsOptions& options, const std::vector<std::vector<int>>& classes)
    : model_(std::move(model)),
      plan_(plan_of_all(required(model_), plan_options)),
      evaluator_(plan_, *model_, evaluation_) {
  q_ = evaluator_.given_configuration();
  qd_.assign(q_.size(), 0.0);
  qdd_.assign(q_.size(), 0.0);
  lambda_.assign(at(plan_->rows), 0.0);
  evaluator_.set_configuration(q_);
  for (ModelPart& part : parts_of(*model_, classes))
    parts_.push_back(std::make_unique<Part>(*this, std::move(part), plan_options, options));
  touches_ =
      std::any_of(parts_.begin(), parts_.end(), [](const auto& part) { return part->dynamics().has_contacts(); });
}

DynamicsOfIslands::~DynamicsOfIslands() = default;

DynamicsWithEvents& DynamicsOfIslands::motion_of(std::size_t part) { return parts_[part]->dynamics(); }
void DynamicsOfIslands::watch_rows_of(std::size_t part, RowObserver* observer) { parts_[part]->watch_rows(observer); }

void DynamicsOfIslands::start_from(const SystemState& state) {
  t_ = state.t;
  take_over_places(evaluator_, state, q_);
  for (const auto& part : parts_) part->start_from(state);
}

SystemState DynamicsOfIslands::state() const { return state_of(evaluator_, t_, q_, qd_); }

std::vector<IntegrationMethod> DynamicsOfIslands::methods() const {
  std::vector<IntegrationMethod> methods;
  for (const auto& part : parts_) {
    const auto& used = part->dynamics().methods();
    methods.insert(methods.end(), used.begin(), used.end());
  }
  return methods;
}

AnalysisReport DynamicsOfIslands::run(const TimeGrid& grid, const Needs& needs, RowObserver& observer) {
  const ProcessTimer timer;
  const FlushDenormals flush;
  driver_work_.assign(needs.work ? model_->elements.size() : 0, 0.0);
  contacts_.assign(touches_ ? model_->elements.size() : 0, {});
  const auto steps = std::make_shared<std::int64_t>(0);
  for (const auto& part : parts_) part->begin(grid, needs, steps);
  bool cancelled = false;
  // Of those that cannot go on before a row the one that ends first.
  Part* ended = nullptr;
  for (std::int64_t row = 0; row < grid.size() && !ended && !cancelled; ++row) {
    for (const auto& part : parts_) {
      part->go_through(t_, grid[row], observer);
      if (!part->go_to(row) && (!ended || part->end() < ended->end())) ended = part.get();
    }
    if (!ended) cancelled = !give_row(grid[row], needs, observer);
  }
  AnalysisReport total = report_of_all(ended);
  if (cancelled && total.ok()) {
    total.status = Status::cancelled;
    total.message = "stopped; the rows so far are kept";
  }
  collect_points_in_time(ended ? ended->end() : grid.last());
  if (ended && total.status == Status::lock_up) give_row_at_lock_up(*ended, needs, observer);
  total.counters += evaluator_.counters;
  total.seconds = timer.seconds();
  return total;
}

// The outcome is that of the one that ended, if one did.
AnalysisReport DynamicsOfIslands::report_of_all(const Part* ended) {
  AnalysisReport total;
  total.bodies = plan_->bodies;
  total.islands = plan_->islands;
  std::vector<Part*> in_order;
  for (const auto& part : parts_) in_order.push_back(part.get());
  std::stable_partition(in_order.begin(), in_order.end(), [&](const Part* part) { return part == ended; });
  for (Part* part : in_order) merge(total, part->dynamics().end());
  return total;
}

// The others are elsewhere when one locks, and some have gone past that instant.
void DynamicsOfIslands::give_row_at_lock_up(Part& locked, const Needs& needs, RowObserver& observer) {
  const double t = locked.end();
  if (locked.dynamics().singular_points().back().at_infinity) return;
  locked.show_last();
  for (const auto& part : parts_) {
    if (part.get() != &locked && !part->go_again_to(t, needs)) return;
  }
  give_row(t, needs, observer);
}

// What happened up to an instant, in the order of time, at one instant in the order of the mechanisms: some have gone
// past it.
void DynamicsOfIslands::collect_points_in_time(double until) {
  const auto collect = [&]<class Point>(std::vector<Point>& all, auto&& of) {
    all.clear();
    for (const auto& part : parts_) {
      for (Point& point : of(*part)) {
        if (point.t <= until) all.push_back(std::move(point));
      }
    }
    std::stable_sort(all.begin(), all.end(), [](const Point& a, const Point& b) { return a.t < b.t; });
  };
  collect(singular_points_, [](const Part& part) { return part.singular_points(); });
  collect(jolts_, [](const Part& part) { return part.jolts(); });
  collect(contact_events_, [](const Part& part) { return part.contact_events(); });
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
    const Part::Sums& sums = part->sums;
    s.residual = std::max(s.residual, sums.residual);
    s.work += sums.work;
    s.dissipated += sums.dissipated;
    s.initial_energy += sums.initial_energy;
    s.contact_energy += sums.contact_energy;
  }
  s.contacts = contacts_;
  s.driver_work = driver_work_;
  return observer.observe(s);
}

}  // namespace catena
