// catena bench: rows with small errors, its document, comparisons on made files, wrong words and wrong files. Times are
// looked at nowhere.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "cases/exact_chain.hpp"
#include "cases/reference_file.hpp"
#include "cli/program.hpp"
#include "documents/comparison.hpp"
#include "documents/document.hpp"
#include "results/temporary_folder.hpp"

namespace catena::testing {
namespace {

using bench::Document;
using bench::Row;
using nlohmann::json;

void expect_said(const std::string& text, const std::string& words) {
  EXPECT_NE(text.find(words), std::string::npos) << "\"" << words << "\" is not in\n" << text;
}

/// Four rows of a suite that none of the machines here ran.
Document made_document(double factor) {
  Document document{
      .catena = "0", .date = "2026-01-01T00:00:00Z", .brief = false, .machine = {}, .notes = {}, .rows = {}};
  document.machine.cpu = "made";
  for (int k = 2; k <= 5; ++k) {
    Row row{.suite = "scaling", .problem = "p", .method = "m", .bodies = static_cast<int>(std::pow(10, k))};
    row.seconds = factor * 1e-9 * std::pow(row.bodies, 1.5);
    row.spread = 0.1;
    row.repeats = 7;
    row.error = 1e-12;
    row.allowed = 1e-10;
    document.rows.push_back(row);
  }
  return document;
}

TEST(BenchReferences, TheExactChainAgreesWithTheReferenceInHighPrecision) {
  bench::ExactChain chain(40);
  chain.move(1, 100);
  const auto ends = chain.ends();
  const auto value = [](const std::string& path) { return bench::reference_value("", "npendulum_N40", "t=1/" + path); };
  EXPECT_NEAR(static_cast<double>(ends[39].x), value("tip/0"), 1e-11);
  EXPECT_NEAR(static_cast<double>(ends[39].y), value("tip/1"), 1e-11);
  EXPECT_NEAR(static_cast<double>(ends[19].x), value("mid_joint/0"), 1e-11);
  EXPECT_NEAR(static_cast<double>(ends[19].y), value("mid_joint/1"), 1e-11);
  EXPECT_NEAR(static_cast<double>(chain.angle[0]), value("phi_1"), 1e-12);
  EXPECT_NEAR(static_cast<double>(chain.rate[0]), value("omega_1"), 1e-11);
  EXPECT_NEAR(static_cast<double>(chain.angular_accelerations()[0]), value("alpha_1"), 1e-11);
}

// A tail of level rods in place of rods that are level to 64 bits changes nothing.
TEST(BenchReferences, TheTailOfAnExactChainPullsAsItsRodsDo) {
  bench::ExactChain whole(200), with_tail(80), cut(80);
  with_tail.tail = 120;
  for (bench::ExactChain* chain : {&whole, &with_tail, &cut}) chain->move(0.1L, 10);
  for (std::size_t k = 0; k < 80; ++k) {
    EXPECT_NEAR(static_cast<double>(whole.angle[k] - with_tail.angle[k]), 0, 1e-16) << k;
    EXPECT_NEAR(static_cast<double>(whole.rate[k] - with_tail.rate[k]), 0, 1e-15) << k;
  }
  EXPECT_GT(std::abs(whole.angle[0] - cut.angle[0]), 1e-4) << "the pull of the far rods matters";
}

TEST(BenchReferences, ExactShapeAtRestAgreesWithTheReferenceInHighPrecision) {
  // 1.5 m between pins 1 m apart, in rods of 1.5 / 10 m; the exact shape is that of rods of 1 m.
  const auto ends = bench::ends_at_rest(10, 1 / 1.5L);
  for (int k = 1; k <= 10; ++k) {
    const std::string path = "N10/all_joints/" + std::to_string(k);
    EXPECT_NEAR(0.15 * static_cast<double>(ends[static_cast<std::size_t>(k - 1)].x),
                bench::reference_value("", "discrete_catenary", path + "/0"), 1e-14);
    EXPECT_NEAR(0.15 * static_cast<double>(ends[static_cast<std::size_t>(k - 1)].y),
                bench::reference_value("", "discrete_catenary", path + "/1"), 1e-14);
  }
}

TEST(BenchReferences, MissingValuesAreNamed) {
  try {
    bench::reference_value("", "caraxis_t3", "t=3/xm");
    FAIL();
  } catch (const std::runtime_error& error) {
    expect_said(error.what(), "t=3/xm");
    expect_said(error.what(), "caraxis_t3.json");
  }
}

/// Where a value is not as a schema says, of the words that catena-bench-1.schema.json uses; empty: it is.
std::string schema_fault(const json& value, const json& schema, const std::string& where) {
  if (schema.contains("const") && value != schema["const"]) return where + " is " + value.dump();
  if (schema.contains("enum") && std::count(schema["enum"].begin(), schema["enum"].end(), value) == 0)
    return where + " is " + value.dump();
  if (schema.contains("type")) {
    const json types = schema["type"].is_array() ? schema["type"] : json::array({schema["type"]});
    const bool known = std::any_of(types.begin(), types.end(), [&](const std::string& type) {
      return type == value.type_name() || (type == "integer" && value.is_number_integer());
    });
    if (!known) return where + " is a " + value.type_name();
  }
  if (schema.contains("minimum") && value < schema["minimum"]) return where + " is " + value.dump();
  if (value.is_array() && schema.contains("items")) {
    for (const json& entry : value) {
      if (const std::string fault = schema_fault(entry, schema["items"], where + "[]"); !fault.empty()) return fault;
    }
  }
  if (!value.is_object()) return "";
  for (const std::string key : schema.value("required", json::array())) {
    if (!value.contains(key)) return where + " has no " + key;
  }
  for (const auto& [key, entry] : value.items()) {
    const bool named = schema.contains("properties") && schema["properties"].contains(key);
    const json inner = named ? schema["properties"][key] : schema.value("additionalProperties", json(true));
    if (inner == false) return where + " has " + key;
    if (!inner.is_object()) continue;
    if (const std::string fault = schema_fault(entry, inner, where + "." + key); !fault.empty()) return fault;
  }
  return "";
}
const json& bench_schema() {
  static const json schema = json::parse(read_file(CATENA_DATA_DIR "/schema/catena-bench-1.schema.json"));
  return schema;
}

TEST(Bench, DocumentsAreAsTheirSchemaSays) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(CATENA_DATA_DIR "/bench")) {
    if (entry.path().extension() != ".json") continue;
    ++files;
    EXPECT_EQ(schema_fault(json::parse(read_file(entry.path())), bench_schema(), "document"), "") << entry.path();
  }
  EXPECT_GE(files, 1);
  json document = json::parse(bench::to_json(made_document(1)));
  EXPECT_EQ(schema_fault(document, bench_schema(), "document"), "");
  EXPECT_FALSE(document["growth"].empty());
  for (const auto& [key, wrong] : std::map<std::string, json>{
           {"seconds", "fast"}, {"suite", "other"}, {"bodies", -1}, {"repeats", 0.5}, {"unknown", 1}}) {
    json changed = document;
    changed["rows"][0][key] = wrong;
    EXPECT_NE(schema_fault(changed, bench_schema(), "document"), "") << key;
  }
  document["rows"][0].erase("error");
  expect_said(schema_fault(document, bench_schema(), "document"), "has no error");
}

