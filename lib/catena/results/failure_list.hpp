// The designs that could not be analysed, with their parameters and the reasons, however many they are.
//
// What is kept of one is its number, its status and its reason; its parameters follow from the number. More than a
// megabyte of that moves to a file without a name, which goes with the process: memory stays bounded.
#pragma once

#include <cstdio>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "catena/results/analysis_result.hpp"

namespace catena {

class FailureList final : public LongList {
 public:
  /// Values of the parameters of design k = 0, 1 ...
  using Values = std::function<void(std::int64_t k, std::span<double> values)>;
  FailureList(std::vector<std::string> parameters, Values values)
      : parameters_(std::move(parameters)), values_(std::move(values)) {}

  /// Design k = 0, 1 ... Throws std::runtime_error where the file cannot be written.
  void add(std::int64_t k, Status status, std::string_view reason);
  std::int64_t size() const override { return size_; }
  /// {"design": 18, parameters by name, "status": "not_assembled", "message": ...}. Not from several threads at once.
  void for_each(const std::function<bool(const FieldRecord&)>& take) const override;

  /// Bytes that wait in memory at most.
  static constexpr std::size_t most_bytes = 1 << 20;
  std::size_t bytes_held() const { return held_.size(); }

 private:
  struct Head {
    std::int64_t k;
    Status status;
    std::uint32_t length;  // of the reason, which follows
  };
  FieldRecord record_of(const Head& head, std::string reason) const;

  std::vector<std::string> parameters_;
  Values values_;
  std::int64_t size_ = 0;
  std::string held_;  // the last ones
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> moved_;  // those before
};

}  // namespace catena
