#pragma once
/// What sensors measure, and when.

#include "flexarm/scene/scene_description.h"
#include "simulation/published_motion.h"

namespace flexarm {

/// {force, moment} that a joint transmits to the link that it carries, at the end of the last step: world axes, about
/// the point at `about` relative to the state's origin [m].
Wrench transmitted_wrench(const Model& model, const State& state, int reaction, const Vector3& about);

/// The same about the point of a sensor that measures it. On a flexible link that point moves with the section.
Wrench sensed_wrench(const Model& model, const State& state, const SensorPlace& place);

/// Takes the samples that are due at the state's time, or all samples. The time of the call does not matter otherwise:
/// errors of a sample follow from its number, counted from t = 0. Allocates nothing after its first call.
void take_samples(const std::vector<scene::Sensor>& sensors, const MotionView& view, PublishedMotion& motion, bool all,
                  std::vector<SensorSample>& samples);

}  // namespace flexarm