/// Larger errors than these are wrong whatever a row allows itself.
double largest_error(const json& row) {
  const std::string suite = row.at("suite");
  if (suite == "kinematics") return 1e-7;
  if (suite == "dynamics") return row.at("setting") == "1e-04" ? 1e-2 : 1e-5;
  if (suite == "equilibrium") return 1e-9;
  if (suite == "scaling") return 1e-6;
  if (suite == "kernels") return 1e-10;
  if (suite == "digits") return 1e-5;  // at tolerances from 1e-7 on and condition numbers up to 1e5
  return 1e-6;
}

TEST(Bench, BriefRunOfAllSuitesIsRight) {
  const TemporaryFolder folder;
  const ProgramResult run = run_catena(
      {"bench", "--brief", "--json", folder / "b.json", "--html", folder / "b.html", "--svg", folder / "plots"});
  EXPECT_EQ(run.exit_code, 0) << run.err << run.out;
  expect_said(run.out, " 0 without a right answer");
  expect_said(run.out, "peers: none was run");
  const json document = json::parse(read_file(folder / "b.json"));
  EXPECT_EQ(schema_fault(document, bench_schema(), "document"), "");
  EXPECT_EQ(document.at("catena_bench"), 1);
  EXPECT_EQ(document.at("catena"), CATENA_VERSION);
  EXPECT_EQ(document.at("brief"), true);
  for (const char* key : {"cpu", "system", "compiler"}) EXPECT_NE(document.at("machine").at(key), "") << key;
  EXPECT_GE(document.at("machine").at("cores"), 1);
  EXPECT_GT(document.at("machine").at("memory"), 1e6);
  EXPECT_EQ(document.at("date").get<std::string>().size(), 20u);
  std::map<std::string, int> rows;
  std::set<std::string> keys;
  for (const json& row : document.at("rows")) {
    const std::string name = row.dump();
    ++rows[row.at("suite")];
    for (const char* text : {"problem", "method", "setting", "error_of", "reference", "failure"})
      EXPECT_TRUE(row.at(text).is_string()) << name;
    const bool is_ours = row.at("engine") == "catena";
    EXPECT_TRUE(is_ours || row.at("engine") == "closed form by hand") << name;
    EXPECT_TRUE(keys.insert(row.at("suite").dump() + row.at("problem").dump() + row.at("method").dump() +
                            row.at("setting").dump() + row.at("bodies").dump())
                    .second)
        << "two rows of one name: " << name;
    EXPECT_TRUE(row.at("seconds").is_number()) << name;
    EXPECT_GE(row.at("repeats"), 1) << name;
    EXPECT_TRUE(row.at("counts").is_object()) << name;
    ASSERT_TRUE(row.at("error").is_number()) << name;
    EXPECT_NE(row.at("reference"), "") << name;
    EXPECT_TRUE(row.at("allowed").is_number() || row.at("method") == "baumgarte") << name;
    EXPECT_LE(row.at("error"), largest_error(row)) << name;
  }
  for (const char* suite :
       {"kinematics", "dynamics", "contact", "equilibrium", "design", "kernels", "scaling", "economy", "digits"})
    EXPECT_GE(rows[suite], 4) << suite;
  // The page holds the plots, which name what they clip to differently.
  const std::string page = read_file(folder / "b.html");
  expect_said(page, "<svg");
  expect_said(page, "id=\"f1clip1\"");
  expect_said(page, "id=\"f2clip1\"");
  EXPECT_EQ(page.find("id=\"clip1\""), std::string::npos);
  expect_said(read_file(folder / "plots/dynamics_car_axis.svg"), "partitioning");
  expect_said(read_file(folder / "plots/scaling_time.svg"), "accelerations");
  expect_said(read_file(folder / "plots/digits_claimed.svg"), "pendulums");
  expect_said(read_file(folder / "plots/digits_condition.svg"), "acceleration, claimed");
}

