#include "catena/columns/element_columns.hpp"

#include "catena/elements/all.hpp"
#include "catena/elements/gap_element.hpp"
#include "catena/model/attachment.hpp"

namespace catena {
namespace {

template <class E>
UnitKind multiplier_unit(const E& element, int row) {
  if (row_in_angle(element, row)) return UnitKind::torque;
  return HasSquaredValue<E> ? UnitKind::stiffness : UnitKind::force;
}

template <class Entry>
void add_reactions(const Entry& entry, std::vector<ElementColumn>& out) {
  using E = typename Entry::Element;
  const auto add = [&](const char* suffix, UnitKind unit, ColumnKind kind, ReactionSide side) {
    out.push_back({suffix, unit, kind, side, true});
  };
  add("fx", UnitKind::force, ColumnKind::reaction_x, on_j);
  add("fy", UnitKind::force, ColumnKind::reaction_y, on_j);
  add("torque", UnitKind::torque, ColumnKind::reaction_torque, on_j);
  if (E::bodies == 2) {
    add("i.fx", UnitKind::force, ColumnKind::reaction_x, on_i);
    add("i.fy", UnitKind::force, ColumnKind::reaction_y, on_i);
    add("i.torque", UnitKind::torque, ColumnKind::reaction_torque, on_i);
  }
  add("joint.fx", UnitKind::force, ColumnKind::reaction_x, on_j_in_joint);
  add("joint.fy", UnitKind::force, ColumnKind::reaction_y, on_j_in_joint);
  for (int row = 0; row < E::rows; ++row)
    out.push_back(
        {"lambda" + std::to_string(row + 1), multiplier_unit(entry.element, row), ColumnKind::multiplier, row});
}

template <class Entry>
void add_measures(const Entry& entry, bool driver, std::vector<ElementColumn>& out) {
  using E = typename Entry::Element;
  if constexpr (E::functions == 1) {
    const bool angle = E::value_unit == UnitKind::angle;
    out.push_back({"value", E::value_unit, ColumnKind::value});
    out.push_back({"rate", angle ? UnitKind::angular_velocity : UnitKind::velocity, ColumnKind::rate});
    if (driver) {
      out.push_back({"load", angle ? UnitKind::torque : UnitKind::force, ColumnKind::load});
      out.push_back({"power", UnitKind::power, ColumnKind::power});
      out.push_back({"work", UnitKind::energy, ColumnKind::work});
    }
  }
  if (E::type == "revolute") {
    out.push_back({"angle", UnitKind::angle, ColumnKind::joint_angle});
    out.push_back({"omega", UnitKind::angular_velocity, ColumnKind::joint_omega});
  }
  if (E::bodies == 2 && attachment_of(entry).has_axis) {
    out.push_back({"slide", UnitKind::length, ColumnKind::slide});
    out.push_back({"slide_rate", UnitKind::velocity, ColumnKind::slide_rate});
  }
}

template <class Entry>
void add_gap(const Entry& entry, std::vector<ElementColumn>& out) {
  const bool angle = row_in_angle(entry.element, 0);
  out.push_back({"force", angle ? UnitKind::torque : UnitKind::force, ColumnKind::push});
  out.push_back({"gap", angle ? UnitKind::angle : UnitKind::length, ColumnKind::gap});
  if constexpr (requires { entry.element.mu; }) {
    out.push_back({"friction", UnitKind::force, ColumnKind::friction});
    out.push_back({"slip", UnitKind::velocity, ColumnKind::slip});
  }
}

template <class Entry>
void add_loads(const Entry& entry, std::vector<ElementColumn>& out) {
  using E = typename Entry::Element;
  static_cast<void>(entry);
  if (E::type == "spring_damper") {
    out.push_back({"length", UnitKind::length, ColumnKind::length});
    out.push_back({"rate", UnitKind::velocity, ColumnKind::length_rate});
    out.push_back({"force", UnitKind::force, ColumnKind::tension});
    out.push_back({"power", UnitKind::power, ColumnKind::supplied_power});
  }
  if (E::type == "point_force") {
    out.push_back({"fx", UnitKind::force, ColumnKind::applied_x});
    out.push_back({"fy", UnitKind::force, ColumnKind::applied_y});
    out.push_back({"power", UnitKind::power, ColumnKind::supplied_power});
  }
  if (E::type == "torque") {
    out.push_back({"torque", UnitKind::torque, ColumnKind::spring_torque});
    out.push_back({"power", UnitKind::power, ColumnKind::supplied_power});
  }
  if (E::type == "cable") {
    out.push_back({"length", UnitKind::length, ColumnKind::length});
    out.push_back({"force", UnitKind::force, ColumnKind::tension});
    out.push_back({"gap", UnitKind::length, ColumnKind::slack});
  }
  if constexpr (Sharing<E>) {
    if (entry.element.pieces > 0) {
      out.push_back({"length", UnitKind::length, ColumnKind::way});
      out.push_back({"force", UnitKind::force, ColumnKind::tension});
      out.push_back({"force_j", UnitKind::force, ColumnKind::far_pull});
      out.push_back({"gap", UnitKind::length, ColumnKind::slack});
    }
  }
  if (E::type == "torsion_spring") {
    out.push_back({"angle", UnitKind::angle, ColumnKind::turn});
    out.push_back({"torque", UnitKind::torque, ColumnKind::spring_torque});
    out.push_back({"power", UnitKind::power, ColumnKind::supplied_power});
  }
  if (E::type == "bushing") {
    const auto add = [&](const char* suffix, UnitKind unit, ColumnKind kind, ReactionSide side) {
      out.push_back({suffix, unit, kind, side, true});
    };
    out.push_back({"dx", UnitKind::length, ColumnKind::offset_x});
    out.push_back({"dy", UnitKind::length, ColumnKind::offset_y});
    out.push_back({"angle", UnitKind::angle, ColumnKind::turn});
    add("fx", UnitKind::force, ColumnKind::exerted_x, on_j);
    add("fy", UnitKind::force, ColumnKind::exerted_y, on_j);
    add("torque", UnitKind::torque, ColumnKind::exerted_torque, on_j);
    add("joint.fx", UnitKind::force, ColumnKind::exerted_x, on_j_in_joint);
    add("joint.fy", UnitKind::force, ColumnKind::exerted_y, on_j_in_joint);
  }
}

}  // namespace

std::vector<ElementColumn> columns_of_element(const Model& model, int element) {
  std::vector<ElementColumn> out;
  const ElementKind kind = model.elements[static_cast<std::size_t>(element)].kind;
  with_entry(model, element, [&]<class Entry>(const Entry& entry) {
    if constexpr (Dry<typename Entry::Element>) {
      const bool angle = entry.element.in_angle();
      out.push_back({"friction", angle ? UnitKind::torque : UnitKind::force, ColumnKind::friction});
      out.push_back({"slip", angle ? UnitKind::angular_velocity : UnitKind::velocity, ColumnKind::slip});
      out.push_back({"force", UnitKind::force, ColumnKind::push});
    } else if constexpr (HasParts<typename Entry::Element>) {
      out.push_back({"length", UnitKind::length, ColumnKind::way});
      add_gap(entry, out);
      out.push_back({"force_j", UnitKind::force, ColumnKind::far_pull});
      out.push_back({"lambda1", UnitKind::force, ColumnKind::multiplier, 0});
    } else if constexpr (Joining<typename Entry::Element>) {
      // A stretch of a rope: the rope has the columns.
    } else if constexpr (OneSided<typename Entry::Element>) {
      add_gap(entry, out);
      if (Entry::Element::type == "cable") out.push_back({"length", UnitKind::length, ColumnKind::length});
      add_reactions(entry, out);
    } else if constexpr (requires { Entry::Element::rows; }) {
      add_measures(entry, kind == ElementKind::driver, out);
      add_reactions(entry, out);
    } else {
      add_loads(entry, out);
    }
  });
  return out;
}

}  // namespace catena
