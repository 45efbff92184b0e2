// One search for a design, as the minimiser sees it: variables in parts of their ranges, objective and constraints in
// their sizes at the start, failed designs replaced. Private to design.
//
// A design that cannot be analysed lies beyond some border. On the line from the last design that could, the border is
// approached by halving; values beyond it are those on this side continued straight, and the square of the distance
// added with a weight of ten times the objective's size, so that the search turns back without a jump.
#pragma once

#include <algorithm>
#include <limits>

#include "catena/analysis/design/design_problem.hpp"

namespace catena {

class DesignSearch final : public MinimisationProblem {
 public:
  DesignSearch(const DesignProblem& problem, const DesignOptions& options, DesignOutcome& outcome);

  int variables() const override { return static_cast<int>(problem_.lower.size()); }
  int inequalities() const override { return problem_.inequalities; }
  int equations() const override { return problem_.equations; }
  double objective(std::span<const double> u, std::span<double> gradient) override;
  void unequal(std::span<const double> u, std::span<double> g, std::span<double> jacobian) override;
  void equal(std::span<const double> u, std::span<double> h, std::span<double> jacobian) override;
  bool go_on() override;

  /// Analyses the start of a search and takes sizes from it; false where it cannot be analysed, nor any of some designs
  /// around it.
  bool begin(std::vector<double>& u);
  std::span<const double> unequal_sizes() const { return unequal_size_; }
  /// What a derivative by a variable, in parts of its range, is measured against: the largest gradient that was seen,
  /// and by how much objectives of designs that were seen differ.
  double gradient_size() const { return std::max(gradient_size_, largest_ - least_); }
  /// Analyses the design a short step away from the best one, `direction` in parts of the ranges: by how much its
  /// objective is larger. Nothing where it cannot be analysed, or misses constraints by more than `allowed` of their
  /// sizes. A better one becomes the best.
  std::optional<double> change_along(std::span<const double> direction, double allowed);
  /// The best design in parts of the ranges.
  std::vector<double> best() const;
  bool was_cancelled() const { return cancelled_; }
  /// After a search everywhere: what it left of the designs may be spent near the best one.
  void stay_near() { is_near_ = true; }
  /// How many designs were better than all before.
  int improvements() const { return improvements_; }
  /// Measures constraints and objectives by the sizes that another search has taken.
  void take_sizes(const DesignSearch& other);
  /// Takes over what another search has found, as if its designs had been analysed here one after the other; of those
  /// that are more than max_evaluations nothing. True where all of them count.
  bool absorb(const DesignSearch& other);
  /// Whether the best design has gradients, which are asked for once more where the method needed none.
  bool complete_best();

 private:
  struct Point {
    std::vector<double> u;
    DesignValues values;
  };
  /// What a search keeps of itself for absorb(): of each design that was better than all before, or failed, which one
  /// in order it was.
  struct Improvement {
    int number;
    Point point;
  };
  struct Failure {
    int number;
    std::string reason;
  };
  std::vector<double> design(std::span<const double> u) const;
  /// Analyses a design, with gradients where the method uses them; false, and counted, where it fails.
  bool analyse(std::span<const double> u, Point& point);
  /// The values at u, continued from the nearest good design where u fails.
  const Point& look(std::span<const double> u);
  void replace_failed(std::span<const double> u);
  void compare(const Point& point);
  double violation_of(const DesignValues& values) const;
  /// How many designs may be analysed before the best one is judged.
  int most_evaluations() const;

  const DesignProblem& problem_;
  DesignProblem::Evaluate evaluate_;
  const DesignOptions& options_;
  DesignOutcome& outcome_;
  bool gradients_;
  Point now_, good_;
  bool cancelled_ = false, has_sizes_ = false, is_near_ = false;
  int improvements_ = 0;
  std::vector<Improvement> improved_;
  std::vector<Failure> failures_;
  double objective_size_ = 1, gradient_size_ = 0;
  double largest_ = -std::numeric_limits<double>::infinity();  // objective so far
  double least_ = std::numeric_limits<double>::infinity();
  std::vector<double> unequal_size_, equal_size_;
};

}  // namespace catena
