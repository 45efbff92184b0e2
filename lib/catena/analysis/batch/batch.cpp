#include "catena/analysis/batch/batch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "catena/analysis/kinematics/kinematics.hpp"
#include "catena/analysis/run/time_coverage.hpp"
#include "catena/base/at.hpp"
#include "catena/columns/energy.hpp"

namespace catena {
namespace {

PlanOptions plan_options(const Model& model) {
  PlanOptions options;
  options.released_elements = model.gaps();
  return options;
}

/// Keeps the rows of one design in its lane.
class LaneRows final : public RowObserver {
 public:
  LaneRows(LaneMotion& motion, int lane) : motion_(motion), lane_(lane) {}
  bool observe(const Snapshot& row) override {
    const auto count = at(motion_.coordinates());
    const auto none = std::span<const double>{};
    const bool moves = !row.qd.empty(), is_accelerated = !row.qdd.empty();
    std::vector<double> q(row.q.begin(), row.q.begin() + static_cast<std::ptrdiff_t>(count));
    for (std::size_t b = 0; 3 * b < count; ++b) {
      q[3 * b] += row.evaluator.origin(static_cast<int>(b)).x;
      q[3 * b + 1] += row.evaluator.origin(static_cast<int>(b)).y;
    }
    motion_.put_row(next_++, lane_, q, moves ? row.qd.first(count) : none, is_accelerated ? row.qdd.first(count) : none,
                    row.lambda);
    return true;
  }

 private:
  LaneMotion& motion_;
  int lane_, next_ = 0;
};

}  // namespace

int BatchRows::place(int body, int entry) const {
  const int number = plan_->plan_body[at(body)];
  if (number >= plan_->moving || entry < 0 || entry > 2)
    throw std::out_of_range("a batch has rows of bodies that move, three numbers each");
  return lane_count * (3 * number + entry);
}

Frame<double> BatchRows::position(int row, int body, int lane) const {
  const auto number = [&](int entry) { return positions(row, body, entry)[lane]; };
  return make_frame(number(0), number(1), number(2));
}

Rates BatchRows::velocity(int row, int body, int lane) const {
  const auto number = [&](int entry) { return velocities(row, body, entry)[lane]; };
  return {number(0), number(1), number(2)};
}

Rates BatchRows::acceleration(int row, int body, int lane) const {
  const auto number = [&](int entry) { return accelerations(row, body, entry)[lane]; };
  return {number(0), number(1), number(2)};
}

const double* BatchRows::multipliers(int row, int element, int k) const {
  const int first_row = plan_->element_row[at(element)];
  if (!has_loads_ || first_row < 0)
    throw std::out_of_range("a batch has multipliers of constraints, where loads are wanted");
  return motion_->lambda(row) + lane_count * (first_row + k);
}

double BatchRows::load(int row, int element, int lane) const {
  const Model& model = *model_[at(lane)];
  const LaneProgram& program = motion_->solver().program();
  const LaneProgram::Constraint constraint = program.constraint(model, element, lane, motion_->solver().field());
  const double lambda = constraint.scale * multipliers(row, element, 0)[lane];
  if (!constraint.squared) return -lambda;
  const auto& [constant, function, law] = constraint.value;
  return -2 * (function < 0 ? constant : model.functions[at(function)].evaluate(instants_[at(row)]).f) * lambda;
}

/// One thread's designs.
class Batch::Worker {
 public:
  Worker(const Batch& batch, std::span<const double> instants, const TimeGrid& grid)
      : batch_(batch),
        instants_(instants),
        grid_(grid),
        models_(at(lane_count), *batch.model_),
        evaluator_(batch.plan_, models_.front(), evaluation_),
        motion_(*batch.program_),
        length_scale_(evaluator_.length_scale()) {
    motion_.solver().share_functions(batch.options_.same_functions);
    motion_.solver().tolerance = batch.options_.tolerance;
    rows_.motion_ = &motion_;
    rows_.plan_ = batch.plan_.get();
    rows_.rows = static_cast<int>(instants.size());
    rows_.instants_ = instants;
    rows_.has_loads_ = batch.options_.loads;
  }

  const BatchRows& follow(std::int64_t first, int count, const Design& design) {
    rows_.first = first;
    rows_.designs = count;
    for (int lane = 0; lane < lane_count; ++lane) {
      if (lane < count) design(first + lane, models_[at(lane)]);
      if (!motion_.set_design(lane, models_[at(lane < count ? lane : 0)], length_scale_))
        throw std::invalid_argument(
            fmt::format("batch: a pose, point or constant of design {} is not finite", first + lane));
      rows_.model_[at(lane)] = &models_[at(lane)];
      rows_.outcome_[at(lane)] = {};
      rows_.left_[at(lane)].clear();
    }
    const unsigned lanes = (1U << count) - 1;
    const unsigned in_lanes = assemble(lanes & ~without_mass(count));
    motion_.run(in_lanes, rows_.rows, [&](int row, int) { return instants_[at(row)]; });
    for (int lane = 0; lane < count; ++lane) {
      if (motion_.alive() & 1U << lane) continue;
      if (in_lanes & 1U << lane) rows_.left_[at(lane)] = motion_.why(lane);
      follow_alone(lane);
    }
    return rows_;
  }

 private:
  /// Loads need masses: Kinematics refuses designs that lack some.
  unsigned without_mass(int count) {
    unsigned lacking = 0;
    for (int lane = 0; batch_.options_.loads && lane < count; ++lane) {
      if (body_without_mass(models_[at(lane)], *batch_.plan_) < 0) continue;
      lacking |= 1U << lane;
      rows_.left_[at(lane)] = "a body has no mass";
    }
    return lacking;
  }

