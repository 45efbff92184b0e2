// Gradients of motions by SUNDIALS CVODES, for `catena bench --peers`: a chain of rods in the least coordinates with
// hand-written derivatives (cases/pendulum_gradient.hpp), by the adjoint and forward, at several tolerances.
//
//   peer_cvodes gradient      prints  S5 <tab> cvodes <tab> method <tab> tolerance <tab> rods <tab> ms <tab> parameters
//                             <tab> error
//
// f_y^T and f_p^T of v = M^-1 (adjoint of the rates) and a = the accelerations:
//   S = -sum_ij v_i a_ij (sin(phi_i - phi_j) phid_j^2 + cos(phi_i - phi_j) a_j) - g sum_i v_i lever_i cos(phi_i)
// Times are processor times, the least of several. A reference is computed first, with no code of CVODES.
#include <cvodes/cvodes.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <cstdio>
#include <cstring>
#include <ctime>
#include <limits>

#include "cases/pendulum_gradient.hpp"

namespace {

using bench::PendulumChain;
using Values = std::vector<double>;

double processor_time() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double* data(N_Vector v) { return N_VGetArrayPointer(v); }

/// The chain with what the derivatives need.
struct Problem {
  explicit Problem(int rods)
      : chain(Values(static_cast<std::size_t>(rods), 1.0), Values(static_cast<std::size_t>(rods), 1.0)),
        n(static_cast<std::size_t>(rods)),
        acceleration(n),
        v(n),
        rest(n),
        prefix(n) {}

  void move_to(const double* y) {
    chain.factorize(y);
    chain.accelerations(y + n, acceleration.data());
  }
  /// out = f_y^T l for l of the length 2 n; by_p (if any) = f_p^T l.
  void transpose(const double* y, const double* l, double* out, double* by_p) {
    move_to(y);
    std::copy(l + n, l + 2 * n, v.begin());
    chain.solve(v.data());
    const double* rate = y + n;
    for (std::size_t i = 0; i < n; ++i) {
      if (out) out[i] = bench::pendulum_gravity * v[i] * chain.lever(i) * chain.sine(i);
      if (out) out[n + i] = l[i];
      prefix[i] = 0;
    }
    if (by_p) std::fill(by_p, by_p + 2 * n, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        const double s = chain.sine_of(i, j), c = chain.cosine_of(i, j), a = chain.coupling(i, j),
                     w2 = rate[j] * rate[j];
        const double by_angle = v[i] * a * (c * w2 - s * acceleration[j]);
        if (out) {
          out[i] -= by_angle;
          out[j] += by_angle;
          out[n + j] -= 2 * v[i] * a * s * rate[j];
        }
        if (!by_p) continue;
        const double term = v[i] * a * (s * w2 + c * acceleration[j]);
        by_p[i] -= term / chain.length()[i];
        by_p[j] -= term / chain.length()[j];
        const std::size_t k = std::max(i, j);
        const double of_mass = term / chain.weight(i, j);
        by_p[n + k] -= of_mass / (i == j ? 3 : 2);
        prefix[k] += of_mass;
      }
    }
    if (!by_p) return;
    double sum = 0, gravity = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const double moment = bench::pendulum_gravity * v[k] * chain.length()[k] * chain.cosine(k);
      by_p[k] -= moment * chain.lever(k) / (chain.length()[k] * chain.length()[k]);
      by_p[n + k] -= moment / 2 + sum + gravity;
      sum += prefix[k];
      gravity += moment;
    }
  }
  /// out = f_y s + f_p for parameter p.
  void along(const double* y, const double* s, int p, double* out) {
    const double* rate = y + n;
    for (std::size_t i = 0; i < n; ++i) {
      out[i] = s[n + i];
      double sum = bench::pendulum_gravity * chain.lever(i) * chain.sine(i) * s[i];
      for (std::size_t j = 0; j < n; ++j) {
        const double sine = chain.sine_of(i, j), c = chain.cosine_of(i, j), a = chain.coupling(i, j);
        const double w2 = rate[j] * rate[j], b = acceleration[j];
        sum -= a * ((c * w2 - sine * b) * (s[i] - s[j]) + 2 * sine * rate[j] * s[n + j]);
        sum -= coupling_by(i, j, p) * (sine * w2 + c * b);
      }
      rest[i] = sum - bench::pendulum_gravity * lever_by(i, p) * chain.cosine(i);
    }
    chain.solve(rest.data());
    std::copy(rest.begin(), rest.end(), out + n);
  }
  double coupling_by(std::size_t i, std::size_t j, int p) const {
    const auto q = static_cast<std::size_t>(p);
    if (q < n) return ((q == i) + (q == j)) * chain.coupling(i, j) / chain.length()[q];
    const std::size_t k = std::max(i, j), m = q - n;
    const double part = m > k ? 1 : m == k ? (i == j ? 1.0 / 3 : 0.5) : 0;
    return chain.length()[i] * chain.length()[j] * part;
  }
  double lever_by(std::size_t i, int p) const {
    const auto q = static_cast<std::size_t>(p);
    if (q < n) return q == i ? chain.lever(i) / chain.length()[i] : 0;
    const std::size_t m = q - n;
    return chain.length()[i] * (m > i ? 1 : m == i ? 0.5 : 0);
  }

  PendulumChain<double> chain;
  std::size_t n;
  Values acceleration, v, rest, prefix;
  std::vector<int> parameters{};  // of forward derivatives
};

