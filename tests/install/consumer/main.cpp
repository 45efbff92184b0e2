// Uses the installed library: prints the version it was asked for and a word from the compiled part.
#include <cstdio>
#include <string>

#include "catena/base/status.hpp"

int main() {
  const std::string word(catena::to_string(catena::Status::ok));
  std::printf("catena %s %s\n", EXPECTED_VERSION, word.c_str());
  return word.empty() ? 1 : 0;
}