TEST(Bench, CountsShowWhatIsLeftOut) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_catena({"bench", "economy", "--brief", "-q", "--json", folder / "e.json"}).exit_code, 0);
  std::map<std::string, double> counts;
  const json document = json::parse(read_file(folder / "e.json"));
  for (const json& row : document.at("rows")) {
    for (const auto& [name, value] : row.at("counts").items())
      counts[(row.at("method") == "none" ? row.at("problem").get<std::string>() + ", " : "") +
             row.at("method").get<std::string>() + ": " + name] = value;
  }
  EXPECT_EQ(counts.count("positions alone: gammas"), 0u);
  EXPECT_GE(counts["all columns: gammas"], 1001);
  EXPECT_EQ(counts["1 row: steps"], counts["1001 rows: steps"]);
  // Bodies that do not move change the length scale, and so the tolerance of residuals, but add no equations.
  EXPECT_EQ(counts["bodies that do not move, none: steps"], counts["200 fixed, 200 welded: steps"]);
  EXPECT_LE(counts["200 fixed, 200 welded: factorizations"], counts["bodies that do not move, none: factorizations"]);
  EXPECT_EQ(counts.count("gravity and 10 springs: forces"), 0u);
  EXPECT_EQ(counts["forces where none are asked for, none: factorizations"],
            counts["gravity and 10 springs: factorizations"]);
  EXPECT_EQ(counts["constant: factorizations"], 1);
  EXPECT_GT(counts["may vary: factorizations"], 100);
  EXPECT_GT(counts["together: steps"], 100);
  EXPECT_LT(counts["apart: factorizations"], counts["together: factorizations"]);
  EXPECT_EQ(counts.count("goes on from the last solution: symbolic"), 0u);
  EXPECT_EQ(counts["anew: symbolic"], 1);
}

// The error is taken against the reference, and a row that is off is said to be wrong.
TEST(Bench, AnotherReferenceMakesRowsWrong) {
  const TemporaryFolder folder;
  json reference = json::parse(read_file(std::string(CATENA_DATA_DIR) + "/reference/caraxis_t3.json"));
  reference["values"]["t=3"]["xr"] = reference["values"]["t=3"]["xr"].get<double>() + 1e-2;
  std::ofstream(folder / "caraxis_t3.json") << reference;
  std::filesystem::copy(std::string(CATENA_DATA_DIR) + "/reference/andrews_t003.json", folder / "andrews_t003.json");
  const ProgramResult run = run_catena(
      {"bench", "dynamics", "--brief", "--only", "car axis / catena / rk8 / 1e-07", "--references", folder / ""});
  EXPECT_EQ(run.exit_code, 1) << run.err;
  expect_said(run.err, "WRONG: worst place, m may be off by");
  expect_said(run.out, "1 rows, 1 without a right answer");
  std::filesystem::remove(folder / "caraxis_t3.json");
  const ProgramResult none = run_catena({"bench", "dynamics", "--brief", "-q", "--references", folder / ""});
  EXPECT_EQ(none.exit_code, 4);
  expect_said(none.err, "caraxis_t3.json");
}