  unsigned assemble(unsigned lanes) {
    unsigned near = motion_.assemble({});
    const auto& bodies = batch_.model_->bodies;
    if (std::any_of(bodies.begin(), bodies.end(), [](const auto& b) { return b.hold_x || b.hold_y || b.hold_angle; }))
      near = 0;
    if ((lanes & ~near) == 0) return lanes;
    unsigned placed = near;
    for (int lane = 0; lane < lane_count; ++lane) {
      if (!(lanes & ~near & 1U << lane)) continue;
      evaluator_.set_model(models_[at(lane)]);
      evaluator_.set_time(0);
      evaluator_.go_to_given_curve_places();
      std::vector<double> q = evaluator_.given_configuration();
      AssemblyOutcome outcome = Assembler(evaluator_).assemble(q, batch_.options_.tolerance);
      if (!outcome.ok()) {
        rows_.left_[at(lane)] = "it is not assembled";
        continue;
      }
      for (int b = 0; b < motion_.coordinates() / 3; ++b) {
        q[at(3 * b)] += evaluator_.origin(b).x;
        q[at(3 * b + 1)] += evaluator_.origin(b).y;
      }
      motion_.set_start(lane, q, evaluator_.curve_places());
      placed |= 1U << lane;
    }
    near = motion_.assemble({});
    for (int lane = 0; lane < lane_count; ++lane) {
      if (!(lanes & placed & ~near & 1U << lane)) continue;
      const char* const trouble = motion_.solver().trouble(lane);
      rows_.left_[at(lane)] = trouble ? trouble : "it is assembled near to a singular position";
    }
    return lanes & placed & near;
  }

  void follow_alone(int lane) {
    motion_.clear_rows(lane, rows_.rows);
    KinematicsOptions options;
    options.tolerance = batch_.options_.tolerance;
    options.inverse_dynamics = batch_.options_.loads;
    Kinematics kinematics(std::make_shared<const Model>(models_[at(lane)]), plan_options(models_[at(lane)]), options);
    LaneRows rows(motion_, lane);
    Needs needs;
    needs.velocity = needs.acceleration = true;
    needs.multipliers = batch_.options_.loads;
    const AnalysisReport report = kinematics.run(grid_, needs, rows);
    rows_.outcome_[at(lane)] = static_cast<const Report&>(report);
  }

  const Batch& batch_;
  std::span<const double> instants_;
  const TimeGrid& grid_;
  std::vector<Model> models_;
  EvaluationWork evaluation_;
  Evaluator evaluator_;
  LaneMotion motion_;
  double length_scale_;
  BatchRows rows_;
};

Batch::~Batch() = default;

Batch::Batch(std::shared_ptr<const Model> model, const BatchOptions& options)
    : model_(std::move(model)), options_(options) {
  required(model_);
  if (!(options.tolerance > 0)) throw std::invalid_argument("batch: the tolerance must be above zero");
  if (options.threads < 1) throw std::invalid_argument("batch: it needs one thread at least");
  plan_ = Plan::make(*model_, plan_options(*model_));
  std::string why_not;
  program_ = LaneProgram::make(*model_, plan_, options.loads, why_not);
  if (!program_) throw std::invalid_argument("designs of this mechanism cannot be computed in lanes: " + why_not);
}

std::string Batch::obstacle(const Model& model, bool loads) {
  std::string why_not;
  return LaneProgram::make(model, Plan::make(model, plan_options(model)), loads, why_not) ? std::string() : why_not;
}

BatchReport Batch::run(std::int64_t designs, const TimeGrid& grid, const Design& design, const Take& take) {
  if (designs < 0) throw std::invalid_argument(fmt::format("batch: there are no {} designs", designs));
  std::vector<double> instants;
  for (std::int64_t k = 0; k < grid.size(); ++k) instants.push_back(grid[k]);
  if (instants.empty()) throw std::invalid_argument("batch: there are no instants at which rows are wanted");
  if (!(instants.front() >= 0) || !std::is_sorted(instants.begin(), instants.end()))
    throw std::invalid_argument("batch: instants of rows are to be in order, from zero on");
  if (const Report covered = check_time_functions(*model_, {0, instants.back()}); !covered.ok())
    throw std::invalid_argument("batch: " + covered.message);
  BatchReport report;
  std::mutex mutex;
  std::exception_ptr trouble;
  std::atomic<std::int64_t> next{0};
  std::atomic<bool> stop{false};
  const auto work = [&] {
    try {
      Worker worker(*this, instants, grid);
      while (!stop) {
        const std::int64_t first = next.fetch_add(lane_count);
        if (first >= designs) return;
        if (options_.cancel && options_.cancel->load(std::memory_order_relaxed)) stop = true;
        if (stop) return;
        const BatchRows& rows =
            worker.follow(first, static_cast<int>(std::min<std::int64_t>(lane_count, designs - first)), design);
        take(rows);
        const std::lock_guard lock(mutex);
        report.designs += rows.designs;
        for (int lane = 0; lane < rows.designs; ++lane) {
          report.in_lanes += rows.left_lane(lane).empty();
          report.failed += rows.status(lane) != Status::ok;
        }
      }
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!trouble) trouble = std::current_exception();
      stop = true;
    }
  };
  {
    std::vector<std::jthread> others;
    for (int n = 1; n < options_.threads; ++n) others.emplace_back(work);
    work();
  }
  if (trouble) std::rethrow_exception(trouble);
  report.cancelled = report.designs < designs;
  return report;
}

}  // namespace catena
