#include "result_folder.hpp"

#include <filesystem>

#include "catena/scene/scene_runner.hpp"

namespace catena::cli {

void ResultFolder::begin_run(const RunHeader& header) {
  csv_.begin_run(header);  // makes the folder
  report_file_.emplace(TextOutput::file((std::filesystem::path(path_) / "report.json").string()));
  report_ = json_result_sink(*report_file_);
  report_->begin_run(header);
  tee_.add(csv_);
  tee_.add(*report_);
}

void ResultFolder::end_run() {
  tee_.end_run();
  files_ = csv_.files();
  error_ = csv_.error();
  if (report_file_->commit()) {
    files_.push_back((std::filesystem::path(path_) / "report.json").string());
  } else if (error_.empty()) {
    error_ = report_file_->error();
  }
}

}  // namespace catena::cli
