// Sweeps: which parameters, and which values of them.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "catena/scene/json/near_miss.hpp"
#include "catena/scene/numbers/evaluation.hpp"
#include "catena/scene/reading/analysis_reader.hpp"

namespace catena {

void AnalysisReader::read_over(const JsonValue& object, AnalysisTask& task) {
  if (!object.is(JsonKind::object) || object.size() == 0) {
    error(object,
          "\"over\" must be an object of parameters, each with its values: {\"a\": {\"from\": 0, \"to\": 1, \"count\": "
          "11}, \"b\": [1, 2, 5], \"c\": {\"normal\": [mean, deviation]}, \"d\": {\"uniform\": [least, greatest]}}");
    return;
  }
  for (const JsonMember member : object.members()) read_range(member, task);
}

void AnalysisReader::read_range(const JsonMember& member, AnalysisTask& task) {
  const int index = parameters_.names().find(member.name());
  if (index < 0) {
    error(member.key, fmt::format("unknown parameter {}{}", in_quotes(member.name()),
                                  NearMiss(member.name()).consider_all(parameters_.names().all()).hint()));
    return;
  }
  const std::string owner = "sweep over " + in_quotes(member.name());
  const std::optional<Dimension>& dimension = parameters_.names().dimension_of_value(index);
  const Evaluation<double> evaluation(member.value.source(), scene_.expressions, values_, diagnostics_, tables());
  const auto number = [&](const JsonValue& value, std::string_view key) {
    return evaluation(reading_.numbers.read(value, dimension, {key, owner}));
  };
  SweepRange range;
  range.parameter = index;
  if (member.value.is(JsonKind::array)) {
    if (member.value.size() == 0) error(member.value, fmt::format("{}: the list of values is empty", owner));
    for (const JsonValue& value : member.value.elements()) range.values.push_back(number(value, "value"));
  } else if (!member.value.is(JsonKind::object)) {
    range.values.push_back(number(member.value, "value"));
  } else {
    constexpr std::array<std::string_view, 5> keys{"from", "to", "count", "normal", "uniform"};
    std::array<JsonValue, keys.size()> v;
    if (!read_members(member.value, keys, owner, v, diagnostics_)) return;
    const bool steps = v[0] || v[1] || v[2];
    if (static_cast<int>(steps) + static_cast<int>(static_cast<bool>(v[3])) +
            static_cast<int>(static_cast<bool>(v[4])) !=
        1) {
      error(member.value, fmt::format("{} wants from, to and count, or normal, or uniform: one of them", owner));
      return;
    }
    if (steps) {
      read_steps(member, {v[0], v[1], v[2]}, owner, range);
    } else {
      const JsonValue& pair = v[3] ? v[3] : v[4];
      const std::string_view key = v[3] ? keys[3] : keys[4];
      if (!pair.is(JsonKind::array) || pair.size() != 2) {
        error(pair, fmt::format("{} of {} must be a pair of numbers", in_quotes(key), owner));
        return;
      }
      double ends[2] = {0, 0};
      std::size_t k = 0;
      for (const JsonValue& value : pair.elements()) ends[k++] = number(value, key);
      range.kind = v[3] ? SweepRange::Kind::normal : SweepRange::Kind::uniform;
      range.first = ends[0];
      range.second = ends[1];
      if (v[3] && !(range.second > 0)) error(pair, fmt::format("{}: the deviation must be above zero", owner));
      if (v[4] && !(range.second > range.first))
        error(pair, fmt::format("{}: its least value {} is not below its greatest {}", owner, ends[0], ends[1]));
    }
  }
  task.sweep.over.push_back(std::move(range));
}

void AnalysisReader::read_steps(const JsonMember& member, const std::array<JsonValue, 3>& v, const std::string& owner,
                                SweepRange& range) {
  if (!v[0] || !v[1] || !v[2]) {
    error(member.value, fmt::format("{} needs from, to and count", owner));
    return;
  }
  const std::optional<Dimension>& dimension = parameters_.names().dimension_of_value(range.parameter);
  const Evaluation<double> evaluation(member.value.source(), scene_.expressions, values_, diagnostics_, tables());
  range.kind = SweepRange::Kind::steps;
  range.first = evaluation(reading_.numbers.read(v[0], dimension, {"from", owner}));
  range.second = evaluation(reading_.numbers.read(v[1], dimension, {"to", owner}));
  range.count = v[2].is(JsonKind::number) ? v[2].number() : 0;
  if (!(range.count >= 1) || range.count != std::floor(range.count))
    error(v[2], fmt::format("\"count\" of {} must be a whole number, at least 1", owner));
}

void AnalysisReader::check_sweep(const JsonValue& object, AnalysisTask& task) {
  // In the order of the key's words.
  constexpr SweepKind kinds[] = {SweepKind::grid, SweepKind::together, SweepKind::sobol, SweepKind::latin,
                                 SweepKind::random};
  task.sweep.kind = kinds[task.word("design")];
  // What is beyond 64 bits is more than any sweep has, too.
  task.sweep.samples =
      static_cast<std::int64_t>(std::min(task.number("samples", static_cast<double>(task.sweep.samples)), 9e18));
  task.sweep.seed = static_cast<std::uint64_t>(task.number("seed", 1));
  // What was reported already is not reported again as what follows from it.
  const auto lacks_values = [](const SweepRange& range) {
    return (range.kind == SweepRange::Kind::list && range.values.empty()) ||
           (range.kind == SweepRange::Kind::steps && !(range.count >= 1));
  };
  const bool reported = !object.find("over") || task.sweep.over.empty() ||
                        std::any_of(task.sweep.over.begin(), task.sweep.over.end(), lacks_values);
  if (reported) return;
  if (const std::optional<std::string> why = SweepPlan::trouble(task.sweep)) error(object.find("over"), *why);
}

}  // namespace catena
