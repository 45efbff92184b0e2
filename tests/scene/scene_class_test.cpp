// Scenes in C++ programs: loaded, changed, run again; everything that may be asked wrongly.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "catena/scene/loading/scene.hpp"

namespace catena::testing {
namespace {

constexpr auto turning = R"--({"catena": 1, "parameters": {"speed": 2, "turn": "30 deg"},
  "bodies": {"crank": {"mass": 1, "rod": {"from": [0, 0], "to": [1, 0]}}},
  "constraints": [{"type": "revolute", "i": "ground", "j": "crank.from"}],
  "drivers": [{"type": "absolute_angle", "i": "crank", "value": {"polynomial": ["turn", "speed"]}}],
  "outputs": ["crank.angle"],
  "analyses": [{"type": "kinematics", "until": 1, "every": 0.25, "measures": {"end": {"final": "crank.angle"},
    "root": {"final": "=sqrt(-1 - t)"}}}, {"type": "assemble"}]})--";

TEST(SceneClass, RunsAgainWithOtherParameters) {
  Scene scene = Scene::loads(turning);
  ASSERT_EQ(scene.parameters().size(), 2u);
  EXPECT_EQ(scene.parameters()[1].first, "turn");
  EXPECT_NEAR(scene.parameters()[1].second, std::numbers::pi / 6, 1e-15);
  for (const double speed : {-1.0, 0.1, 1.0 / 3}) {
    const SceneResults results = scene.set("speed", speed).set("turn", "=speed/2").run();
    ASSERT_TRUE(results.ok());
    EXPECT_EQ(results.size(), 2u);
    const std::vector<double> angle = results["kinematics"].column("crank.angle");
    ASSERT_EQ(angle.size(), 5u);
    for (std::size_t k = 0; k < 5; ++k) EXPECT_NEAR(angle[k], speed / 2 + speed * 0.25 * static_cast<double>(k), 1e-14);
    EXPECT_NEAR(results[0].measure("end"), 1.5 * speed, 1e-14);
  }
}

TEST(SceneClass, IsAValue) {
  const Scene first = Scene::loads(turning);
  Scene second = first;
  second.set("speed", 5);
  EXPECT_NEAR(first.run()[0].measure("end"), 2 + std::numbers::pi / 6, 1e-14);
  EXPECT_NEAR(second.run()[0].measure("end"), 5 + std::numbers::pi / 6, 1e-14);
}

template <class Error, class Call>
void expect_thrown(Call&& call, const std::string& part) {
  try {
    call();
    ADD_FAILURE() << "nothing was thrown; expected " << part;
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(SceneClass, NamesWhatIsWrong) {
  Scene scene = Scene::loads(turning);
  expect_thrown<std::out_of_range>([&] { scene.set("sped", 1); }, "did you mean \"speed\"?");
  expect_thrown<std::invalid_argument>([&] { scene.set("speed", std::nan("")); }, "\"speed\" may not be nan");
  const SceneResults results = scene.run();
  expect_thrown<std::out_of_range>([&] { results["dynamics"]; }, "there is no analysis \"dynamics\"");
  expect_thrown<std::out_of_range>([&] { results[2]; }, "number 2 among 2");
  expect_thrown<std::out_of_range>([&] { results[0].column("crank.angel"); }, "did you mean \"crank.angle\"?");
  expect_thrown<std::out_of_range>([&] { results[0].measure("ent"); }, "did you mean \"end\"?");
  expect_thrown<std::runtime_error>([&] { results[0].measure("root"); }, "measure \"root\" has no value: its column");
  scene.set("speed", "3 kg");
  expect_thrown<SceneError>([&] { scene.set("turn", "30 dge").run(); }, "dge");
  expect_thrown<SceneError>([&] { Scene::load("/nowhere/scene.json"); }, "/nowhere/scene.json");
  try {
    Scene::loads(R"({"catena": 1, "bodys": {}})", "mine.json");
    ADD_FAILURE();
  } catch (const SceneError& error) {
    EXPECT_NE(std::string(error.what()).find("mine.json:1:15"), std::string::npos) << error.what();
    EXPECT_EQ(error.diagnostics.size(), 1u);
  }
}

}  // namespace
}  // namespace catena::testing
