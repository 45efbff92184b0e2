// Wrong scenes: the message, the place, the exit code. § marks the character at which the error must stand.
#include <gtest/gtest.h>

#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

struct BadScene {
  const char* what;
  std::string text;     // with the mark
  const char* message;  // a part of the message that belongs to the mark
  std::size_t errors = 1;
};

// Two bodies to hang elements on; the argument is what else the scene has.
std::string two_bodies(const std::string& rest) {
  return R"({"catena": 1,
  "parameters": {"l": "120 mm", "n": 3},
  "bodies": {"crank": {"points": {"tip": [0.1, 0]}}, "rod": {"position": [0.4, 0]}},
  )" + rest +
         "\n}\n";
}
std::string constraint(const std::string& element) { return two_bodies("\"constraints\": [" + element + "]"); }
std::string force(const std::string& element) { return two_bodies("\"forces\": [" + element + "]"); }
std::string analysis(const std::string& object) { return two_bodies("\"analyses\": [" + object + "]"); }

void PrintTo(const BadScene& bad, std::ostream* out) { *out << bad.text; }

class WrongScene : public ::testing::TestWithParam<BadScene> {};

TEST_P(WrongScene, IsReportedAtItsPlace) {
  const BadScene& bad = GetParam();
  const MarkedText marked = take_mark(bad.text);
  const TextRun run = run_text(marked.text);
  const SceneOutcome& outcome = run.outcome;
  EXPECT_EQ(outcome.exit_code, 3) << outcome.error_text;
  EXPECT_EQ(run.sink.runs, 0);
  EXPECT_EQ(outcome.errors.size(), bad.errors) << outcome.error_text;
  bool found = false;
  for (const Diagnostic& error : outcome.errors) {
    if (error.message.find(bad.message) == std::string::npos) continue;
    found = true;
    EXPECT_EQ(error.line, marked.line) << outcome.error_text;
    EXPECT_EQ(error.column, marked.column) << outcome.error_text;
  }
  EXPECT_TRUE(found) << "expected: " << bad.message << "\ngot:\n" << outcome.error_text;
}

const BadScene texts[] = {
    {"EmptyFile", "§", "empty"},
    {"BlankFile", "  \n §", "empty"},
    {"TruncatedFile", "{\"catena\": 1, \"bodies\": {\"a\": {§", "the text ends here"},
    {"NotAnObject", "§[1, 2]", "must be an object"},
    {"NaN", "{\"catena\": 1, \"gravity\": [0, §NaN]}", "NaN"},
    {"TooLarge", "{\"catena\": 1, \"gravity\": [0, §1e400]}", "1e400"},
    {"InvalidUtf8", "{\"catena\": 1, \"name\": \"a§\xff\"}", "UTF-8"},
    {"KeyTwice", "{\"catena\": 1, \"name\": \"a\", §\"name\": \"b\"}", "name"},
    {"BodyTwice", "{\"catena\": 1, \"bodies\": {\"a\": {}, §\"a\": {}}}", "duplicate key \"a\""},
    {"DrawNoList", R"({"catena": 1, "bodies": {"a": {"draw": §{"disc": {"radius": 1}}}}})", "must be a list of shapes"},
    {"DrawNothing", R"({"catena": 1, "bodies": {"a": {"draw": [§{}]}}})", "must be one of"},
    {"DrawTwo", R"({"catena": 1, "bodies": {"a": {"draw": [§{"disc": {"radius": 1}, "line": [[0, 0], [1, 0]]}]}}})",
     "must be one of"},
    {"DrawnDot", R"({"catena": 1, "bodies": {"ground": {"draw": [{"line": §[[0, 0]]}]}}})", "at least two corners"},
    {"DrawnMass", R"({"catena": 1, "bodies": {"a": {"draw": [{§"mass": 1, "disc": {"radius": 1}}]}}})", "mass"},
    {"DrawnNoArea", R"({"catena": 1, "bodies": {"a": {"draw": [§{"disc": {"radius": 0}}]}}})", "disc without area"},
    {"DrawnInKilograms", R"({"catena": 1, "bodies": {"a": {"draw": [{"disc": {"radius": §"1 kg"}}]}}})", "kg"},
};

