#pragma once
/// Checks the errors of scenes that the model builder refuses.

#include <gtest/gtest.h>

#include <string>

#include "building/model_builder.h"

namespace flexarm::test {

/// Expects that the scene is refused with a message that contains `part`.
inline void expect_error(const scene::SceneDescription& scene, const std::string& part) {
  try {
    build_model(scene);
    ADD_FAILURE() << "no error about: " << part;
  } catch (const ModelError& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

}  // namespace flexarm::test
