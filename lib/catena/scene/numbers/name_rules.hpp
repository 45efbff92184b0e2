// The rules for names in a scene.
//
// Bodies and elements: any Unicode without dots, braces, # and control characters, no blank at either end; `ground`,
// `t`, `energy`, `momentum` and `residual` are taken. Points: the same characters, but not the name of a body's column.
// Parameters: identifiers of expressions.
#pragma once

#include <string>
#include <string_view>

namespace catena {

/// Why a name cannot be that of a body, constraint, driver or force; empty if it can.
std::string element_name_problem(std::string_view name);
/// Why a name cannot be that of a point; empty if it can.
std::string point_name_problem(std::string_view name);
/// Why a name cannot be that of a parameter; empty if it can.
std::string parameter_name_problem(std::string_view name);

}  // namespace catena