const BadScene scenes[] = {
    {"NoVersion", "§{\"name\": \"x\"}", "\"catena\": 1"},
    {"Version2", "{\"catena\": §2}", "must be 1; this is version 2"},
    {"VersionText", "{\"catena\": §\"1\"}", "must be 1"},
    {"UnknownKey", "{\"catena\": 1, §\"bodeis\": {}}", "unknown key \"bodeis\" in the scene; did you mean \"bodies\"?"},
    {"BodiesAList", "{\"catena\": 1, \"bodies\": §[]}", "must be an object"},
    {"ConstraintsAnObject", "{\"catena\": 1, \"constraints\": §{}}", "must be a list"},
    {"GravityOne", "{\"catena\": 1, \"gravity\": §[1]}", "two numbers"},
    {"GravityUnit", "{\"catena\": 1, \"gravity\": [0, §\"9.81 m/s\"]}", "must be an acceleration"},
    {"BareNumberInQuotes", "{\"catena\": 1, \"gravity\": [0, §\"9.81\"]}", "number in quotes"},
    {"ParameterCycle", "{\"catena\": 1, \"parameters\": {\"a\": §\"=b\", \"b\": \"=a\"}}", "a -> b -> a"},
    {"ParameterLimit", "{\"catena\": 1, \"parameters\": {\"a\": {\"value\": §3, \"max\": 2}}}", "more than its max"},
    {"DivisionByZero", "{\"catena\": 1, \"parameters\": {\"a\": 0, \"b\": \"=1§/a\"}}", "division by zero"},
    {"BodyKey", "{\"catena\": 1, \"bodies\": {\"crank\": {§\"lenght\": 1}}}",
     "unknown key \"lenght\" in body \"crank\""},
    {"BodyKeyNear", "{\"catena\": 1, \"bodies\": {\"crank\": {§\"mas\": 1}}}", "did you mean \"mass\"?"},
    {"BodyMassUnit", "{\"catena\": 1, \"bodies\": {\"crank\": {\"mass\": §\"3 m\"}}}", "must be a mass"},
    {"BodyMassNegative", "{\"catena\": 1, \"bodies\": {\"crank\": {\"mass\": §-3}}}", "may not be negative"},
    {"BodyName", "{\"catena\": 1, \"bodies\": {§\"a.b\": {}}}", "may not have a ."},
    {"BodyNameTaken", "{\"catena\": 1, \"bodies\": {§\"energy\": {}}}", "is taken"},
    {"PointName", "{\"catena\": 1, \"bodies\": {\"a\": {\"points\": {§\"vx\": [0, 0]}}}}", "column of every body"},
    {"FixedNumber", "{\"catena\": 1, \"bodies\": {\"a\": {\"fixed\": §1}}}", "must be true or false"},
    {"RodAndAngle",
     "{\"catena\": 1, \"bodies\": {\"a\": {\"rod\": {\"from\": [0, 0], \"to\": [1, 0]}, \"angle\": §1}}}",
     "follows from its rod"},
    {"RodWithoutLength", "{\"catena\": 1, \"bodies\": {\"a\": {\"rod\": {\"from\": [§1, 0], \"to\": [1, 0]}}}}",
     "has no length"},
    {"RodOneEnd", "{\"catena\": 1, \"bodies\": {\"a\": {\"rod\": §{\"from\": [1, 0]}}}}", "needs \"to\""},
    {"RodPointAgain",
     "{\"catena\": 1, \"bodies\": {\"a\": {\"rod\": {\"from\": [0, 0], \"to\": [1, 0]}, \"points\": {§\"to\": [0, "
     "0]}}}}",
     "given twice"},
    {"HoldWord", "{\"catena\": 1, \"bodies\": {\"a\": {\"hold\": [§\"z\"]}}}", "\"x\", \"y\" or \"angle\""},
    {"PartAndMass", "{\"catena\": 1, \"bodies\": {\"a\": {\"mass\": §1, \"parts\": [{\"mass\": 1}]}}}",
     "follow from its parts"},
    {"GroundMass", "{\"catena\": 1, \"bodies\": {\"ground\": {§\"mass\": 1}}}", "unknown key \"mass\" in the ground"},
};

