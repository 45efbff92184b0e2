// Rows as a NumPy archive (.npz): one array a column, under the column's name, as numpy.load() reads them.
//
// An archive is a zip file of stored entries, each an array in the format .npy 1.0: doubles, little-endian; a status is
// a text of bytes. Columns are kept in memory until the last row, as an array must lie in one piece. Archives of 4 GB
// and more are refused. Sources: PKWARE, APPNOTE (zip); NumPy enhancement proposal 1 (npy).
#pragma once

#include <string>
#include <vector>

#include "catena/results/row_writer.hpp"

namespace catena {

class NpzWriter final : public RowWriter {
 public:
  explicit NpzWriter(TextOutput& output) : output_(output) {}

  void begin(std::span<const ColumnInfo> columns) override;
  bool row(std::span<const double> values) override;
  void finish() override;

 private:
  struct Entry {
    std::string name;
    std::uint32_t check = 0, size = 0, offset = 0;
  };
  void add(const std::string& name, const std::string& array);
  void write(const std::string& bytes);

  TextOutput& output_;
  std::vector<ColumnInfo> columns_;
  std::vector<std::vector<double>> values_;  // by column
  std::vector<Entry> entries_;
  std::uint64_t written_ = 0;
  bool too_large_ = false;
};

}  // namespace catena
