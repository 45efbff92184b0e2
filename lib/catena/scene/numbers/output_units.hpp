// Units in which results are shown, in place of SI and radians: {"angle": "deg", "length": "mm", "force": "kN"}.
//
// Of every unit the powers of length, time, angle and force (mass where it stands alone) are known: each is written in
// the unit that was asked for it, N m/rad with the ones above as kN mm/deg. What contains none of these stays as it is.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "catena/scene/json/text_error.hpp"

namespace catena {

class OutputUnits {
 public:
  /// Kinds of quantities with their units, as texts.
  using Wishes = std::vector<std::pair<std::string, std::string>>;

  /// Kinds that a unit can be asked for.
  static constexpr std::array<std::string_view, 5> kinds{"length", "time", "angle", "force", "mass"};

  /// Why a wish cannot be met, or nothing.
  static std::optional<std::string> problem(std::string_view kind, std::string_view unit);
  /// Takes wishes without a problem; later ones of the same kind replace earlier ones.
  void ask(const Wishes& wishes);
  bool any() const;

  struct Conversion {
    double factor = 1;  ///< value in `unit` = factor x value in SI
    std::string unit;
  };
  /// Of a quantity by its SI unit, in the syntax of scenes; itself where its unit is not known.
  Conversion of(std::string_view si_unit) const;

 private:
  struct Unit {
    std::string name;
    double si = 1;  // of one of it
  };
  std::array<std::optional<Unit>, kinds.size()> units_;
};

}  // namespace catena
