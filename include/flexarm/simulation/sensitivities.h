#pragma once
/// Derivatives of a run with respect to its parameters and its start, computed during the run.
/// (docs/notes/sensitivities.md)

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "flexarm/model/run_event.h"
#include "flexarm/scene/urdf_reader.h"
#include "flexarm/simulation/simulation.h"

namespace flexarm {

/// Selects the parameters and initial states with respect to which a run is differentiated.
struct SensitivityRequest {
  /// Names of <parameter> elements of the scene.
  std::vector<std::string> parameters;
  /// Reads the scene of the simulation again, with another value of one parameter. Required if `parameters` is not
  /// empty.
  std::function<scene::ReadResult(const std::string& parameter, double value)> read;
  /// Whether to differentiate with respect to the initial state as well. Its components are those of a linear model
  /// about the start (LinearModel::states): joint positions, displacements of beam nodes, then their rates.
  bool initial_state = false;
};

/// Derivatives of a simulation's run with respect to parameters and initial states. The columns of all matrices, called
/// directions, are first the parameters in the order of the request, then the initial states.
///
/// The derivatives are those of the discrete time steps, accurate to about 1e-6 of the largest derivative. At stops and
/// dry friction they are those of the continuous motion, whose events lie within steps. Computing derivatives does not
/// change any bit of the simulation. Iterative interpolation has no derivatives.
class Sensitivities {
 public:
  /// Starts with a simulation that has made no steps. The simulation must outlive this object and must not move in
  /// memory. Copies of the simulation have no derivatives.
  /// @throws std::invalid_argument if a parameter is unknown, if it changes something that cannot be differentiated
  /// (numbers of elements, joints, the step), or if the simulation has made steps; ModelError if its scheme has no
  /// derivatives; std::runtime_error if initial states are requested at a dead point of a loop.
  Sensitivities(Simulation& simulation, const SensitivityRequest& request);
  ~Sensitivities();
  Sensitivities(Sensitivities&&) noexcept;
  Sensitivities& operator=(Sensitivities&&) noexcept;

  /// Does one step of the simulation (Simulation::step()), with all derivatives.
  /// @throws std::logic_error if the simulation was stepped, reset or restored by other means since the last step.
  StepResult step();

  /// Names of the columns: the parameters, then the initial states.
  const std::vector<std::string>& directions() const;
  /// Why the derivatives were lost, so that all matrices are NaN: a step failed or was done by another scheme, a slider
  /// left its line, or there were too many events of stops and friction in one step. Empty if the derivatives are
  /// valid.
  const std::string& lost() const;
  /// Events of the run so far: stops that were touched or left, dry friction that sticks or slips. The derivatives
  /// account for the change of each event's time. After an event with a doubt (RunEvent::doubt) they are unreliable.
  const std::vector<RunEvent>& events() const;

  /// Derivatives of joint positions [rad or m] and of Simulation::velocity() [rad/s or m/s]: coordinates x directions.
  Eigen::MatrixXd positions() const;
  Eigen::MatrixXd velocities() const;
  /// Derivatives of a probe's {position [m], small rotation [rad], velocity [m/s], angular velocity [rad/s]}, world
  /// axes: 12 x directions.
  /// @throws std::out_of_range if there is no such probe.
  Eigen::MatrixXd probe(std::size_t index) const;
  /// Derivatives of any smooth function of a simulation: values of the function x directions.
  /// @throws std::invalid_argument if the number of values differs between calls of the function.
  Eigen::MatrixXd of(const std::function<Eigen::VectorXd(const Simulation&)>& observable) const;
  /// Derivatives of outputs of linear models (LinearRequest::outputs): outputs x directions. Possible outputs are
  /// position: and velocity: of joints and points, acceleration: of points, effort: of driven joints. Without names:
  /// positions of all joints and probes.
  /// @throws std::invalid_argument if there is no such output.
  Eigen::MatrixXd outputs(const std::vector<std::string>& names = {}) const;
  /// Names of the rows of outputs().
  std::vector<std::string> output_names(const std::vector<std::string>& names = {}) const;
  /// Derivatives of the states of a linear model about the present: states x directions. The columns of the initial
  /// states form the transition matrix.
  /// @throws std::runtime_error as linearise() does.
  Eigen::MatrixXd states() const;
  std::vector<std::string> state_names() const;  ///< names of the rows of states()

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace flexarm
