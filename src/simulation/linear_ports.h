#pragma once
/// Inputs and outputs of linear models, by name.

#include <string>
#include <vector>

#include "analysis/linear_dynamics.h"
#include "flexarm/simulation/linear_model.h"

namespace flexarm {

/// An input or an output: one scalar of the mechanism.
struct LinearPort {
  enum class Kind { Effort, Motion, Wrench, Position, Velocity, Acceleration, Strain, SectionForce };
  Kind kind = Kind::Effort;
  int coordinate = -1;  ///< of Model::coordinates; -1: a point
  ProbePoint point;     ///< of a sensor, too
  int component = 0;    ///< of the point
  std::string name;     ///< as users write it, with the component
};

/// @throws std::invalid_argument if there is no such input.
std::vector<LinearPort> input_ports(const Simulation& simulation, const std::vector<std::string>& names);
/// @throws std::invalid_argument if there is no such output.
std::vector<LinearPort> output_ports(const Simulation& simulation, const std::vector<std::string>& names);

/// How the places of the ports move with the dynamics' coordinates, a row for each; rotors' columns included.
MovingMatrix port_motion(const Simulation& simulation, const LinearDynamics& dynamics,
                         const std::vector<LinearPort>& ports);

/// Values of outputs (port_values.cpp); rotations of points as small ones from where `reference` has them, world axes.
/// @throws std::invalid_argument for accelerations of joints, and what sections of beams feel, which are not
/// differences of what a simulation puts out.
Eigen::VectorXd port_values(const Simulation& simulation, const Simulation& reference,
                            const std::vector<LinearPort>& ports);

}  // namespace flexarm
