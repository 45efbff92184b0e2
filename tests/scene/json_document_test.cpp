// JSON documents: values, order and places of everything; every way a text can be wrong, with its line and column.
#include "catena/scene/json/json_document.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <random>

namespace catena {
namespace {

/// The errors of a text as "line:column message", one a line.
std::string errors_of(std::string_view text) {
  const SourceText source("scene.json", text);
  Diagnostics diagnostics;
  const auto document = JsonDocument::parse(source, diagnostics);
  if (!document) {
    EXPECT_FALSE(diagnostics.ok()) << "no document and no reason for " << text;
  }
  std::string all;
  for (const Diagnostic& d : diagnostics.items()) {
    all += std::to_string(d.line) + ":" + std::to_string(d.column) + " " + d.message + "\n";
  }
  return all;
}

TEST(JsonDocument, KeepsValuesOrderAndPlaces) {
  const SourceText source("scene.json",
                          "// a scene\n{\"b\": [1, -2.5e-3, true, null],\n \"a\" /* key */ : {\"x\": \"text\"},\n"
                          "\t\"empty\": {}, \"none\": []}\n");
  Diagnostics diagnostics;
  const auto document = JsonDocument::parse(source, diagnostics);
  ASSERT_TRUE(document) << diagnostics.text();
  const JsonValue root = document->root();
  ASSERT_EQ(root.kind(), JsonKind::object);
  EXPECT_EQ(root.size(), 4u);

  std::vector<std::string> names;
  for (const JsonMember member : root.members()) names.emplace_back(member.name());
  EXPECT_EQ(names, (std::vector<std::string>{"b", "a", "empty", "none"}));

  const JsonValue list = root.find("b");
  ASSERT_EQ(list.size(), 4u);
  auto element = list.elements().begin();
  EXPECT_EQ(element->number(), 1.0);
  EXPECT_EQ(source.text().substr((++element)->offset(), 7), "-2.5e-3");
  EXPECT_EQ(element->number(), -2.5e-3);
  EXPECT_TRUE((++element)->boolean());
  EXPECT_EQ((++element)->kind(), JsonKind::null);
  EXPECT_TRUE(++element == list.elements().end());

  const JsonValue text = root.find("a").find("x");
  EXPECT_EQ(text.text(), "text");
  EXPECT_EQ(source.place(text.offset()).line, 3);
  EXPECT_EQ(source.place(text.offset()).column, 24);
  for (const JsonMember member : root.members()) {
    if (member.name() == "empty") {
      EXPECT_EQ(source.place(member.key.offset()).line, 4);
      EXPECT_EQ(source.place(member.key.offset()).column, 2);
      EXPECT_TRUE(member.value.members().begin() == member.value.members().end());
    }
  }
  EXPECT_FALSE(root.find("absent"));
}

TEST(JsonDocument, DecodesEscapesAndFindsTheirPlaces) {
  const SourceText source("scene.json", R"({"plain": "a", "esc\u0061pe": "\u00e4\n\ud83d\ude00=x", "k": "after"})");
  Diagnostics diagnostics;
  const auto document = JsonDocument::parse(source, diagnostics);
  ASSERT_TRUE(document) << diagnostics.text();
  const JsonValue value = document->root().find("escape");
  ASSERT_TRUE(value);
  EXPECT_EQ(value.text(), "\u00e4\n\U0001F600=x");
  EXPECT_EQ(document->root().find("k").text(), "after");
  const std::size_t equals = value.text().find('=');
  EXPECT_EQ(source.text()[source.offset_in_string(value.offset(), equals)], '=');
  EXPECT_EQ(source.offset_in_string(document->root().find("k").offset(), 2), document->root().find("k").offset() + 3);
}

TEST(JsonDocument, ReadsNumbersExactly) {
  for (const double value : {0.1, 1e-300, 123456789.123456789, 9007199254740993.0, 5e-324, -1.7976931348623157e308}) {
    char text[64];
    std::snprintf(text, sizeof text, "[%.17g]", value);
    const SourceText source("scene.json", text);
    Diagnostics diagnostics;
    const auto document = JsonDocument::parse(source, diagnostics);
    ASSERT_TRUE(document);
    EXPECT_EQ(document->root().elements().begin()->number(), value);
  }
}

TEST(JsonDocument, ToleratesAByteOrderMark) {
  EXPECT_EQ(errors_of("\xef\xbb\xbf{\"a\": 1}"), "");
  EXPECT_EQ(errors_of("\xef\xbb\xbf{\"a\": NaN}"), "1:7 NaN is not a number a scene can have; numbers are finite\n");
}

TEST(JsonDocument, ReportsEveryDuplicateKeyWithBothPlaces) {
  EXPECT_EQ(errors_of("{\"mass\": 1,\n  \"x\": {\"a\": 1, \"\\u0061\": 2},\n  \"mass\": 2}"),
            "2:17 duplicate key \"a\"; it was given before at line 2, column 9\n"
            "3:3 duplicate key \"mass\"; it was given before at line 1, column 2\n");
  std::string many = "{";
  for (int i = 0; i < 1000; ++i) many += "\"link" + std::to_string(i) + "\": 0,\n";
  EXPECT_EQ(errors_of(many + "\"last\": 0}"), "");
  EXPECT_EQ(errors_of(many + "\"link7\": 0}"),
            "1001:1 duplicate key \"link7\"; it was given before at line 8, column 1\n");
}

TEST(JsonDocument, ANumberTooLargeDoesNotHideWhatFollows) {
  EXPECT_EQ(errors_of("{\"a\": 1e400,\n \"b\": [-2e999, 3],\n \"a\": x}"),
            "1:7 the number 1e400 is too large\n"
            "2:8 the number -2e999 is too large\n"
            "3:7 \"x\" is not a value; text needs double quotes\n");
  const SourceText source("scene.json", "{\"a\": 1e400, \"b\": 2}");
  Diagnostics diagnostics;
  const auto document = JsonDocument::parse(source, diagnostics);
  ASSERT_TRUE(document);
  EXPECT_EQ(diagnostics.count(), 1u);
  EXPECT_EQ(document->root().find("b").number(), 2);
}

struct Wrong {
  const char* text;
  const char* error;
};

TEST(JsonDocument, NamesWhatIsWrongAndWhere) {
  const Wrong cases[] = {
      {"", "1:1 the text is empty; a scene is an object: {\"catena\": 1, ...}"},
      {"  // nothing\n", "2:1 the text is empty; a scene is an object: {\"catena\": 1, ...}"},
      {"{\"a\": 1,\n \"b\": {\"c\": [1, 2",
       "2:18 the text ends here, but the [ opened at line 2, column 13 is not closed"},
      {"{\"a\": 1,", "1:9 the text ends here, but the { opened at line 1, column 1 is not closed"},
      {"{\"a\"", "1:5 the text ends here, but the { opened at line 1, column 1 is not closed"},
      {"{\"a\":", "1:6 the text ends here, but the { opened at line 1, column 1 is not closed"},
      {"{\"a\": 1}\n{}", "2:1 unexpected text after the end of the scene"},
      {"{\"a\": 1} }", "1:10 unexpected text after the end of the scene"},
      {"{\"a\": 1,}", "1:8 remove this comma: } follows"},
      {"[1, 2, ]", "1:6 remove this comma: ] follows"},
      {"[,1]", "1:2 unexpected ,"},
      {"{\"a\": 1\n \"b\": 2}", "2:2 expected , or } here"},
      {"[1 2]", "1:4 expected , or ] here"},
      {"[1}", "1:3 expected , or ] here"},
      {"{\"a\" 1}", "1:6 expected : after this key"},
      {"{\"a\":, \"b\": 1}", "1:6 unexpected ,"},
      {"{a: 1}", "1:2 the key a needs double quotes"},
      {"{1: 1}", "1:2 expected a key in double quotes"},
      {"{'a': 1}", "1:2 text needs double quotes"},
      {"{\"a\": NaN}", "1:7 NaN is not a number a scene can have; numbers are finite"},
      {"{\"a\": -Infinity}", "1:7 -Infinity is not a number a scene can have; numbers are finite"},
      {"{\"a\": 1e400}", "1:7 the number 1e400 is too large"},
      {"{\"a\": [0, -1e999]}", "1:11 the number -1e999 is too large"},
      {"{\"a\": True}", "1:7 \"True\" is not a value; did you mean \"true\"?"},
      {"{\"a\": crank}", "1:7 \"crank\" is not a value; text needs double quotes"},
      {"{\"a\": 'x'}", "1:7 text needs double quotes"},
      {"{\"a\": .5}", "1:7 \".5\" is not a number; write it like -0.5, 12 or 1e-3"},
      {"{\"a\": +1}", "1:7 \"+1\" is not a number; write it like -0.5, 12 or 1e-3"},
      {"{\"a\": 1.}", "1:7 \"1.\" is not a number; write it like -0.5, 12 or 1e-3"},
      {"{\"a\": [01]}", "1:8 \"01\" is not a number; write it like -0.5, 12 or 1e-3"},
      {"{\"a\": 1-2}", "1:7 \"1-2\" is not a number; write it like -0.5, 12 or 1e-3"},
      {"{\"a\": 1.2.3}", "1:7 \"1.2.3\" is not a number; write it like -0.5, 12 or 1e-3"},
      {"{\"a\": -}", "1:7 \"-\" is not a number; write it like -0.5, 12 or 1e-3"},
      {"{\"a\": \"xy\n\"}", "1:7 this text is not closed with \" before the end of the line"},
      {"{\"a\": \"xy", "1:7 this text is not closed with \" before the end of the file"},
      {"{\"a\": \"x\ty\"}", "1:9 a control character in a text must be written as \\u0009"},
      {"{\"a\": \"x\\y\"}",
       "1:9 a backslash in a text must be doubled, or begin one of \\n \\t \\\" \\\\ \\/ \\b \\f \\r \\u"},
      {"{\"a\": \"\\u12g4\"}", "1:8 \\u must be followed by four hexadecimal digits"},
      {"{\"a\": \"\\ud800x\"}", "1:8 \\ud800 is half of a surrogate pair"},
      {"{\"\xc3\xa4\": \"x\xffy\"}", "1:9 invalid UTF-8: byte 0xff"},
      {"{\"a\xc3\": 1}", "1:4 invalid UTF-8: byte 0xc3"},
      {"\xff\xfe{", "1:1 unexpected byte 0xff; a scene is UTF-8 text"},
      {"{\"a\": 1 /* open", "1:9 this comment is not closed with */"},
      {"{\"a\": 1 # note\n}", "1:9 unexpected #; comments begin with //"},
      {"{\"a\": \xe2\x88\x92"
       "1}",
       "1:7 unexpected \xe2\x88\x92"},
  };
  for (const Wrong& wrong : cases) EXPECT_EQ(errors_of(wrong.text), std::string(wrong.error) + "\n") << wrong.text;
  EXPECT_EQ(errors_of(std::string_view("{}\0{", 4)), "1:3 unexpected byte 0x00; a scene is UTF-8 text\n");
}

TEST(JsonDocument, StopsAtTooDeepNesting) {
  const std::string open(64, '['), close(64, ']');
  EXPECT_EQ(errors_of(open + close), "");
  EXPECT_EQ(errors_of("[" + open + close + "]"), "1:65 nested more than 64 levels deep\n");
  // A hundred megabytes of brackets are read no further than the limit.
  const SourceText source("deep.json", std::string(100'000'000, '['));
  Diagnostics diagnostics;
  EXPECT_FALSE(JsonDocument::parse(source, diagnostics));
  ASSERT_EQ(diagnostics.count(), 1u);
  EXPECT_EQ(diagnostics.items()[0].column, 65);
  EXPECT_LT(diagnostics.items()[0].excerpt.size(), 200u);
}

/// Visits every value, so that a damaged tree would be noticed.
std::size_t walk(const JsonValue& value, const SourceText& source) {
  EXPECT_LT(value.offset(), source.text().size());
  std::size_t count = 1;
  switch (value.kind()) {
    case JsonKind::array:
      for (const JsonValue& element : value.elements()) count += walk(element, source);
      break;
    case JsonKind::object:
      for (const JsonMember member : value.members()) count += walk(member.key, source) + walk(member.value, source);
      break;
    case JsonKind::number:
      EXPECT_TRUE(std::isfinite(value.number()));
      EXPECT_TRUE(source.text()[value.offset()] == '-' || std::isdigit(source.text()[value.offset()]));
      break;
    case JsonKind::string:
      EXPECT_EQ(source.text()[value.offset()], '"');
      EXPECT_LE(value.text().size(), source.text().size());
      break;
    default:
      break;
  }
  return count;
}

TEST(JsonDocument, SurvivesDamagedTexts) {
  const std::string scene =
      "{\"catena\": 1, /* format */ \"gravity\": [0, -9.81],\n \"parameters\": {\"l\": \"120 mm\", \"b\": \"=l/2 + "
      "0.1\"},\n"
      " \"bodies\": {\"cr\\u0061nk\": {\"mass\": 2.5e-1, \"points\": {\"to\": [\"l\", 0]}}, \"\xc3\xa4\": {}}, // "
      "\xc3\xa4\n"
      " \"list\": [true, false, null, \"\\ud83d\\ude00\", -0, 1E5]}\n";
  const std::string bytes = "{}[]\",:/*\\u0159.eE+-tfn \n\xc3\xa4\xff";
  std::mt19937 random(12345);
  const auto pick = [&](std::size_t n) { return static_cast<std::size_t>(random()) % n; };
  std::size_t sound = 0, wrong = 0;
  for (int round = 0; round < 20000; ++round) {
    std::string text = scene;
    for (std::size_t edits = 1 + pick(4); edits > 0 && !text.empty(); --edits) {
      const std::size_t at = pick(text.size());
      switch (pick(5)) {
        case 0:
          text[at] = bytes[pick(bytes.size())];
          break;
        case 1:
          text.erase(at, 1 + pick(5));
          break;
        case 2:
          text.insert(at, 1, bytes[pick(bytes.size())]);
          break;
        case 3:
          text.insert(at, text.substr(pick(text.size()), pick(20)));
          break;
        default:
          text.resize(at);
          break;
      }
    }
    const SourceText source("damaged.json", text);
    Diagnostics diagnostics;
    const auto document = JsonDocument::parse(source, diagnostics);
    if (document) {
      ++sound;
      EXPECT_GE(walk(document->root(), source), 1u);
    } else {
      ++wrong;
      ASSERT_EQ(diagnostics.items().size() >= 1, true) << text;
      EXPECT_GE(diagnostics.items()[0].line, 1);
      EXPECT_FALSE(diagnostics.text().empty());
    }
  }
  EXPECT_GT(sound, 500u);
  EXPECT_GT(wrong, 5000u);
}

}  // namespace
}  // namespace catena
