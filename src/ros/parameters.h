#pragma once
/// Reads the node's parameters from the parameter server.

#include <ros/node_handle.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "flexarm/scene/scene_description.h"
#include "messages/marker_messages.h"

namespace flexarm::node {

/// Parameters or a scene that cannot be used; what() lists all errors.
class ParameterError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Parameters {
  double real_time_factor = 1;  ///< simulated time per wall time; 0: as fast as possible
  double max_catch_up = 0.1;    ///< largest backlog that is made up; beyond it steps are dropped, wall time [s]
  bool paused = false;          ///< at the start
  double publish_rate = 100;    ///< of joint_states, /tf, beam_states, ~contacts [Hz]
  double marker_rate = 25;      ///< of beam_markers [Hz]
  messages::MarkerChoice markers;
  double status_rate = 10;   ///< of ~status [Hz]
  bool interactive = false;  ///< handles in rviz that pull on links
  // Of the handles' springs and dampers; 0: chosen by the mass of the scene.
  double pull_stiffness = 0;  ///< [N/m]
  double pull_damping = 0;    ///< [N s/m]
  bool publish_clock = false;
  double clock_rate = 100;   ///< [Hz]
  std::string frame_prefix;  ///< put before all names of frames: empty, or ends with a slash
  bool realtime = false;   ///< SCHED_FIFO and locked memory; a step that takes too long is cut short, and does not fail
  bool lock_step = false;  ///< each step waits for its command
  double recovery_wall_time = 2;  ///< a step that was halved is given up after this wall time [s]; 0: never
  double command_timeout =
      0;  ///< this long after a command, efforts and set points (but not positions) return to zero [s]; 0: never
  double error_window = 0;                ///< interval over which the error of steps is estimated [s]; 0: no estimate
  bool web = false;                       ///< shows the simulation on a web page
  std::string web_address = "127.0.0.1";  ///< IP address at which the page is served
  int web_port = 8090;                    ///< 0: any free one
  double web_rate = 30;                   ///< of the page's instants, by the wall clock [Hz]
  double stop_duration = 0;               ///< in which joints decelerate whose trajectory is cancelled [s]; 0: at once
};

/// Reads the private parameters.
/// @throws ParameterError that names each parameter of the wrong type or out of range
Parameters read_parameters(const ros::NodeHandle& private_node);

/// Logs a warning of parameters directly below the node's name that it does not know: misspelt ones have no effect.
/// @param more  names that only this node knows
void warn_of_unknown_parameters(const ros::NodeHandle& private_node, const std::vector<std::string>& more = {});

/// Reads the scene from the file `~scene` or, if that is empty, from the text in `robot_description` (searched upwards
/// from `node`). `~parameters` and `~xacro_args` give values of its parameters and arguments for xacro. Logs the
/// scene's warnings. The private parameters scheme, step, tolerance, max_iterations, max_halvings and rho_infinity
/// override the scene's <integrator>.
/// @throws ParameterError that lists all errors of the scene or of the parameters
scene::SceneDescription read_scene(const ros::NodeHandle& node, const ros::NodeHandle& private_node);

}  // namespace flexarm::node
