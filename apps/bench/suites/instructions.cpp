#include "suites/instructions.hpp"

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "cases/economy_cases.hpp"

namespace bench {

namespace {

std::string in_shell_quotes(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return quoted + "'";
}

}  // namespace

std::string no_instructions_because() {
  return std::system("command -v valgrind >/dev/null 2>&1") == 0 ? "" : "valgrind is not installed (Debian: valgrind)";
}

std::optional<double> instructions_of(const std::string& variant) {
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) return std::nullopt;
  const std::string command =
      std::string("valgrind --tool=callgrind --callgrind-out-file=/dev/null --toggle-collect=") + measured_function +
      " " + in_shell_quotes(self.string()) + " bench --economy-variant " + in_shell_quotes(variant) + " 2>&1";
  std::FILE* pipe = ::popen(command.c_str(), "r");
  if (!pipe) return std::nullopt;
  std::string output;
  char buffer[4096];
  while (const std::size_t read = std::fread(buffer, 1, sizeof buffer, pipe)) output.append(buffer, read);
  if (::pclose(pipe) != 0) return std::nullopt;
  constexpr std::string_view label = "Collected :";
  const std::size_t at = output.find(label);
  if (at == std::string::npos) return std::nullopt;
  const double count = std::strtod(output.c_str() + at + label.size(), nullptr);
  return count > 0 ? std::optional(count) : std::nullopt;
}

}  // namespace bench
