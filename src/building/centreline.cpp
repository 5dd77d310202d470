#include "building/centreline.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flexarm {
namespace {

constexpr double kKinkAngle = 1e-9;   // rad; a smaller angle between tangents is no kink
constexpr double kLargestGap = 1e-6;  // relative to the length; a line with a smaller gap is closed

/// The rotation that maps the direction of `from` onto that of `to`, which must not be opposite. (Eigen's
/// FromTwoVectors also covers opposite directions, by a singular value decomposition, which takes long to compile.)
Quaternion smallest_rotation(const Vector3& from, const Vector3& to) {
  const Vector3 a = from.normalized(), b = to.normalized();
  const double twice_half_cosine = std::sqrt((1 + b.dot(a)) * 2);
  Quaternion rotation;
  rotation.vec() = a.cross(b) * (1 / twice_half_cosine);
  rotation.w() = 0.5 * twice_half_cosine;
  return rotation;
}

Quaternion first_frame(const Vector3& tangent, const std::optional<Vector3>& section_y) {
  Vector3 y;
  if (section_y) {
    y = *section_y - section_y->dot(tangent) * tangent;
    if (y.norm() < 1e-9 * section_y->norm())
      throw std::invalid_argument("section y axis is parallel to the centreline");
  } else {
    // The link's y axis, or z if the line runs along y. For a beam along x this gives the link frame itself.
    const Vector3 guess = std::abs(tangent.y()) < 0.9 ? Vector3::UnitY() : Vector3::UnitZ();
    y = guess - guess.dot(tangent) * tangent;
  }
  y.normalize();
  Matrix3 frame;
  frame << tangent, y, tangent.cross(y);
  return Quaternion(frame).normalized();
}

}  // namespace

Vector3 Centreline::Piece::point(double s) const {
  const double x = s - begin;
  if (curvature == 0) return start + x * tangent;
  const double angle = x * curvature;
  const Vector3 normal = axis.cross(tangent);
  return start + (std::sin(angle) * tangent + 2 * std::pow(std::sin(angle / 2), 2) * normal) / curvature;
}

Pose Centreline::Piece::pose(double s) const {
  const double x = s - begin;
  const Quaternion turn(Eigen::AngleAxisd(curvature * x, axis));
  const Quaternion twist(Eigen::AngleAxisd(twist_rate * x, Vector3::UnitX()));
  return {point(s), (turn * frame * twist).normalized()};
}

Centreline::Centreline(const std::vector<scene::CentrelinePiece>& pieces, const std::optional<Vector3>& section_y) {
  if (pieces.empty()) throw std::invalid_argument("centreline has no piece");
  Vector3 start = Vector3::Zero();
  for (const scene::CentrelinePiece& description : pieces) {
    Piece piece;
    piece.start = start;
    const Vector3 chord = description.to - start;
    if (!(chord.norm() > 0)) throw std::invalid_argument("centreline piece has no length");
    double length = chord.norm();
    if (description.kind == scene::CentrelinePiece::Kind::Line) {
      piece.tangent = chord / length;
    } else {
      const Vector3 from_center = start - description.center, to_center = description.to - description.center;
      const Vector3 normal = from_center.cross(to_center);
      const double radius = 0.5 * (from_center.norm() + to_center.norm());
      if (std::abs(from_center.norm() - to_center.norm()) > 1e-6 * radius || normal.norm() < 1e-9 * radius * radius)
        throw std::invalid_argument("arc centre must be equidistant from both ends and not on their line");
      piece.axis = normal.normalized();
      piece.tangent = piece.axis.cross(from_center).normalized();
      piece.curvature = 1 / radius;
      length = radius * std::atan2(normal.norm(), from_center.dot(to_center));
    }
    if (pieces_.empty()) {
      piece.frame = first_frame(piece.tangent, section_y);
    } else {
      const Pose before = pieces_.back().pose(pieces_.back().end);
      const Vector3 tangent_before = before.orientation * Vector3::UnitX();
      if (tangent_before.dot(piece.tangent) < -1 + 1e-9)
        throw std::invalid_argument("centreline reverses its direction");
      piece.frame = smallest_rotation(tangent_before, piece.tangent) * before.orientation;
      piece.begin = pieces_.back().end;
    }
    piece.end = piece.begin + length;
    piece.twist_rate = description.twist / length;
    pieces_.push_back(piece);
    start = description.to;
  }
}

const Centreline::Piece& Centreline::piece_at(double s, bool before) const {
  const auto ends_too_early = [&](const Piece& piece, double at) { return before ? piece.end < at : piece.end <= at; };
  const auto piece = std::lower_bound(pieces_.begin(), pieces_.end(), s, ends_too_early);
  return piece == pieces_.end() ? pieces_.back() : *piece;
}

Pose Centreline::at(double s, bool before) const {
  return piece_at(s, before).pose(s);
}

std::vector<double> Centreline::piece_ends() const {
  std::vector<double> ends;
  for (const Piece& piece : pieces_) ends.push_back(piece.end);
  return ends;
}

bool Centreline::is_kink(double s) const {
  const Vector3 before = at(s, true).orientation * Vector3::UnitX(),
                after = at(s, false).orientation * Vector3::UnitX();
  return before.cross(after).norm() > kKinkAngle;
}

bool Centreline::is_closed() const {
  return (at(length()).position - at(0).position).norm() <= kLargestGap * length();
}

double Centreline::nearest(const Vector3& point) const {
  double best = 0, best_distance = std::numeric_limits<double>::infinity();
  for (const Piece& piece : pieces_) {
    double x;
    if (piece.curvature == 0) {
      x = (point - piece.start).dot(piece.tangent);
    } else {
      const Vector3 normal = piece.axis.cross(piece.tangent), center = piece.start + normal / piece.curvature;
      const Vector3 d = point - center;
      x = std::atan2(d.dot(piece.tangent), -d.dot(normal)) / piece.curvature;
    }
    const double ends[] = {piece.begin + std::clamp(x, 0.0, piece.end - piece.begin), piece.begin, piece.end};
    for (const double s : ends) {
      const double distance = (piece.point(s) - point).norm();
      if (distance < best_distance - 1e-12 * length()) best = s, best_distance = distance;
    }
  }
  return best;
}

double Centreline::turning(double from, double to) const {
  double angle = 0;
  for (const Piece& piece : pieces_) {
    const double overlap = std::min(to, piece.end) - std::max(from, piece.begin);
    if (overlap > 0) angle += overlap * std::hypot(piece.curvature, piece.twist_rate);
  }
  return angle;
}

}  // namespace flexarm
