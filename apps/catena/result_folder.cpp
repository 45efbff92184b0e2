#include "result_folder.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "catena/results/csv_writer.hpp"
#include "catena/results/npz_writer.hpp"
#include "catena/scene/running/scene_runner.hpp"

namespace catena::cli {
namespace {

std::unique_ptr<RowWriter> csv_writer(TextOutput& output) { return std::make_unique<CsvWriter>(output); }
std::unique_ptr<RowWriter> npz_writer(TextOutput& output) { return std::make_unique<NpzWriter>(output); }

MakeRowWriter writer_of(const std::string& format) {
  if (format == "npz") return npz_writer;
  return format == "json" ? json_row_writer : csv_writer;
}

}  // namespace

ResultFolder::ResultFolder(std::string path, const std::string& format)
    : path_(std::move(path)), rows_(path_, "." + format, writer_of(format)) {}

std::string ResultFolder::obstacle(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  fs::path place = fs::absolute(path, ignored);
  while (!fs::exists(place, ignored) && place.has_parent_path() && place != place.parent_path()) {
    place = place.parent_path();
  }
  if (!fs::is_directory(place, ignored)) {
    return fmt::format("cannot write results to \"{}\": \"{}\" is not a folder", path, place.string());
  }
  if (access(place.c_str(), W_OK | X_OK) == 0) return {};
  return fmt::format("cannot write results to \"{}\": \"{}\": {}", path, place.string(), std::strerror(errno));
}

void ResultFolder::begin_run(const RunHeader& header) {
  rows_.begin_run(header);  // makes the folder
  report_file_.emplace(TextOutput::file((std::filesystem::path(path_) / "report.json").string()));
  report_ = json_result_sink(*report_file_, JsonRows::left_out);
  report_->begin_run(header);
  tee_.add(rows_);
  tee_.add(*report_);
}

void ResultFolder::end_run() {
  tee_.end_run();
  files_ = rows_.files();
  error_ = rows_.error();
  if (report_file_->commit()) {
    files_.push_back((std::filesystem::path(path_) / "report.json").string());
  } else if (error_.empty()) {
    error_ = report_file_->error();
  }
}

}  // namespace catena::cli
