// Expressions: values, ranks of operators, derivatives against differences, errors at their column.
#include "catena/scene/numbers/expression.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace catena {
namespace {

constexpr double pi = std::numbers::pi;

struct Fixture {
  ParameterNames names;
  std::vector<std::string> loops{"j", "k"};
  std::vector<double> values{0.3, 2.0, 7.0, -1.5};

  Fixture() {
    for (const char* name : {"crank", "rod", "k",
                             "gr\xc3\xb6\xc3\x9f"
                             "e"})
      names.add(name);
  }
  ExpressionScope scope(bool with_loops = false) const {
    return {&names, with_loops ? std::span<const std::string>(loops) : std::span<const std::string>()};
  }
};

double value(std::string_view text) {
  const Fixture f;
  const auto expression = Expression::parse(text, f.scope());
  if (!expression) {
    ADD_FAILURE() << text << ": " << expression.error.message;
    return 0;
  }
  return expression->evaluate<double>(f.values, {});
}

TEST(Expression, EvaluatesWithTheUsualRanks) {
  EXPECT_EQ(value("1 + 2 * 3"), 7);
  EXPECT_EQ(value("(1 + 2) * 3"), 9);
  EXPECT_EQ(value("10 - 4 - 3"), 3);
  EXPECT_EQ(value("24 / 4 / 3"), 2);
  EXPECT_EQ(value("2^3^2"), 512);
  EXPECT_EQ(value("-2^2"), -4);
  EXPECT_EQ(value("(-2)^2"), 4);
  EXPECT_EQ(value("(-2)^3"), -8);
  EXPECT_EQ(value("2^-1"), 0.5);
  EXPECT_EQ(value("2^-2^2"), 1.0 / 16);
  EXPECT_EQ(value("2 * -3"), -6);
  EXPECT_EQ(value("--3"), 3);
  EXPECT_EQ(value("+3 - +1"), 2);
  EXPECT_EQ(value("0^0"), 1);
  EXPECT_EQ(value(" 1e3 + .5 "), 1000.5);
  EXPECT_EQ(value("crank/2 + 0.1"), 0.3 / 2 + 0.1);
  EXPECT_EQ(value("gr\xc3\xb6\xc3\x9f"
                  "e*k"),
            -10.5);
}

TEST(Expression, KnowsItsFunctions) {
  EXPECT_EQ(value("sin(pi/6)"), std::sin(pi / 6));
  EXPECT_EQ(value("cos(1) + tan(1)"), std::cos(1.0) + std::tan(1.0));
  EXPECT_EQ(value("asin(0.5) - acos(0.5) + atan(2)"), std::asin(0.5) - std::acos(0.5) + std::atan(2.0));
  EXPECT_EQ(value("atan2(-1, -1)"), std::atan2(-1.0, -1.0));
  EXPECT_EQ(value("sqrt(2) * exp(1) * log(3)"), std::sqrt(2.0) * std::exp(1.0) * std::log(3.0));
  EXPECT_EQ(value("abs(-3)"), 3);
  EXPECT_EQ(value("min(3, 1, 2) + max(3, 1, 2)"), 4);
  EXPECT_EQ(value("min (rod, k)"), 2);
}

TEST(Expression, LoopVariablesComeBeforeParameters) {
  const Fixture f;
  const double loops[] = {10, 4};
  const auto expression = Expression::parse("100*j + k - 1", f.scope(true));
  ASSERT_TRUE(expression);
  EXPECT_EQ(expression->evaluate<double>(f.values, loops), 1003);
  // Outside a block the same name is the parameter.
  EXPECT_EQ(value("k"), 7);
  // The innermost block wins where nested blocks use one name.
  const std::vector<std::string> nested{"k", "k"};
  const auto inner = Expression::parse("k", {&f.names, nested});
  ASSERT_TRUE(inner);
  EXPECT_EQ(inner->evaluate<double>(f.values, loops), 4);
}

TEST(Expression, DerivativesAgreeWithDifferences) {
  ParameterNames names;
  names.add("a");
  names.add("b");
  const char* texts[] = {"a + b*a - b", "a/b",        "a^3 - b^2",     "a^b",          "(-a)^3*b",
                         "sin(a*b)",    "cos(a)/b",   "tan(a - b)",    "asin(a/3)",    "acos(b/3)",
                         "atan(a*b)",   "atan2(a,b)", "sqrt(a*b + 1)", "exp(a - b)",   "log(a + b)",
                         "abs(a - b)",  "min(a, b)",  "max(a*a, b)",   "-a^2/(1 + b)", "2^a*k^2"};
  const std::vector<std::string> loops{"k"};
  const double k[] = {3};
  for (const char* text : texts) {
    const auto expression = Expression::parse(text, {&names, loops});
    ASSERT_TRUE(expression) << text << expression.error.message;
    const double at[] = {0.7, 1.9};
    using D = Dual<double, 2>;
    const D seeded[] = {D::variable(at[0], 0), D::variable(at[1], 1)};
    const D dual = expression->evaluate<D>(seeded, k);
    EXPECT_EQ(dual.v, expression->evaluate<double>(at, k)) << text;
    for (std::size_t i = 0; i < 2; ++i) {
      const double h = 1e-6;
      double up[] = {at[0], at[1]}, down[] = {at[0], at[1]};
      up[i] += h;
      down[i] -= h;
      const double difference = (expression->evaluate<double>(up, k) - expression->evaluate<double>(down, k)) / (2 * h);
      // Central differences: h^2 f'''/6 + rounding / h, both below 1e-9 for values and slopes of order ten.
      EXPECT_NEAR(dual.d[i], difference, 2e-9 * (1 + std::abs(difference))) << text << " by " << names.all()[i];
    }
  }
}

TEST(Expression, RefusesWhatItCannotRead) {
  const struct {
    const char* text;
    std::size_t position;
    const char* message;
  } cases[] = {
      {"", 0, "expected an expression"},
      {"1 +", 3, "the expression is incomplete"},
      {"1 + * 2", 4, "unexpected \"*\" in an expression"},
      {"(1 + 2", 0, "this ( is not closed"},
      {"1 + 2)", 5, "this ) was never opened"},
      {"()", 1, "unexpected \")\" in an expression"},
      {"sin(1", 3, "this ( is not closed"},
      {"sin", 0, "sin is a function: write sin(...)"},
      {"sin 1", 0, "sin is a function: write sin(...)"},
      {"2 + sin(1, 2)", 4, "sin takes 1 value, not 2"},
      {"atan2(1)", 0, "atan2 takes 2 values, not 1"},
      {"min(1)", 0, "min takes at least 2 values, not 1"},
      {"sni(1)", 0, "unknown function \"sni\"; did you mean \"sin\"?"},
      {"2*cranc", 2, "unknown parameter \"cranc\"; did you mean \"crank\"?"},
      {"2*whatever", 2, "unknown parameter \"whatever\""},
      {"2 pi", 2, "expected an operator here; numbers in an expression have no units, they are SI and radians"},
      {"120 mm", 4, "expected an operator here; numbers in an expression have no units, they are SI and radians"},
      {"crank rod", 6, "expected an operator here"},
      {"2(3)", 1, "expected an operator here"},
      {"2**3", 1, "write ^ for a power"},
      {"1e999", 0, "this number is too large"},
      {"crank.x", 5, "expected an operator here"},
      {"1,2", 1, "unexpected \",\" in an expression"},
      {"1 \xe2\x88\x92 2", 2, "unexpected \"\xe2\x88\x92\" in an expression"},
      {"1 & 2", 2, "unexpected \"&\" in an expression"},
  };
  const Fixture f;
  for (const auto& c : cases) {
    const auto expression = Expression::parse(c.text, f.scope());
    ASSERT_FALSE(expression) << c.text;
    EXPECT_EQ(expression.error.position, c.position) << c.text;
    EXPECT_EQ(expression.error.message, c.message) << c.text;
  }
}

TEST(Expression, LimitsItsDepth) {
  const Fixture f;
  const auto deep = [&](int n) {
    return std::string(static_cast<std::size_t>(n), '(') + "1" + std::string(static_cast<std::size_t>(n), ')');
  };
  EXPECT_TRUE(Expression::parse(deep(60), f.scope()));
  EXPECT_FALSE(Expression::parse(deep(100), f.scope()));
  EXPECT_FALSE(Expression::parse(deep(1000000), f.scope()));
  EXPECT_FALSE(Expression::parse(std::string(1000000, '-') + "1", f.scope()));
  std::string waiting = "1";
  for (int i = 0; i < 40; ++i) waiting = "1+(" + waiting + ")";
  const auto refused = Expression::parse(waiting, f.scope());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error.message, "this expression is nested too deeply; give a part of it a parameter");
  std::string sum = "1";
  for (int i = 0; i < 10000; ++i) sum += "+1";
  EXPECT_EQ(value(sum), 10001);
}

