#include "catena/results/row_files.hpp"

#include <filesystem>

namespace catena {

void RowFiles::begin_run(const RunHeader&) {
  std::error_code failure;
  std::filesystem::create_directories(path_, failure);
  // An existing folder is no failure; if something else has its name, opening the first file fails.
  if (failure) error_ = "cannot make the folder " + path_ + ": " + failure.message();
}

RowSink& RowFiles::begin_analysis(std::string_view type) {
  const int number = ++count_[std::string(type)];
  file_name_ = std::string(type) + (number > 1 ? "-" + std::to_string(number) : "") + extension_;
  return *this;
}

void RowFiles::begin(std::span<const ColumnInfo> columns) {
  output_.emplace(TextOutput::file((std::filesystem::path(path_) / file_name_).string()));
  writer_ = make_(*output_);
  writer_->begin(columns);
}

bool RowFiles::row(std::span<const double> values) { return !writer_ || writer_->row(values); }

void RowFiles::end_analysis(const AnalysisResult&) {
  if (!output_) return;
  writer_->finish();
  if (output_->commit()) {
    files_.push_back((std::filesystem::path(path_) / file_name_).string());
  } else if (error_.empty()) {
    error_ = output_->error();
  }
  writer_.reset();
  output_.reset();
}

}  // namespace catena
