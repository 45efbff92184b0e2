// Instructions that one variant of the economy suite takes, counted by valgrind's callgrind in a child process.
#pragma once

#include <optional>
#include <string>

namespace bench {

/// "" where valgrind can be run; else why instructions are not counted.
std::string no_instructions_because();

/// Nothing where the child fails. Starts this very program with the hidden option --economy-variant.
std::optional<double> instructions_of(const std::string& variant);

}  // namespace bench
