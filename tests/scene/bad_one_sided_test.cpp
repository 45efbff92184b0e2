// Wrong stops, contacts, cables and ropes of a scene.
#include <gtest/gtest.h>

#include "scene/wrong_scenes.hpp"

namespace catena::testing {
namespace {

using namespace wrong_scenes;

class WrongOneSided : public ::testing::TestWithParam<BadScene> {};
TEST_P(WrongOneSided, IsReportedAtItsPlace) { expect_report_of(GetParam()); }

const BadScene one_sided[] = {
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
};

INSTANTIATE_TEST_SUITE_P(All, WrongOneSided, ::testing::ValuesIn(one_sided), name_of);

}  // namespace
}  // namespace catena::testing