TEST(Expression, ReportsValuesThatDoNotExistAtTheirOperation) {
  const struct {
    const char* text;
    std::size_t position;
    const char* message;
  } cases[] = {
      {"1 + crank/(rod - 2)", 9, "division by zero: 0.3 / 0"},
      {"0/0", 1, "division by zero: 0 / 0"},
      {"sqrt(-4)", 0, "sqrt(-4) has no finite value"},
      {"2*log(0)", 2, "log(0) has no finite value"},
      {"asin(rod)", 0, "asin(2) has no finite value"},
      {"exp(1000) * 0", 0, "exp(1000) has no finite value"},
      {"1/exp(1000)", 2, "exp(1000) has no finite value"},
      {"1e300 * 1e300", 6, "1e+300 * 1e+300 has no finite value"},
      {"(-2)^0.5", 4, "-2 ^ 0.5 has no finite value"},
      {"0^-1", 1, "0 ^ -1 has no finite value"},
  };
  const Fixture f;
  for (const auto& c : cases) {
    const auto expression = Expression::parse(c.text, f.scope());
    ASSERT_TRUE(expression) << c.text;
    try {
      expression->evaluate<double>(f.values, {});
      ADD_FAILURE() << c.text << " has a value";
    } catch (const ExpressionError& error) {
      EXPECT_EQ(error.position, c.position) << c.text;
      EXPECT_STREQ(error.what(), c.message) << c.text;
    }
  }
  // A parameter that was wrong before gives no second error.
  const double nan[] = {std::nan(""), 2, 7, 0};
  EXPECT_TRUE(std::isnan(Expression::parse("sqrt(crank)/rod", f.scope())->evaluate<double>(nan, {})));
}

