#pragma once
/// Reads scenes that are written in tests.

#include <stdexcept>
#include <string>

#include "flexarm/scene/urdf_reader.h"

namespace flexarm::test {

/// The scene of an extended URDF. @throws std::runtime_error with the findings if it has errors
inline scene::SceneDescription scene_of(const std::string& text) {
  scene::ReadResult read = scene::read_scene_text(text, "test.urdf");
  if (!read.scene) throw std::runtime_error(scene::to_text(read.diagnostics));
  return *std::move(read.scene);
}

}  // namespace flexarm::test
