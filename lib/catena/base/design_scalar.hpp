// The scalar that carries derivatives with respect to design parameters, four at once.
//
// Models over it (BasicModel<DesignScalar>) hold a value and its derivatives by up to four parameters in every number
// that follows from them. More parameters are taken in groups of four. Four derivatives fill one register of 256 bits;
// with more the elements' arithmetic no longer stays in registers.
#pragma once

#include "catena/base/dual.hpp"

namespace catena {

inline constexpr int parameters_at_once = 4;
using DesignScalar = Dual<double, parameters_at_once>;

}  // namespace catena
