#pragma once
/// Whether a simulation's steps are short enough for a linear model about an instant. (docs/notes/linearisation.md 3)

#include <string>

#include "flexarm/simulation/linear_model.h"

namespace flexarm {

/// Returns a sentence about why the linear model of an instant is doubtful; empty if it is not. Takes two steps with a
/// copy of the simulation. If steps resolve a motion, its velocities change by the accelerations that follow from the
/// forces at the beginning of the step, up to half the phase w h by which the motion advances in the step. If they do
/// not, stresses may oscillate from step to step, and the forces result in accelerations that no step makes.
std::string doubt_about_instant(const Simulation& simulation, const LinearModel& model);

}  // namespace flexarm
