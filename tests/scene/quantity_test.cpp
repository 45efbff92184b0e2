// Quantities: values in SI, dimensions, and every way of writing one wrong; names and units of dimensions.
#include "catena/scene/numbers/quantity.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "catena/base/si_unit.hpp"

namespace catena {
namespace {

constexpr double pi = std::numbers::pi;

TEST(Quantity, ConvertsToSi) {
  const struct {
    const char* text;
    double value;
    UnitKind kind;
  } cases[] = {
      {"120 mm", 0.12, UnitKind::length},
      {"120mm", 0.12, UnitKind::length},
      {"1.5 cm", 0.015, UnitKind::length},
      {"12 in", 0.3048, UnitKind::length},
      {"1 ft", 0.3048, UnitKind::length},
      {"2 lb", 0.90718474, UnitKind::mass},
      {"10 lbf", 44.482216152605, UnitKind::force},
      {"1 lbf/in", 175.12683524647636, UnitKind::stiffness},
      {"2 psi in^2", 8.896443230521, UnitKind::force},
      {"-2 km", -2000, UnitKind::length},
      {"+.5 m", 0.5, UnitKind::length},
      {"1e-3 m", 0.001, UnitKind::length},
      {"30 deg", pi / 6, UnitKind::angle},
      {"2 rev", 4 * pi, UnitKind::angle},
      {"60 rpm", 2 * pi, UnitKind::angular_velocity},
      {"180 deg/s", pi, UnitKind::angular_velocity},
      {"1 rev/min^2", 2 * pi / 3600, UnitKind::angular_acceleration},
      {"2 rev^2/min^2", 8 * pi * pi / 3600, UnitKind::squared_frequency},
      {"250 g", 0.25, UnitKind::mass},
      {"3 t", 3000, UnitKind::mass},
      {"2 kg m^2", 2, UnitKind::inertia},
      {"2 kg*m*m", 2, UnitKind::inertia},
      {"5 ms", 0.005, UnitKind::time},
      {"2 min", 120, UnitKind::time},
      {"36 km/min", 600, UnitKind::velocity},
      {"9.81 m/s^2", 9.81, UnitKind::acceleration},
      {"9.81 m / s / s", 9.81, UnitKind::acceleration},
      {"9.81 m s^-2", 9.81, UnitKind::acceleration},
      {"1.2 kN", 1200, UnitKind::force},
      {"5 Pa m^2", 5, UnitKind::force},
      {"5 N m", 5, UnitKind::torque},
      {"5 J", 5, UnitKind::energy},
      {"5 W", 5, UnitKind::power},
      {"3 N/mm", 3000, UnitKind::stiffness},
      {"3 N s/m", 3, UnitKind::damping},
      {"6 N m/rad", 6, UnitKind::torsion_stiffness},
      {"1 N m/deg", 180 / pi, UnitKind::torsion_stiffness},
      {"0.1 N m s/rad", 0.1, UnitKind::torsion_damping},
      {"7 kg m/s", 7, UnitKind::momentum},
      {"7 kg m^2/s", 7, UnitKind::angular_momentum},
  };
  for (const auto& c : cases) {
    const auto quantity = parse_quantity(c.text);
    ASSERT_TRUE(quantity) << c.text << ": " << quantity.error.message;
    EXPECT_DOUBLE_EQ(quantity->value, c.value) << c.text;
    EXPECT_EQ(quantity->dimension, dimension_of(c.kind)) << c.text;
    EXPECT_TRUE(quantity->has_unit);
  }
  EXPECT_EQ(parse_quantity("120 mm")->value, 0.12);  // to the last bit
  EXPECT_EQ(parse_quantity("2 1/s")->dimension, (Dimension{0, 0, -1, 0}));
  EXPECT_EQ(parse_quantity("2 /m")->dimension, (Dimension{-1, 0, 0, 0}));
  EXPECT_FALSE(parse_quantity("0.12")->has_unit);
  EXPECT_EQ(parse_quantity("-0.12 ")->value, -0.12);
  EXPECT_EQ(parse_quantity("1e-400 m")->value, 0);
}

TEST(Quantity, SaysWhatIsWrongAndWhere) {
  const struct {
    const char* text;
    std::size_t position;
    const char* message;
  } cases[] = {
      {"3 mn", 2, "unknown unit \"mn\"; did you mean \"m\"?"},
      {"3 degs", 2, "unknown unit \"degs\"; did you mean \"deg\"?"},
      {"3 furlong", 2,
       "unknown unit \"furlong\"; known are m mm cm km in ft, kg g t lb, s ms min, Hz, rad deg rev, rpm, N kN lbf, Pa "
       "psi, J, W"},
      {"3 m/", 4, "a unit is missing at the end"},
      {"3 m//s", 4, "expected a unit here; an expression begins with ="},
      {"3 m^", 4, "an exponent is a whole number from 1 to 9 or from -9 to -1"},
      {"3 m^x", 4, "an exponent is a whole number from 1 to 9 or from -9 to -1"},
      {"3 m^0", 4, "an exponent is a whole number from 1 to 9 or from -9 to -1"},
      {"3 m^99", 4, "an exponent is a whole number from 1 to 9 or from -9 to -1"},
      {"3/4 m", 2, "expected a unit here; an expression begins with ="},
      {"2*crank", 1, "expected a unit here; an expression begins with ="},
      {"-crank", 0, "expected a number before the unit; an expression begins with ="},
      {"-inf m", 0, "expected a number before the unit; an expression begins with ="},
      {".", 0, "expected a number before the unit; an expression begins with ="},
      {"1e400 m", 0, "this number is too large"},
      {"1e308 km", 0, "this quantity is too large"},
  };
  for (const auto& c : cases) {
    const auto quantity = parse_quantity(c.text);
    ASSERT_FALSE(quantity) << c.text;
    EXPECT_EQ(quantity.error.position, c.position) << c.text;
    EXPECT_EQ(quantity.error.message, c.message) << c.text;
  }
}

TEST(Unit, EveryKindsSiUnitReadsBackAsThatKind) {
  for (int i = static_cast<int>(UnitKind::length); i <= static_cast<int>(UnitKind::torsion_damping); ++i) {
    const auto kind = static_cast<UnitKind>(i);
    const auto quantity = parse_quantity("2 " + std::string(si_unit(kind)));
    ASSERT_TRUE(quantity) << si_unit(kind);
    EXPECT_EQ(quantity->value, 2.0) << si_unit(kind);
    EXPECT_EQ(quantity->dimension, dimension_of(kind)) << si_unit(kind);
    // So does the example that messages give; the part before " or " where there are two.
    const std::string shown = example(dimension_of(kind));
    const auto parsed = parse_quantity(shown.substr(1, shown.find('"', 1) - 1));
    ASSERT_TRUE(parsed) << shown;
    EXPECT_EQ(parsed->dimension, dimension_of(kind)) << shown;
  }
}

TEST(Unit, NamesDimensionsWithAndWithoutAName) {
  const Dimension velocity = dimension_of(UnitKind::velocity), time = dimension_of(UnitKind::time);
  EXPECT_EQ(velocity / time, dimension_of(UnitKind::acceleration));
  EXPECT_EQ(velocity * time, dimension_of(UnitKind::length));
  EXPECT_EQ(describe(velocity), "a velocity");
  EXPECT_EQ(describe(velocity / power(time, 2)), "a quantity in m/s^3");
  EXPECT_EQ(example(velocity / power(time, 2)), "\"2 m/s^3\"");
  EXPECT_EQ(si_unit(Dimension{}), "1");
  EXPECT_EQ(si_unit(Dimension{-1, 0, 0, 0}), "1/m");
  EXPECT_EQ(si_unit(Dimension{3, 1, -2, -2}), "kg m^3/rad^2/s^2");
  for (const Dimension d : {Dimension{-1, 0, 0, 0}, Dimension{3, 1, -2, -2}, Dimension{0, -2, 1, 1}}) {
    const auto quantity = parse_quantity("2 " + si_unit(d));
    ASSERT_TRUE(quantity) << si_unit(d);
    EXPECT_EQ(quantity->dimension, d);
  }
}

}  // namespace
}  // namespace catena