int slope(double, N_Vector y, N_Vector out, void* user) {
  Problem& problem = *static_cast<Problem*>(user);
  problem.move_to(data(y));
  std::copy(data(y) + problem.n, data(y) + 2 * problem.n, data(out));
  std::copy(problem.acceleration.begin(), problem.acceleration.end(), data(out) + problem.n);
  return 0;
}
int slope_back(double, N_Vector y, N_Vector l, N_Vector out, void* user) {
  Problem& problem = *static_cast<Problem*>(user);
  problem.transpose(data(y), data(l), data(out), nullptr);
  N_VScale(-1, out, out);
  return 0;
}
int integrand_back(double, N_Vector y, N_Vector l, N_Vector out, void* user) {
  static_cast<Problem*>(user)->transpose(data(y), data(l), nullptr, data(out));
  N_VScale(-1, out, out);  // it is integrated from the end to the start
  return 0;
}
int slope_of_all(int count, double, N_Vector y, N_Vector, N_Vector* s, N_Vector* out, void* user, N_Vector, N_Vector) {
  Problem& problem = *static_cast<Problem*>(user);
  problem.move_to(data(y));
  for (int k = 0; k < count; ++k)
    problem.along(data(y), data(s[k]), problem.parameters[static_cast<std::size_t>(k)], data(out[k]));
  return 0;
}

/// d(height)/d(parameter) at fixed angles, added.
double direct(const Problem& problem, const double* y, int p) {
  return static_cast<std::size_t>(p) < problem.n
             ? bench::height_weight(static_cast<std::size_t>(p), problem.n) * std::sin(y[p])
             : 0;
}

/// Whatever CVODES needs for one solution.
struct Solver {
  SUNContext context = nullptr;
  void* memory = nullptr;
  N_Vector y = nullptr;
  SUNNonlinearSolver fixed_point = nullptr;

  Solver(Problem& problem, double tolerance) {
    SUNContext_Create(nullptr, &context);
    const auto size = static_cast<sunindextype>(2 * problem.n);
    y = N_VNew_Serial(size, context);
    N_VConst(0, y);
    for (std::size_t k = 0; k < problem.n; ++k) data(y)[k] = bench::start_angle(k);
    memory = CVodeCreate(CV_ADAMS, context);
    CVodeInit(memory, slope, 0, y);
    CVodeSStolerances(memory, tolerance, tolerance);
    CVodeSetUserData(memory, &problem);
    CVodeSetMaxNumSteps(memory, 1000000);
    fixed_point = SUNNonlinSol_FixedPoint(y, 0, context);
    CVodeSetNonlinearSolver(memory, fixed_point);
  }
  Solver(const Solver&) = delete;
  Solver& operator=(const Solver&) = delete;
  ~Solver() {
    CVodeFree(&memory);
    SUNNonlinSolFree(fixed_point);
    N_VDestroy(y);
    SUNContext_Free(&context);
  }
};

/// By all parameters.
Values adjoint(Problem& problem, double duration, double tolerance) {
  Solver solver(problem, tolerance);
  CVodeAdjInit(solver.memory, 100, CV_POLYNOMIAL);
  double t = 0;
  int points = 0, number = 0;
  if (CVodeF(solver.memory, duration, solver.y, &t, CV_NORMAL, &points) < 0) return {};
  const auto size = static_cast<sunindextype>(2 * problem.n);
  N_Vector l = N_VNew_Serial(size, solver.context), integral = N_VNew_Serial(size, solver.context);
  const Values end(data(solver.y), data(solver.y) + 2 * problem.n);
  N_VConst(0, integral);
  for (std::size_t k = 0; k < problem.n; ++k) {
    data(l)[k] = bench::height_weight(k, problem.n) * problem.chain.length()[k] * std::cos(end[k]);
    data(l)[problem.n + k] = 0;
  }
  CVodeCreateB(solver.memory, CV_ADAMS, &number);
  CVodeInitB(solver.memory, number, slope_back, duration, l);
  CVodeSStolerancesB(solver.memory, number, tolerance, tolerance);
  CVodeSetUserDataB(solver.memory, number, &problem);
  CVodeSetMaxNumStepsB(solver.memory, number, 1000000);
  SUNNonlinearSolver fixed_point = SUNNonlinSol_FixedPoint(l, 0, solver.context);
  CVodeSetNonlinearSolverB(solver.memory, number, fixed_point);
  CVodeQuadInitB(solver.memory, number, integrand_back, integral);
  CVodeQuadSStolerancesB(solver.memory, number, tolerance, tolerance);
  CVodeSetQuadErrConB(solver.memory, number, 1);
  Values gradient;
  if (CVodeB(solver.memory, 0, CV_NORMAL) >= 0) {
    CVodeGetQuadB(solver.memory, number, &t, integral);
    for (int p = 0; p < static_cast<int>(2 * problem.n); ++p)
      gradient.push_back(data(integral)[p] + direct(problem, end.data(), p));
  }
  SUNNonlinSolFree(fixed_point);
  N_VDestroy(l);
  N_VDestroy(integral);
  return gradient;
}

