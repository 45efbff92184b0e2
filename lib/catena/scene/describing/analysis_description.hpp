// The analyses that a scene may list and the keys of each, as plain data: from it follow reader, schema and explain.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "catena/elements/field.hpp"

namespace catena {

enum class KeyKind {
  number,        ///< in a unit, within a domain
  whole,         ///< a whole number above zero
  flag,          ///< true or false
  word,          ///< one of some words
  time,          ///< an instant
  times,         ///< an instant or a list of them
  columns,       ///< a list of column names
  parameter,     ///< the name of a parameter
  set,           ///< parameters and their values
  events,        ///< a list of events
  event_blocks,  ///< a list of blocks with events that are repeated
  impulse,       ///< of an event: the point that is struck, and the impulse
  measures,      ///< names and measures
  analysis,      ///< an analysis, or a list of them
  names,         ///< a list of parameters
  variables,     ///< parameters with bounds and starts
  over,          ///< parameters with values
  objective,     ///< a measure or an expression over measures and parameters
  relations,     ///< a list of expressions with <=, >= or ==
};

struct AnalysisKey {
  std::string_view name;
  KeyKind kind = KeyKind::number;
  std::string_view doc;
  UnitKind unit = UnitKind::none;
  Domain domain = Domain::positive;
  std::vector<std::string_view> words = {};  ///< the first is the default
  bool required = false;
};

struct AnalysisDescription {
  std::string_view type, summary;
  std::string results;  ///< its result fields besides rows, for explain
  bool timed = false;   ///< rows at instants of time
  std::vector<AnalysisKey> keys;

  const AnalysisKey* find(std::string_view key) const;
};

/// A key of one event in the list `events`.
std::span<const AnalysisKey> event_keys();
/// A key of a block of events that is repeated, in the list `replicate`.
std::span<const AnalysisKey> event_block_keys();

std::span<const AnalysisDescription> analysis_descriptions();
/// The analysis of this name, or nullptr.
const AnalysisDescription* find_analysis_type(std::string_view type);

}  // namespace catena
