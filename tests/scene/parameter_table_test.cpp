// Parameters: any order, circles by name, limits, replaced definitions, derivatives through dependent definitions.
#include "catena/scene/numbers/parameter_table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace catena {
namespace {

struct Table {
  SourceText source;
  Diagnostics diagnostics;
  std::optional<JsonDocument> document;
  ExpressionPool pool;
  ParameterTable table;

  explicit Table(std::string_view text) : source("s.json", text) {
    document = JsonDocument::parse(source, diagnostics);
    if (document) table = ParameterTable::read(document->root(), pool, diagnostics);
  }
  double value(std::string_view name) {
    return table.evaluate<double>(pool, diagnostics)[static_cast<std::size_t>(table.names().find(name))];
  }
  std::string errors() const {
    std::string all;
    for (const Diagnostic& d : diagnostics.items()) {
      all += std::to_string(d.line) + ":" + std::to_string(d.column) + " " + d.message + "\n";
    }
    return all;
  }
};

TEST(ParameterTable, EvaluatesInAnyOrder) {
  Table t(
      "{\"c\": \"=a*b\", \"b\": \"=2*a\", \"a\": \"120 mm\", \"d\": \"c\", \"e\": {\"value\": \"30 deg\", \"min\": 0, "
      "\"max\": \"=pi\"}}");
  EXPECT_EQ(t.value("a"), 0.12);
  EXPECT_EQ(t.value("b"), 0.24);
  EXPECT_EQ(t.value("c"), 0.12 * 0.24);
  EXPECT_EQ(t.value("d"), 0.12 * 0.24);
  EXPECT_EQ(t.value("e"), std::numbers::pi / 6);
  EXPECT_EQ(t.errors(), "");
  EXPECT_EQ(t.table.names().dimension(t.table.names().find("a")), dimension_of(UnitKind::length));
  EXPECT_FALSE(t.table.names().dimension(t.table.names().find("c")));
}

TEST(ParameterTable, NamesCircles) {
  Table t(
      "{\"a\": \"=b + 1\",\n \"b\": \"=2*c\",\n \"c\": \"=a - b0\", \"b0\": 1,\n \"own\": \"own\", \"user\": \"=a + "
      "1\"}");
  EXPECT_EQ(t.errors(),
            "1:7 parameters depend on each other in a circle: a -> b -> c -> a\n"
            "4:9 parameters depend on each other in a circle: own -> own\n");
  EXPECT_TRUE(std::isnan(t.value("user")));  // no further error where they are used
  EXPECT_EQ(t.value("b0"), 1);
  EXPECT_EQ(t.diagnostics.count(), 2u);
}

TEST(ParameterTable, FollowsLongChains) {
  std::string text = "{";
  for (int i = 0; i < 20000; ++i) text += "\"p" + std::to_string(i) + "\": \"=p" + std::to_string(i + 1) + " + 1\",\n";
  Table t(text + "\"p20000\": 0}");
  EXPECT_EQ(t.errors(), "");
  EXPECT_EQ(t.value("p0"), 20000);
}

TEST(ParameterTable, ReportsWrongDefinitions) {
  const auto errors = [](std::string_view text) {
    Table t(text);
    t.table.evaluate<double>(t.pool, t.diagnostics);
    return t.errors();
  };
  EXPECT_EQ(errors("{\"a\": 1, \"b\": \"=1/(a-1)\", \"c\": \"=b*2\"}"), "1:18 division by zero: 1 / 0\n");
  EXPECT_EQ(errors("{\"crank\": 1, \"b\": \"=cranc\"}"),
            "1:21 \"value\" of parameter \"b\": unknown parameter \"cranc\"; did you mean \"crank\"?\n");
  EXPECT_EQ(errors("{\"a\": \"0.5\"}"),
            "1:7 \"value\" of parameter \"a\": \"0.5\" is a number in quotes: write 0.5, or give it a unit\n");
  EXPECT_EQ(
      errors("{\"a\": true}"),
      "1:7 \"value\" of parameter \"a\" must be a number, for example 0.5, \"120 mm\" or \"=2*a\"; this is true or "
      "false\n");
  EXPECT_EQ(errors("{\"2a\": 1, \"sin\": 2}"),
            "1:2 the parameter name \"2a\" cannot stand in an expression; use letters, digits and _, no digit first\n"
            "1:11 the name \"sin\" is taken by expressions; choose another\n");
  EXPECT_EQ(errors("{\"a\": {\"min\": 0}}"), "1:7 parameter \"a\" needs a \"value\"\n");
  EXPECT_EQ(errors("{\"a\": {\"value\": 1, \"mx\": 0}}"),
            "1:20 unknown key \"mx\" in parameter \"a\"; did you mean \"max\"?\n");
  EXPECT_EQ(errors("{\"a\": {\"value\": \"1 m\", \"max\": \"2 kg\"}}"),
            "1:31 \"max\" of parameter \"a\" must be a length, for example \"120 mm\"; \"2 kg\" is a mass\n");
  EXPECT_EQ(errors("[1]"), "1:1 \"parameters\" must be an object of names and numbers; this is a list\n");
}

TEST(ParameterTable, ChecksLimits) {
  Table t(
      "{\"a\": {\"value\": 5, \"min\": \"=b\", \"max\": 10}, \"b\": 6,\n \"c\": {\"value\": \"2 m\", \"max\": \"150 "
      "cm\"}}");
  EXPECT_TRUE(std::isnan(t.value("a")));
  EXPECT_EQ(t.errors(),
            "1:17 parameter \"a\" is 5, less than its min 6\n"
            "2:17 parameter \"c\" is 2, more than its max 1.5\n");
}

TEST(ParameterTable, TakesOtherDefinitions) {
  Table t("{\"a\": {\"value\": 1, \"max\": 10}, \"b\": \"=2*a\", \"l\": \"1 m\"}");
  const SourceText set_source("set", "{\"a\": \"=3 + 1\", \"l\": \"50 cm\"}");
  const auto set = JsonDocument::parse(set_source, t.diagnostics);
  t.table.set(set->root(), t.pool, t.diagnostics);
  EXPECT_EQ(t.value("b"), 8);
  EXPECT_EQ(t.value("l"), 0.5);
  EXPECT_EQ(t.errors(), "");

  const SourceText wrong_source("set", "{\"a\": 11, \"bb\": 1, \"l\": \"2 kg\"}");
  const auto wrong = JsonDocument::parse(wrong_source, t.diagnostics);
  t.table.set(wrong->root(), t.pool, t.diagnostics);
  EXPECT_TRUE(std::isnan(t.value("a")));
  EXPECT_EQ(t.errors(),
            "1:11 unknown parameter \"bb\"; did you mean \"b\"?\n"
            "1:25 \"value\" of parameter \"l\" must be a length, for example \"120 mm\"; \"2 kg\" is a mass\n"
            "1:7 parameter \"a\" is 11, more than its max 10\n");
  EXPECT_EQ(t.diagnostics.items()[0].file, "set");
}

TEST(ParameterTable, SetMayCloseACircle) {
  Table t("{\"a\": 1, \"b\": \"=a\"}");
  const SourceText set_source("set", "{\"a\": \"b\"}");
  const auto set = JsonDocument::parse(set_source, t.diagnostics);
  t.table.set(set->root(), t.pool, t.diagnostics);
  EXPECT_EQ(t.errors(), "1:7 parameters depend on each other in a circle: a -> b -> a\n");
}

TEST(ParameterTable, CarriesDerivativesThroughDefinitions) {
  Table t("{\"b\": \"=a^2*c\", \"a\": 3, \"c\": \"=a + 1\", \"d\": \"=b\"}");
  using D = Dual<double, 4>;
  const auto& names = t.table.names();
  const ParameterSeed<D> seeds[] = {{names.find("a"), D::variable(3, 0)}, {names.find("c"), D::variable(5, 1)}};
  const auto values = t.table.evaluate<D>(t.pool, t.diagnostics, seeds);
  const D b = values[static_cast<std::size_t>(names.find("d"))];
  EXPECT_EQ(b.v, 45);     // c is 5 now, not a + 1
  EXPECT_EQ(b.d[0], 30);  // 2 a c
  EXPECT_EQ(b.d[1], 9);   // a^2
  const ParameterSeed<D> only_a[] = {{names.find("a"), D::variable(3, 0)}};
  EXPECT_EQ(t.table.evaluate<D>(t.pool, t.diagnostics, only_a)[static_cast<std::size_t>(names.find("b"))].d[0],
            33);  // 2 a (a + 1) + a^2
}

}  // namespace
}  // namespace catena
