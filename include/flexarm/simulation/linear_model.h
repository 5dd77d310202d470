#pragma once
/// Linearises a mechanism, for the design of controllers. (docs/notes/linearisation.md)

#include <complex>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "flexarm/simulation/simulation.h"

namespace flexarm {

/// The reference motion about which a simulation is linearised.
enum class LinearisedAbout {
  Rest,    ///< the present configuration, without velocities, under the loads at time 0; use it after solve_static()
  Steady,  ///< a steady motion: driven joints have their speeds of time 0, and nothing else moves relative to them
  Instant  ///< the present motion
};

/// Inputs and outputs of a linear model. Points are links ("elbow": the link's origin), ends of beams ("upper_arm/tip")
/// and probes.
///
/// | input               | meaning                                                                                  |
/// |---------------------|------------------------------------------------------------------------------------------|
/// | `effort:JOINT`      | effort on a coordinate; if it has a motor, the motor's effort [N or N m]                   |
/// | `motion:JOINT`      | acceleration of a coordinate with a <motion> [m/s^2 or rad/s^2]                            |
/// | `wrench:POINT:fx`   | force (fx fy fz) [N] or moment (mx my mz) [N m] at a point, world axes                     |
///
/// | output              | meaning                                                                                  |
/// |---------------------|------------------------------------------------------------------------------------------|
/// | `position:JOINT`    | of a coordinate [m or rad]; also its derivatives `velocity:` and `acceleration:`           |
/// | `position:POINT:x`  | displacement (x y z) [m] or small rotation (rx ry rz) [rad] of a point, world axes         |
/// | `effort:JOINT`      | effort that drives a coordinate with a <motion> [N or N m]                                |
/// | `strain:SENSOR`     | strain at a strain gauge of the scene, without the gauge's errors [-]                     |
/// | `section_force:SENSOR:fx` | force (fx fy fz) [N] or moment (mx my mz) [N m] at a sensor of that kind            |
///
/// Coordinates with a <motion> that is not an input are held. A point or section without a component stands for all six
/// components. Points also have `velocity:` and `acceleration:`.
struct LinearRequest {
  LinearisedAbout about = LinearisedAbout::Rest;
  std::vector<std::string> inputs;  ///< empty: the efforts on all coordinates that accept commands
  /// Empty: the positions of all coordinates that accept commands, and of all probes.
  std::vector<std::string> outputs;
};

/// Equations of small deviations from a reference motion, with coordinates y, states x = {y, y'}, inputs u, outputs v:
///   mass y'' + damping y' + stiffness y = forces,   x' = a x + b u,   v = c x + d u.
///
/// y consists of joint coordinates, of displacements [m] and rotations [rad] of beam nodes, and of rotor angles behind
/// elastic gears. Displacements and rotations are relative to the node at which the link is held, and along its axes.
/// Closed loops remove some of these coordinates. Driven coordinates that are not inputs are held; they are no states.
struct LinearModel {
  std::vector<std::string> coordinates;      ///< names of y, driven coordinates included
  Eigen::MatrixXd mass, damping, stiffness;  ///< damping includes gyroscopic, stiffness centrifugal terms
  /// Round-off of the diagonal of `stiffness` for coordinates that move whole bodies, whose strains cancel; 0 for
  /// others.
  Eigen::VectorXd stiffness_round_off;
  Eigen::VectorXd residual;  ///< efforts that drive the driven coordinates in the reference, else zeros
  std::vector<std::string> states, inputs, outputs;
  int positions = 0;  ///< number of positions, which are the first states; their rates follow
  Eigen::MatrixXd a, b, c, d;
  Eigen::VectorXd drift;              ///< x' of the reference itself; zero at rest
  std::vector<std::string> left_out;  ///< effects of the scene that the linear model ignores, in words
};

/// Linearises the simulation about a reference motion.
/// @throws std::invalid_argument if an input or output does not exist, naming those that do; std::runtime_error if the
/// reference motion cannot be found, or if the masses do not determine all accelerations.
LinearModel linearise(const Simulation& simulation, const LinearRequest& request = {});

/// An eigenvalue of the matrix `a`. Of a conjugate pair, only the one with imaginary part >= 0.
struct Pole {
  std::complex<double> value;    ///< [1/s]
  int state = 0;                 ///< index of the displacement or rotation with the largest motion in the mode
  Eigen::VectorXcd mode;         ///< eigenvector of the states, scaled so that the largest position is 1
  double frequency() const;      ///< imaginary part / (2 pi) [Hz]
  double damping_ratio() const;  ///< -real part / |value|; 0 for a pole at 0
};
/// All poles, sorted by |value| in ascending order.
/// @throws std::invalid_argument if the sizes of the model's matrices do not match; std::runtime_error if the
/// eigenvalue problem cannot be solved.
std::vector<Pole> poles(const LinearModel& model);

}  // namespace flexarm
