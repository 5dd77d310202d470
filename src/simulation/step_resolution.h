#pragma once
/// Whether a simulation's steps are short enough for a linear model about an instant. (docs/notes/linearisation.md 3)

#include <string>

#include "flexarm/simulation/linear_model.h"

namespace flexarm {

/// What makes the model of an instant doubtful, a sentence; empty: nothing. Takes two steps of a copy: of a motion that
/// these resolve, velocities change by the accelerations that follow from the forces at its beginning, but for half the
/// phase w h by which that motion goes on in the step. Stresses that ring in steps which do not resolve them let
/// forces ask for accelerations that no step makes.
std::string doubt_about_instant(const Simulation& simulation, const LinearModel& model);

}  // namespace flexarm
