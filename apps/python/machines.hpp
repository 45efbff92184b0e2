// Analyses that are stepped: what they have in common, and the three kinds.
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

#include "catena/analysis/dynamics/dynamics_with_events.hpp"
#include "catena/analysis/kinematics/kinematics.hpp"
#include "catena/analysis/statics/equilibrium.hpp"
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

  virtual double time() const = 0;
  virtual Frame<double> frame(int body) const = 0;
  const Model& model() const { return *model_; }
  /// Number of the body in the model; -1 for the ground. Throws std::out_of_range with the names that come near.
  int body(const std::string& name) const;

  const Numbers& q() const { return q_; }
  /// Empty where no step has found them yet.
  const Numbers& qd() const { return qd_; }
  /// Values of the columns after the last step; empty before the first.
  const Numbers& row() const { return row_; }
  std::span<const ColumnInfo> columns() const { return info_; }
  const std::vector<std::string>& notes() const { return notes_; }
  const std::vector<std::string>& warnings() const { return warnings_; }

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
  ColumnSet resolve(const Model& model, const Plan& plan) const;
  AnalysisReport go(const std::vector<double>& times, ResultStorage* kept);

  OpenScene scene_;
  ColumnSources sources_;
  std::shared_ptr<const Model> model_;
  std::optional<ColumnSet> columns_;
  std::atomic<bool> busy_{false};

 private:
  static void put(Numbers& numbers, std::span<const double> values);

  Numbers q_, qd_, row_;
  std::vector<ColumnInfo> info_;
  std::vector<std::string> notes_, warnings_;
};

class KinematicsMachine final : public Machine {
 public:
  KinematicsMachine(OpenScene scene, const KinematicsOptions& options);

  /// Takes a driver to a value along the branch that the mechanism is on, while time stands still; from then on the
  /// driver's value changes at this rate.
  void drive(const std::string& driver, double value, double rate);
  /// Accelerations at the present place, in the order of q().
  Numbers accelerations();
  double time() const override { return analysis_->time(); }
  Frame<double> frame(int body) const override { return analysis_->frame(body); }

 private:
  void use_model(std::shared_ptr<const Model> model) override;
  const ColumnSet& resolved() override { return *columns_; }
  AnalysisReport run(const TimeGrid& grid, RowObserver& observer) override;
  SystemState state() const override { return analysis_->state(); }
  /// By element: what drive() put in place of the scene's functions.
  using Driven = std::map<int, TimeFunction<double>>;
  std::unique_ptr<Kinematics> analysis_of(std::shared_ptr<const Model> model) const;
  /// Takes over the model with these drivers, assembled near `start` if that is given.
  void rebuild(std::shared_ptr<const Model> model, Driven driven, const std::optional<SystemState>& start);

  KinematicsOptions options_;
  std::unique_ptr<Kinematics> analysis_;
  Driven driven_;
  bool stepped_ = false;
};

class DynamicsMachine final : public Machine {
 public:
  DynamicsMachine(OpenScene scene, const DynamicsOptions& options);

  double time() const override { return state_.t; }
  Frame<double> frame(int body) const override;
  std::string_view method() const;

 private:
  void use_model(std::shared_ptr<const Model> model) override;
  const ColumnSet& resolved() override;
  AnalysisReport run(const TimeGrid& grid, RowObserver& observer) override;
  SystemState state() const override { return state_; }

  DynamicsOptions options_;
  SystemState state_;
  bool touches_ = false;  // contacts or friction: every step begins with looking what touches
  std::unique_ptr<Dynamics> free_;
  std::unique_ptr<DynamicsWithEvents> touching_;
};

class EquilibriumMachine final : public Machine {
 public:
  EquilibriumMachine(OpenScene scene, const EquilibriumOptions& options);

  double time() const override { return analysis_->time(); }
  Frame<double> frame(int body) const override { return analysis_->frame(body); }
  const EquilibriumReport& report() const { return report_; }

 private:
  void use_model(std::shared_ptr<const Model> model) override;
  const ColumnSet& resolved() override { return *columns_; }
  AnalysisReport run(const TimeGrid& grid, RowObserver& observer) override;
  SystemState state() const override { return analysis_->state(); }

  EquilibriumOptions options_;
  std::unique_ptr<Equilibrium> analysis_;
  EquilibriumReport report_;
};

}  // namespace catena::python
