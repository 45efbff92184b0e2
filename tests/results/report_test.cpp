#include <gtest/gtest.h>

#include <cmath>
#include <csignal>

#include "catena/results/result_storage.hpp"
#include "catena/results/terminal/interrupt.hpp"
#include "catena/results/terminal/progress_bar.hpp"
#include "catena/results/terminal/report_text.hpp"
#include "catena/results/terminal/text_sink.hpp"
#include "results/temporary_folder.hpp"

namespace catena::testing {
namespace {

AnalysisResult check() {
  AnalysisResult r;
  r.type = "check";
  r.report.bodies = 3;
  r.report.rows = 9;
  r.report.rank = 9;
  r.report.dof = 0;
  r.report.mobility = 1;
  r.report.islands = 1;
  return r;
}

TEST(Report, SaysInWordsHowAMechanismMoves) {
  EXPECT_EQ(outcome_text(check()), "check: ok\n");
  EXPECT_EQ(report_text(check()),
            "  3 bodies, 9 constraint equations, 9 of them independent, on 9 coordinates\n"
            "  0 degrees of freedom: constraints and drivers fix every position\n"
            "  mobility 1: 1 degree of freedom if the drivers are taken away\n"
            "  no redundant constraints\n");
}

TEST(Report, NamesRedundantConstraintsButNotAThousandOfThem) {
  AnalysisResult r = check();
  r.report.redundant = {"B", "C"};
  EXPECT_NE(report_text(r).find("redundant: B, C ("), std::string::npos) << report_text(r);
  r.report.redundant.assign(1000, "B");
  EXPECT_NE(report_text(r).find(", ... 990 more"), std::string::npos);
  EXPECT_LT(report_text(r).size(), 1000u);
}

TEST(Report, ShowsMessageNotesAndNamedResults) {
  AnalysisResult r;
  r.type = "equilibrium";
  r.has_rows = true;
  r.rows = 1;
  r.report.status = Status::not_converged;
  r.report.message = "gave up after 50 iterations";
  r.report.warnings = {"first", "second"};
  r.fields = {{"energy", -2.5},
              {"stable", false},
              {"iterations", std::int64_t{6}},
              {"loads", std::vector<double>{1, 2.25}},
              {"critical", std::vector<FieldRecord>{{{"kind", std::string("limit")}, {"row", std::int64_t{4}}}}}};
  EXPECT_EQ(outcome_text(r), "equilibrium: not_converged, 1 row\n");
  EXPECT_EQ(report_text(r),
            "  gave up after 50 iterations\n"
            "  note: first\n"
            "  note: second\n"
            "  energy: -2.5\n"
            "  stable: no\n"
            "  iterations: 6\n"
            "  loads: 1, 2.25\n"
            "  critical: \n"
            "    kind limit, row 4\n");
}

TEST(Report, CountersShowWhatWasDoneOnly) {
  AnalysisResult r = check();
  r.report.seconds = 0.25;
  r.report.counters.factorizations = 103;
  EXPECT_EQ(counters_text(r), "check: 0.25 s\n           103  factorizations\n");
}

TEST(TextSink, WritesHeaderTableAndReportAndTheHintOnce) {
  TemporaryFolder folder;
  TextOutput output = TextOutput::file(folder / "out");
  TextSink sink(output, {.first_rows = 1, .last_rows = 0}, "-v shows all");
  RunHeader header;
  header.scene = "crank";
  header.bodies = 1;
  header.elements = 2;
  header.gravity = {0, -9.81};
  header.analyses = 3;
  sink.begin_run(header);
  for (int k = 0; k < 2; ++k) {
    RowSink& rows = sink.begin_analysis("kinematics");
    rows.begin(std::vector<ColumnInfo>{{"t", UnitKind::time}});
    rows.row(std::vector<double>{0});
    rows.row(std::vector<double>{1});
    AnalysisResult r;
    r.type = "kinematics";
    r.has_rows = true;
    r.rows = 2;
    sink.end_analysis(r);
  }
  sink.begin_analysis("check");  // no table of the one before
  sink.end_analysis(check());
  sink.end_run();
  ASSERT_TRUE(output.commit());
  EXPECT_EQ(read_file(folder / "out"),
            "crank: 1 body, 2 elements, gravity [0, -9.81] m/s^2\n"
            "\nkinematics: ok, 2 rows\n  t\n  s\n  0\n  ... 1 more row\n  (-v shows all)\n"
            "\nkinematics: ok, 2 rows\n  t\n  s\n  0\n  ... 1 more row\n"
            "\ncheck: ok\n" +
                report_text(check()));
}

TEST(TextSink, TellsWhoHasNoAnalysesWhatToDo) {
  RunHeader header;
  header.scene = "crank";
  EXPECT_NE(header_text(header).find("the scene lists no \"analyses\"; catena check SCENE"), std::string::npos);
  header.analyses = 1;
  EXPECT_EQ(header_text(header).find("analyses"), std::string::npos);
}

TEST(ResultStorage, KeepsRowsUpToItsLimit) {
  ResultStorage storage(5);
  storage.begin(std::vector<ColumnInfo>{{"t", UnitKind::time}, {"x", UnitKind::length}});
  EXPECT_TRUE(storage.row(std::vector<double>{1, 2}));
  EXPECT_TRUE(storage.row(std::vector<double>{3, 4}));
  EXPECT_FALSE(storage.row(std::vector<double>{5, 6}));
  EXPECT_EQ(storage.rows(), 2u);
  EXPECT_EQ(storage.column("x"), (std::vector<double>{2, 4}));
  EXPECT_EQ(storage.at(1, 0), 3);
  EXPECT_TRUE(storage.column("y").empty());
}

class Stopping final : public ResultSink, private RowSink {
 public:
  int rows = 0;
  void begin_run(const RunHeader&) override {}
  RowSink& begin_analysis(std::string_view) override { return *this; }
  void end_analysis(const AnalysisResult&) override {}
  void end_run() override {}
  explicit Stopping(int after) : after_(after) {}

