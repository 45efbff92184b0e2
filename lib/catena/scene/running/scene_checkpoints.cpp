#include "catena/scene/running/scene_checkpoints.hpp"

#include <fmt/format.h>

#include <vector>

namespace catena {

void SceneCheckpoints::prepare(std::span<const std::string_view> of_scene) {
  std::vector<std::string_view> texts{CATENA_VERSION};
  texts.insert(texts.end(), of_scene.begin(), of_scene.end());
  texts.push_back("verb");
  texts.push_back(options_.verb);
  for (const auto* pairs : {&options_.verb_options, &options_.set}) {
    texts.push_back(pairs == &options_.set ? "set" : "keys");
    for (const auto& [name, value] : *pairs) {
      texts.push_back(name);
      texts.push_back(value);
    }
  }
  texts.push_back("outputs");
  texts.insert(texts.end(), options_.outputs.begin(), options_.outputs.end());
  owner_ = fingerprint(texts);
  if (!options_.restart.empty()) {
    restart_ = read_checkpoint(options_.restart);
    if (restart_->owner != owner_) {
      throw CheckpointError(
          fmt::format("the checkpoint \"{}\" belongs to another scene, or to this one with another text, other files "
                      "or parameters, "
                      "another command or another version of catena",
                      options_.restart));
    }
  }
  if (!options_.checkpoint.empty()) check_checkpoint_place(options_.checkpoint);
}

CheckpointRequest SceneCheckpoints::request(int analysis) const {
  CheckpointRequest request;
  request.every = restart_ ? restart_->every : options_.checkpoint_every;
  if (restart_ && restart_->analysis == analysis) request.restart = restart_;
  request.save = [this, analysis, every = request.every](double begin, const MotionMemory& motion) {
    if (options_.checkpoint.empty()) return;
    write_checkpoint(options_.checkpoint, {owner_, analysis, begin, every, motion});
  };
  return request;
}

}  // namespace catena
