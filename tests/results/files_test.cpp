// What ends up in files: CSV, the folder of a run, and what is left when writing fails.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "catena/results/csv_writer.hpp"
#include "catena/results/npz_writer.hpp"
#include "catena/results/row_files.hpp"
#include "results/temporary_folder.hpp"

namespace catena::testing {
namespace {

std::unique_ptr<RowWriter> csv_writer(TextOutput& output) { return std::make_unique<CsvWriter>(output); }
std::unique_ptr<RowWriter> npz_writer(TextOutput& output) { return std::make_unique<NpzWriter>(output); }

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

TEST(RowFiles, HasOneFileAnAnalysisWithRows) {
  TemporaryFolder folder;
  RowFiles directory(folder / "new/results", ".csv", csv_writer);
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

// Made with NumPy's format in hand; the check sum is zlib.crc32 of the 144 bytes of t.npy.
TEST(Npz, IsAZipFileOfArrays) {
  TemporaryFolder folder;
  RowFiles directory(folder / "results", ".npz", npz_writer);
  directory.begin_run({});
  RowSink& rows = directory.begin_analysis("sweep");
  std::vector<ColumnInfo> columns{{"t", UnitKind::time}, {"status", {}}};
  columns[1].is_status = true;
  rows.begin(columns);
  rows.row(std::vector<double>{0.5, 0});
  rows.row(std::vector<double>{-2, std::nan("")});
  directory.end_analysis(result("sweep"));
  EXPECT_EQ(directory.error(), "");
  const std::string bytes = read_file(folder / "results/sweep.npz");
  const auto number = [&](std::size_t at, std::size_t width) {
    std::uint64_t sum = 0;
    for (std::size_t k = width; k-- > 0;) sum = 256 * sum + static_cast<unsigned char>(bytes.at(at + k));
    return sum;
  };
  ASSERT_EQ(bytes.substr(0, 4), "PK\x03\x04");
  EXPECT_EQ(bytes.substr(30, 5), "t.npy");
  const std::size_t array = 35;
  EXPECT_EQ(number(22, 4), 128U + 16);
  EXPECT_EQ(number(14, 4), 0x75bc59acU);
  EXPECT_EQ(bytes.substr(array, 8), std::string("\x93NUMPY\x01\x00", 8));
  EXPECT_EQ(number(array + 8, 2), 118U);
  EXPECT_EQ(bytes.substr(array + 10, 60).find("{'descr': '<f8', 'fortran_order': False, 'shape': (2,), }"), 0U);
  EXPECT_EQ(bytes[array + 127], '\n');
  double values[2];
  std::memcpy(values, bytes.data() + array + 128, sizeof values);
  EXPECT_EQ(values[0], 0.5);
  EXPECT_EQ(values[1], -2);
  EXPECT_NE(bytes.find(std::string("ok") + std::string(14, '\0') + std::string(16, '\0')), std::string::npos);
  const std::size_t end = bytes.size() - 22;
  EXPECT_EQ(bytes.substr(end, 4), "PK\x05\x06");
  EXPECT_EQ(number(end + 10, 2), 2U);
  EXPECT_EQ(bytes.substr(number(end + 16, 4), 4), "PK\x01\x02");
  EXPECT_EQ(number(end + 16, 4) + number(end + 12, 4), end);
  EXPECT_EQ(number(number(end + 16, 4) + 16, 4), number(14, 4));  // the same check sum in both places
}

TEST(RowFiles, TellsAtTheEndWhatCouldNotBeWritten) {
  TemporaryFolder folder;
  std::ofstream(folder / "file") << "in the way";
  RowFiles directory(folder / "file", ".csv", csv_writer);
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
