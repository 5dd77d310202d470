#pragma once
/// A simulation as markers for rviz.

#include <ros/time.h>
#include <visualization_msgs/MarkerArray.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "flexarm/simulation/simulation.h"
#include "messages/arrows.h"
#include "messages/scene_extent.h"
#include "messages/skin.h"
#include "messages/trails.h"

namespace flexarm::messages {

/// What is drawn.
struct MarkerChoice {
  bool beams = true;           ///< deformed, by their <visual> or as tubes; each in a namespace of its link's name
  bool trails = true;          ///< of probes
  bool efforts = true;         ///< of joint coordinates
  bool wrenches = true;        ///< loads of the scene, and what is applied from outside
  bool reactions = true;       ///< of joints, where a sensor of kind wrench or reaction asks for them
  bool contacts = true;        ///< forces of what is touched, on the first of each pair
  bool text = true;            ///< time, real-time factor, energies, and why nothing moves
  bool legend = true;          ///< of colours and arrows
  double trail_duration = 10;  ///< simulated [s]

  /// The member that has that name, one of names(); null: none has.
  bool* find(const std::string& name);
  static const std::vector<std::string>& names();
};

/// Markers in the root frame, sized by the scene. Beams are coloured from blue (unloaded) over green to red by the
/// strain at the edge of the section. One scale serves all links, and one all arrows: red, and the longest arrow, are
/// the largest that were shown since the start or the last reset.
class MarkerMessages {
 public:
  using Warn = std::function<void(const std::string&)>;
  /// The simulation must outlive this. @param warn  is told of each <visual> that cannot be drawn, once
  MarkerMessages(const Simulation& simulation, const std::string& root_frame, const MarkerChoice& choice,
                 const Warn& warn);

  /// @param real_time_factor  for the text, where it is known
  /// @param state             why nothing moves ("PAUSED", "FAILED: ..."), above the scene; empty: it runs
  visualization_msgs::MarkerArray make(const ros::Time& stamp, std::optional<double> real_time_factor,
                                       const std::string& state = {});
  /// After a reset: scales and trails begin anew.
  void begin_anew();
  /// Nobody looks: trails begin anew when somebody does.
  void forget_trails() { trails_.forget(); }

 private:
  struct Beam {
    std::size_t link;
    std::vector<Skin> skins;
    std::vector<BeamPoint> points;        ///< scratch
    std::vector<Skin::Section> sections;  ///< scratch
  };

  void add_beams(const std_msgs::Header& header, visualization_msgs::MarkerArray& message);
  void add_all_arrows(const std_msgs::Header& header, visualization_msgs::MarkerArray& message);
  void add_text(const std_msgs::Header& header, std::optional<double> real_time_factor,
                visualization_msgs::MarkerArray& message) const;
  void add_state(const std_msgs::Header& header, const std::string& state,
                 visualization_msgs::MarkerArray& message) const;
  /// What was shown once and is not any more has to go.
  void delete_others(const std_msgs::Header& header, visualization_msgs::MarkerArray& message);

  const Simulation& simulation_;
  std::string root_frame_;
  MarkerChoice choice_;
  SceneExtent extent_;  ///< of the initial configuration
  double energy_;       ///< of the initial state, less the work that it took, plus what was dissipated [J]
  std::vector<Beam> beams_;
  Trails trails_;
  double largest_strain_ = 0;
  ArrowScale arrow_scale_;
  std::vector<ActingWrench> efforts_, wrenches_, reactions_, pushes_;  ///< scratch
  std::vector<ActingContact> contacts_;                                ///< scratch
  std::set<std::pair<std::string, int>> shown_;                        ///< names and ids
};

}  // namespace flexarm::messages
