// The suites of `catena bench`: each adds its rows to a Bench.
#pragma once

#include <array>
#include <string_view>

#include "suites/bench.hpp"

namespace bench {

void kinematics_suite(Bench& bench);   ///< driven linkages against closed forms, by tolerance
void dynamics_suite(Bench& bench);     ///< every method at tolerances 1e-3 ... 1e-12: error against time
void contact_suite(Bench& bench);      ///< bounces, friction and sticking against closed forms, by tolerance
void equilibrium_suite(Bench& bench);  ///< hanging chains by every solver, small oscillations
void design_suite(Bench& bench);       ///< gradients and searches against closed forms
void kernels_suite(Bench& bench);      ///< accelerations, Jacobians, plans, factorizations: a body
void scaling_suite(Bench& bench);      ///< 10 ... 10^6 bodies, with fitted slopes
void digits_suite(Bench& bench);       ///< digits that columns claim, beside those that are right
void economy_suite(Bench& bench);      ///< what a scene does not need, and proof that the answer is the full one

struct Suite {
  std::string_view name;
  void (*run)(Bench&);
};

inline constexpr std::array<Suite, 9> suites{{{"kinematics", kinematics_suite},
                                              {"dynamics", dynamics_suite},
                                              {"contact", contact_suite},
                                              {"equilibrium", equilibrium_suite},
                                              {"design", design_suite},
                                              {"kernels", kernels_suite},
                                              {"scaling", scaling_suite},
                                              {"economy", economy_suite},
                                              {"digits", digits_suite}}};

}  // namespace bench
