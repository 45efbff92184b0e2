// A problem as Ipopt takes it, and the run itself: the only door to that library.
//
//   min f(x)   subject to   x_low <= x <= x_high,   g_low <= g(x) <= g_high
//
// Derivatives of g and of the Lagrangian as lists of places (row, column) and values, the latter the lower triangle.
// One problem at a time runs in a process: MUMPS shares its workspace. The turn is recursive, because a design that
// Ipopt asks for may itself be an equilibrium by Ipopt, within the same thread, while the outer one waits. Source:
// Waechter, Biegler, Math. Program. 106 (2006).
#pragma once

#include <span>

namespace catena {

// Ipopt takes any value beyond 1e19 as no bound.
inline constexpr double ipopt_no_bound = 2e19;

class IpoptProgram {
 public:
  /// Numbers of variables, rows of g, entries of their derivatives, entries of the Lagrangian's second derivatives;
  /// `hessian` below zero: these are made of changes of gradients.
  struct Size {
    int variables = 0, rows = 0, jacobian = 0, hessian = -1;
  };
  struct Place {
    int row, column;
  };

  virtual ~IpoptProgram() = default;
  virtual Size size() const = 0;
  virtual void bounds(std::span<double> x_low, std::span<double> x_high, std::span<double> g_low,
                      std::span<double> g_high) = 0;
  /// lambda is wanted where its span is not empty: at a warm start.
  virtual void start(std::span<double> x, std::span<double> lambda) = 0;
  virtual double objective(const double* x) = 0;
  virtual void gradient(const double* x, std::span<double> out) = 0;
  virtual void rows(const double* x, std::span<double> g) = 0;
  virtual Place jacobian_place(int entry) const = 0;
  virtual void jacobian(const double* x, std::span<double> values) = 0;
  virtual Place hessian_place(int entry) const { return {entry, entry}; }
  /// Of factor f + lambda^T g.
  virtual void hessian(const double* x, double factor, const double* lambda, std::span<double> values) {
    static_cast<void>(x), static_cast<void>(factor), static_cast<void>(lambda), static_cast<void>(values);
  }
  /// Asked after every iteration: whether to go on.
  virtual bool go_on(int iteration) = 0;
  /// Where it ended.
  virtual void finish(const double* x, const double* lambda) = 0;
};

struct IpoptSettings {
  int max_iterations = 500;
  double tolerance = 1e-11;
  double acceptable = 1e4;  ///< so many tolerances, met `acceptable_iterations` times in a row, will do
  int acceptable_iterations = 8;
  double constraint_tolerance = 0;  ///< 0: Ipopt's own
  double relaxed_bounds = -1;       ///< part by which bounds may be passed; below zero: Ipopt's own
  bool warm = false;                ///< start() is near a solution, with its multipliers
  bool verbose = false;             ///< its log to standard error
};

enum class IpoptEnd {
  solved,
  acceptable,
  infeasible,  ///< at a place where the rows are met as nearly as can be
  diverging,
  tiny_steps,
  slow,     ///< max_iterations
  stopped,  ///< go_on() said no
  failed,
  unavailable,  ///< it could not be begun, or is not built in
};

/// Whether the library was built with Ipopt (CATENA_WITH_IPOPT).
bool ipopt_program_is_built_in();

IpoptEnd run_ipopt(IpoptProgram& program, const IpoptSettings& settings);

}  // namespace catena
