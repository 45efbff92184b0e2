// An analysis that is stepped: what kinematics, dynamics and equilibrium have in common.
//
// A machine has a scene, a model of it and an analysis of this model. Places and velocities of the bodies, and the row
// of columns, are copied after every step to memory that Python sees as arrays: they follow the motion. Calls from two
// threads at once are refused. Lengths m, angles rad; bodies in the order of the scene, [x, y, phi] of their centroids.
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "catena/analysis/run/row_observer.hpp"
#include "catena/analysis/run/system_state.hpp"
#include "catena/analysis/run/time_grid.hpp"
#include "catena/columns/column_set.hpp"
#include "open_scene.hpp"

namespace catena::python {

/// While a machine is at work no other thread may use it.
class AtWork {
 public:
  explicit AtWork(std::atomic<bool>& busy) : busy_(busy) {
    if (busy_.exchange(true)) throw std::runtime_error("it is being stepped by another thread");
  }
  ~AtWork() { busy_ = false; }
  AtWork(const AtWork&) = delete;
  AtWork& operator=(const AtWork&) = delete;

 private:
  std::atomic<bool>& busy_;
};

/// Why a step is not made at all.
Report refusal(std::string message);

class Machine {
 public:
  using Numbers = std::shared_ptr<std::vector<double>>;

  virtual ~Machine() = default;

  /// One row at t; throws StepError.
  void step_to(double t);
  /// Rows at these instants; the analysis says how it ended.
  Analysis follow(const std::vector<double>& times);
  /// Changes parameters and goes on from the present state; where the scene has no such model nothing is changed.
  void set(const std::map<std::string, double>& values);
  std::vector<std::pair<std::string, double>> parameters() const { return scene_.parameters(); }

  double time() const { return t_; }
  /// The frame in which the points of a body are given. Throws std::out_of_range for a number that no body has.
  Frame<double> frame(int body) const;
  const Model& model() const { return *model_; }
  /// Number of the body in the model; -1 for the ground. Throws std::out_of_range with the names that come near.
  int body(const std::string& name) const;

  const Numbers& q() const { return q_; }
  /// Empty where no step has found them yet.
  const Numbers& qd() const { return qd_; }
  /// Values of the columns after the last step; empty before the first.
  const Numbers& row() const { return row_; }
  std::span<const ColumnInfo> columns() const { return shown_.info; }
  const std::vector<std::string>& notes() const { return shown_.notes; }
  const std::vector<std::string>& warnings() const { return shown_.warnings; }
  std::atomic<bool>& busy() const { return busy_; }

 protected:
  Machine(OpenScene scene, const ColumnSources& sources);
  /// Takes over the model; the first call is the constructor's, of the class that makes the analysis.
  virtual void use_model(std::shared_ptr<const Model> model) = 0;
  virtual const ColumnSet& resolved() = 0;
  virtual AnalysisReport run(const TimeGrid& grid, RowObserver& observer) = 0;
  virtual SystemState state() const = 0;
  void show_state();
  /// The bodies are elsewhere now.
  void forget_row() { row_.reset(); }
  /// With what the columns ask for.
  PlanOptions plan(const Model& model) const;
  ColumnSet resolve(const Model& model, const Plan& plan) const;
  AnalysisReport go(const std::vector<double>& times, ResultStorage* kept);

  OpenScene scene_;
  ColumnSources sources_;
  std::shared_ptr<const Model> model_;
  std::optional<ColumnSet> columns_;
  mutable std::atomic<bool> busy_{false};

 private:
  static void put(Numbers& numbers, std::span<const double> values);

  double t_ = 0;
  Numbers q_, qd_, row_;
  /// Of the last step.
  struct Shown {
    std::vector<ColumnInfo> info;
    std::vector<std::string> notes, warnings;
  };
  Shown shown_;
};

}  // namespace catena::python