const BadScene elements[] = {
    {"NoType", constraint("§{\"i\": \"crank\"}"), "needs a \"type\""},
    {"UnknownType", constraint(R"({"type": §"revolut", "i": "crank", "j": "rod"})"), "did you mean \"revolute\"?"},
    {"ForceAmongConstraints", constraint(R"({"type": §"torque", "i": "crank", "torque": 1})"), "belongs in \"forces\""},
    {"ConstraintAmongForces", force(R"({"type": §"weld", "i": "crank", "j": "rod"})"), "belongs in \"constraints\""},
    {"UndrivableDriver", two_bodies(R"("drivers": [{"type": §"revolute", "i": "crank", "j": "rod"}])"),
     "no value that could be driven"},
    {"DriverWithoutValue", two_bodies(R"("drivers": [§{"type": "absolute_angle", "i": "crank"}])"), "needs \"value\""},
    {"UnknownElementKey", constraint(R"({"type": "absolute_x", "i": "crank", §"valeu": 1})"),
     "did you mean \"value\"?"},
    {"MissingJ", constraint(R"(§{"type": "revolute", "i": "crank"})"), "needs \"j\""},
    {"MissingBody", constraint(R"({"type": "revolute", "i": §"crnk", "j": "rod"})"),
     "there is no body \"crnk\"; did you mean \"crank\"?"},
    {"MissingBodyBeforePoint", constraint(R"({"type": "revolute", "i": §"crnk.tip", "j": "rod"})"),
     "there is no body \"crnk\""},
    {"MissingPoint", constraint(R"({"type": "revolute", "i": "crank.§tpi", "j": "rod"})"), "did you mean \"tip\"?"},
    {"ElementForBody", constraint(R"({"type": "absolute_x", "name": "A", "i": "crank"},
                                     {"type": "revolute", "i": §"A", "j": "rod"})"),
     "there is no body \"A\": that is a absolute_x"},
    {"SelfJoint", constraint(R"(§{"type": "revolute", "i": "crank", "j": "crank.tip"})"),
     "ties body \"crank\" to itself"},
    {"GroundJoint", constraint(R"(§{"type": "weld", "i": "ground", "j": ["ground", [1, 0]]})"),
     "ties the ground to itself"},
    {"AbsoluteOfGround", constraint(R"(§{"type": "absolute_x", "i": "ground"})"), "may not be the ground"},
    {"ZeroAxis",
     constraint(R"({"type": "translational", "name": "guide", "i": "ground", "j": "rod", "axis_i": [§0, 0]})"),
     "\"axis_i\" of translational \"guide\" has no direction"},
    {"ZeroDistance", constraint(R"({"type": "absolute_distance", "i": "crank", "ground": [1, 1], "value": §0})"),
     "use absolute_x and absolute_y, or a revolute joint"},
    {"ZeroDistanceGiven", constraint(R"(§{"type": "coupler", "i": ["crank", [0.4, 0]], "j": "rod"})"),
     "a revolute joint"},
    {"NegativeDistance", constraint(R"({"type": "coupler", "i": "crank", "j": "rod", "value": §-1})"), "negative"},
    {"ValueAndLength", constraint(R"({"type": "coupler", "i": "crank", "j": "rod", "value": 1, "length": §1})"),
     "\"length\" is another name of \"value\""},
    {"NameTwice", constraint(R"({"type": "absolute_x", "name": "A", "i": "crank"},
                                {"type": "absolute_y", "name": §"A", "i": "crank"})"),
     "the name \"A\" is used twice: an element in line 4 has it already"},
    {"NameOfBody", constraint(R"({"type": "absolute_x", "name": §"rod", "i": "crank"})"), "a body in line 3"},
    {"WrongUnit", constraint(R"({"type": "absolute_angle", "i": "crank", "value": §"30 mm"})"), "must be an angle"},
    {"WrongUnitOfParameter", constraint(R"({"type": "absolute_angle", "i": "crank", "value": §"l"})"),
     "must be an angle"},
    {"UnknownParameter", constraint(R"({"type": "absolute_x", "i": "crank", "value": §"ll"})"), "did you mean \"l\"?"},
    {"ExpressionName", constraint(R"({"type": "absolute_x", "i": "crank", "value": "=2*§m"})"), "m"},
    {"AtAndPoint", constraint(R"({"type": "revolute", "i": §"crank.tip", "j": "rod", "at": [0, 0]})"), "\"at\""},
    {"AttachmentNumber", constraint(R"({"type": "revolute", "i": §3, "j": "rod"})"), "\"body.point\""},
    {"AttachmentPointInList", constraint(R"({"type": "revolute", "i": [§"crank.tip", [0, 0]], "j": "rod"})"),
     "must name a body without a point"},
    {"NotPositive", constraint(R"({"type": "gear", "i": "crank", "j": "rod", "radius_i": §-1, "radius_j": 1})"),
     "must be above zero; it is -1"},
    {"RequiredNumber", constraint(R"(§{"type": "gear", "i": "crank", "j": "rod", "radius_i": 1})"),
     "needs \"radius_j\""},
    {"Side",
     constraint(R"({"type": "rack_pinion", "i": "crank", "j": "rod", "axis_i": [1, 0], "radius": 1, "side": §0})"),
     "must be 1 or -1"},
    {"Choice", force(R"({"type": "point_force", "i": "crank", "force": [0, 1], "frame": §"bdy"})"),
     "did you mean \"body\"?"},
    {"ForcePair", force(R"({"type": "point_force", "i": "crank", "force": §3})"), "two functions"},
    {"FunctionKind", constraint(R"({"type": "absolute_x", "i": "crank", "value": {§"polynomail": [1]}})"),
     "did you mean \"polynomial\"?"},
    {"FunctionUnit", constraint(R"({"type": "absolute_x", "i": "crank", "value": {"polynomial": [0, §"3 rad/s"]}})"),
     "must be a velocity"},
    {"FunctionKey",
     constraint(R"({"type": "absolute_x", "i": "crank", "value": {"harmonic": {"amplitude": 1, §"freq": 3}}})"),
     "unknown key \"freq\"", 2},
    {"FunctionMissing", constraint(R"({"type": "absolute_x", "i": "crank", "value": {"harmonic": §{"amplitude": 1}}})"),
     "needs \"omega\""},
    {"StepOrder", constraint(R"({"type": "absolute_x", "i": "crank",
       "value": {"step": {"t0": 0, "t1": 1, "from": 0, "to": 1, "order": §4}}})"),
     "must be 3 or 5"},
    {"StepTimes", constraint(R"({"type": "absolute_x", "i": "crank",
       "value": §{"step": {"t0": 1, "t1": 1, "from": 0, "to": 1}}})"),
     "is no function of time"},
    {"TableLengths", constraint(R"({"type": "absolute_x", "i": "crank",
       "value": {"spline": {"t": [0, 1, 2], "value": §[0, 1]}}})"),
     "3 times, but 2 values"},
    {"SpringWithoutLaw", force(R"(§{"type": "spring_damper", "i": "crank", "j": "rod"})"),
     "spring_damper needs \"k\" or \"curve\""},
    {"CurveOfOnePair", force(R"({"type": "spring_damper", "i": "crank", "j": "rod", "curve": §[[0, 1]]})"),
     "needs at least 2 points"},
    {"CurveFallsBack", force(R"({"type": "spring_damper", "i": "crank", "j": "rod", "curve": §[[0, 1], [0, 2]]})"),
     "must increase"},
    {"CurveUnit", force(R"({"type": "spring_damper", "i": "crank", "j": "rod", "curve": [[0, 0], [§"1 N", 2]]})"),
     "must be a length"},
    {"CurveNoPair", force(R"({"type": "spring_damper", "i": "crank", "j": "rod", "curve": [§3]})"), "list of pairs"},
    {"BushingOfNothing", force(R"(§{"type": "bushing", "i": "crank", "j": "rod"})"), "\"kx\""},
    {"BushingUnit", force(R"({"type": "bushing", "i": "crank", "j": "rod", "kt": §"3 N/m"})"),
     "must be a torsional stiffness"},
    {"StopWithoutColumn", force(R"(§{"type": "stop", "min": 1})"), "stop needs \"column\""},
    {"StopWithoutBounds", force(R"(§{"type": "stop", "column": "crank.angle"})"), "needs \"min\" or \"max\""},
    {"StopCrossed", force(R"(§{"type": "stop", "column": "crank.angle", "min": 2, "max": 1})"),
     "\"min\" must be below \"max\""},
    {"StopOfNothing", force(R"({"type": "stop", "column": §"crnk.angle", "min": 1})"), "did you mean \"crank\"?"},
    {"StopOfAVelocity", force(R"({"type": "stop", "column": §"crank.vx", "min": 1})"), "cannot be bounded"},
    {"StopOfNoPoint", force(R"({"type": "stop", "column": §"crank.tpi.x", "min": 1})"), "has no point \"tpi\""},
    {"StopOfALoad", force(R"({"type": "torque", "name": "T", "i": "crank", "torque": 1},
       {"type": "stop", "column": §"T.angle", "min": 1})"),
     "of the torque \"T\" cannot be bounded"},
    {"StopUnit", force(R"({"type": "stop", "column": "crank.angle", "min": §"3 mm"})"), "must be an angle"},
    {"StopUnitOfALength", force(R"({"type": "stop", "column": "crank.x", "min": §"3 deg"})"), "must be a length"},
    {"StopColumnNumber", force(R"({"type": "stop", "column": §3, "min": 1})"), "must be the name of a column"},
    {"ContactWithoutCurve", force(R"(§{"type": "contact", "i": "crank", "j": "rod"})"), "contact needs \"curve\""},
    {"ContactRadius", force(R"({"type": "contact", "i": "crank", "j": "rod", "radius": §-1,
       "curve": {"line": {"point": [0, 0], "axis": [1, 0]}}})"),
     "must be zero or above"},
    {"ContactSide", force(R"({"type": "contact", "i": "crank", "j": "rod", "side": §0,
       "curve": {"line": {"point": [0, 0], "axis": [1, 0]}}})"),
     "must be 1 or -1"},
    {"ContactAmongConstraints", constraint(R"({"type": §"contact", "i": "crank", "j": "rod"})"),
     "it belongs in \"forces\""},
    {"CableStiffness", force(R"({"type": "cable", "i": "crank", "j": "rod", "k": §0})"), "must be above zero"},
    {"CableLength", force(R"({"type": "cable", "i": "crank", "j": "rod", "length": §0})"), "must be above zero"},
    {"CableOfNoLength", force(R"(§{"type": "cable", "i": "crank", "j": ["rod", [-0.4, 0]]})"), "length above zero"},
    {"RopeOverNothing", force(R"({"type": "rope", "i": "crank", "over": §[], "j": "rod"})"), "at least one pulley"},
    {"RopeWithoutOver", force(R"(§{"type": "rope", "i": "crank", "j": "rod"})"), "needs \"over\""},
    {"RopeOverNoList", force(R"({"type": "rope", "i": "crank", "over": §{"at": "ground"}, "j": "rod"})"),
     "must be a list of pulleys"},
    {"RopePulleyNowhere", force(R"({"type": "rope", "i": "crank", "over": [§{"radius": 0.1}], "j": "rod"})"),
     "needs \"at\""},
    {"RopePulleyOfNoBody", force(R"({"type": "rope", "i": "crank", "over": [{"at": §"crnk"}], "j": "rod"})"),
     "did you mean \"crank\"?"},
    {"RopePulleyKey", force(R"({"type": "rope", "i": "crank", "over": [{"at": ["ground", [0, 1]], §"raduis": 1}],
       "j": "rod"})"),
     "\"radius\"?"},
    {"RopePulleyRadius", force(R"({"type": "rope", "i": "crank", "over": [{"at": ["ground", [0, 1]], "radius": §-0.1}],
       "j": "rod"})"),
     "must be zero or above"},
    {"RopePulleySide", force(R"({"type": "rope", "i": "crank", "over": [{"at": ["ground", [0, 1]], "side": §0}],
       "j": "rod"})"),
     "must be 1, on the left"},
    {"RopePulleyWord",
     force(R"({"type": "rope", "i": "crank", "over": [{"at": ["ground", [0, 1]], "pulley": §"glides"}],
       "j": "rod"})"),
     "\"rolls\""},
    {"RopePulleyMu", force(R"({"type": "rope", "i": "crank", "over": [{"at": ["ground", [0, 1]], "mu": §-1}],
       "j": "rod"})"),
     "must be zero or above"},
    {"RopeFrictionAtAPoint", force(R"({"type": "rope", "i": "crank", "over": [{"at": ["ground", [0, 1]], "mu": §0.2}],
       "j": "rod"})"),
     "friction needs a \"radius\" above zero"},
    {"RopeFrictionAndRolls", force(R"({"type": "rope", "i": "crank", "over": [{"at": ["ground", [0.2, 1]],
       "radius": 0.1, "pulley": "rolls", "mu": §0.2}], "j": "rod"})"),
     "does not slide over a pulley that rolls"},
    {"RopeRollsOnAPoint", force(R"({"type": "rope", "i": "crank", "over": [§{"at": ["ground", [0, 1]],
       "pulley": "rolls"}], "j": "rod"})"),
     "needs a \"radius\" above zero"},
    {"RopeRollsLength", force(R"(§{"type": "rope", "i": "crank", "over": [{"at": ["ground", [0.2, 1]], "radius": 0.1,
       "pulley": "rolls"}], "j": "rod", "length": 3})"),
     "leave \"length\" out"},
    {"RopeEndInsideAPulley", force(R"(§{"type": "rope", "i": "crank", "over": [{"at": ["ground", [0, 0.1]],
       "radius": 0.2}], "j": "rod"})"),
     "between its end i and pulley 1"},
    {"RopeWithoutBend", force(R"(§{"type": "rope", "i": "crank", "over": [{"at": ["ground", [0.2, 0]], "radius": 0.1}],
       "j": "rod"})"),
     "does not bend at pulley 1"},
    {"RopeOfTheGround", force(R"(§{"type": "rope", "i": "ground", "over": [{"at": ["ground", [0.2, 1]]}],
       "j": ["ground", [1, 0]]})"),
     "does not move relative to each other"},
    {"OnlyInCpp", force(R"({"type": §"custom_force", "i": "crank", "j": "rod"})"), "unknown type"},
};

