#include "catena/model/name_table.hpp"

#include <functional>

namespace catena {
namespace {

// Load factor at most 1/2 keeps the probe sequences short.
constexpr std::size_t slots_for(std::size_t names) {
  std::size_t slots = 16;
  while (slots < 2 * names) slots *= 2;
  return slots;
}

std::uint64_t hash_of(std::string_view name) { return std::hash<std::string_view>{}(name); }

}  // namespace

std::string_view NameTable::operator[](int number) const {
  const auto k = static_cast<std::size_t>(number);
  return std::string_view(characters_).substr(start_[k], start_[k + 1] - start_[k]);
}

std::size_t NameTable::locate(std::string_view name, std::uint64_t hash) const {
  const std::size_t mask = slots_.size() - 1;
  const auto tag = static_cast<std::uint32_t>(hash >> 32);
  std::size_t s = hash & mask;
  while (slots_[s].number >= 0 && !(slots_[s].tag == tag && (*this)[slots_[s].number] == name)) s = (s + 1) & mask;
  return s;
}

int NameTable::find(std::string_view name) const {
  return slots_.empty() ? -1 : slots_[locate(name, hash_of(name))].number;
}

int NameTable::intern(std::string_view name) {
  if (2 * (static_cast<std::size_t>(size()) + 1) > slots_.size()) {
    rehash(slots_for(2 * (static_cast<std::size_t>(size()) + 1)));
  }
  const std::uint64_t hash = hash_of(name);
  Slot& slot = slots_[locate(name, hash)];
  if (slot.number < 0) {
    slot = {size(), static_cast<std::uint32_t>(hash >> 32)};
    characters_.append(name);
    start_.push_back(characters_.size());
  }
  return slot.number;
}

void NameTable::reserve(std::size_t names, std::size_t characters) {
  const std::size_t total = static_cast<std::size_t>(size()) + names;
  start_.reserve(total + 1);
  characters_.reserve(characters_.size() + characters);
  if (slots_for(total) > slots_.size()) rehash(slots_for(total));
}

void NameTable::rehash(std::size_t slots) {
  slots_.assign(slots, {});
  const std::size_t mask = slots - 1;
  for (int k = 0; k < size(); ++k) {
    const std::uint64_t hash = hash_of((*this)[k]);
    std::size_t s = hash & mask;
    while (slots_[s].number >= 0) s = (s + 1) & mask;
    slots_[s] = {k, static_cast<std::uint32_t>(hash >> 32)};
  }
}

}  // namespace catena
