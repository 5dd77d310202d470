#pragma once
/// Formulas of straight pieces of lines between circles and points (internal to tendon_piece.cpp and
/// tendon_change.cpp). Templates are on the number type: double, or Dual for derivatives. (docs/notes/lines.md 1)

#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Core>
#include <unsupported/Eigen/AutoDiff>

#include "elements/tendon_piece.h"
#include "math/pi.h"
#include "math/so3.h"

namespace flexarm::tendon {

/// A number with its derivatives by {displacement, spin} of both nodes.
using Dual = Eigen::AutoDiffScalar<Vector12>;

inline double value_of(double x) {
  return x;
}
inline double value_of(const Dual& x) {
  return x.value();
}

template <class S>
GuideFrame<double> values_of(const GuideFrame<S>& frame) {
  const auto of = [](const Eigen::Matrix<S, 3, 1>& v) {
    return Vector3(value_of(v[0]), value_of(v[1]), value_of(v[2]));
  };
  return {of(frame.centre), of(frame.arm), of(frame.first), of(frame.second), of(frame.normal)};
}

using so3::cross;
using so3::dot;

inline GuideFrame<double> frame_of(const GuidePlace& guide, const NodePose& node) {
  const Vector3 arm = node.rotation * guide.centre;
  const Vector3 first = node.rotation * guide.first, second = node.rotation * guide.second;
  return {node.position + arm, arm, first, second, first.cross(second)};
}

/// The frame with its derivatives; `column`: of the node's displacement.
inline GuideFrame<Dual> moving(const GuideFrame<double>& frame, const GuidePlace& guide, int column) {
  GuideFrame<Dual> out;
  const auto seed = [&](const Vector3& v, bool moves, GuideFrame<Dual>::V& result) {
    const Matrix3 turn = -so3::hat(v);
    for (int i = 0; i < 3; ++i) {
      result[i] = Dual(v[i], Vector12::Zero());
      if (guide.node < 0) continue;
      result[i].derivatives().segment<3>(column + 3) = turn.row(i).transpose();
      if (moves) result[i].derivatives()[column + i] = 1;
    }
  };
  seed(frame.arm, false, out.arm);
  out.centre = out.arm;
  for (int i = 0; i < 3; ++i) {
    out.centre[i].value() = frame.centre[i];
    if (guide.node >= 0) out.centre[i].derivatives()[column + i] += 1;
  }
  seed(frame.first, false, out.first);
  seed(frame.second, false, out.second);
  seed(frame.normal, false, out.normal);
  return out;
}

template <class S>
GuideFrame<S> mixed(const GuideFrame<double>& begin, const GuideFrame<S>& end, double weight) {
  const auto mix = [&](const Vector3& a, const typename GuideFrame<S>::V& b) {
    typename GuideFrame<S>::V out;
    for (int i = 0; i < 3; ++i) out[i] = (1 - weight) * a[i] + weight * b[i];
    return out;
  };
  return {mix(begin.centre, end.centre), mix(begin.arm, end.arm), mix(begin.first, end.first),
          mix(begin.second, end.second), mix(begin.normal, end.normal)};
}

/// The place where a line meets a circle: the unit vector from the centre, and its derivative by the angle.
template <class S>
struct Rim {
  S cos{1}, sin{0};
  Eigen::Matrix<S, 3, 1> out, along;

  Rim() = default;  ///< of a point, whose vectors are not used
  Rim(const GuideFrame<S>& frame, const S& angle) {
    using std::cos, std::sin;
    this->cos = cos(angle), this->sin = sin(angle);
    for (int i = 0; i < 3; ++i) {
      out[i] = this->cos * frame.first[i] + this->sin * frame.second[i];
      along[i] = this->cos * frame.second[i] - this->sin * frame.first[i];
    }
  }
};

/// A piece whose ends are given by angles. `open`: projections of the chord on the radii, which are zero at the tangent
/// points; `slopes`: their derivatives by both angles.
template <class S>
struct Chord {
  S begin, end;  // angles
  Rim<S> first, second;
  Eigen::Matrix<S, 3, 1> way;
  std::array<S, 2> open{S(0), S(0)};
  std::array<std::array<S, 2>, 2> slopes{{{S(1), S(0)}, {S(0), S(1)}}};