const BadScene replicated[] = {
    {"IndexOutOfRange", R"({"catena": 1, "replicate": [{"count": 3, "bodies": {"link{k}": {}},
       "constraints": [{"type": "revolute", "i": §"link{k-1}", "j": "link{k}"}]}]})",
     "there is no body \"link0\""},
    {"ShowsK", R"({"catena": 1, "replicate": [{"count": 3, "bodies": {"link{k}": {}},
       "constraints": [{"type": "revolute", "i": "link{k}", "j": §"link{k+1}"}]}]})",
     "at k = 3"},
    {"OncePerPlace", R"({"catena": 1, "replicate": [{"count": 1000, "bodies": {"link{k}": {"mass": §"=-k"}}}]})",
     "it is -1 (at k = 1)"},
    {"NoCount", R"({"catena": 1, "replicate": [§{"bodies": {}}]})", "needs \"count\""},
    {"CountFraction", R"({"catena": 1, "replicate": [{"count": §2.5, "bodies": {"b{k}": {}}}]})", "whole number"},
    {"CountNegative", R"({"catena": 1, "replicate": [{"count": §-2, "bodies": {"b{k}": {}}}]})", "-2"},
    {"SameNames", R"({"catena": 1, "replicate": [{"count": 3, "bodies": {§"link": {}}}]})", "is used twice"},
    {"NameFraction", R"({"catena": 1, "replicate": [{"count": 3, "bodies": {"link{§k/2}": {}}}]})", "integer"},
    {"NameUnclosed", R"({"catena": 1, "bodies": {"link§{k": {}}})", "not closed"},
    {"KOutside", R"({"catena": 1, "bodies": {"link{§k}": {}}})", "k"},
    {"TooMany", R"({"catena": 1, "replicate": [{"count": §1e9, "bodies": {"b{k}": {}}}]})", "--max-elements"},
    {"TooManyNested",
     R"({"catena": 1, "replicate": [{"count": 1e6, "replicate": [{"count": §1e6, "bodies": {"b{k}": {}}}]}]})",
     "--max-elements"},
};

