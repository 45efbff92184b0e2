// What a run in text lists under "events" and "impulses".
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "scene/run_text.hpp"

namespace catena::testing {

struct EventEntry {
  std::string name, kind;
  double t = 0;
  std::int64_t row = -1;  ///< -1: none is told
};

struct ImpulseEntry {
  std::string element, event;
  double t = 0, px = 0, py = 0, moment = 0, load = std::nan("");  ///< load: of drivers
};

/// The records of a field of the k-th analysis; none if it has no such field.
inline std::vector<FieldRecord> records_of(const TextRun& run, const std::string& name, std::size_t k = 0) {
  for (const NamedField& field : run.analysis(k).fields) {
    if (field.name == name) return std::get<std::vector<FieldRecord>>(field.value);
  }
  return {};
}

inline std::vector<EventEntry> events_of(const TextRun& run, std::size_t k = 0) {
  std::vector<EventEntry> all;
  for (const FieldRecord& record : records_of(run, "events", k)) {
    EventEntry entry;
    for (const auto& [key, value] : record) {
      if (key == "name") entry.name = std::get<std::string>(value);
      if (key == "kind") entry.kind = std::get<std::string>(value);
      if (key == "t") entry.t = std::get<double>(value);
      if (key == "row") entry.row = std::get<std::int64_t>(value);
    }
    all.push_back(entry);
  }
  return all;
}

inline std::vector<ImpulseEntry> impulses_of(const TextRun& run, std::size_t k = 0) {
  std::vector<ImpulseEntry> all;
  for (const FieldRecord& record : records_of(run, "impulses", k)) {
    ImpulseEntry entry;
    for (const auto& [key, value] : record) {
      if (key == "element") entry.element = std::get<std::string>(value);
      if (key == "event") entry.event = std::get<std::string>(value);
      if (key == "t") entry.t = std::get<double>(value);
      if (key == "px") entry.px = std::get<double>(value);
      if (key == "py") entry.py = std::get<double>(value);
      if (key == "moment") entry.moment = std::get<double>(value);
      if (key == "load") entry.load = std::get<double>(value);
    }
    all.push_back(entry);
  }
  return all;
}

/// The impulse of one element at its first jolt; a failure if there is none.
inline ImpulseEntry impulse_of(const TextRun& run, const std::string& element) {
  for (const ImpulseEntry& entry : impulses_of(run)) {
    if (entry.element == element) return entry;
  }
  ADD_FAILURE() << "no impulse of " << element << "; " << run.analysis().report.message << run.outcome.error_text;
  return {};
}

}  // namespace catena::testing