  Chord(const GuidePlace& a, const GuidePlace& b, const GuideFrame<S>& from, const GuideFrame<S>& to,
        const S& begin_angle, const S& end_angle)
      : begin(begin_angle), end(end_angle) {
    if (a.is_circle()) first = Rim<S>(from, begin);
    if (b.is_circle()) second = Rim<S>(to, end);
    for (int i = 0; i < 3; ++i) {
      way[i] = to.centre[i] - from.centre[i];
      if (a.is_circle()) way[i] -= a.radius * first.out[i];
      if (b.is_circle()) way[i] += b.radius * second.out[i];
    }
    if (a.is_circle()) {
      open[0] = dot(way, first.out);
      slopes[0][0] = dot(way, first.along) - a.radius * dot(first.along, first.out);
    }
    if (b.is_circle()) {
      open[1] = dot(way, second.out);
      slopes[1][1] = dot(way, second.along) + b.radius * dot(second.along, second.out);
    }
    if (a.is_circle() && b.is_circle()) {
      slopes[0][1] = b.radius * dot(second.along, first.out);
      slopes[1][0] = -a.radius * dot(first.along, second.out);
    }
  }
  S determinant() const { return slopes[0][0] * slopes[1][1] - slopes[0][1] * slopes[1][0]; }
};

struct Angles {
  double begin = 0, end = 0;
};

/// Angle of the point at which a line from or to `point` is tangent to a circle. NaN if the point is inside.
inline double tangent_angle(const GuidePlace& guide, const GuideFrame<double>& frame, const Vector3& point,
                            bool leaves) {
  const Vector3 way = point - frame.centre;
  const double x = way.dot(frame.first), y = way.dot(frame.second);
  return std::atan2(y, x) + (leaves ? -1 : 1) * guide.sense * std::acos(guide.radius / std::hypot(x, y));
}

/// The angles of the tangent points, in turns as from points to circles; exact if one guide is a point.
inline Angles rough_tangents(const GuidePlace& a, const GuidePlace& b, const GuideFrame<double>& from,
                             const GuideFrame<double>& to) {
  Angles out;
  const auto rim = [](const GuidePlace& guide, const GuideFrame<double>& frame, double angle) {
    return Vector3(frame.centre + guide.radius * Rim<double>(frame, angle).out);
  };
  Vector3 other = to.centre;
  for (int turn = 0; turn < (a.is_circle() && b.is_circle() ? 8 : 1); ++turn) {
    if (a.is_circle()) out.begin = tangent_angle(a, from, other, true);
    if (b.is_circle()) {
      out.end = tangent_angle(b, to, a.is_circle() ? rim(a, from, out.begin) : from.centre, false);
      other = rim(b, to, out.end);
    }
  }
  return out;
}

/// The angles after a step of Newton's method towards the tangent points.
template <class S>
std::array<S, 2> newton_step(const Chord<S>& chord) {
  const double s00 = value_of(chord.slopes[0][0]), s01 = value_of(chord.slopes[0][1]);
  const double s10 = value_of(chord.slopes[1][0]), s11 = value_of(chord.slopes[1][1]);
  const double determinant = s00 * s11 - s01 * s10;
  return {S(chord.begin - (chord.open[0] * s11 - chord.open[1] * s01) / determinant),
          S(chord.end - (chord.open[1] * s00 - chord.open[0] * s10) / determinant)};
}

/// The chord between the tangent points at `solution`, with its derivatives.
inline Chord<Dual> with_derivatives(const GuidePlace& a, const GuidePlace& b, const GuideFrame<Dual>& from,
                                    const GuideFrame<Dual>& to, const Angles& solution) {
  const auto [begin, end] = newton_step(Chord<Dual>(a, b, from, to, Dual(solution.begin), Dual(solution.end)));
  return {a, b, from, to, begin, end};
}

/// The chord between the tangent points by Newton's method. NaN if it does not converge, or to points where the line
/// would run the other way round a circle.
inline Chord<double> tangents_near(const GuidePlace& a, const GuidePlace& b, const GuideFrame<double>& from,
                                   const GuideFrame<double>& to, const Angles& guess) {
  Chord<double> chord(a, b, from, to, guess.begin, guess.end);
  if (!a.is_circle() && !b.is_circle()) return chord;
  for (int iteration = 0; iteration < 10; ++iteration) {
    const auto [begin, end] = newton_step(chord);
    const double size = std::abs(begin - chord.begin) + std::abs(end - chord.end);
    chord = Chord<double>(a, b, from, to, begin, end);
    if (size < 1e-7) {  // the next correction is below round-off
      const bool is_turned = (a.is_circle() && a.sense * dot(chord.way, chord.first.along) < 0) ||
                             (b.is_circle() && b.sense * dot(chord.way, chord.second.along) < 0);
      if (!is_turned) return chord;
      break;
    }
    if (!(size < kPi)) break;
  }
  const double none = std::numeric_limits<double>::quiet_NaN();
  chord.begin = chord.end = none;
  chord.way.setConstant(none);
  return chord;
}

/// The length of a piece. A piece of length zero has no direction; so a length is never smaller than kShortest, and all
/// lengths are larger by the square of that over their double, which is round-off.
constexpr double kShortest = 1e-8;  // [m]
template <class S>
S length_of(const Eigen::Matrix<S, 3, 1>& way) {
  using std::sqrt;
  return sqrt(dot(way, way) + kShortest * kShortest);
}

/// The derivatives of a functional by the vectors of both guides.
template <class S>
struct VectorGradient {
  using V = Eigen::Matrix<S, 3, 1>;
  V by_way;                     // centre of the second guide; minus that by the centre of the first
  V by_first[2], by_second[2];  // axes of the first guide, and of the second one

