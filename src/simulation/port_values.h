#pragma once
/// Outputs of linear models as functions of the motion.

#include "simulation/linear_names.h"
#include "simulation/linear_ports.h"

namespace flexarm {

/// Their values; rotations of points as small ones from where `reference` has them, world axes.
/// @throws std::invalid_argument for accelerations of joints, and what sections of beams feel, which are not
/// differences of what a simulation puts out.
Eigen::VectorXd port_values(const Simulation& simulation, const Simulation& reference,
                            const std::vector<LinearPort>& ports);

}  // namespace flexarm
