// What the processes of a sweep say to each other: a kind, the number of the sweep, and what follows of it.
//
// Bytes as in memory: all processes of a job run on machines of one kind.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "catena/scene/models/sweep_record.hpp"

namespace catena {

enum class CrewWord : char { hello = 'h', results = 'r', alive = 'a', designs = 'd', stop = 's', stop_with_loss = 'l' };

class CrewWriter {
 public:
  CrewWriter(CrewWord word, int sweep) { put(word), put(sweep); }
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void put(const T& value) { text_.append(reinterpret_cast<const char*>(&value), sizeof value); }
  void put(std::string_view text) {
    put(text.size());
    text_ += text;
  }
  void put(std::int64_t k, const SweepRecord::Design& design) {
    put(k);
    put(design.status);
    put(std::string_view(design.message));
    put(design.measures.size());
    for (const double value : design.measures) put(value);
  }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

class CrewReader {
 public:
  explicit CrewReader(std::string_view text) : rest_(text) {}
  /// Nothing more to be read.
  bool at_end() const { return rest_.empty(); }
  template <class T>
  T get() {
    T value{};
    if (rest_.size() < sizeof value) return rest_ = {}, value;
    std::memcpy(&value, rest_.data(), sizeof value);
    rest_.remove_prefix(sizeof value);
    return value;
  }
  std::string get_text() {
    const auto length = get<std::size_t>();
    std::string text(rest_.substr(0, length));
    rest_.remove_prefix(text.size());
    return text;
  }
  SweepRecord::Design get_design() {
    SweepRecord::Design design;
    design.status = get<Status>();
    design.message = get_text();
    design.measures.resize(get<std::size_t>());
    for (double& value : design.measures) value = get<double>();
    return design;
  }

 private:
  std::string_view rest_;
};

}  // namespace catena
