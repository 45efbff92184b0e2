// The evaluator of a scene given as text, at t = 0.7 s.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "catena/assembly/evaluate.hpp"
#include "catena/scene/building/build_model.hpp"
#include "catena/scene/reading/scene_reader.hpp"

namespace catena::testing {

/// `model`: what it is of, which must outlive it, as `work` must. nullptr, and a failure, where the scene cannot be
/// built.
inline std::unique_ptr<Evaluator> evaluator_of(const std::string& text, Model& model, EvaluationWork& work) {
  Diagnostics diagnostics;
  const auto scene = read_scene(SourceText("scene", text), diagnostics);
  if (scene) model = build_model<double>(*scene, std::span<const double>(), {}, diagnostics);
  EXPECT_TRUE(scene && diagnostics.ok()) << diagnostics.text();
  if (!scene || !diagnostics.ok()) return nullptr;
  auto evaluator = std::make_unique<Evaluator>(Plan::make(model), model, work);
  evaluator->set_time(0.7);
  return evaluator;
}

}  // namespace catena::testing
