#include "catena/results/failure_list.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace catena {

void FailureList::add(std::int64_t k, Status status, std::string_view reason) {
  // A reason is a sentence or two.
  reason = reason.substr(0, most_bytes / 4);
  const Head head{k, status, static_cast<std::uint32_t>(reason.size())};
  if (held_.size() + sizeof head + reason.size() > most_bytes) {
    if (!moved_) moved_.reset(std::tmpfile());
    if (!moved_ || std::fwrite(held_.data(), 1, held_.size(), moved_.get()) != held_.size() ||
        std::fflush(moved_.get()) != 0) {
      throw std::runtime_error(
          fmt::format("reasons of failed designs cannot be kept in a temporary file: {}", std::strerror(errno)));
    }
    held_.clear();
  }
  held_.append(reinterpret_cast<const char*>(&head), sizeof head);
  held_ += reason;
  ++size_;
}

FieldRecord FailureList::record_of(const Head& head, std::string reason) const {
  FieldRecord record{{"design", head.k + 1}};
  std::vector<double> values(parameters_.size());
  values_(head.k, values);
  for (std::size_t p = 0; p < values.size(); ++p) record.emplace_back(parameters_[p], values[p]);
  record.emplace_back("status", std::string(to_string(head.status)));
  record.emplace_back("message", std::move(reason));
  return record;
}

void FailureList::for_each(const std::function<bool(const FieldRecord&)>& take) const {
  std::size_t at = 0;
  bool from_file = moved_ != nullptr;
  if (moved_) std::rewind(moved_.get());
  const auto get = [&](void* place, std::size_t bytes) {
    if (from_file) return std::fread(place, 1, bytes, moved_.get()) == bytes;
    std::memcpy(place, held_.data() + at, bytes);
    at += bytes;
    return true;
  };
  for (std::int64_t k = 0; k < size_; ++k) {
    Head head{};
    if (from_file && !get(&head, sizeof head)) from_file = false;
    if (!from_file) get(&head, sizeof head);
    std::string reason(head.length, '\0');
    if (!get(reason.data(), reason.size())) throw std::runtime_error("the file of failed designs cannot be read");
    if (!take(record_of(head, std::move(reason)))) break;
  }
  // What is added next is written after all.
  if (moved_) std::fseek(moved_.get(), 0, SEEK_END);
}

}  // namespace catena
