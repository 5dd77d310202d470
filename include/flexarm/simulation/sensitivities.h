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

/// With respect to what a run is differentiated.
struct SensitivityRequest {
  /// Names of <parameter>s of the scene.
  std::vector<std::string> parameters;
  /// Reads the scene of the simulation once more, with another value of one parameter. Required if there are
  /// parameters.
  std::function<scene::ReadResult(const std::string& parameter, double value)> read;
  /// The states of linear models about the start (LinearModel::states): joint positions, displacements of beams' nodes,
  /// then their rates.
  bool initial_state = false;
};

/// Derivatives of a simulation's run, per unit of parameters and of states at the start. The columns of all matrices
/// are these directions: first the parameters in the order of the request, then the states.
///
/// They are derivatives of the steps as they are taken, to about 1e-6 of the largest. At stops and dry friction they
/// are those of the motion, whose events are within steps. The simulation has the same bits as without them. There are
/// none for iterative interpolation.
class Sensitivities {
 public:
  /// For a simulation at its start. It must outlive this object and stay in its place in memory; its copies have no
  /// derivatives.
  /// @throws std::invalid_argument if a parameter is unknown, or changes something without a derivative (numbers of
  /// elements, joints, the step), or if the simulation has made steps; ModelError if its scheme has no derivatives;
  /// std::runtime_error for initial states at a dead point.
  Sensitivities(Simulation& simulation, const SensitivityRequest& request);
  ~Sensitivities();
  Sensitivities(Sensitivities&&) noexcept;
  Sensitivities& operator=(Sensitivities&&) noexcept;

  /// Steps the simulation (Simulation::step()) with all derivatives.
  /// @throws std::logic_error if the simulation was stepped, reset or restored by other means since the last step.
  StepResult step();

  /// Names of the parameters, then of the states.
  const std::vector<std::string>& directions() const;
  /// Why there are no derivatives any more, so that matrices are NaN: a step failed or was done by another scheme, a
  /// slider left its line, or stops and friction changed more often in a step than can be followed. Empty if there are
  /// derivatives.
  const std::string& lost() const;
  /// Events of the run: stops that were touched or left, dry friction that sticks or slips. Derivatives include how the
  /// time of each event changes. After an event with a doubt they are not to be trusted.
  const std::vector<RunEvent>& events() const;

  /// Of joint positions [rad or m] and Simulation::velocity() [rad/s or m/s]: coordinates x directions.
  Eigen::MatrixXd positions() const;
  Eigen::MatrixXd velocities() const;
  /// Of a probe: {position [m], small rotation [rad], velocity [m/s], angular velocity [rad/s]}, world axes:
  /// 12 x directions.
  /// @throws std::out_of_range if there is no such probe.
  Eigen::MatrixXd probe(std::size_t index) const;
  /// Of any smooth function of a simulation: numbers of the function x directions.
  /// @throws std::invalid_argument if the function does not always give the same number of values.
  Eigen::MatrixXd of(const std::function<Eigen::VectorXd(const Simulation&)>& observable) const;
  /// Of outputs of linear models (LinearRequest::outputs): position: and velocity: of joints and points, acceleration:
  /// of points, effort: of driven joints. Without names: positions of all joints and probes. Outputs x directions.
  /// @throws std::invalid_argument if there is no such output.
  Eigen::MatrixXd outputs(const std::vector<std::string>& names = {}) const;
  /// Names of the rows of outputs().
  std::vector<std::string> output_names(const std::vector<std::string>& names = {}) const;
  /// Of the states of linear models about the present: states x directions. The columns of the states at the start are
  /// the transition matrix.
  /// @throws std::runtime_error as linearise() does.
  Eigen::MatrixXd states() const;
  std::vector<std::string> state_names() const;  ///< of the rows of states()

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace flexarm