const BadScene analyses[] = {
    {"UnknownAnalysis", analysis(R"({"type": §"kinematic"})"), "did you mean \"kinematics\"?"},
    {"NoType", analysis("§{}"), "needs a \"type\""},
    {"AnalysisKey", analysis(R"({"type": "kinematics", §"evry": 1})"), "did you mean \"every\"?"},
    {"KeyOfAnother", analysis(R"({"type": "check", §"until": 1})"), "unknown key \"until\" in check"},
    {"UntilZero", analysis(R"({"type": "kinematics", "until": §0})"), "must be above zero; it is 0"},
    {"UntilUnit", analysis(R"({"type": "kinematics", "until": §"3 m"})"), "must be a time"},
    {"EveryNegative", analysis(R"({"type": "kinematics", "until": 1, "every": §-1})"), "must be above zero"},
    {"EveryZero", analysis(R"({"type": "kinematics", "until": 1, "every": §0})"), "must be above zero"},
    {"EveryAlone", analysis(R"({"type": "kinematics", "every": §1})"), "needs \"until\""},
    {"AtAndUntil", analysis(R"({"type": "kinematics", "until": 1, "at": §1})"), "together"},
    {"TooManyRows", analysis(R"({"type": "kinematics", "until": 1, "every": §1e-12})"), "rows"},
    {"Word", analysis(R"({"type": "equilibrium", "accept": §"unstable"})"), "\"stable\" or \"stationary\""},
    {"Whole", analysis(R"({"type": "modes", "count": §0})"), "whole number"},
    {"SetUnknown", analysis(R"({"type": "check", "set": {§"q": 1}})"), "unknown parameter \"q\""},
    {"SetUnit", analysis(R"({"type": "check", "set": {"l": §"3 kg"}})"), "must be a length"},
    {"SetMakesItWrong", R"({"catena": 1, "parameters": {"d": 1}, "bodies": {"a": {"position": [1, 0]}},
       "constraints": [{"type": "absolute_distance", "i": "a", "ground": [0, 0], "value": §"d"}],
       "analyses": [{"type": "check", "set": {"d": 0}}]})",
     "a revolute joint"},
    {"UnknownColumn", analysis(R"({"type": "kinematics", "outputs": ["crank.x", §"crank.z"]})"),
     "unknown column \"crank.z\""},
    {"UnknownColumnNear", analysis(R"({"type": "assemble", "outputs": [§"crnk.x"]})"), "did you mean \"crank.x\"?"},
    {"UnknownColumnOfScene", two_bodies(R"("outputs": [§"crank.anlge"])"), "did you mean \"crank.angle\"?"},
    {"UnknownColumnOfSceneOnce",
     two_bodies(R"("outputs": [§"rod.tip.x"], "analyses": [{"type": "assemble"}, {"type": "kinematics"}])"), "rod"},
    {"PathParameter", analysis(R"({"type": "path", "parameter": §"m", "to": 1})"), "unknown parameter"},
    {"PathWithout", analysis(R"(§{"type": "path", "to": 1})"), "needs \"parameter\""},
    {"PathToUnit", analysis(R"({"type": "path", "parameter": "l", "to": §"3 N"})"), "must be a length"},
    {"EventValueUnit", analysis(R"({"type": "dynamics", "events": [{"when": "crank.angle", "value": §"3 mm"}]})"),
     "must be an angle"},
    {"EventValueUnitOfParameter", analysis(R"({"type": "kinematics", "events": [{"when": "rod.vx", "value": §"l"}]})"),
     "must be a velocity"},
    {"EventBlockCountUnit", analysis(R"({"type": "dynamics", "replicate": [
       {"count": §"3 mm", "events": [{"when": "crank.angle"}]}]})"),
     "must be a"},
    {"EventWithout", analysis(R"({"type": "dynamics", "events": [§{"name": "a"}]})"), "needs \"when\""},
    {"EventColumn", analysis(R"({"type": "dynamics", "events": [{"when": §"crank.q"}]})"), "unknown column"},
};

