// Rows of a motion at which constraints depend on each other for an instant: accelerations and loads there are the
// limit of the motion (singular_instant.hpp), where it can be found; and what is said of such rows.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "catena/analysis/motion/singular_instant.hpp"

namespace catena {

class SingularRows {
 public:
  explicit SingularRows(EquationsOfMotion& equations) : equations_(equations) {}

  void begin_run();
  /// A step ended, where the equations were solved last.
  void follow_step();
  /// Accelerations of a row at t where the equations of motion do not have them; true: qdd is the limit of the motion.
  bool look(double t, std::span<const double> q, std::span<const double> qd, std::span<double> qdd);
  /// The same where the motion starts, the equations solved there.
  bool look_at_start(double t, std::span<const double> q, std::span<const double> qd, std::span<double> qdd);
  /// Whether the row looked at last is one of them; then the load of its constraints, by coordinate, and the time over
  /// which derivatives were taken, s.
  bool is_here() const { return here_; }
  std::span<const double> loads() const { return instant_->loads(); }
  double moment() const { return instant_->moment(); }

  /// The elements whose reactions are not determined there.
  bool has_names() const { return !names_.empty(); }
  void name(std::string names) { names_ = std::move(names); }
  void remark(std::vector<std::string>& warnings) const;

 private:
  struct Seen {
    std::int64_t rows = 0;
    double t = 0;  // of the first one, s
  };
  static std::string told(const Seen& seen);

  EquationsOfMotion& equations_;
  std::optional<SingularInstant> instant_;
  bool here_ = false, unbounded_ = false;
  bool dependent_ = false, always_dependent_ = false;  // where the last step ended, and where it began too
  Seen limits_, formal_;  // rows whose accelerations are the limit of the motion, and those whose are not known to be
  std::string names_;
};

}  // namespace catena
