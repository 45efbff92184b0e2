// The reference of scenes in the manual names everything that the reader accepts: every type, key and analysis.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "catena/scene/describing/analysis_description.hpp"
#include "catena/scene/describing/body_keys.hpp"
#include "catena/scene/describing/element_description.hpp"
#include "catena/scene/reading/scene_reader.hpp"

namespace catena::testing {
namespace {

std::string read_reference() {
  std::ifstream file(std::string(CATENA_DATA_DIR) + "/../apps/manual/scenes.md");
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

/// The line of a table whose first cell names `word`; empty if there is none.
std::string line_of(const std::string& reference, std::string_view word) {
  std::istringstream lines(reference);
  const std::string marked = "`" + std::string(word) + "`";
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("| ") && line.substr(0, line.find(" | ", 2)).find(marked) != std::string::npos) return line;
  }
  return {};
}

bool names(const std::string& text, std::string_view key) {
  return text.find("`" + std::string(key) + "`") != std::string::npos ||
         text.find("\"" + std::string(key) + "\"") != std::string::npos;
}

template <class Keys>
void expect_all(const std::string& text, const Keys& keys) {
  for (const std::string_view key : keys) EXPECT_TRUE(names(text, key)) << key;
}

TEST(Manual, NamesTheKeysOfScenesBlocksAndBodies) {
  const std::string reference = read_reference();
  ASSERT_FALSE(reference.empty());
  expect_all(reference, scene_keys);
  expect_all(reference, block_keys);
  expect_all(reference, body_keys);
  expect_all(reference, rod_keys);
  expect_all(reference, part_keys);
  expect_all(reference, rectangle_keys);
  expect_all(reference, disc_keys);
  for (const AnalysisKey& key : event_keys()) EXPECT_FALSE(line_of(reference, key.name).empty()) << key.name;
}

TEST(Manual, NamesTheFieldsOfEveryElement) {
  const std::string reference = read_reference();
  for (const ElementDescription& type : element_descriptions()) {
    const std::string line = line_of(reference, type.type);
    ASSERT_FALSE(line.empty()) << type.type;
    for (const FieldDescription& field : type.fields) {
      if (field.kind == FieldKind::point || field.reserved()) continue;
      EXPECT_TRUE(names(line, field.key)) << type.type << " " << field.key;
    }
  }
}

TEST(Manual, NamesTheKeysOfEveryAnalysis) {
  const std::string reference = read_reference();
  for (const AnalysisDescription& analysis : analysis_descriptions()) {
    const std::string line = line_of(reference, analysis.type);
    ASSERT_FALSE(line.empty()) << analysis.type;
    for (const AnalysisKey& key : analysis.keys) {
      const bool common = key.name == "type" || key.name == "set" || key.name == "from" || key.name == "outputs";
      const bool in_time = key.name == "until" || key.name == "every" || key.name == "at";
      EXPECT_TRUE(names(common || (analysis.timed && in_time) ? reference : line, key.name))
          << analysis.type << " " << key.name;
      for (const std::string_view word : key.words) EXPECT_TRUE(names(reference, word)) << word;
    }
  }
}

// What `catena explain` lists of an analysis and what the manual lists are the same results.
TEST(Manual, NamesTheResultsThatExplainNames) {
  const std::string reference = read_reference();
  for (const AnalysisDescription& analysis : analysis_descriptions()) {
    const std::string line = line_of(reference, analysis.type);
    const std::size_t last = line.rfind('|');
    const std::size_t before = line.rfind('|', last - 1);
    const std::string cell = line.substr(before, last - before);
    int listed = 0;
    for (std::size_t at = cell.find('`'); at != std::string::npos; at = cell.find('`', at)) {
      const std::size_t end = cell.find('`', at + 1);
      const std::string name = cell.substr(at + 1, end - at - 1);
      at = end + 1;
      ++listed;
      if (name.find('(') != std::string::npos) continue;  // a pattern of columns
      EXPECT_NE(analysis.results.find(name), std::string_view::npos) << analysis.type << ' ' << name;
    }
    EXPECT_GT(listed, 0) << analysis.type;
  }
}

}  // namespace
}  // namespace catena::testing
