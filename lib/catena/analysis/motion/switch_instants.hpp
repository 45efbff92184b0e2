// Instants at which laws of state take another branch (columns/switches.hpp) in a motion that is differentiated.
//
//   g(y(t*), p, t*) = 0        t*_p = -(g_y y_p- + g_p) / g'        g' = g_y y'- + g_t
//   y_p+ = y_p- + (y'- - y'+) t*_p
//
// g: what is compared with zero. Where the law only bends y'- = y'+, and it is enough that steps of the derivatives end
// there: with stages on both sides they would miss by what the derivative of the law jumps by, times the length of the
// step. Where it jumps, as v / |v| does, the state's derivatives do so as well. A step of the motion that has such an
// instant inside shows velocities in it that are smoothed: derivatives go on from its beginning by steps of their own,
// each over 7/8 of the way to where g comes to zero at its present rate, so that no stage is beyond, until g is told
// from zero by rounding only just; and they begin again as far behind. y'- and y'+ are those there.
//
// Not all that jumps is compared: x / sqrt(x^2), atan(1 / x), and what is as steep as a jump. A step in which all that
// accelerations change by lies between two neighbouring stages has such an instant inside, of which no more is known.
//
// None: these; a law that jumps where g comes to zero without a rate, or is driven back by the other branch; two at one
// instant that move apart with the parameters. Units: s. Source: R. I. Leine, H. Nijmeijer, Dynamics and Bifurcations
// of Non-Smooth Mechanical Systems (2004), chapter 7.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "catena/analysis/run/row_observer.hpp"
#include "catena/assembly/design/design_mechanism.hpp"
#include "catena/columns/column_set.hpp"

namespace catena {

class SwitchInstants {
 public:
  using Vector = std::vector<DesignScalar>;
  SwitchInstants(const Model& model, const Plan& plan);

  bool any() const { return columns_.has_value(); }
  /// Instants that are one to rounding are one switch, of all these columns.
  struct Switch {
    double before = 0, behind = 0;
    std::vector<std::size_t> columns{};
  };
  /// Those inside of a stretch, in order, as the motion shows them.
  std::vector<Switch> find(const MotionStretch& stretch) const;
  /// What is summed up over a stretch is divided there.
  static std::vector<double> part_ends(const std::vector<Switch>& switches, double to);

  /// Derivatives that are carried along, as far as they have come.
  struct Carrier {
    /// Of a group of parameters: y with its derivatives, y' there, how many parameters there are.
    struct Group {
      DesignMechanism& mechanism;
      Vector& y;
      Vector slope;
      std::size_t count;
    };
    const Evaluator& evaluator;
    std::vector<Group> groups;
    std::function<bool(double t)> find_slopes;  ///< at the y that was reached
    std::function<bool(double to)> take;        ///< goes on to there by one step
    std::function<void()> leave;                ///< y is changed next
    /// The rate of a function of time at the end of a stretch, from its inside.
    std::function<std::optional<double>(const MotionStretch&, const std::function<std::optional<double>(double)>&)>
        rate;
  };
  /// Why derivatives are not carried over a step with these stages, of the method of order 8; empty: they are.
  std::string trouble_in(double from, double to, const std::vector<Vector>& stages) const;
  /// From an instant of the stretch over a switch; to where, or nothing, and `trouble` says it if the carrier does not.
  std::optional<double> pass(const Switch& one, const MotionStretch& stretch, double from, Carrier& carrier,
                             std::string& trouble) const;

 private:
  /// By column of a switch: g; g' and |y| g_y, not numbers where they are not known; g_y y_p + g_p by parameter.
  struct Rates {
    std::vector<double> value{}, by_time{}, size{};
    std::vector<std::vector<double>> by_parameter{};
  };
  Rates look(const Switch& one, double t, double length, Carrier& carrier) const;
  std::vector<DesignScalar> values(DesignMechanism& mechanism, const Snapshot& there, const Vector& y) const;
  /// t*_p of a switch at which accelerations change by this part of their size; empty: nothing jumps.
  std::optional<std::vector<double>> instant(const Switch& one, double t, const Rates& before, const Rates& behind,
                                             double change, std::string& trouble) const;
  std::string name(const Switch& one) const;

  const Model& model_;
  std::optional<ColumnSet> columns_;
  std::vector<int> laws_;  // by column; -1: it is one of a spring
};

}  // namespace catena