TEST(Bench, DocumentsAreReadAsTheyWereWritten) {
  const TemporaryFolder folder;
  Document document = made_document(1);
  document.notes = {"a \"note\""};
  document.rows[0].counts = {{"steps", 12}};
  document.rows[1].error = bench::not_measured;
  document.rows[1].failure = "not assembled: \n a";
  std::ofstream(folder / "d.json") << bench::to_json(document);
  const Document again = bench::read_document(folder / "d.json");
  EXPECT_EQ(bench::to_json(again), bench::to_json(document));
  ASSERT_EQ(again.rows.size(), 4u);
  EXPECT_EQ(again.rows[0].counts, document.rows[0].counts);
  EXPECT_TRUE(std::isnan(again.rows[1].error));
  EXPECT_TRUE(again.rows[1].failed());
  EXPECT_FALSE(again.rows[2].failed());
  EXPECT_EQ(again.rows[2].seconds, document.rows[2].seconds);
}

TEST(Bench, FittedExponentIsThatOfTheRows) {
  const auto growth = bench::growth_of(made_document(3).rows);
  ASSERT_EQ(growth.size(), 1u);
  EXPECT_NEAR(growth[0].exponent, 1.5, 1e-12);
  EXPECT_EQ(growth[0].points, 4);
}

TEST(Bench, ComparesRowByRow) {
  const TemporaryFolder folder;
  Document then = made_document(1), now = made_document(2);
  now.rows[1].seconds = then.rows[1].seconds * 1.05;  // within the spread
  now.rows[2].error = 1e-11 * 1.5;                    // fifteen times as much, still allowed
  then.rows.push_back(then.rows[0]);
  then.rows.back().method = "gone";
  now.rows.push_back(now.rows[0]);
  now.rows.back().method = "new";
  now.rows[3].error = 1;
  const bench::Comparison comparison = bench::compare(now, then);
  ASSERT_EQ(comparison.rows.size(), 4u);
  EXPECT_NEAR(comparison.rows[0].ratio, 2, 1e-12);
  EXPECT_NEAR(comparison.rows[0].least, 2 / 1.1, 1e-12);
  EXPECT_NEAR(comparison.rows[0].most, 2 * 1.1, 1e-12);
  EXPECT_EQ(comparison.slower, 3);
  EXPECT_EQ(comparison.faster, 0);
  EXPECT_EQ(comparison.rows[2].remark, "error 1.5e-11, then 1.0e-12");
  EXPECT_EQ(comparison.rows[3].remark, "now wrong");
  ASSERT_EQ(comparison.only_now.size(), 1u);
  ASSERT_EQ(comparison.only_then.size(), 1u);
  std::ofstream(folder / "then.json") << bench::to_json(then);
  std::ofstream(folder / "now.json") << bench::to_json(now);
  const ProgramResult run = run_catena({"bench", "--from", folder / "now.json", "--compare", folder / "then.json"});
  EXPECT_EQ(run.exit_code, 1) << run.err;  // one row is wrong
  expect_said(run.out, "  2.000 1.818 ... 2.200");
  expect_said(run.out, "new, nothing to compare with: scaling / p / catena / new / 100 bodies");
  expect_said(run.out, "missing, measured then: scaling / p / catena / gone / 100 bodies");
  expect_said(run.out, "4 rows: ratio of times now / then 2.000 in the middle, 3 clearly slower, 0 clearly faster");
  expect_said(run.out, "p: m: time grows with bodies^");
}

