#pragma once
/// What the node reads from the parameter server.

#include <ros/node_handle.h>

#include <stdexcept>
#include <string>

#include "flexarm/scene/scene_description.h"
#include "messages/marker_messages.h"

namespace flexarm::node {

/// Parameters or a scene that cannot be used; what() lists every finding.
class ParameterError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Parameters {
  double real_time_factor = 1;  ///< simulated per wall time; 0: as fast as possible
  double max_catch_up = 0.1;    ///< backlog that is made up before steps are dropped, wall time [s]
  bool paused = false;          ///< at the start
  double publish_rate = 100;    ///< joint_states, /tf, beam_states, ~contacts [Hz]
  double marker_rate = 25;      ///< beam_markers [Hz]
  messages::MarkerChoice markers;
  double status_rate = 10;   ///< ~status [Hz]
  bool interactive = false;  ///< handles in rviz that pull on links
  // Of these; 0: by the scene's mass.
  double pull_stiffness = 0;  ///< [N/m]
  double pull_damping = 0;    ///< [N s/m]
  bool publish_clock = false;
  double clock_rate = 100;        ///< [Hz]
  std::string frame_prefix;       ///< of all names of frames: empty, or with a slash at its end
  bool realtime = false;          ///< SCHED_FIFO and locked memory; a step that takes too long is cut, not failed
  bool lock_step = false;         ///< each step waits for its command
  double recovery_wall_time = 2;  ///< a step that has been halved is given up after so much wall time [s]; 0: never
  double command_timeout =
      0;  ///< efforts, and set points but positions, return to zero so long after a command [s]; 0: never
  double error_window = 0;   ///< over which the error of steps is estimated [s]; 0: it is not
  double stop_duration = 0;  ///< in which joints decelerate whose trajectory is cancelled [s]; 0: at once
};

/// Reads the private parameters.
/// @throws ParameterError naming every parameter of the wrong type or out of range.
Parameters read_parameters(const ros::NodeHandle& private_node);

/// Reads the scene from the file `~scene`, or else from the text in `robot_description` (searched upwards from `node`),
/// with the values of its parameters that the dictionary `~parameters` has, and `~xacro_args`, logs its warnings, and
/// lets the private parameters scheme, step, tolerance, max_iterations, max_halvings and rho_infinity override its
/// <integrator>.
/// @throws ParameterError with every error of the scene or of the parameters.
scene::SceneDescription read_scene(const ros::NodeHandle& node, const ros::NodeHandle& private_node);

}  // namespace flexarm::node
