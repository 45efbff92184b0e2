#include "result_folder.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "catena/scene/running/scene_runner.hpp"

namespace catena::cli {

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
