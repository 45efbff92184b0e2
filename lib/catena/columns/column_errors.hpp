// How many digits of the columns of a result are right.
//
//   digits = log10(size / error)        size: largest magnitude of the column in all rows
//                                       error: largest estimate, at least size eps / 2
//
// The error of a column is one number for all of its rows, as its printed decimals are: in a row where the column
// passes zero fewer digits are right, and as many decimals. Between 0, where the column is nothing but error,
// and 15.95, all digits of a double. NaN: no estimate of the error was made.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "catena/base/row_sink.hpp"

namespace catena {

class ColumnErrors {
 public:
  explicit ColumnErrors(std::size_t columns) : size_(columns, 0.0), error_(columns, none) {}

  /// Every row; values that are not finite do not count.
  void take_row(std::span<const double> values) {
    for (std::size_t k = 0; k < size_.size(); ++k) {
      const double size = std::abs(values[k]);
      if (size > size_[k] && std::isfinite(size)) size_[k] = size;
    }
  }
  /// An estimate of a column's error in some row; not finite: its error is not known.
  void take_error(std::size_t column, double error) {
    if (!std::isnan(error_[column]) && !(error <= error_[column])) error_[column] = error;
  }
  /// Places are sums of lengths of this size, m, even where a body cannot move and nothing is solved for.
  void take_places(std::span<const ColumnInfo> columns, double length) {
    for (std::size_t k = 0; k < error_.size(); ++k) {
      if (columns[k].unit == UnitKind::length && error_[k] >= 0) take_error(k, 2 * rounding * length);
    }
  }
  /// Largest estimate; not a number where none was made or it is not known.
  double error(std::size_t column) const {
    const double error = error_[column];
    return std::isfinite(error) && error >= 0 ? error : std::numeric_limits<double>::quiet_NaN();
  }
  /// Of every column; NaN where it is not known.
  std::vector<double> digits() const {
    std::vector<double> all(size_.size());
    for (std::size_t k = 0; k < all.size(); ++k) {
      const double error = std::max(error_[k], size_[k] * rounding);
      const bool known = !std::isnan(this->error(k));
      all[k] = !known ? std::numeric_limits<double>::quiet_NaN() : error > 0 ? digits_of(size_[k], error) : most;
    }
    return all;
  }

 private:
  static constexpr double none = -1;  // no estimate was made: the column had no value where one would have been
  static constexpr double rounding = std::numeric_limits<double>::epsilon() / 2;
  static constexpr double most = 15.95;  // -log10(rounding)
  static double digits_of(double size, double error) { return size > error ? std::log10(size / error) : 0; }

  std::vector<double> size_, error_;
};

}  // namespace catena
