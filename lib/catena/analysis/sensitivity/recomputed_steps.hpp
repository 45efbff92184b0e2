// Steps of a motion recomputed by the method of Dormand and Prince of order 8, several as one where that is as good.
//
//   y1 = y0 + h sum b_s k_s,   k_s = f(t_s, Y_s),   Y_s = y0 + h sum a_sj k_j        y = [q, qd]
//   y(t) = (1 - e) y0 + e y1 + h sum c_s k_s            the interpolant of order 7, k_12 the slope at y1
//
// What derivatives along a motion are made of: states, slopes, multipliers and factors of the stages, in plain numbers,
// once for all parameters. Steps of another method are shorter than this one needs: they are joined as long as the
// recomputed end misses that of the motion by no more than single steps do. Singular where constraints depend on each
// other; not for massless bodies. Source: apps/manual/sensitivity.md; analysis/motion/tableau.hpp.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "catena/analysis/motion/equations_of_motion.hpp"
#include "catena/analysis/motion/tableau.hpp"
#include "catena/analysis/run/row_observer.hpp"

namespace catena {

/// y(t) at a part of a step.
struct InterpolantWeights {
  double end = 0;                  ///< e
  std::array<double, 16> slope{};  ///< c_s
};
InterpolantWeights interpolant_weights(double part);

/// In place of a stage: the end of the step.
inline constexpr int step_end = 16;
/// What the slope of every stage weighs in stages after it and in the end, h taken out; the interpolant's stages are
/// among them or not. The slope at the end itself is reached through the projection there. `end`: what is made of the
/// stages there.
std::array<std::vector<StageTerm>, 16> stage_weights_back(bool interpolated,
                                                          const StageSum& end = dormand_prince_8().b);

class RecomputedSteps {
 public:
  using Vector = std::vector<double>;
  struct Step {
    double from = 0, to = 0;
    Vector begin, end;  // y
  };
  /// The equations of motion at a stage, with their factors.
  struct Stage {
    Stage(const Evaluator& evaluator, std::size_t size);
    /// Of the same model: the structure of its equations need not be found again.
    Stage(const Evaluator& evaluator, const Stage& like);
    EvaluationWork work;
    Evaluator evaluator;
    EquationsOfMotion equations;
    double t = 0;
    Side side = Side::after;
    Vector y, slope, lambda;
  };
  /// Steps of the motion that are joined to one, at most.
  static constexpr std::size_t most_at_once = 16;

  explicit RecomputedSteps(const Evaluator& evaluator);

  /// Why nothing can be recomputed, as a phrase; empty: it can.
  const std::string& why_not() const { return why_not_; }
  Stage& stage(int number) { return *stages_[static_cast<std::size_t>(number)]; }
  /// Takes this stage as its first one, and gives that away with its state and factors.
  void exchange_first(std::unique_ptr<Stage>& stage) { std::swap(stages_.front(), stage); }
  /// One more, for what is not of a step.
  std::unique_ptr<Stage> make_stage();
  /// Slope and multipliers at the stage's y; false where constraints depend on each other.
  static bool evaluate(Stage& stage, double t, Side side);
  /// The step that a stretch of the motion is. `before`: the end of the last one, from which the motion goes on; it is
  /// not looked at again. Nothing where the motion could not be looked at: `at` is the instant.
  static std::optional<Step> step_of(const MotionStretch& stretch, const Vector* before, double& at);
  /// False where constraints depend on each other, at `t`.
  bool recompute(const Step& step);
  /// The end of the step that was recomputed, by its stages.
  Vector end_of(const Step& step) const;
  /// The stages of the interpolant, once the step has been recomputed.
  bool prepare_interpolant(const Step& step);
  double singular_at() const { return singular_at_; }

  /// The first step, or last one, is one by itself and tells what steps usually miss.
  void begin_anew();
  enum class From { front, back };
  /// Recomputes steps at one end of those given, as many as can be taken as one, and joins them; how many, or 0 where
  /// constraints depend on each other.
  std::size_t join(std::span<const Step> steps, From from, Step& joined);
  /// Those that are joined are to be shorter together, for a while.
  void join_less(double length);

 private:
  /// How far the recomputed end of a step lies from that of the motion, relative to what it moves by.
  double misfit(const Step& step);

  const Evaluator& evaluator_;
  std::size_t size_;
  std::string why_not_;
  std::vector<std::unique_ptr<Stage>> stages_;
  double singular_at_ = 0;
  Vector moved_;              // by a step, as it was recomputed
  double reach_ = 0;          // how long steps that are joined may be together, s
  double single_misfit_ = 0;  // of a step by itself
  int waits_ = 1;             // blocks until longer ones are tried
  int far_ = 0;               // how often two together were far off
};

}  // namespace catena
