#include "catena/analysis/motion/energy_account.hpp"

namespace catena {

EnergyAccount::EnergyAccount(const Evaluator& evaluator) : evaluator_(evaluator) {
  const Plan& plan = evaluator.plan();
  const Model& model = evaluator.model();
  for (std::size_t e = 0; e < model.elements.size(); ++e) {
    if (model.elements[e].kind == ElementKind::driver && plan.element_row[e] >= 0) {
      drivers_.push_back({static_cast<int>(e), plan.element_row[e]});
    }
  }
  nu_.resize(static_cast<std::size_t>(plan.rows));
}

void EnergyAccount::powers(std::span<const double> qd, std::span<const double> lambda, std::span<double> out) {
  out[0] = evaluator_.dissipation(qd);
  out[1] = evaluator_.load_power(qd);
  if (drivers_.empty()) return;
  evaluator_.nu(nu_);
  for (std::size_t k = 0; k < drivers_.size(); ++k) {
    const auto row = static_cast<std::size_t>(drivers_[k].row);
    out[2 + k] = -lambda[row] * nu_[row];
  }
}

void EnergyAccount::powers_of_one(std::span<const double> qd, int driver, double power, std::span<double> out) {
  out[0] = evaluator_.dissipation(qd);
  out[1] = evaluator_.load_power(qd);
  for (std::size_t k = 0; k < drivers_.size(); ++k) out[2 + k] = drivers_[k].element == driver ? power : 0;
}

void EnergyAccount::add_jolt(std::span<const double> p, std::span<const double> before, std::span<const double> after,
                             std::span<double> work) const {
  for (std::size_t k = 0; k < drivers_.size(); ++k) {
    const auto row = static_cast<std::size_t>(drivers_[k].row);
    work[2 + k] -= p[row] * (before[row] + after[row]) / 2;
  }
}

double EnergyAccount::supplied(std::span<const double> work) {
  double sum = 0;
  for (double w : work.subspan(1)) sum += w;
  return sum;
}

void EnergyAccount::driver_work(std::span<const double> work, std::span<double> by_element) const {
  for (std::size_t k = 0; k < drivers_.size(); ++k) {
    by_element[static_cast<std::size_t>(drivers_[k].element)] = work[2 + k];
  }
}

}  // namespace catena