  /// The functional's change if the vectors change, to first order.
  S change(const GuideFrame<double>& begin_a, const GuideFrame<S>& end_a, const GuideFrame<double>& begin_b,
           const GuideFrame<S>& end_b) const {
    const auto minus = [](const V& end, const Vector3& begin) {
      V out;
      for (int i = 0; i < 3; ++i) out[i] = end[i] - begin[i];
      return out;
    };
    return dot(by_way, V(minus(end_b.centre, begin_b.centre) - minus(end_a.centre, begin_a.centre))) +
           dot(by_first[0], minus(end_a.first, begin_a.first)) + dot(by_first[1], minus(end_a.second, begin_a.second)) +
           dot(by_second[0], minus(end_b.first, begin_b.first)) +
           dot(by_second[1], minus(end_b.second, begin_b.second));
  }
  /// {force, moment} on both nodes.
  Eigen::Matrix<S, 12, 1> on_nodes(const GuideFrame<S>& a, const GuideFrame<S>& b) const {
    Eigen::Matrix<S, 12, 1> out;
    const V opposite = -by_way;
    out << opposite, V(cross(a.arm, opposite) + cross(a.first, by_first[0]) + cross(a.second, by_first[1])), by_way,
        V(cross(b.arm, by_way) + cross(b.first, by_second[0]) + cross(b.second, by_second[1]));
    return out;
  }
};

template <class S>
VectorGradient<S> vector_gradient(const GuidePlace& a, const GuidePlace& b, const PieceWeights& weights,
                                  const Chord<S>& chord) {
  using V = Eigen::Matrix<S, 3, 1>;
  const S length = length_of(chord.way);
  const V unit = chord.way / length;
  // Multipliers of the conditions of tangency: they carry what the angles contribute.
  S by_begin(0), by_end(0);
  if (a.is_circle()) by_begin = weights.begin - weights.straight * a.radius * dot(unit, chord.first.along);
  if (b.is_circle()) by_end = weights.end + weights.straight * b.radius * dot(unit, chord.second.along);
  const S determinant = chord.determinant();
  const S first = (by_begin * chord.slopes[1][1] - by_end * chord.slopes[1][0]) / determinant;
  const S second = (by_end * chord.slopes[0][0] - by_begin * chord.slopes[0][1]) / determinant;
  VectorGradient<S> out;
  out.by_way = weights.straight * unit;
  if (a.is_circle()) out.by_way -= first * chord.first.out;
  if (b.is_circle()) out.by_way -= second * chord.second.out;
  const V on_first = -a.radius * out.by_way - first * chord.way;
  const V on_second = b.radius * out.by_way - second * chord.way;
  const S zero(0);
  out.by_first[0] = (a.is_circle() ? chord.first.cos : zero) * on_first;
  out.by_first[1] = (a.is_circle() ? chord.first.sin : zero) * on_first;
  out.by_second[0] = (b.is_circle() ? chord.second.cos : zero) * on_second;
  out.by_second[1] = (b.is_circle() ? chord.second.sin : zero) * on_second;
  return out;
}

/// The functional of a chord between tangent points.
template <class S>
S functional(const GuidePlace& a, const GuidePlace& b, const PieceWeights& weights, const Chord<S>& chord) {
  S out = weights.straight * length_of(chord.way);
  if (a.is_circle()) out += weights.begin * chord.begin;
  if (b.is_circle()) out += weights.end * chord.end;
  return out;
}

}  // namespace flexarm::tendon
