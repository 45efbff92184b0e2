#include "catena/scene/loading/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "catena/results/stored_results.hpp"
#include "catena/scene/json/near_miss.hpp"
#include "catena/scene/json/source_text.hpp"

namespace catena {
namespace {

template <class Names>
std::out_of_range no_such(std::string_view what, std::string_view name, const Names& known) {
  return std::out_of_range(
      fmt::format("there is no {} {}{}", what, in_quotes(name), NearMiss(name).consider_all(known).hint()));
}

}  // namespace

std::vector<double> AnalysisOutcome::column(std::string_view name) const {
  if (rows_->find(name)) return rows_->column(name);
  std::vector<std::string> known;
  for (const ColumnInfo& info : rows_->columns()) known.push_back(info.name);
  throw no_such("column", name, known);
}

double AnalysisOutcome::measure(std::string_view name) const {
  std::vector<std::string> known;
  for (const MeasureResult& measure : result_.measures) {
    if (measure.name == name) {
      if (measure.value) return *measure.value;
      throw std::runtime_error(fmt::format("measure {} has no value: {}", in_quotes(name), measure.trouble));
    }
    known.push_back(measure.name);
  }
  throw no_such("measure", name, known);
}

bool SceneResults::ok() const {
  return std::all_of(analyses_.begin(), analyses_.end(), [](const AnalysisOutcome& one) { return one.ok(); });
}

const AnalysisOutcome& SceneResults::operator[](std::size_t number) const {
  if (number < analyses_.size()) return analyses_[number];
  throw std::out_of_range(fmt::format("there is no analysis number {} among {}", number, analyses_.size()));
}

const AnalysisOutcome& SceneResults::operator[](std::string_view type) const {
  std::vector<std::string> known;
  for (const AnalysisOutcome& one : analyses_) {
    if (one.result().type == type) return one;
    known.push_back(one.result().type);
  }
  throw no_such("analysis", type, known);
}

Scene Scene::load(const std::string& path) {
  std::string text;
  try {
    text = SourceText::read(path).text();
  } catch (const FileError& error) {
    SceneOutcome outcome;
    outcome.error_text = error.what();
    throw SceneError(outcome);
  }
  return {path, std::move(text)};
}

Scene Scene::loads(std::string text, std::string path) { return {std::move(path), std::move(text)}; }

Scene::Scene(std::string path, std::string text) : path_(std::move(path)), text_(std::move(text)) {
  RunOptions options;
  options.text = text_;
  SceneOutcome outcome = check_scene(path_, options);
  if (outcome.exit_code != 0) throw SceneError(outcome);
  parameters_ = std::move(outcome.parameters);
}

Scene& Scene::set(std::string_view name, double value) {
  if (!std::isfinite(value))
    throw std::invalid_argument(fmt::format("parameter {} may not be {}", in_quotes(name), value));
  return set(name, fmt::format("{}", value));
}

Scene& Scene::set(std::string_view name, std::string_view value) {
  std::vector<std::string> known;
  for (const auto& [parameter, given] : parameters_) known.push_back(parameter);
  if (std::find(known.begin(), known.end(), name) == known.end()) throw no_such("parameter", name, known);
  std::erase_if(set_, [&](const auto& earlier) { return earlier.first == name; });
  set_.emplace_back(name, value);
  return *this;
}

SceneResults Scene::run(RunOptions options) const {
  options.text = text_;
  options.set.insert(options.set.begin(), set_.begin(), set_.end());
  StoredResults sink;
  SceneOutcome outcome = run_scene(path_, options, sink);
  if (outcome.exit_code >= 2) throw SceneError(outcome);
  std::vector<AnalysisOutcome> analyses;
  for (std::size_t k = 0; k < outcome.analyses.size(); ++k)
    analyses.emplace_back(std::move(outcome.analyses[k]), std::move(sink.rows[k]));
  return SceneResults(std::move(analyses));
}

}  // namespace catena
