// Who may use Ipopt: one thread of a process at a time, since MUMPS shares its workspace. Recursive, because a design
// that Ipopt asks for may itself be an equilibrium by Ipopt, within the same thread, while the outer one waits.
#pragma once

#include <mutex>

namespace catena {

std::recursive_mutex& ipopt_turn();

}  // namespace catena