TEST(Bench, RecordsOfOtherEnginesBecomeRows) {
  const TemporaryFolder folder;
  std::ofstream(folder / "records.tsv") << "info\twhatever\n"
                                        << "S1a\tOther\tbest\t1\t5\t0.005\t0\t-14.715\n"
                                        << "S1b\tOther\tEuler\th=0.01\t100\t2\t1\t1e-3\t2e-3\n"
                                        << "S1b\tcatena\trk8\ttol=1e-3\t100\t2\t1\t1e-3\t2e-3\n"
                                        << "S1a\tOther\tbroken\n";
  const ProgramResult run = run_catena({"bench", "kernels", "dynamics", "--brief", "--only", "Other", "--peers",
                                        folder / "records.tsv", "--json", folder / "p.json"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const Document document = bench::read_document(folder / "p.json");
  ASSERT_EQ(document.rows.size(), 2u);
  EXPECT_EQ(document.rows[0].engine, "Other");
  EXPECT_EQ(document.rows[0].seconds, 5e-9);
  // One rod from angle 0.3 sin 1: its tip turns with the angular acceleration 1.5 g cos, not with 1.5 g.
  EXPECT_GT(document.rows[0].error, 0.1);
  EXPECT_EQ(document.rows[1].problem, "40 rods fall");
  EXPECT_EQ(document.rows[1].error, 2e-3);
  expect_said(run.out, "2 records from records.tsv");
  EXPECT_EQ(run_catena({"bench", "kernels", "--brief", "-q", "--peers", folder / "none"}).exit_code, 4);
}

TEST(Bench, EnginesThatAreAbsentAreNamed) {
  const TemporaryFolder folder;
  const std::filesystem::path program = folder / "peer_cvodes";
  std::ofstream(program) << "#!/bin/sh\nprintf 'S5\\tcvodes\\tadjoint\\t1e-05\\t2\\t3\\t7\\t1e-6\\n'\n";
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  const ProgramResult run =
      run_catena({"bench", "design", "contact", "--brief", "--only", "cvodes", "--peers", folder / ""});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  expect_said(run.out, "peers: absent, and no rows of theirs: peer_contact_box2d (contact)");
  expect_said(run.out, "peer_contact_siconos (contact)");
  for (const char* wrong : {"peer_cvodes (", "(dynamics)"}) EXPECT_EQ(run.out.find(wrong), std::string::npos) << wrong;
}

TEST(Bench, WrongWordsAndFilesAreNamed) {
  const TemporaryFolder folder;
  const ProgramResult word = run_catena({"bench", "kinematix"});
  EXPECT_EQ(word.exit_code, 2);
  expect_said(word.err, "there is no suite \"kinematix\"; did you mean \"kinematics\"?");
  EXPECT_EQ(run_catena({"bench", "kernels", "--brief", "-q", "--only", "no such row"}).exit_code, 2);
  EXPECT_EQ(run_catena({"bench", "--budget", "0"}).exit_code, 2);
  EXPECT_EQ(run_catena({"bench", "--economy-variant", "none / none"}).exit_code, 2);

  const ProgramResult missing = run_catena({"bench", "--compare", folder / "none.json"});
  EXPECT_EQ(missing.exit_code, 4);
  expect_said(missing.err, "none.json");
  const auto refused = [&](const std::string& text, const std::string& said) {
    std::ofstream(folder / "bad.json") << text;
    for (const char* option : {"--compare", "--from"}) {
      const ProgramResult run = run_catena({"bench", option, folder / "bad.json"});
      EXPECT_EQ(run.exit_code, 3) << text;
      expect_said(run.err, said);
      expect_said(run.err, "bad.json");
    }
  };
  refused("{", "the text ends here");
  refused("[]", "is not an object");
  refused(R"({"catena": 1})", "was not written by catena bench");
  refused(R"({"catena_bench": 2})", "has version 2 of the format, this program reads 1");
  json document = json::parse(bench::to_json(made_document(1)));
  document["rows"][2].erase("method");
  refused(document.dump(), "row 3 has no \"method\" that is text");
  document["rows"][2]["method"] = "m";
  document["rows"][2]["seconds"] = "fast";
  refused(document.dump(), "row 3 has no \"seconds\" that is a number");
}

// Kernels with a second of repeats each: the signal comes while the first ones are measured.
TEST(Bench, CtrlCKeepsTheRowsSoFar) {
  TemporaryFolder folder;
  const std::string document = folder / "rows.json";
  const ProgramResult result = run_catena({"bench", "kernels", "-q", "--budget", "1", "--json", document},
                                          {.standard_output = {}, .during = [](int process) {
                                             wait_for_handler(process, SIGINT);
                                             std::this_thread::sleep_for(std::chrono::milliseconds(500));
                                             ::kill(process, SIGINT);
                                           }});
  EXPECT_EQ(result.exit_code, 1) << result.err;
  const json written = json::parse(std::ifstream(document));
  EXPECT_GE(written["rows"].size(), 1u);
  EXPECT_LT(written["rows"].size(), 15u);  // a whole run has so many
  expect_said(written["notes"].dump(), "stopped by a signal");
}

}  // namespace
}  // namespace catena::testing
