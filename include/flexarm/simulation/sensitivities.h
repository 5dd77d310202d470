#pragma once
/// How a run changes with its parameters and with its start, found beside it. (docs/notes/sensitivities.md)

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "flexarm/model/run_event.h"
#include "flexarm/scene/urdf_reader.h"
#include "flexarm/simulation/simulation.h"

namespace flexarm {

/// By what a run is differentiated.
struct SensitivityRequest {
  /// Names of <parameter>s of the scene.
  std::vector<std::string> parameters;
  /// Reads the scene once more, in all else as that of the simulation, with another value of one parameter. Needed
  /// where there are parameters.
  std::function<scene::ReadResult(const std::string& parameter, double value)> read;
  /// The states of linear models about the start (LinearModel::states): joint positions, displacements of beams' nodes,
  /// then their rates.
  bool initial_state = false;
};

/// Derivatives of the run of a simulation, per unit of parameters and of states at the start. Directions are the
/// columns of all matrices: parameters in the order asked for, then states.
///
/// They are those of the steps as they are taken, to about 1e-6 of the largest, but at stops and dry friction: there
/// they are those of the motion, whose events lie within steps. The simulation goes on with the same bits as without
/// them. Iterative interpolation has none.
class Sensitivities {
 public:
  /// Of a simulation at its start, which must outlive this and stay where it is: copies go without.
  /// @throws std::invalid_argument if a parameter is unknown, or changes what no derivative tells (numbers of elements,
  /// joints, the step); if the simulation has moved already. ModelError if its scheme has none; std::runtime_error for
  /// initial states at a dead point.
  Sensitivities(Simulation& simulation, const SensitivityRequest& request);
  ~Sensitivities();
  Sensitivities(Sensitivities&&) noexcept;
  Sensitivities& operator=(Sensitivities&&) noexcept;

  /// Simulation::step() of the simulation, with all derivatives.
  /// @throws std::logic_error if somebody else has stepped, reset or restored the simulation since the last one.
  StepResult step();

  /// Names: those of parameters, then states.
  const std::vector<std::string>& directions() const;
  /// Why there are no derivatives any more, matrices being NaN; empty: there are. A step has failed, or was done by
  /// another scheme; a slider has left its line; stops and friction change more often in a step than can be followed.
  const std::string& lost() const;
  /// What the run has come over: stops that were touched or left, dry friction that sticks or slips. Derivatives have
  /// the time of each event as it changes, but for those with a doubt: behind one of these they are not to be trusted.
  const std::vector<RunEvent>& events() const;

  /// Of joint positions [rad or m] and Simulation::velocity() [rad/s or m/s]: coordinates x directions.
  Eigen::MatrixXd positions() const;
  Eigen::MatrixXd velocities() const;
  /// Of a probe: {position [m], small rotation [rad], velocity [m/s], angular velocity [rad/s]}, world axes:
  /// 12 x directions.
  /// @throws std::out_of_range if there is no such probe.
  Eigen::MatrixXd probe(std::size_t index) const;
  /// Of any smooth function of a simulation: its numbers x directions.
  /// @throws std::invalid_argument if it has not always as many numbers.
  Eigen::MatrixXd of(const std::function<Eigen::VectorXd(const Simulation&)>& observable) const;
  /// Of outputs of linear models (LinearRequest::outputs): position: and velocity: of joints and points, acceleration:
  /// of points, effort: of driven joints; none: positions of all joints and probes. Outputs x directions.
  /// @throws std::invalid_argument if there is no such output.
  Eigen::MatrixXd outputs(const std::vector<std::string>& names = {}) const;
  /// Names of the rows then.
  std::vector<std::string> output_names(const std::vector<std::string>& names = {}) const;
  /// Of the states of linear models about now: states x directions; those by states of the start are the transition
  /// matrix.
  /// @throws std::runtime_error as linearise() does.
  Eigen::MatrixXd states() const;
  std::vector<std::string> state_names() const;  ///< of the rows then

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace flexarm
