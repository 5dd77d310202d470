#pragma once
/// Linear models of a mechanism, for the design of controllers. (docs/notes/linearisation.md)

#include <complex>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "flexarm/simulation/simulation.h"

namespace flexarm {

/// The reference motion about which a simulation is linearised.
enum class LinearisedAbout {
  Rest,    ///< the configuration as it is, without velocities, under the loads at time 0: after solve_static()
  Steady,  ///< a steady motion: driven joints move as fast as at time 0, everything else is at rest relative to them
  Instant  ///< the present motion
};

/// Inputs and outputs of a linear model. Points are links ("elbow": the link's origin), ends of beams ("upper_arm/tip")
/// and probes.
///
/// | input               | is                                                                                       |
/// |---------------------|------------------------------------------------------------------------------------------|
/// | `effort:JOINT`      | effort on a coordinate, of its motor where it has one [N or N m]                          |
/// | `motion:JOINT`      | acceleration of a coordinate that a <motion> drives [m/s^2 or rad/s^2]; others are held   |
/// | `wrench:POINT:fx`   | force (fx fy fz) [N] or moment (mx my mz) [N m] at a point, world axes                     |
///
/// | output              | is                                                                                       |
/// |---------------------|------------------------------------------------------------------------------------------|
/// | `position:JOINT`    | of a coordinate [m or rad]; `velocity:` and `acceleration:` are its derivatives            |
/// | `position:POINT:x`  | displacement (x y z) [m] or small rotation (rx ry rz) [rad] of a point, world axes         |
/// | `effort:JOINT`      | what drives a coordinate that a <motion> drives [N or N m]                                |
/// | `strain:SENSOR`     | what a strain gauge of the scene measures, without its errors [-]                         |
/// | `section_force:SENSOR:fx` | of a sensor of elastic forces: (fx fy fz) [N] and moments (mx my mz) [N m]          |
///
/// A point or a section without a component stands for all six; points have `velocity:` and `acceleration:`, too.
struct LinearRequest {
  LinearisedAbout about = LinearisedAbout::Rest;
  std::vector<std::string> inputs;   ///< empty: the efforts on all coordinates that take commands
  std::vector<std::string> outputs;  ///< empty: the positions of all coordinates that take commands, and of all probes
};

/// Small deviations from a reference motion: with the coordinates y, states x = {y, y'}, inputs u and outputs v
///   mass y'' + damping y' + stiffness y = forces,   x' = a x + b u,   v = c x + d u.
/// y consists of joint coordinates, of displacements [m] and rotations [rad] of beams' nodes, relative to the node at
/// which their link is held and along its axes, and of rotors' angles behind elastic gears; closed loops leave a part
/// of these. Driven coordinates without an input are held, and are no states.
struct LinearModel {
  std::vector<std::string> coordinates;      ///< of y, driven ones included
  Eigen::MatrixXd mass, damping, stiffness;  ///< by y; damping: with gyroscopic, stiffness: with centrifugal terms
  Eigen::VectorXd residual;                  ///< efforts that drive the driven ones in the reference, zeros else
  std::vector<std::string> states, inputs, outputs;
  int positions = 0;  ///< the first of the states; the others are their rates
  Eigen::MatrixXd a, b, c, d;
  Eigen::VectorXd drift;              ///< x' of the reference itself; zeros at rest
  std::vector<std::string> left_out;  ///< effects of the scene that a linear model does not have, in words
};

/// @throws std::invalid_argument if an input or output does not exist, naming those that do; std::runtime_error if the
/// reference is not found, or the masses do not determine an acceleration.
LinearModel linearise(const Simulation& simulation, const LinearRequest& request = {});

/// An eigenvalue of `a`; of a conjugate pair the one with an imaginary part >= 0.
struct Pole {
  std::complex<double> value;    ///< [1/s]
  int state = 0;                 ///< that moves most in its mode, of displacements and rotations
  Eigen::VectorXcd mode;         ///< of the states, the largest of their positions is 1
  double frequency() const;      ///< imaginary part over 2 pi [Hz]
  double damping_ratio() const;  ///< -Re / |value|; 0 for a pole at 0
};
/// By |value|, the smallest first.
/// @throws std::invalid_argument if the matrices of the model are not of one size; std::runtime_error if poles are not
/// found.
std::vector<Pole> poles(const LinearModel& model);

}  // namespace flexarm
