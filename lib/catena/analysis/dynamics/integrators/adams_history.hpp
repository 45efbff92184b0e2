// The instants behind an Adams method of variable order and step, and the weights that follow from them.
//
// At t_n the derivative f is known through modified divided differences of its last k values:
//   phi_1 = f_n        phi_i = (t_n - t_(n-1)) ... (t_n - t_(n-i+1)) f[t_n, ..., t_(n-i+1)]
// The polynomial through those values, and its integrals from t_n, are sums over them: at t_n + s
//   f = sum value_i phi_i        s sum integral_i phi_i        s^2 sum twice_i phi_i
// with G_(1,q) = 1/q, G_(i,q) = c_i G_(i-1,q) - e_i G_(i-1,q+1), c_i = (s + t_n - t_(n-i+2)) / (t_n - t_(n-i+1)),
// e_i = s / (t_n - t_(n-i+1)); value_i = c_2 ... c_i, integral_i = G_(i,1), twice_i = G_(i,2).
// Sources: L. Shampine, M. Gordon, "Computer Solution of Ordinary Differential Equations" (1975); F. Krogh, "Changing
// stepsize in the integration of differential equations using modified divided differences", LNM 362 (1974).
#pragma once

#include <array>
#include <cstddef>

namespace catena {

class AdamsHistory {
 public:
  static constexpr std::size_t most = 14;  ///< differences
  using Row = std::array<double, most + 2>;

  /// Of difference i, in entry i; entry 0 is not used.
  struct Weights {
    Row value{}, integral{}, twice{};
  };

  /// Removes all instants but the present one.
  void restart() { count_ = 0; }
  /// The present instant moves on by h > 0, in s.
  void push(double h) {
    count_ = count_ < most ? count_ + 1 : most;
    for (std::size_t i = count_; i > 1; --i) back_[i] = back_[i - 1] + h;
    back_[1] = h;
  }
  /// Whether the last `steps` steps had the length h.
  bool equal_steps(std::size_t steps, double h) const;
  /// sigma_(i+1) = i! h^i / ((t - t_n) ... (t - t_(n-i+1))), t = t_n + h: 1 where steps are equal.
  double sigma(std::size_t i, double h) const;
  /// Weights of differences 1 ... k at a distance s, in s, from the present instant; negative: back.
  void find_weights(double s, std::size_t k, Weights& weights) const;

 private:
  std::array<double, most + 1> back_{};  // t_n - t_(n-i)
  std::size_t count_ = 0;
};

}  // namespace catena
