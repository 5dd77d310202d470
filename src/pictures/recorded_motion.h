#pragma once
/// Where links and beams are in runs of which only rows of results are left.

#include <optional>
#include <vector>

#include "flexarm/simulation/simulation.h"
#include "pictures/bent_beam.h"
#include "pictures/recorded_columns.h"

namespace flexarm::pictures {

/// Puts a simulation where a row of results has it: links by the columns frame/LINK/*, or else by the positions of
/// joints; nodes of beams by the columns beam/LINK/K/*, or else on a line between the ends of the beam. Its velocities,
/// strains and efforts have no meaning.
class RecordedMotion {
 public:
  /// @param simulation  in its state at the start
  /// @param columns     must outlive this object
  RecordedMotion(const Simulation& simulation, const RecordedColumns& columns);

  bool has_frames() const { return has_frames_; }
  bool has_positions() const { return has_positions_; }
  /// Whether the columns place all links and nodes of beams.
  bool is_exact() const { return is_exact_; }
  bool places_lines() const { return !has_frames_ || has_all_frames_; }
  bool is_flexible(std::size_t link) const { return shown_.is_flexible(link); }
  /// The columns of all nodes of a beam, those of section_columns() for each; empty if some are missing.
  const std::vector<std::size_t>& sections_of(std::size_t link) const { return links_[link].sections; }

  /// Goes to a row, which has this time.
  void show(std::size_t row, double time);
  /// With the joints where the row has them, and all else as at the start.
  const Simulation& moved() const { return moved_; }
  const Simulation& shown() const { return shown_; }
  /// Not a number where the row has none.
  Pose link_pose(std::size_t row, std::size_t link) const;

 private:
  using PosePlaces = RecordedColumns::PosePlaces;
  /// What a link's pose says about a node: its pose in the frame of the link, or in that of the node's section.
  struct Node {
    int index;
    Pose offset;
  };
  struct Link {
    std::optional<PosePlaces> frame, tip;
    std::vector<std::size_t> sections;
    std::vector<Node> nodes;  ///< one of a rigid link; of a beam one for each section
    /// Of a beam: what to know to draw it without columns.
    PictureBeam beam = {};
    /// A link at its end, whose joint tells where the end is; and the coordinates of that joint.
    std::optional<std::size_t> child = {};
    std::vector<std::size_t> coordinates = {};
    bool child_stays = false;  ///< the child's origin is always at the end
  };

  void add_link(std::size_t index);
  void add_beam(std::size_t index, Link& link);
  void find_child(std::size_t index, Link& link) const;
  void move_joints(std::size_t row);
  bool is_at(std::size_t row, std::size_t coordinate) const;
  /// The end of a beam whose root is at `root`.
  std::optional<BeamEnd> end_of(std::size_t row, std::size_t index, const Pose& root) const;
  std::vector<Pose> sections_in_row(std::size_t row, std::size_t index) const;

  const RecordedColumns& columns_;
  Simulation moved_, shown_;
  std::vector<Link> links_;
  std::vector<std::optional<std::size_t>> positions_;  ///< of joint coordinates
  bool has_frames_ = false, has_all_frames_ = true, has_positions_ = false, is_exact_ = true;
};

}  // namespace flexarm::pictures