 private:
  void begin(std::span<const ColumnInfo>) override {}
  bool row(std::span<const double>) override { return ++rows < after_; }
  int after_;
};

TEST(TeeSink, StopsIfOneOfItsSinksDoesButLeavesNoneOut) {
  Stopping a(1), b(2);
  TeeSink tee;
  tee.add(a);
  tee.add(b);
  RowSink& rows = tee.begin_analysis("kinematics");
  rows.begin({});
  EXPECT_FALSE(rows.row({}));
  EXPECT_EQ(a.rows, 1);
  EXPECT_EQ(b.rows, 1);
}

TEST(TimeLeft, FollowsThePaceOfTheLastHalf) {
  TimeLeft steady;
  EXPECT_FALSE(steady.after(100, 0));
  EXPECT_FALSE(steady.after(100.5, 0.05)) << "too early to tell";
  for (double t = 101; t < 110; t += 0.1) EXPECT_NEAR(steady.after(t, (t - 100) / 10).value(), 110 - t, 1e-9);
  // Nine tenths from a record at once, the rest at a hundredth a second: ten seconds in all.
  TimeLeft resumed;
  resumed.after(0, 0);
  for (double t = 0.01; t < 9; t += 0.1) {
    const std::optional<double> left = resumed.after(t, 0.9 + 0.01 * t);
    if (t > 4) {
      EXPECT_NEAR(left.value(), 10 - t, 1e-9) << t;
    }
  }
  EXPECT_EQ(TimeLeft::text(39.2), "40 s left");
  EXPECT_EQ(TimeLeft::text(700), "12 min left");
  EXPECT_EQ(TimeLeft::text(12000), "3 h 20 min left");
  EXPECT_EQ(TimeLeft::text(1e300), "years left");
}

TEST(ProgressBar, ShowsAFractionWhateverItIsGiven) {
  EXPECT_EQ(ProgressBar::text("kinematics", 0.5), "kinematics [###############...............]  50 %");
  EXPECT_EQ(ProgressBar::text("k", 7), "k [##############################] 100 %");
  EXPECT_EQ(ProgressBar::text("k", std::nan("")), ProgressBar::text("k", 0));
  EXPECT_FALSE(ProgressBar(false).visible());
}

TEST(Interrupt, SetsAFlagInsteadOfEndingTheProgram) {
  const std::atomic<bool>& flag = interrupt_flag();
  catch_interrupts();
  EXPECT_FALSE(flag.load());
  std::raise(SIGINT);
  EXPECT_TRUE(flag.load());
  std::signal(SIGTERM, SIG_DFL);
}

}  // namespace
}  // namespace catena::testing
