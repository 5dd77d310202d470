#pragma once
/// Inputs and outputs of linear models, by name.

#include <string>
#include <vector>

#include "analysis/linear_dynamics.h"
#include "flexarm/simulation/linear_model.h"

namespace flexarm {

/// An input or an output of a linear model: one scalar of the mechanism.
struct LinearPort {
  enum class Kind { Effort, Motion, Wrench, Position, Velocity, Acceleration, Strain, SectionForce };
  Kind kind = Kind::Effort;
  int coordinate = -1;  ///< index into Model::coordinates; -1: the port is at a point
  ProbePoint point;     ///< also the point of a sensor
  int component = 0;    ///< of the quantity at the point
  std::string name;     ///< as users write it, with the component
};

/// If `names` is empty: the efforts of all coordinates that take commands.
/// @throws std::invalid_argument if there is no such input.
std::vector<LinearPort> input_ports(const Simulation& simulation, const std::vector<std::string>& names);
/// If `names` is empty: positions of all coordinates that are not driven, and of all probes.
/// @throws std::invalid_argument if there is no such output.
std::vector<LinearPort> output_ports(const Simulation& simulation, const std::vector<std::string>& names);

/// How the quantities of the ports change with the coordinates of `dynamics`: a row per port, a column per coordinate,
/// rotors included.
MovingMatrix port_motion(const Simulation& simulation, const LinearDynamics& dynamics,
                         const std::vector<LinearPort>& ports);

/// Values of outputs (port_values.cpp). Rotations of points are small rotations from their orientations in `reference`,
/// world axes.
/// @throws std::invalid_argument for accelerations of joints, strains and section forces, which have no sensitivities:
/// they are not computed from results of a simulation.
Eigen::VectorXd port_values(const Simulation& simulation, const Simulation& reference,
                            const std::vector<LinearPort>& ports);

}  // namespace flexarm
