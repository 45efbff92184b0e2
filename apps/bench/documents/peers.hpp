// Rows of other engines: their programs print records (peer_records.hpp), which are laid beside catena's rows of the
// same problem.
#pragma once

#include <functional>
#include <string_view>

#include "suites/bench.hpp"

namespace bench {

/// Runs the programs peer_NAME of Options::peers, or reads the file of records there, for the suites that are wanted;
/// what is absent becomes a remark. Throws catena::FileError where there is neither.
void add_peers(Bench& bench, const std::function<bool(std::string_view)>& wanted);

}  // namespace bench
