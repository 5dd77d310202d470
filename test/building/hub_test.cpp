// Tests hubs: rigid inertia at the ends of beams.
#include <gtest/gtest.h>

#include "flexarm/simulation/simulation.h"
#include "simulation/inside.h"
#include "support/scene_builder.h"

namespace flexarm::test {
namespace {

scene::HubDescription hub(scene::HubDescription::End end, double mass, const Vector3& inertia) {
  scene::HubDescription out;
  out.end = end;
  out.mass = mass;
  out.inertia = inertia;
  return out;
}

/// A beam on a hinge about z, whose section is rotated and whose line is bent.
SceneBuilder arm() {
  SceneBuilder b;
  scene::BeamDescription& beam =
      b.beam("arm", {{0.6, 0.2, 0}}, scene::DirectSection{2e4, 1e4, 1e4, 60, 80, 90, 0.3, 2e-4, 1e-4, 1e-4}, 2, 2);
  beam.section_y = Vector3(0, 0, 1);
  b.joint("hinge", scene::JointKind::Revolute, "world", "arm", {0, 0, 0}, {0, 0, 1});
  b.scene.initial_joints.push_back({"hinge", 0, 2, {}});
  return b;
}

// Hubs act like rigid links that are fixed to the beam's ends.
TEST(Hub, IsARigidLinkFixedToTheEnd) {
  SceneBuilder with_hubs = arm(), with_links = arm();
  const Vector3 inertia(0.02, 0.03, 0.04);
  with_hubs.scene.links.back().beam->hubs = {hub(scene::HubDescription::End::Start, 0.5, inertia),
                                             hub(scene::HubDescription::End::End, 0.7, 2 * inertia)};
  with_links.body("flange", 0.5, Vector3::Zero(), inertia.asDiagonal());
  with_links.joint("flange", scene::JointKind::Fixed, "arm", "flange", {0, 0, 0});
  with_links.body("head", 0.7, Vector3::Zero(), 2 * inertia.asDiagonal().toDenseMatrix());
  with_links.joint("head", scene::JointKind::Fixed, "arm", "head", {0.6, 0.2, 0});
  Simulation hubs(with_hubs.scene), links(with_links.scene);
  EXPECT_NEAR(hubs.energies().kinetic, links.energies().kinetic, 1e-14);
  for (int n = 0; n < 100; ++n) {
    ASSERT_TRUE(hubs.step().converged);
    ASSERT_TRUE(links.step().converged);
  }
  EXPECT_LT((hubs.tip_pose(1).position - links.tip_pose(1).position).norm(), 1e-12);
  const std::vector<Mode> a = hubs.natural_modes(6), b = links.natural_modes(6);
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(a[i].frequency, b[i].frequency, 1e-8 * (1 + b[i].frequency));
}

}  // namespace
}  // namespace flexarm::test
