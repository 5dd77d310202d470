#pragma once
/// Makes markers for rviz that show a simulation.

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
#include "messages/bare_link_markers.h"
#include "messages/cylinder_markers.h"
#include "messages/skin.h"
#include "messages/trails.h"
#include "pictures/floors.h"
#include "pictures/scene_extent.h"

namespace flexarm::messages {

/// Which markers are made.
struct MarkerChoice {
  bool beams = true;      ///< deformed links, by their <visual> or as tubes, and barrels and rods of cylinders; the
                          ///< namespace is the link's name
  bool trails = true;     ///< of probes
  bool efforts = true;    ///< of joint coordinates
  bool wrenches = true;   ///< loads of the scene, and wrenches applied from outside
  bool reactions = true;  ///< of joints that have a sensor of kind `wrench` or `reaction`
  bool contacts = true;   ///< contact forces, on the first body of each pair
  bool lines = true;      ///< springs between points, and tendons
  bool masses = true;     ///< of links that have neither a <visual> nor a beam
  bool grounds = true;    ///< as large as the scene, not without end
  bool text = true;       ///< time, real-time factor, energies, and the reason if the simulation stands still
  bool legend = true;     ///< of colours and arrows
  double trail_duration = 10;  ///< simulated [s]

  /// The member with that name, which is one of names(); null if there is none.
  bool* find(const std::string& name);
  static const std::vector<std::string>& names();
};

/// Markers in the root frame; their sizes follow from the size of the scene. Beams are coloured by the strain at the
/// edge of the section, from violet (no strain) over green to yellow. All links share one scale, and so do all arrows:
/// yellow and the longest arrow stand for the largest values shown since the start or the last reset.
class MarkerMessages {
 public:
  using Warn = std::function<void(const std::string&)>;
  /// The simulation must outlive this object. @param warn  called once for each <visual> that cannot be drawn
  MarkerMessages(const Simulation& simulation, const std::string& root_frame, const MarkerChoice& choice,
                 const Warn& warn);

  /// @param real_time_factor  for the text, if it is known
  /// @param state             why the simulation stands still ("PAUSED", "FAILED: ..."), shown above the scene; empty:
  ///                          it runs
  visualization_msgs::MarkerArray make(const ros::Time& stamp, std::optional<double> real_time_factor,
                                       const std::string& state = {});
  /// To be called after a reset: scales are chosen again, and trails start empty.
  void begin_anew();
  /// To be called while nobody subscribes: trails start empty with the next subscriber.
  void forget_trails() { trails_.forget(); }

 private:
  struct Beam {
    std::size_t link;
    std::vector<Skin> skins;
    std::vector<BeamPoint> points;        ///< scratch
    std::vector<Skin::Section> sections;  ///< scratch
  };

  void add_beams(const std_msgs::Header& header, visualization_msgs::MarkerArray& message);
  void add_lines(const std_msgs::Header& header, visualization_msgs::MarkerArray& message);
  void add_all_arrows(const std_msgs::Header& header, visualization_msgs::MarkerArray& message);
  void add_text(const std_msgs::Header& header, std::optional<double> real_time_factor,
                visualization_msgs::MarkerArray& message) const;
  void add_state(const std_msgs::Header& header, const std::string& state,
                 visualization_msgs::MarkerArray& message) const;
  /// Adds deletions of markers that were shown before and do not exist any more.
  void delete_others(const std_msgs::Header& header, visualization_msgs::MarkerArray& message);

  const Simulation& simulation_;
  std::string root_frame_;
  MarkerChoice choice_;
  pictures::SceneExtent extent_;  ///< of the initial configuration
  double energy_;                 ///< balance of energy in the initial state: energy - work + dissipated [J]
  std::vector<Beam> beams_;
  CylinderMarkers cylinders_;
  BareLinkMarkers bare_links_;
  std::vector<pictures::Floor> floors_;
  Trails trails_;
  std::vector<Vector3> line_points_;  ///< scratch
  double largest_strain_ = 0;
  ArrowScale arrow_scale_;
  std::vector<ActingWrench> efforts_, wrenches_, reactions_, pushes_;  ///< scratch
  std::set<std::pair<std::string, int>> shown_;                        ///< namespaces and ids of the markers in rviz
};

}  // namespace flexarm::messages