/// By problem.parameters.
Values forward(Problem& problem, double duration, double tolerance) {
  Solver solver(problem, tolerance);
  const int count = static_cast<int>(problem.parameters.size());
  N_Vector* s = N_VCloneVectorArray(count, solver.y);
  for (int k = 0; k < count; ++k) N_VConst(0, s[k]);
  CVodeSensInit(solver.memory, count, CV_STAGGERED, slope_of_all, s);
  Values scale(static_cast<std::size_t>(count), 1.0), absolute(static_cast<std::size_t>(count), tolerance);
  CVodeSensSStolerances(solver.memory, tolerance, absolute.data());
  CVodeSetSensErrCon(solver.memory, 1);
  SUNNonlinearSolver fixed_point = SUNNonlinSol_FixedPointSens(count, solver.y, 0, solver.context);
  CVodeSetNonlinearSolverSensStg(solver.memory, fixed_point);
  double t = 0;
  Values gradient;
  if (CVode(solver.memory, duration, solver.y, &t, CV_NORMAL) >= 0) {
    CVodeGetSens(solver.memory, &t, s);
    for (int k = 0; k < count; ++k) {
      const int p = problem.parameters[static_cast<std::size_t>(k)];
      double sum = direct(problem, data(solver.y), p);
      for (std::size_t i = 0; i < problem.n; ++i)
        sum += bench::height_weight(i, problem.n) * problem.chain.length()[i] * std::cos(data(solver.y)[i]) *
               data(s[k])[i];
      gradient.push_back(sum);
    }
  }
  SUNNonlinSolFree(fixed_point);
  N_VDestroyVectorArray(s, count);
  return gradient;
}

template <class Solve>
void measure(const char* method, double tolerance, const bench::PendulumProblem& of, int parameters,
             const std::array<double, bench::compared_parameters>& exact, Solve&& solve) {
  constexpr double budget = 0.3;  // s of repeats
  double least = std::numeric_limits<double>::infinity(), spent = 0;
  std::array<double, bench::compared_parameters> found{};
  for (int repeat = 0; repeat < 3 || (spent < budget && repeat < 1000); ++repeat) {
    const double start = processor_time();
    if (!solve(found)) return;
    const double seconds = processor_time() - start;
    least = std::min(least, seconds);
    spent += seconds;
  }
  std::printf("S5\tcvodes\t%s\t%.0e\t%d\t%.6g\t%d\t%.3g\n", method, tolerance, of.rods, 1e3 * least, parameters,
              bench::gradient_error(found, exact));
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 2 || std::strcmp(arguments[1], "gradient") != 0) {
    std::fprintf(stderr, "usage: peer_cvodes gradient\n");
    return 2;
  }
  for (const bench::PendulumProblem& of : bench::pendulum_problems) {
    const auto exact = bench::pendulum_gradient(of.rods, of.duration);
    Problem problem(of.rods);
    const auto chosen = bench::compared(of.rods);
    problem.parameters.assign(chosen.begin(), chosen.end());
    for (const double tolerance : {1e-5, 1e-7, 1e-9, 1e-11}) {
      measure("adjoint", tolerance, of, 2 * of.rods, exact, [&](auto& found) {
        const Values all = adjoint(problem, of.duration, tolerance);
        for (std::size_t p = 0; p < found.size() && !all.empty(); ++p)
          found[p] = all[static_cast<std::size_t>(chosen[p])];
        return !all.empty();
      });
      measure("forward", tolerance, of, bench::compared_parameters, exact, [&](auto& found) {
        const Values all = forward(problem, of.duration, tolerance);
        for (std::size_t p = 0; p < found.size() && !all.empty(); ++p) found[p] = all[p];
        return !all.empty();
      });
    }
  }
  return 0;
}
