#include "catena/scene/numbers/unit.hpp"

#include <string_view>
#include <utility>

#include "catena/base/si_unit.hpp"

namespace catena {
namespace {

struct Name {
  UnitKind kind;
  std::string_view words;
  std::string_view example;
};

// Where kinds share a dimension the first one names it.
constexpr Name names[] = {
    {UnitKind::none, "a pure number", "0.5"},
    {UnitKind::length, "a length", "\"120 mm\""},
    {UnitKind::angle, "an angle", "\"30 deg\""},
    {UnitKind::mass, "a mass", "\"2 kg\""},
    {UnitKind::inertia, "a moment of inertia", "\"0.3 kg m^2\""},
    {UnitKind::time, "a time", "\"0.5 s\""},
    {UnitKind::velocity, "a velocity", "\"1.5 m/s\""},
    {UnitKind::angular_velocity, "an angular velocity", "\"2 rad/s\" or \"60 rpm\""},
    {UnitKind::acceleration, "an acceleration", "\"9.81 m/s^2\""},
    {UnitKind::angular_acceleration, "an angular acceleration", "\"3 rad/s^2\""},
    {UnitKind::squared_frequency, "a squared frequency", "\"40 rad^2/s^2\""},
    {UnitKind::force, "a force", "\"20 N\""},
    {UnitKind::torque, "a torque or an energy", "\"5 N m\""},
    {UnitKind::power, "a power", "\"100 W\""},
    {UnitKind::momentum, "a momentum", "\"2 kg m/s\""},
    {UnitKind::angular_momentum, "an angular momentum", "\"2 kg m^2/s\""},
    {UnitKind::stiffness, "a stiffness", "\"800 N/m\""},
    {UnitKind::damping, "a damping", "\"15 N s/m\""},
    {UnitKind::torsion_stiffness, "a torsional stiffness", "\"6 N m/rad\""},
    {UnitKind::torsion_damping, "a torsional damping", "\"0.1 N m s/rad\""},
};

const Name* find_name(const Dimension& dimension) {
  for (const Name& name : names) {
    if (dimension_of(name.kind) == dimension) return &name;
  }
  return nullptr;
}

}  // namespace

std::string si_unit(const Dimension& dimension) {
  if (const Name* name = find_name(dimension)) return std::string(si_unit(name->kind));
  const std::pair<std::string_view, int> factors[] = {
      {"kg", dimension.mass}, {"m", dimension.length}, {"rad", dimension.angle}, {"s", dimension.time}};
  std::string text;
  for (const auto& [unit, exponent] : factors) {
    if (exponent <= 0) continue;
    if (!text.empty()) text += ' ';
    text += unit;
    if (exponent > 1) text += '^' + std::to_string(exponent);
  }
  if (text.empty()) text += '1';
  for (const auto& [unit, exponent] : factors) {
    if (exponent >= 0) continue;
    text += '/';
    text += unit;
    if (exponent < -1) text += '^' + std::to_string(-exponent);
  }
  return text;
}

std::string describe(const Dimension& dimension) {
  const Name* name = find_name(dimension);
  return name ? std::string(name->words) : "a quantity in " + si_unit(dimension);
}

std::string example(const Dimension& dimension) {
  const Name* name = find_name(dimension);
  return name ? std::string(name->example) : "\"2 " + si_unit(dimension) + '"';
}

}  // namespace catena
