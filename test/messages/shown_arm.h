#pragma once
/// An arm, the markers that show it in rviz, and functions that look for markers in messages.

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "messages/marker_messages.h"
#include "scene/scene_builder.h"

namespace flexarm::messages {

using scene::JointKind;
using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

/// Returns an arm with a motor, a beam, a probe, and a force cell between hub and beam.
inline scene::SceneBuilder arm() {
  scene::SceneBuilder b("arm");
  b.scene.integrator.step = 0.01;
  b.body("hub", 2, Vector3::Zero(), Matrix3::Identity());
  b.beam("boom", {{2, 0, 0}}, scene::DirectSection{2e4, 1e4, 1e4, 200, 250, 300, 0.5, 0.02, 0.01, 0.01}, 2, 2);
  b.joint("motor", JointKind::Revolute, "world", "hub");
  b.joint("weld", JointKind::Fixed, "hub", "boom");
  b.probe("tip", "boom", {2, 0, 0});
  b.sensor("cell", scene::SensorKind::Reaction, "boom");
  return b;
}

class Markers : public ::testing::Test {
 protected:
  explicit Markers(const scene::SceneBuilder& builder = arm()) : simulation_(builder.scene) {}
  MarkerMessages messages(const MarkerChoice& choice = {}) {
    return {simulation_, "frame", choice, [this](const std::string& text) { warnings_.push_back(text); }};
  }
  void step(int steps) {
    for (int n = 0; n < steps; ++n) ASSERT_TRUE(simulation_.step().converged);
  }
  /// The texts of the legend with all that it can have. Makes a step.
  std::vector<Marker> full_legend();
  Simulation simulation_;
  std::vector<std::string> warnings_;
};

inline MarkerArray shown(MarkerMessages& messages) {
  return messages.make(ros::Time(1), 0.5);
}

inline std::vector<Marker> Markers::full_legend() {
  MarkerMessages messages = this->messages();
  simulation_.command_effort(0, 5);
  simulation_.apply_wrenches({{2, {2, 0, 0}, {{0, 0, 3}, Vector3::Zero()}, false, {}}});
  step(1);
  std::vector<Marker> texts;
  for (const Marker& marker : shown(messages).markers)
    if (marker.ns == "legend" && marker.type == Marker::TEXT_VIEW_FACING) texts.push_back(marker);
  return texts;
}

inline const Marker* find(const MarkerArray& message, const std::string& name, int action = Marker::ADD) {
  const auto found = std::find_if(message.markers.begin(), message.markers.end(),
                                  [&](const Marker& marker) { return marker.ns == name && marker.action == action; });
  return found == message.markers.end() ? nullptr : &*found;
}

}  // namespace flexarm::messages
