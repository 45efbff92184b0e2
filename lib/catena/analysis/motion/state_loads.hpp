// Forces that an analysis adds to those of the model's force elements, and that may depend on the multipliers of the
// same instant: compliant contacts, and dry friction, which is mu times a normal force that is itself a multiplier.
//
//   M qdd + Phi_q^T lambda = Q + Q_a(q, qd) + Q_m(q, qd, lambda)        Phi_q qdd = gamma
//
// EquationsOfMotion asks for Q_a before its solve and has Q_m completed after it. One virtual call each an evaluation.
// Vectors have plan.coordinates() entries in plan order. Units: N, N m, W, J.
#pragma once

#include <span>
#include <string>

namespace catena {

class EquationsOfMotion;

class StateLoads {
 public:
  virtual ~StateLoads() = default;

  /// Adds Q_a at the evaluator's configuration to `loads`.
  virtual void add(std::span<const double> qd, std::span<double> loads) = 0;
  /// Changes `loads`, qdd and lambda, which the equations solved for without Q_m, to those with it. False: there is no
  /// such force, or none that is unique; trouble() then says why.
  virtual bool complete(EquationsOfMotion& equations, std::span<const double> gamma, std::span<double> loads,
                        std::span<double> qdd, std::span<double> lambda) = 0;
  /// Power lost at the last evaluation.
  virtual double dissipation() const = 0;
  /// Energy stored at the evaluator's configuration, in elastic contacts.
  virtual double energy() const = 0;
  /// Whether any power is lost at all.
  virtual bool dissipates() const = 0;
  virtual std::string trouble() const = 0;
};

}  // namespace catena