TEST(Expression, SurvivesDamagedTexts) {
  const Fixture f;
  const std::string sound =
      "max(crank/2 + 0.1, -sin(k*pi)^2) * (rod - atan2(1e-3, gr\xc3\xb6\xc3\x9f"
      "e))";
  const std::string bytes = "()+-*/^,.=kpe19 \xc3{}\"";
  std::mt19937 random(4711);
  const auto pick = [&](std::size_t n) { return static_cast<std::size_t>(random()) % n; };
  int read = 0, refused = 0;
  for (int round = 0; round < 20000; ++round) {
    std::string text = sound;
    for (std::size_t edits = 1 + pick(3); edits > 0 && !text.empty(); --edits) {
      const std::size_t at = pick(text.size());
      if (pick(2) == 0) {
        text[at] = bytes[pick(bytes.size())];
      } else {
        text.erase(at, 1 + pick(4));
      }
    }
    const auto expression = Expression::parse(text, f.scope());
    if (!expression) {
      ++refused;
      EXPECT_LE(expression.error.position, text.size());
      continue;
    }
    ++read;
    try {
      EXPECT_TRUE(std::isfinite(expression->evaluate<double>(f.values, {}))) << text;
    } catch (const ExpressionError& error) {
      EXPECT_LT(error.position, text.size());
    }
  }
  EXPECT_GT(read, 500);
  EXPECT_GT(refused, 5000);
}

}  // namespace
}  // namespace catena