const auto name_of = [](const auto& info) { return std::string(info.param.what); };
INSTANTIATE_TEST_SUITE_P(Text, WrongScene, ::testing::ValuesIn(texts), name_of);
INSTANTIATE_TEST_SUITE_P(Scene, WrongScene, ::testing::ValuesIn(scenes), name_of);
INSTANTIATE_TEST_SUITE_P(Element, WrongScene, ::testing::ValuesIn(elements), name_of);
INSTANTIATE_TEST_SUITE_P(Replicate, WrongScene, ::testing::ValuesIn(replicated), name_of);
INSTANTIATE_TEST_SUITE_P(Analysis, WrongScene, ::testing::ValuesIn(analyses), name_of);

TEST(WrongScenes, AllErrorsAtOnceInTheOrderOfTheText) {
  const TextRun run = run_text(R"({"catena": 2, "gravity": [0, "9.81 m"],
  "bodies": {"a": {"mas": 1}, "b": {"mass": "l"}},
  "constraints": [{"type": "revolute", "i": "a", "j": "c"}, {"type": "weld", "i": "a", "j": "a"}],
  "analyses": [{"type": "kinematics", "until": 0}]})");
  ASSERT_EQ(run.outcome.errors.size(), 7u) << run.outcome.error_text;
  const int lines[] = {1, 1, 2, 2, 3, 3, 4};
  for (std::size_t k = 0; k < 7; ++k) EXPECT_EQ(run.outcome.errors[k].line, lines[k]) << k;
}

