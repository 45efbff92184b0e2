// What ends up in files: CSV, the folder of a run, and what is left when writing fails.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "catena/results/csv_directory.hpp"
#include "catena/results/csv_writer.hpp"
#include "results/temporary_folder.hpp"

namespace catena::testing {
namespace {

AnalysisResult result(const std::string& type) {
  AnalysisResult r;
  r.type = type;
  return r;
}

TEST(Csv, IsExactAndQuotesWhatNeedsIt) {
  TemporaryFolder folder;
  {
    TextOutput output = TextOutput::file(folder / "a.csv");
    CsvWriter csv(output);
    const std::vector<ColumnInfo> columns{{"t", UnitKind::time}, {"a,b.x", UnitKind::length}, {"say \"c\".y", {}}};
    csv.begin(columns);
    const double third = 1.0 / 3, nan = std::nan("");
    csv.row(std::vector<double>{0, 0.1, third});
    csv.row(std::vector<double>{1e-300, nan, -std::numeric_limits<double>::infinity()});
    EXPECT_TRUE(output.commit());
  }
  EXPECT_EQ(read_file(folder / "a.csv"), "t,\"a,b.x\",\"say \"\"c\"\".y\"\r\n0,0.1,0.3333333333333333\r\n1e-300,,\r\n");
}

TEST(TextOutput, LeavesNothingUnlessCommitted) {
  TemporaryFolder folder;
  {
    TextOutput output = TextOutput::file(folder / "a");
    output.write("half");
  }
  EXPECT_EQ(folder.entries(), 0u);
}

TEST(TextOutput, KeepsTheFormerFileUntilTheNewOneIsComplete) {
  TemporaryFolder folder;
  std::ofstream(folder / "a") << "old";
  TextOutput output = TextOutput::file(folder / "a");
  output.write("new");
  EXPECT_EQ(read_file(folder / "a"), "old");
  EXPECT_TRUE(output.commit());
  EXPECT_EQ(read_file(folder / "a"), "new");
  EXPECT_EQ(folder.entries(), 1u);
}

TEST(TextOutput, SaysWhatCannotBeWrittenAndWhy) {
  TemporaryFolder folder;
  TextOutput missing = TextOutput::file(folder / "no/such/file");
  EXPECT_FALSE(missing.ok());
  EXPECT_FALSE(missing.write("x"));
  EXPECT_FALSE(missing.commit());
  EXPECT_NE(missing.error().find("no/such/file: No such file or directory"), std::string::npos) << missing.error();
  EXPECT_FALSE(missing.reader_gone());

  std::filesystem::create_directory(folder / "a");  // in the way of the file
  TextOutput blocked = TextOutput::file(folder / "a");
  EXPECT_TRUE(blocked.write("x"));
  EXPECT_FALSE(blocked.commit());
  EXPECT_FALSE(blocked.error().empty());
  EXPECT_EQ(folder.entries(), 1u);
}

TEST(CsvDirectory, HasOneFileAnAnalysisWithRows) {
  TemporaryFolder folder;
  CsvDirectory directory(folder / "new/results");
  const std::vector<ColumnInfo> columns{{"t", UnitKind::time}};
  directory.begin_run({});
  for (const std::string type : {"kinematics", "check", "kinematics"}) {
    RowSink& rows = directory.begin_analysis(type);
    if (type == "kinematics") {
      rows.begin(columns);
      rows.row(std::vector<double>{0.5});
    }
    directory.end_analysis(result(type));
  }
  directory.end_run();
  EXPECT_EQ(directory.error(), "");
  EXPECT_EQ(directory.files(),
            (std::vector<std::string>{folder / "new/results/kinematics.csv", folder / "new/results/kinematics-2.csv"}));
  EXPECT_EQ(read_file(folder / "new/results/kinematics-2.csv"), "t\r\n0.5\r\n");
}

TEST(CsvDirectory, TellsAtTheEndWhatCouldNotBeWritten) {
  TemporaryFolder folder;
  std::ofstream(folder / "file") << "in the way";
  CsvDirectory directory(folder / "file");
  directory.begin_run({});
  RowSink& rows = directory.begin_analysis("kinematics");
  rows.begin(std::vector<ColumnInfo>{{"t", UnitKind::time}});
  EXPECT_TRUE(rows.row(std::vector<double>{1}));  // the analysis goes on
  directory.end_analysis(result("kinematics"));
  EXPECT_NE(directory.error().find(folder / "file"), std::string::npos) << directory.error();
  EXPECT_TRUE(directory.files().empty());
  EXPECT_EQ(read_file(folder / "file"), "in the way");
}

}  // namespace
}  // namespace catena::testing
