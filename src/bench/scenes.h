#pragma once
/// Scenes for measuring the properties of schemes.

#include <string>

#include "flexarm/scene/scene_description.h"

namespace flexarm::bench {

/// A tree of flexible beams with two and three elements, a revolute and a spherical joint, and rigid bodies with offset
/// centres of mass. It is in free flight without loads, spinning and vibrating.
scene::SceneDescription free_tree();
/// The same tree on a revolute joint to the world. It starts at rest, under loads that grow smoothly; probes on all
/// tips.
scene::SceneDescription loaded_tree();

/// A straight clamped cantilever along x, 1 m long, with unit sections.
scene::SceneDescription cantilever(int elements, int order);
/// The same cantilever with a dead force and a dead moment at its tip, in 3D; the tip has a probe.
scene::SceneDescription loaded_cantilever();
/// The right-angle cantilever of Simo and Vu-Quoc (1988), 2 x 10 m, whose elbow is pulled out of the plane for 2 s.
scene::SceneDescription right_angle_cantilever(int elements, int order);
/// A free straight beam of one two-node element along x.
scene::SceneDescription free_bar();
/// A clamped two-node element along x, 1 m long: an exactly linear oscillator with angular frequency omega [rad/s].
scene::SceneDescription axial_oscillator(double omega);

/// An arm of three beams with eight elements each, on revolute joints, that swings under gravity; for timing.
scene::SceneDescription swinging_arm();

// ---- hard scenes
/// A thin beam, EA/(EI/L^2) = 10^6, that is stretched by a heavy ball and whipped by a force at its middle. `pull`: the
/// history of the ball's pull.
scene::SceneDescription stretched_whip(const std::string& pull);
/// Four stiff links on universal and revolute joints with strong dampers, dropped under gravity.
scene::SceneDescription damped_chain();
/// A slender cantilever that is bent far, and suddenly released.
scene::SceneDescription sudden_release();

}  // namespace flexarm::bench