TEST(WrongScenes, FilesThatCannotBeReadAreExitCodeFour) {
  TemporaryFolder folder;
  StoringSink sink;
  const SceneOutcome missing = run_scene(folder / "none.json", {}, sink);
  EXPECT_EQ(missing.exit_code, 4);
  EXPECT_NE(missing.error_text.find("none.json"), std::string::npos) << missing.error_text;
  EXPECT_EQ(run_scene(folder.path().string(), {}, sink).exit_code, 4);
  EXPECT_EQ(sink.runs, 0);
}

TEST(WrongScenes, AHundredMegabytesOfBracketsEndSoon) {
  const TextRun run = run_text(std::string(100'000'000, '['));
  EXPECT_EQ(run.outcome.exit_code, 3);
  ASSERT_EQ(run.outcome.errors.size(), 1u);
  EXPECT_LT(run.outcome.error_text.size(), 1000u);
}

TEST(WrongScenes, ManyMistakesAreCountedNotPrinted) {
  std::string text = "{\"catena\": 1, \"bodies\": {";
  for (int k = 0; k < 1000; ++k) text += (k ? ",\n\"b" : "\n\"b") + std::to_string(k) + "\": {\"mass\": -1}";
  const TextRun run = run_text(text + "}}");
  EXPECT_EQ(run.outcome.exit_code, 3);
  EXPECT_LE(run.outcome.errors.size(), 50u);
  EXPECT_NE(run.outcome.error_text.find("more error"), std::string::npos);
}

