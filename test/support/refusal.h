#pragma once
/// What is said where something is refused.

#include <string>

#include <gtest/gtest.h>

#include "flexarm/model/model_error.h"
#include "flexarm/scene/scene_description.h"
#include "flexarm/simulation/simulation.h"

namespace flexarm::test {

/// The message of the Error that `call` throws, "" if it throws none.
template <class Error, class Call>
std::string refusal(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// The message of the ModelError with which a simulation refuses a scene, "" if it does not.
inline std::string refusal_of(const scene::SceneDescription& scene, const SimulationOptions& options = {}) {
  return refusal<ModelError>([&] { Simulation(scene, options); });
}

/// Expects `fragment` in a text.
inline void expect_contains(const std::string& text, const std::string& fragment) {
  EXPECT_NE(text.find(fragment), std::string::npos) << "expected '" << fragment << "' in: " << text;
}

}  // namespace flexarm::test
