// Tables of catena_bench --table: see kinematics_table.cpp.
#pragma once

namespace bench {

void print_step_costs();
void print_kinematic_errors();

}  // namespace bench
