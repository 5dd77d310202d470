#pragma once
/// The undeformed centreline of a flexible link: lines and arcs with section frames, by arc length.

#include <optional>
#include <stdexcept>
#include <vector>

#include "flexarm/math/pose.h"
#include "flexarm/scene/scene_description.h"

namespace flexarm {

/// A curve of lines and arcs in the link frame, s in [0, length()]. The section frame has x along the tangent. Along an
/// arc it turns with the tangent, and `twist` turns it about the tangent. At a kink it turns by the smallest rotation
/// that maps one tangent onto the next.
class Centreline {
 public:
  /// @throws std::invalid_argument for degenerate pieces (no length, centre not equidistant, reversal at a kink).
  Centreline(const std::vector<scene::CentrelinePiece>& pieces, const std::optional<Vector3>& section_y);

  double length() const { return pieces_.back().end; }
  /// Section pose in the link frame. At a border of pieces it is that of the earlier piece if `before`, else of the
  /// later one.
  Pose at(double s, bool before = true) const;
  /// Arc lengths of the ends of all pieces (the last is length()).
  std::vector<double> piece_ends() const;
  /// Whether the tangent jumps at s (a piece border).
  bool is_kink(double s) const;
  /// Whether the line ends where it begins, within 1e-6 of its length.
  bool is_closed() const;
  /// Arc length of the point of the line nearest to `point` (link frame).
  double nearest(const Vector3& point) const;
  /// Total turning of tangent and section between two arc lengths, kinks excluded [rad].
  double turning(double from, double to) const;

 private:
  struct Piece {
    double begin = 0, end = 0;        // arc length
    Vector3 start, tangent;           // where it begins
    Vector3 axis = Vector3::UnitZ();  // of the arc
    double curvature = 0;             // 0: line
    double twist_rate = 0;            // [rad/m]
    Quaternion frame;                 // of the section, where it begins
    Vector3 point(double s) const;
    Pose pose(double s) const;
  };
  const Piece& piece_at(double s, bool before) const;
  std::vector<Piece> pieces_;
};

}  // namespace flexarm
