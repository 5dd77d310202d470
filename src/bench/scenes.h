#pragma once
/// The mechanisms on which properties are measured.

#include <string>

#include "flexarm/scene/scene_description.h"

namespace flexarm::bench {

/// A tree of flexible beams of two and three elements, with a revolute and a spherical joint and rigid bodies with
/// offset centres of mass: in free flight, spinning and vibrating, without loads.
scene::SceneDescription free_tree();
/// The same tree on a revolute joint of the world, starting at rest from loads that grow smoothly; probes on all tips.
scene::SceneDescription loaded_tree();

/// A straight clamped cantilever along x, 1 m long, with unit sections.
scene::SceneDescription cantilever(int elements, int order);
/// The same with a dead force and moment in space at its tip, which has a probe.
scene::SceneDescription loaded_cantilever();
/// The right-angle cantilever of Simo and Vu-Quoc (1988), 2 x 10 m, whose elbow is pulled out of the plane for 2 s.
scene::SceneDescription right_angle_cantilever(int elements, int order);
/// A free straight beam of one two-node element along x.
scene::SceneDescription free_bar();
/// One clamped two-node element along x, 1 m long: an exactly linear oscillator of angular frequency omega [rad/s].
scene::SceneDescription axial_oscillator(double omega);

/// An arm of three beams of eight elements with revolute joints that swings under gravity: for timing.
scene::SceneDescription swinging_arm();

// ---- hard ones
/// A thin beam, EA/(EI/L^2) = 10^6, that a heavy ball stretches and a force in its middle whips; `pull` is the history
/// of the ball's pull.
scene::SceneDescription stretched_whip(const std::string& pull);
/// Four stiff links on universal and revolute joints with strong dampers, dropped under gravity.
scene::SceneDescription damped_chain();
/// A slender cantilever that is bent far, then let go at once.
scene::SceneDescription sudden_release();

}  // namespace flexarm::bench
