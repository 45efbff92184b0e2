#include "machine.hpp"

#include <algorithm>

#include "catena/scene/json/near_miss.hpp"
#include "catena/scene/judging/distance_check.hpp"
#include "catena/scene/running/analysis_run.hpp"

namespace catena::python {
namespace {

/// Keeps rows, and ends the work when Ctrl-C is pressed.
class StepRows final : public RowObserver {
 public:
  StepRows(const ColumnSet& columns, ResultStorage* kept, SignalWatch& signals)
      : columns_(columns), kept_(kept), signals_(signals), values_(columns.size()) {
    if (kept_) kept_->begin(columns_.info());
  }

  bool observe(const Snapshot& snapshot) override {
    columns_.evaluate(snapshot, values_);
    seen_ = true;
    return (!kept_ || kept_->row(values_)) && signals_.go_on();
  }
  bool proceed(double) override { return signals_.go_on(); }

  /// The last row, if there was any.
  std::span<const double> row() const { return seen_ ? std::span<const double>(values_) : std::span<const double>{}; }

 private:
  const ColumnSet& columns_;
  ResultStorage* kept_;
  SignalWatch& signals_;
  std::vector<double> values_;
  bool seen_ = false;
};

}  // namespace

Report refusal(std::string message) {
  Report report;
  report.status = Status::refused;
  report.message = std::move(message);
  return report;
}

Machine::Machine(OpenScene scene, const ColumnSources& sources) : scene_(std::move(scene)), sources_(sources) {}

int Machine::body(const std::string& name) const {
  const int body = model_->find_body(name);
  if (body >= ground) return body;
  std::vector<std::string> known;
  for (int b = 0; b < static_cast<int>(std::min<std::size_t>(model_->bodies.size(), 2000)); ++b)
    known.emplace_back(model_->body_name(b));
  throw py::key_error("there is no body " + in_quotes(name) + NearMiss(name).consider_all(known).hint());
}

Frame<double> Machine::frame(int body) const {
  static_cast<void>(model_->body_name(body));  // throws for an invalid number
  if (body < 0) return {};
  const double* const q = q_->data() + 3 * static_cast<std::size_t>(body);
  Frame<double> frame = make_frame(q[0], q[1], q[2]);
  const Vec2<double> origin = frame.point(model_->bodies[static_cast<std::size_t>(body)].origin);
  frame.x = origin.x;
  frame.y = origin.y;
  return frame;
}

PlanOptions Machine::plan(const Model& model) const {
  return plan_options(model, {scene_.outputs().begin(), scene_.outputs().end()});
}

ColumnSet Machine::resolve(const Model& model, const Plan& plan) const {
  return ColumnSet::resolve(model, plan, scene_.outputs(), sources_);
}

// The memory stays where it is unless the number of values changes: arrays see the new ones.
void Machine::put(Numbers& numbers, std::span<const double> values) {
  if (!numbers || numbers->size() != values.size()) numbers = std::make_shared<std::vector<double>>(values.size());
  std::copy(values.begin(), values.end(), numbers->begin());
}

void Machine::show_state() {
  const SystemState now = state();
  t_ = now.t;
  if (now.q.empty()) {
    std::vector<double> given;
    for (int b = 0; b < static_cast<int>(model_->bodies.size()); ++b) {
      const Frame<double> frame = model_->frame(b);
      given.insert(given.end(), {frame.x, frame.y, frame.phi});
    }
    put(q_, given);
  } else {
    put(q_, now.q);
  }
  if (now.qd.empty()) {
    qd_.reset();
  } else {
    put(qd_, now.qd);
  }
}

AnalysisReport Machine::go(const std::vector<double>& times, ResultStorage* kept) {
  const TimeGrid grid = TimeGrid::list(times);
  AnalysisReport report;
  if (const auto problem = vanishing_distance(*model_, t_, grid)) {
    static_cast<Report&>(report) = refusal(*problem);
    return report;
  }
  const ColumnSet& columns = resolved();
  shown_.info.assign(columns.info().begin(), columns.info().end());
  shown_.notes.assign(columns.notes().begin(), columns.notes().end());
  SignalWatch signals;
  StepRows rows(columns, kept, signals);
  {
    const py::gil_scoped_release free;
    report = run(grid, rows);
  }
  if (!rows.row().empty()) put(row_, rows.row());
  show_state();
  shown_.warnings = report.warnings;
  if (signals.interrupted()) throw py::error_already_set();
  return report;
}

void Machine::step_to(double t) {
  const AtWork work(busy_);
  const AnalysisReport report = go({t}, nullptr);
  if (!report.ok()) throw StepError(report);
}

Analysis Machine::follow(const std::vector<double>& times) {
  const AtWork work(busy_);
  if (times.empty()) throw std::invalid_argument("there are no instants to go to");
  auto rows = std::make_shared<ResultStorage>();
  AnalysisResult result;
  result.type = std::string(sources_.analysis);
  result.report = go(times, rows.get());
  return {std::move(result), std::move(rows)};
}

void Machine::set(const std::map<std::string, double>& values) {
  const AtWork work(busy_);
  const ParameterSeeds before = scene_.changes();
  const Shown shown = shown_;
  const std::vector<double> row = row_ ? *row_ : std::vector<double>();
  scene_.set(values);
  try {
    use_model(scene_.model());
  } catch (...) {
    scene_.put_back(before);
    shown_ = shown;
    if (!row.empty()) put(row_, row);
    show_state();
    throw;
  }
  show_state();
}

}  // namespace catena::python
