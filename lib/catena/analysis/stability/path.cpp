#include "catena/analysis/stability/path.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "catena/analysis/run/energyless_forces.hpp"
#include "catena/analysis/run/process_time.hpp"
#include "catena/analysis/run/state_conversion.hpp"
#include "catena/analysis/run/time_coverage.hpp"
#include "catena/analysis/stability/path_march.hpp"
#include "catena/analysis/statics/active_set_at.hpp"
#include "catena/analysis/statics/static_explanation.hpp"

namespace catena {

Path::Path(std::shared_ptr<const Model> model, ModelAt model_at, const PathOptions& options,
           const PlanOptions& plan_options)
    : model_(std::move(model)),
      plan_(Plan::make(required(model_), with_gaps(plan_options))),
      model_at_(std::move(model_at)),
      options_(options),
      evaluator_(plan_, *model_, evaluation_),
      system_(evaluator_),
      path_(system_, model_at_, options.from, std::max(std::abs(options.to - options.from), 1e-300)),
      q_(evaluator_.given_configuration()) {
  if (!model_at_)
    throw std::invalid_argument("path: there is nothing that makes models at other values of the parameter");
  if (!std::isfinite(options.from) || !std::isfinite(options.to))
    throw std::invalid_argument("path: the values from and to of the parameter must be finite");
  if (!(options.arc > 0) || !std::isfinite(options.arc))
    throw std::invalid_argument("path: arc, the length of a step, must be above zero");
}

void Path::start_from(const SystemState& state) {
  t_ = state.t;
  q_ = configuration_of(evaluator_, state);
}

SystemState Path::state() const { return state_of(evaluator_, t_, q_); }

Report Path::follow(PathReport& report, const std::function<bool(double, const Snapshot&)>& observe) {
  evaluator_.set_time(t_);
  path_.set_time(t_);
  if (path_.is_circulatory() && system_.has_gaps()) return refuse_gaps_without_energy(system_);
  if (options_.to == options_.from) {
    return {Status::refused, "the path ends where it begins: \"to\" is the present value of the parameter", {}};
  }
  if (path_.is_circulatory()) {
    system_.move_to(q_);
    const MotionGroups groups(system_, false);
    if (!groups.are_small())
      return too_large_without_energy(evaluator_.model(), groups.freedoms(), CirculatoryMotions::most_freedoms);
  }
  March march(*this, observe);
  Report outcome = march.run(report);
  if (!path_.lack_of_masses().empty())
    report.warnings.push_back("flutter depends on masses, and was not looked for: " + path_.lack_of_masses());
  if (!march.point().q.empty()) {
    path_.move_to(march.point());
    q_.assign(path_.q().begin(), path_.q().end());
  }
  return outcome;
}

PathReport Path::run(const std::function<bool(double, const Snapshot&)>& observe) {
  const ProcessTimer timer;
  PathReport report;
  report.bodies = static_cast<int>(model_->bodies.size());
  report.rows = plan_->rows;
  report.islands = plan_->islands;
  Report outcome = check_time_functions(*model_, {t_, t_});
  if (outcome.ok()) outcome = follow(report, observe);
  report.status = outcome.status;
  report.message = std::move(outcome.message);
  report.warnings.insert(report.warnings.end(), outcome.warnings.begin(), outcome.warnings.end());
  report.counters = evaluator_.counters;
  report.seconds = timer.seconds();
  return report;
}

}  // namespace catena