TEST(WrongScenes, ErrorsAsJson) {
  const TextRun run = run_text("{\"catena\": 2}");
  const std::string json = invalid_json(run.outcome);
  EXPECT_NE(json.find("\"status\": \"invalid\""), std::string::npos);
  EXPECT_NE(json.find("\"line\": 1, \"column\": 12"), std::string::npos) << json;
}

TEST(CommandLine, MistakesInOptionsAreExitCodeTwo) {
  const std::string scene = analysis(R"({"type": "check"})");
  const auto run = [&](RunOptions options) { return run_text(scene, options).outcome; };
  RunOptions unknown;
  unknown.set = {{"nn", "3"}};
  EXPECT_EQ(run(unknown).exit_code, 2);
  EXPECT_NE(run(unknown).error_text.find("--set: unknown parameter \"nn\"; did you mean \"n\"?"), std::string::npos)
      << run(unknown).error_text;
  RunOptions unit;
  unit.set = {{"l", "3 kg"}};
  EXPECT_EQ(run(unit).exit_code, 2);
  RunOptions until;
  until.verb = "kinematics";
  until.verb_options = {{"until", "0"}};
  EXPECT_EQ(run(until).exit_code, 2);
  EXPECT_NE(run(until).error_text.find("--until: \"until\" of kinematics must be above zero"), std::string::npos)
      << run(until).error_text;
  RunOptions column;
  column.verb = "assemble";
  column.verb_options = {{"outputs", "crank.x"}, {"outputs", "crank.z"}};
  EXPECT_EQ(run(column).exit_code, 2);
}

}  // namespace
}  // namespace catena::testing
