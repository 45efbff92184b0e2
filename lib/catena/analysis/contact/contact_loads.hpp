// The forces of contacts while none of them changes its state: compliant ones press, closed ones slide or stick.
//
//   N_k = -lambda_k (rigid), k d^n + c d' (compliant), |(lambda_1, lambda_2)| of a joint
//   friction on j along the slide:  f_k = -mu sigma_k N_k        sigma_k: sign of the slip, or tanh(slip / vs)
//   f + mu sigma N(f) = 0           N(f) = N(lambda_0 + B f)       B_l: multipliers that a unit of friction l makes
//
// Friction of a joint that others keep from slipping is a part of N, or of the friction of one of these, in place of
// mu sigma N (same_slides.hpp).
// A grip of an inextensible rope (rope_grips.hpp) has f_k = -(1 - e^(-sigma_k E_k)) T_k-1, with T_k-1 = -lambda + f_1 +
// ... + f_k-1 of the same rope in place of N; those of an elastic one follow from the place (elastic_grips.hpp).
//
// As the multipliers are linear in the friction, the sizes of all friction forces follow from a system of as many
// equations, solved by Newton's method (one step without joints): reactions and friction are those of the same instant.
// Where its determinant is not positive - it is 1 without friction - there is no such friction, or there are several
// (Painleve): complete() is then false and trouble() says so. Source: Stewart, Rigid-body dynamics with friction and
// impact, SIAM Review 42 (2000). Units as in contact_points.hpp.
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "catena/analysis/contact/contact_points.hpp"
#include "catena/analysis/contact/elastic_grips.hpp"
#include "catena/analysis/motion/state_loads.hpp"
#include "catena/assembly/evaluate.hpp"
#include "catena/columns/snapshot.hpp"

namespace catena {

/// Of the largest speed so far, divided by the length scale for rates of angles: what cannot be told from rest after an
/// impact or at the end of a slide.
constexpr double no_speed = 1e-9;
/// Of Newton's method on the forces of friction, which are nearly linear in each other: without joints one step is
/// exact, with joints the error is squared in every step.
constexpr int most_friction_iterations = 30;

class ContactLoads final : public StateLoads {
 public:
  /// `points` must outlive this object.
  ContactLoads(const Evaluator& evaluator, const std::vector<ContactPoint>& points, std::vector<ContactState> states);
  ~ContactLoads() override;

  void add(std::span<const double> qd, std::span<double> loads) override;
  bool complete(EquationsOfMotion& equations, std::span<const double> gamma, std::span<double> loads,
                std::span<double> qdd, std::span<double> lambda) override;
  // The steps of complete(), for loads that others solve with: after add(), response(l) takes the multipliers that
  // unit_load(l) makes, l below coupled(); then the friction is found and added, and finish() reads the multipliers
  // with it.
  std::size_t coupled() const { return coupled_.size(); }
  std::span<const double> unit_load(std::size_t l);
  std::span<double> response(std::size_t l) { return response_[l]; }
  /// lambda: multipliers without that friction. False: see trouble().
  bool find_sizes(std::span<const double> lambda);
  void add_friction(std::span<double> loads);
  void finish(std::span<const double> lambda);

  double dissipation() const override { return lost_; }
  double energy() const override;
  bool dissipates() const override { return dissipates_; }
  std::string trouble() const override { return trouble_; }

  /// After complete(), where multipliers are not unique: what presses and sticks is that of `lambda`, as good as those
  /// of the accelerations. Friction that slides depends on what presses: then nothing is changed.
  void take_share(std::span<const double> lambda) {
    if (coupled_.empty()) finish(lambda);
  }
  /// After complete(): what point k presses with, its friction, its slip.
  double normal(std::size_t k) const { return normal_[k]; }
  double friction(std::size_t k) const { return friction_[k]; }
  /// E of a grip of an inextensible rope, at the last evaluation.
  double exponent(std::size_t k) const { return exponent_[k]; }
  double slip(std::size_t k) const { return slide_[k].rate; }
  /// What presses a place, from multipliers: of a joint its whole force; of a compliant place the force at the
  /// evaluator's configuration, negative where it would have to pull; of an inextensible rope's grip the tension before
  /// it.
  double normal_from(std::size_t k, std::span<const double> qd, std::span<const double> lambda) const;
  /// Scatters what presses, friction and slip to `loads`, one entry an element.
  void scatter(std::span<ContactLoad> loads) const;
  /// The largest speed that the motion has had. Forces are asked for at others as well: stages of steps that are too
  /// long, and given up, may be faster by many powers of ten.
  double speed() const { return speed_; }
  void know_speed(double speed) { speed_ = std::max(speed_, speed); }
  /// Whether rigid places are closed, or exact friction holds or rubs: what a jump of velocities may end.
  bool holds() const { return holds_; }
  /// Rows of closed places and of slides that stick: what they hold, they hold for the time being.
  int rows() const { return rows_; }

 private:
  double compliant_force(const ContactPoint& point, const Evaluator::ScalarMotion& gap) const;
  double joint_force(const ContactPoint& point, std::span<const double> lambda) const;
  double tension_before(std::size_t k, std::span<const double> lambda) const;
  double tension_of_sizes(std::size_t k) const;
  double tension_terms(std::size_t k) const;
  double tension_slope(std::size_t k, std::span<const double> along, std::size_t sliding) const;
  double growth(std::size_t k) const;
  int row_of_slide(std::size_t k) const;
  double joint_slope(const ContactPoint& point, std::span<const double> lambda, std::span<const double> along) const;
  bool slides(std::size_t k) const;
  double sigma(std::size_t k) const;
  double coefficient(std::size_t k) const;
  int row_of_master(std::size_t k) const;
  bool is_guide(const ContactPoint& point) const;
  void find_responses(EquationsOfMotion& equations);
  void find_residual(std::span<const double> lambda);
  void find_slope();

  const Evaluator& evaluator_;
  const std::vector<ContactPoint>& points_;
  std::vector<ContactState> states_;
  std::vector<Evaluator::ScalarMotion> slide_;
  std::vector<double> normal_, friction_, exponent_;
  std::vector<ElasticGrips> elastic_;  // ropes
  std::vector<std::size_t> coupled_;   // whose friction depends on multipliers
  std::vector<double> unit_, change_, nothing_;
  std::vector<std::vector<double>> response_;  // multipliers, by coupled point
  struct Sizes;
  std::unique_ptr<Sizes> sizes_;  // of the friction forces of coupled points, and Newton's method for them
  double lost_ = 0, lost_in_springs_ = 0, speed_ = 0;
  bool dissipates_ = false, holds_ = false;
  int rows_ = 0;
  std::string trouble_;
};

/// Names of the elements of some points, in quotes, for messages.
std::string names_of(const Model& model, const std::vector<ContactPoint>& points, std::span<const std::size_t> which);

/// The largest velocity of a body, m/s; of its turning, rad/s, times the length scale.
double fastest(const Evaluator& evaluator, std::span<const double> qd);

/// The rate of a point's slide, or gap, that a speed of the motion stands for, m/s or rad/s.
inline double rate_of_speed(const ContactPoint& point, double speed, double length_scale) {
  return speed / (point.turns ? length_scale : 1);
}

/// The sign of a rate; 0: it is not faster than `none`.
inline int direction_of(double rate, double none) { return rate > none ? 1 : rate < -none ? -1 : 0; }

/// loads += factor x gradient of a scalar equation.
void scatter_gradient(const Evaluator::ScalarMotion& of, double factor, std::span<double> loads);

}  // namespace catena
