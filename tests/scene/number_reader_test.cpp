// Numbers of a scene: what each way of writing one means, and the message, line and column of every mistake.
#include "catena/scene/numbers/number_reader.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "catena/scene/numbers/evaluation.hpp"

namespace catena {
namespace {

/// A document {"value": ...} with parameters l = "120 mm", N = 40 and the replicate variable k.
struct Scene {
  SourceText source;
  Diagnostics diagnostics;
  std::optional<JsonDocument> document;
  ParameterNames parameters;
  ExpressionPool pool;
  NumberReader reader{parameters, pool, diagnostics};

  explicit Scene(const std::string& value) : source("s.json", "{\"value\":\n  " + value + "}") {
    document = JsonDocument::parse(source, diagnostics);
    parameters.set_dimension(parameters.add("length"), dimension_of(UnitKind::length));
    parameters.add("N");
    reader.enter_block("k");
  }
  JsonValue value() const { return document->root().find("value"); }

  double evaluate_with(const NumberValue& number, double k) {
    const double values[] = {0.12, 40};
    Evaluation<double> evaluation(source, pool, values, diagnostics);
    evaluation.enter_block("k");
    evaluation.set_variable(k);
    return evaluation(number);
  }
  std::string errors() const {
    std::string all;
    for (const Diagnostic& d : diagnostics.items()) {
      all += std::to_string(d.line) + ":" + std::to_string(d.column) + " " + d.message + "\n";
    }
    return all;
  }
};

double value_of_number(const std::string& text, UnitKind kind) {
  Scene scene(text);
  const NumberValue number = scene.reader.read(scene.value(), kind, {"field", "body \"b\""});
  const double value = scene.evaluate_with(number, 3);
  EXPECT_EQ(scene.errors(), "") << text;
  return value;
}

std::string error_of_number(const std::string& text, UnitKind kind) {
  Scene scene(text);
  const NumberValue number = scene.reader.read(scene.value(), kind, {"mass", "body \"crank\""});
  EXPECT_TRUE(std::isnan(scene.evaluate_with(number, 3))) << text;
  return scene.errors();
}

TEST(NumberReader, ReadsEveryWayOfWritingANumber) {
  EXPECT_EQ(value_of_number("0.12", UnitKind::length), 0.12);
  EXPECT_EQ(value_of_number("-3", UnitKind::torque), -3);
  EXPECT_EQ(value_of_number("\"120 mm\"", UnitKind::length), 0.12);
  EXPECT_EQ(value_of_number("\"-30 deg\"", UnitKind::angle), -std::numbers::pi / 6);
  EXPECT_EQ(value_of_number("\"=length/2 + 0.1\"", UnitKind::length), 0.12 / 2 + 0.1);
  EXPECT_EQ(value_of_number("\"length\"", UnitKind::length), 0.12);
  EXPECT_EQ(value_of_number("\"N\"", UnitKind::mass), 40);  // plain numbers are SI of any kind
  EXPECT_EQ(value_of_number("\"=k/N\"", UnitKind::none), 3.0 / 40);
  EXPECT_EQ(value_of_number("\"k\"", UnitKind::none), 3);
}

TEST(NumberReader, SaysWhatIsWrongAndWhere) {
  const struct {
    const char* text;
    UnitKind kind;
    const char* error;
  } cases[] = {
      {"\"3 m\"", UnitKind::mass,
       "2:3 \"mass\" of body \"crank\" must be a mass, for example \"2 kg\"; \"3 m\" is a length"},
      {"\"length\"", UnitKind::mass,
       "2:3 \"mass\" of body \"crank\" must be a mass, for example \"2 kg\"; \"length\" is a length"},
      {"\"3 m\"", UnitKind::none,
       "2:3 \"mass\" of body \"crank\" must be a pure number, for example 0.5; \"3 m\" is a length"},
      {"\"2 1/s\"", UnitKind::angular_velocity,
       "2:3 \"mass\" of body \"crank\" must be an angular velocity, for example \"2 rad/s\" or \"60 rpm\"; \"2 1/s\" "
       "is "
       "a quantity in 1/s"},
      {"\"6 N m\"", UnitKind::torsion_stiffness,
       "2:3 \"mass\" of body \"crank\" must be a torsional stiffness, for example \"6 N m/rad\"; \"6 N m\" is a torque "
       "or an energy"},
      {"true", UnitKind::mass,
       "2:3 \"mass\" of body \"crank\" must be a mass, for example \"2 kg\"; this is true or false"},
      {"null", UnitKind::mass, "2:3 \"mass\" of body \"crank\" must be a mass, for example \"2 kg\"; this is null"},
      {"[1]", UnitKind::mass, "2:3 \"mass\" of body \"crank\" must be a mass, for example \"2 kg\"; this is a list"},
      {"\"\"", UnitKind::mass,
       "2:3 \"mass\" of body \"crank\" must be a mass, for example \"2 kg\"; this text is empty"},
      {"\"0.12\"", UnitKind::length,
       "2:3 \"mass\" of body \"crank\": \"0.12\" is a number in quotes: write 0.12 (in m) or \"0.12 m\""},
      {"\"0.12\"", UnitKind::none, "2:3 \"mass\" of body \"crank\": \"0.12\" is a number in quotes: write 0.12"},
      {"\"3 kgg\"", UnitKind::mass, "2:6 \"mass\" of body \"crank\": unknown unit \"kgg\"; did you mean \"kg\"?"},
      {"\"=1 + lenght\"", UnitKind::length,
       "2:9 \"mass\" of body \"crank\": unknown parameter \"lenght\"; did you mean \"length\"?"},
      {"\"=\"", UnitKind::length, "2:5 \"mass\" of body \"crank\": expected an expression"},
      {"\"=\\u0031 + lenght\"", UnitKind::length,  // columns count the escape as written
       "2:14 \"mass\" of body \"crank\": unknown parameter \"lenght\"; did you mean \"length\"?"},
      {"\"lenght\"", UnitKind::length,
       "2:3 \"mass\" of body \"crank\": unknown parameter \"lenght\"; did you mean \"length\"?"},
      {"\"length/2\"", UnitKind::length,
       "2:3 \"mass\" of body \"crank\": unknown parameter \"length/2\"; an expression begins with ="},
      {"\"2*length\"", UnitKind::length,
       "2:5 \"mass\" of body \"crank\": expected a unit here; an expression begins with ="},
      {"\"N*length\"", UnitKind::length,
       "2:3 \"mass\" of body \"crank\": unknown parameter \"N*length\"; an expression begins with ="},
      {"\"heavy\"", UnitKind::mass,
       "2:3 \"mass\" of body \"crank\": unknown parameter \"heavy\"; a quantity begins with a digit, an expression "
       "with ="},
      {"\"=1/(k-3)\"", UnitKind::mass, "2:6 division by zero: 1 / 0 (at k = 3)"},
      {"\"=sqrt(-k)\"", UnitKind::mass, "2:5 sqrt(-3) has no finite value (at k = 3)"},
  };
  for (const auto& c : cases) EXPECT_EQ(error_of_number(c.text, c.kind), std::string(c.error) + "\n") << c.text;
}

TEST(NumberReader, ReadsPairsAndLists) {
  Scene pair("[\"=length\", \"5 mm\"]");
  const auto xy = pair.reader.read_pair(pair.value(), dimension_of(UnitKind::length), {"position"});
  EXPECT_EQ(pair.evaluate_with(xy[0], 0), 0.12);
  EXPECT_EQ(pair.evaluate_with(xy[1], 0), 0.005);
  EXPECT_EQ(pair.errors(), "");

  const auto error_of_pair = [](const std::string& text) {
    Scene scene(text);
    scene.reader.read_pair(scene.value(), dimension_of(UnitKind::length), {"position", "body \"b\""});
    return scene.errors();
  };
  EXPECT_EQ(error_of_pair("[1, 2, 3]"),
            "2:3 \"position\" of body \"b\" must be a list of two numbers [x, y]; this is a list of 3\n");
  EXPECT_EQ(error_of_pair("1"),
            "2:3 \"position\" of body \"b\" must be a list of two numbers [x, y]; this is a number\n");
  EXPECT_EQ(error_of_pair("[\"1 kg\", \"1\"]"),
            "2:4 \"position\" of body \"b\" must be a length, for example \"120 mm\"; \"1 kg\" is a mass\n"
            "2:12 \"position\" of body \"b\": \"1\" is a number in quotes: write 1 (in m) or \"1 m\"\n");

  Scene list("[1, \"2 s\", \"=N\"]");
  const auto numbers = list.reader.read_list(list.value(), dimension_of(UnitKind::time), {"t"});
  ASSERT_EQ(numbers.size(), 3u);
  EXPECT_EQ(list.evaluate_with(numbers[2], 0), 40);
  EXPECT_EQ(list.errors(), "");
  Scene wrong("{}");
  EXPECT_TRUE(wrong.reader.read_list(wrong.value(), std::nullopt, {"t"}).empty());
  EXPECT_EQ(wrong.errors(), "2:3 \"t\" must be a list of numbers; this is an object\n");
}

TEST(NumberReader, KeepsEqualExpressionsOnce) {
  Scene scene("[\"=N/2\", \"=N/2\", \"=N/3\"]");
  const auto numbers = scene.reader.read_list(scene.value(), std::nullopt, {"list"});
  EXPECT_EQ(scene.pool.size(), 2u);
  EXPECT_EQ(numbers[0].index(), numbers[1].index());
  EXPECT_NE(numbers[0].offset(), numbers[1].offset());
  // The same text means something else where other variables are known.
  scene.reader.enter_block("N");
  const NumberValue inner = scene.reader.read(*scene.value().elements().begin(), std::nullopt, {"list"});
  EXPECT_NE(inner.index(), numbers[0].index());
  scene.reader.leave_block();
}

TEST(Evaluation, ReportsNamesWithTheVariables) {
  Scene scene("\"a{6/(k-2)}\"");
  const auto name = NameTemplate::parse(scene.value().text(), scene.reader.scope());
  ASSERT_TRUE(name);
  const double values[] = {0.12, 40};
  Evaluation<double> evaluation(scene.source, scene.pool, values, scene.diagnostics);
  evaluation.enter_block("k");
  std::string out;
  evaluation.set_variable(4);
  EXPECT_TRUE(evaluation.append_name(*name, scene.value().offset(), out));
  EXPECT_EQ(out, "a3");
  evaluation.set_variable(2);
  EXPECT_FALSE(evaluation.append_name(*name, scene.value().offset(), out));
  evaluation.set_variable(6);
  EXPECT_FALSE(evaluation.append_name(*name, scene.value().offset(), out));
  EXPECT_EQ(scene.errors(),
            "2:7 division by zero: 6 / 0 (at k = 2)\n"
            "2:6 a name needs an integer here, but 6/(k-2) is 1.5 (at k = 6)\n");
}

/// Reads every value below as a number and every text as a name too.
void read_all(const JsonValue& value, NumberReader& reader, const Evaluation<double>& evaluation) {
  if (value.is(JsonKind::array)) {
    for (const JsonValue& element : value.elements()) read_all(element, reader, evaluation);
  } else if (value.is(JsonKind::object)) {
    for (const JsonMember member : value.members()) {
      read_all(member.key, reader, evaluation);
      read_all(member.value, reader, evaluation);
    }
  } else {
    evaluation(reader.read(value, dimension_of(UnitKind::length), {"field", "body \"b\""}));
    if (!value.is(JsonKind::string)) return;
    std::string out;
    if (const auto name = NameTemplate::parse(value.text(), reader.scope())) {
      evaluation.append_name(*name, value.offset(), out);
    }
  }
}

TEST(NumberReader, SurvivesDamagedScenes) {
  const std::string scene =
      "{\"name\": \"link{k-1}.to\", \"n\": \"{k}x{N-2*k}\", \"p\": [\"=length*(k-0.5)/N\", \"120 mm\", -2.5e-1],\n"
      " \"q\": \"6 N m/rad^2\", \"e\": \"=max(sin(\\u0070i/4)^2, atan2(k,2))\", \"l\": \"length\", \"r\": \"-60 rpm\"}";
  const std::string bytes = "{}[]\",:/\\u01.eE+-^=*() km\xc3\xa4";
  std::mt19937 random(99);
  const auto pick = [&](std::size_t n) { return static_cast<std::size_t>(random()) % n; };
  std::size_t read = 0, errors = 0;
  for (int round = 0; round < 10000; ++round) {
    std::string text = scene;
    for (std::size_t edits = 1 + pick(3); edits > 0 && !text.empty(); --edits) {
      const std::size_t at = pick(text.size());
      if (pick(3) == 0) {
        text.erase(at, 1 + pick(3));
      } else {
        text[at] = bytes[pick(bytes.size())];
      }
    }
    Scene damaged(text);
    if (!damaged.document) continue;
    ++read;
    const double values[] = {0.12, 40};
    Evaluation<double> evaluation(damaged.source, damaged.pool, values, damaged.diagnostics);
    evaluation.enter_block("k");
    evaluation.set_variable(3);
    read_all(damaged.document->root(), damaged.reader, evaluation);
    for (const Diagnostic& error : damaged.diagnostics.items()) {
      ++errors;
      EXPECT_GE(error.line, 1);
      EXPECT_LE(error.line, 3);
      EXPECT_FALSE(error.message.empty());
    }
  }
  EXPECT_GT(read, 1000u);
  EXPECT_GT(errors, read);
}

}  // namespace
}  // namespace catena
