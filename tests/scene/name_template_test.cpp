// Names with expressions in braces, and the rules names follow.
#include "catena/scene/numbers/name_template.hpp"

#include <gtest/gtest.h>

#include "catena/scene/numbers/name_rules.hpp"

namespace catena {
namespace {

struct Names {
  ParameterNames parameters;
  std::vector<std::string> loops{"k"};
  ExpressionScope scope;

  Names() {
    parameters.add("N");
    scope = {&parameters, loops};
  }

  std::string text(std::string_view name, double k) const {
    const auto parsed = NameTemplate::parse(name, scope);
    if (!parsed) return std::to_string(parsed.error.position) + " " + parsed.error.message;
    const double values[] = {40}, variables[] = {k};
    std::string out;
    try {
      parsed->append_to(out, values, variables);
    } catch (const ExpressionError& error) {
      return std::to_string(error.position) + " " + error.what();
    }
    return out;
  }
};

TEST(NameTemplate, WritesIntegers) {
  const Names names;
  EXPECT_EQ(names.text("link{k}", 7), "link7");
  EXPECT_EQ(names.text("link{k-1}.to", 1), "link0.to");
  EXPECT_EQ(names.text("link{k-1}", 0), "link-1");
  EXPECT_EQ(names.text("{k}x{N-k}y{ 2*k }z", 3), "3x37y6z");
  EXPECT_EQ(names.text("plain", 3), "plain");
  EXPECT_EQ(names.text("n{k*0.1*10}", 3), "n3");  // 0.1 * 3 * 10 is not quite 3
  EXPECT_EQ(names.text("n{1e6 + k}", 1), "n1000001");
  EXPECT_EQ(names.text("n{-0*k}", 1), "n0");
}

TEST(NameTemplate, SaysWhatIsWrongAndWhere) {
  const Names names;
  EXPECT_EQ(names.text("link{k/2}", 3), "5 a name needs an integer here, but k/2 is 1.5");
  EXPECT_EQ(names.text("link{1e17*k}", 3), "5 a name needs an integer here, but 1e17*k is 3e+17");
  EXPECT_EQ(names.text("a{6/(k-3)}", 3), "3 division by zero: 6 / 0");
  EXPECT_EQ(names.text("link{k", 3), "4 this { is not closed");
  EXPECT_EQ(names.text("link}k{", 3), "4 this } was never opened");
  EXPECT_EQ(names.text("link{}", 3), "5 expected an expression");
  EXPECT_EQ(names.text("link{i}", 3), "5 unknown parameter \"i\"");
  EXPECT_EQ(names.text("link{k}{n}", 3), "8 unknown parameter \"n\"; did you mean \"N\"?");
}

TEST(NameTemplate, AppendsWithoutAllocating) {
  const Names names;
  const auto parsed = NameTemplate::parse("link{k}", names.scope);
  ASSERT_TRUE(parsed);
  EXPECT_EQ(parsed->sample(), "link0");
  EXPECT_TRUE(NameTemplate::has_braces("link{k}"));
  EXPECT_FALSE(NameTemplate::has_braces("link"));
  std::string out;
  out.reserve(64);
  const char* const memory = out.data();
  for (int k = 0; k < 100; ++k) {
    const double variables[] = {static_cast<double>(k)};
    out.clear();
    parsed->append_to(out, {}, variables);
    EXPECT_EQ(out, "link" + std::to_string(k));
  }
  EXPECT_EQ(out.data(), memory);
}

TEST(NameRules, AllowAnyUnicodeButNotWhatColumnsNeed) {
  for (const char* good : {"crank", "link 1", "Kurbel\xc3\xa4", "1", "x", "T", "a-b/c", "\xe6\xa9\x9f\xe6\xa2\xb0"}) {
    EXPECT_EQ(element_name_problem(good), "") << good;
  }
  EXPECT_EQ(element_name_problem(""), "a name may not be empty");
  EXPECT_EQ(element_name_problem(" a"), "the name \" a\" may not begin or end with a blank");
  EXPECT_EQ(element_name_problem("a "), "the name \"a \" may not begin or end with a blank");
  EXPECT_EQ(element_name_problem("a.b"), "the name \"a.b\" may not have a .");
  EXPECT_EQ(element_name_problem("a#1"), "the name \"a#1\" may not have a #");
  EXPECT_EQ(element_name_problem("a{"), "the name \"a{\" may not have a {");
  EXPECT_EQ(element_name_problem("a\nb"), "the name \"a\\u000ab\" may not have control characters");
  for (const char* taken : {"ground", "t", "energy", "momentum", "residual"}) {
    EXPECT_EQ(element_name_problem(taken), "the name \"" + std::string(taken) + "\" is taken; choose another");
  }
}

TEST(NameRules, PointsAreNoBodyColumns) {
  for (const char* column : {"x", "y", "angle", "vx", "vy", "omega", "ax", "ay", "alpha"}) {
    EXPECT_EQ(point_name_problem(column),
              "a point may not be called \"" + std::string(column) + "\": that is a column of every body");
  }
  EXPECT_EQ(point_name_problem("to"), "");
  EXPECT_EQ(point_name_problem("t"), "");
  EXPECT_EQ(point_name_problem("a.b"), "the name \"a.b\" may not have a .");
}

TEST(NameRules, ParametersCanStandInExpressions) {
  EXPECT_EQ(parameter_name_problem("crank_2"), "");
  EXPECT_EQ(parameter_name_problem("l\xc3\xa4nge"), "");
  EXPECT_EQ(parameter_name_problem("sin"), "the name \"sin\" is taken by expressions; choose another");
  EXPECT_EQ(parameter_name_problem("pi"), "the name \"pi\" is taken by expressions; choose another");
  for (const char* bad : {"", "2a", "a-b", "a b", "a.b"}) {
    EXPECT_EQ(parameter_name_problem(bad), "the parameter name \"" + std::string(bad) +
                                               "\" cannot stand in an expression; use letters, digits and _, no "
                                               "digit first");
  }
}

}  // namespace
}  // namespace catena
