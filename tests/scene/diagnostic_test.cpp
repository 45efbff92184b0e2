// Diagnostics: the printed form, the caret under tabs and wide characters, long lines, the cap; sources that cannot be
// read.
#include "catena/scene/json/diagnostic.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace catena {
namespace {

std::string message_at(std::string_view text, std::string_view culprit) {
  const SourceText source("scene.json", text);
  Diagnostics diagnostics;
  diagnostics.error(source, text.find(culprit), "here");
  return diagnostics.text();
}

TEST(Diagnostic, LooksLikeACompilers) {
  EXPECT_EQ(message_at("{\n  \"crank\": {\"lenght\": 1}\n}\n", "\"lenght"),
            "scene.json:2:13: error: here\n"
            "  \"crank\": {\"lenght\": 1}\n"
            "            ^\n");
  EXPECT_EQ(message_at("X", "X"), "scene.json:1:1: error: here\nX\n^\n");
  EXPECT_EQ(message_at("a\r\nXY\r\n", "X"), "scene.json:2:1: error: here\nXY\n^\n");
}

TEST(Diagnostic, PutsTheCaretRightUnderTabsAndUnicode) {
  // A tab is one column of the text and two blanks on the screen.
  EXPECT_EQ(message_at("\t\tX", "X"), "scene.json:1:3: error: here\n    X\n    ^\n");
  EXPECT_EQ(message_at("\xc3\xa4\xc3\xb6X", "X"), "scene.json:1:3: error: here\n\xc3\xa4\xc3\xb6X\n  ^\n");
  // A wide character takes two columns of a terminal, a combining accent none.
  EXPECT_EQ(message_at("\xe6\xa9\x9fX", "X"), "scene.json:1:2: error: here\n\xe6\xa9\x9fX\n  ^\n");
  EXPECT_EQ(message_at("e\xcc\x81X", "X"), "scene.json:1:3: error: here\ne\xcc\x81X\n ^\n");
  // Escape sequences and broken bytes never reach the terminal.
  EXPECT_EQ(message_at("\x1b[31m\xff\xffX", "X"), "scene.json:1:8: error: here\n?[31m??X\n       ^\n");
}

TEST(Diagnostic, ClipsLongLinesAroundTheCaret) {
  const std::string text = std::string(1000, 'a') + "X" + std::string(1000, 'b');
  const std::string printed = message_at(text, "X");
  EXPECT_TRUE(printed.starts_with("scene.json:1:1001: error: here\n...aaaa")) << printed;
  const std::string excerpt = printed.substr(printed.find('\n') + 1);
  const std::size_t line_end = excerpt.find('\n');
  EXPECT_EQ(excerpt.find('X'), excerpt.find('^') - line_end - 1);
  EXPECT_LT(line_end, 140u);
  EXPECT_TRUE(excerpt.substr(0, line_end).ends_with("bbb..."));
}

TEST(Diagnostic, SortsByPlaceAndCountsWhatIsTooMuch) {
  const SourceText source("s.json", "abcdef");
  Diagnostics diagnostics(3);
  diagnostics.error(source, 4, "m4");
  diagnostics.error(source, 0, "m0");
  diagnostics.error(source, 2, "m2");
  EXPECT_TRUE(diagnostics.full());
  diagnostics.error(source, 1, "left out");
  diagnostics.error(source, 1, "left out");
  EXPECT_EQ(diagnostics.count(), 5u);
  EXPECT_EQ(diagnostics.items().size(), 3u);
  EXPECT_EQ(diagnostics.text(),
            "s.json:1:1: error: m0\nabcdef\n^\ns.json:1:3: error: m2\nabcdef\n  ^\n"
            "s.json:1:5: error: m4\nabcdef\n    ^\nand 2 more errors\n");
}

TEST(Diagnostic, PlacesAtTheEndsOfTheText) {
  const SourceText source("s.json", "ab\ncd\n");
  EXPECT_EQ(source.place(0).line, 1);
  EXPECT_EQ(source.place(2).column, 3);
  EXPECT_EQ(source.place(3).line, 2);
  EXPECT_EQ(source.place(6).line, 3);
  EXPECT_EQ(source.place(1000).line, 3);
  const SourceText empty("e.json", "");
  EXPECT_EQ(empty.place(0).line, 1);
  EXPECT_EQ(empty.place(0).column, 1);
}

TEST(Diagnostic, QuotesNamesSafely) {
  EXPECT_EQ(in_quotes("crank"), "\"crank\"");
  EXPECT_EQ(in_quotes("a\"\n\xff"), "\"a\\\"\\u000a\xef\xbf\xbd\"");
  EXPECT_LT(in_quotes(std::string(100000, 'a')).size(), 70u);
}

TEST(SourceText, ReadsFilesAndSaysWhyItCannot) {
  const auto directory = std::filesystem::temp_directory_path() / ("catena_source_" + std::to_string(::getpid()));
  std::filesystem::create_directory(directory);
  const std::string path = (directory / "a.json").string();
  std::ofstream(path) << "{\"a\": 1}";
  EXPECT_EQ(SourceText::read(path).text(), "{\"a\": 1}");
  std::ofstream(path, std::ios::trunc).close();
  EXPECT_EQ(SourceText::read(path).text(), "");

  const auto reason = [](const std::string& name) -> std::string {
    try {
      SourceText::read(name);
    } catch (const FileError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(reason(directory.string()), "cannot read " + directory.string() + ": it is a directory");
  const std::string missing = (directory / "none.json").string();
  EXPECT_EQ(reason(missing), "cannot read " + missing + ": No such file or directory");
  std::filesystem::remove_all(directory);
}

}  // namespace
}  // namespace catena
