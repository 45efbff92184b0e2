// Names and their numbers: one shared namespace for bodies, constraints, drivers and forces.
//
// A million names must fit beside the mechanism they name, so the characters lie in one arena and the hash table holds
// indices, each with a part of the hash: most comparisons end there, without reading characters, which are seldom in
// the cache. About 30 bytes a name besides its characters. Names are never removed.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace catena {

class NameTable {
 public:
  /// Number of the name; a new one gets the next number.
  int intern(std::string_view name);
  /// Number of the name, or -1.
  int find(std::string_view name) const;
  std::string_view operator[](int number) const;
  int size() const { return static_cast<int>(start_.size()) - 1; }
  /// Makes room for `names` more names of `characters` in all.
  void reserve(std::size_t names, std::size_t characters);

 private:
  struct Slot {
    int number = -1;        // -1: empty
    std::uint32_t tag = 0;  // upper half of the hash
  };
  /// The slot of the name, or the empty one where it would go.
  std::size_t locate(std::string_view name, std::uint64_t hash) const;
  void rehash(std::size_t slots);
  std::string characters_;
  std::vector<std::uint64_t> start_ = {0};  // name k occupies [start_[k], start_[k + 1])
  std::vector<Slot> slots_;                 // open addressing
};

}  // namespace catena
