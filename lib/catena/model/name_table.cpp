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

}  // namespace

std::string_view NameTable::operator[](int number) const {
  const auto k = static_cast<std::size_t>(number);
  return std::string_view(characters_).substr(start_[k], start_[k + 1] - start_[k]);
}

int NameTable::find(std::string_view name) const {
  if (slots_.empty()) return -1;
  const std::size_t mask = slots_.size() - 1;
  for (std::size_t s = std::hash<std::string_view>{}(name)&mask;; s = (s + 1) & mask) {
    if (slots_[s] < 0) return -1;
    if ((*this)[slots_[s]] == name) return slots_[s];
  }
}

int NameTable::intern(std::string_view name) {
  if (2 * (static_cast<std::size_t>(size()) + 1) > slots_.size()) {
    rehash(slots_for(2 * (static_cast<std::size_t>(size()) + 1)));
  }
  const std::size_t mask = slots_.size() - 1;
  std::size_t s = std::hash<std::string_view>{}(name)&mask;
  for (; slots_[s] >= 0; s = (s + 1) & mask) {
    if ((*this)[slots_[s]] == name) return slots_[s];
  }
  slots_[s] = size();
  characters_.append(name);
  start_.push_back(characters_.size());
  return slots_[s];
}

void NameTable::reserve(std::size_t names, std::size_t characters) {
  const std::size_t total = static_cast<std::size_t>(size()) + names;
  start_.reserve(total + 1);
  characters_.reserve(characters_.size() + characters);
  if (slots_for(total) > slots_.size()) rehash(slots_for(total));
}

void NameTable::rehash(std::size_t slots) {
  slots_.assign(slots, -1);
  const std::size_t mask = slots - 1;
  for (int k = 0; k < size(); ++k) {
    std::size_t s = std::hash<std::string_view>{}((*this)[k]) & mask;
    while (slots_[s] >= 0) s = (s + 1) & mask;
    slots_[s] = k;
  }
}

}  // namespace catena
