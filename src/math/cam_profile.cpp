#include "flexarm/math/cam_profile.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include <fmt/format.h>
#include <Eigen/SparseLU>

namespace flexarm {
namespace {

constexpr double kTurn = 6.283185307179586;

/// Returns sin(x)/x.
double sinc(double x) {
  return std::abs(x) < 1e-4 ? 1 - x * x / 6 : std::sin(x) / x;
}

/// Returns the second derivatives, at the knots, of the periodic cubic spline with the intervals `h` and the slopes `d`
/// of the chords.
Eigen::VectorXd periodic_spline(const std::vector<double>& h, const std::vector<double>& d) {
  const int n = static_cast<int>(h.size());
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd right(n);
  for (int i = 0; i < n; ++i) {
    const int before = (i + n - 1) % n, after = (i + 1) % n;
    entries.emplace_back(i, before, h[before] / 6);
    entries.emplace_back(i, i, (h[before] + h[i]) / 3);
    entries.emplace_back(i, after, h[i] / 6);
    right[i] = d[i] - d[before];
  }
  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return Eigen::SparseLU<Eigen::SparseMatrix<double>>(matrix).solve(right);
}

}  // namespace

CamProfile CamProfile::eccentric(double radius, double offset) {
  if (!std::isfinite(radius) || !std::isfinite(offset))
    throw std::invalid_argument(
        fmt::format("radius and offset: expected finite numbers [m], got {} and {}", radius, offset));
  CamProfile profile;
  profile.radius_ = radius;
  profile.offset_ = offset;
  return profile;
}

CamProfile CamProfile::periodic(const std::vector<double>& angles, const std::vector<double>& travels) {
  const std::size_t n = angles.size();
  if (n < 3) throw std::invalid_argument("a profile needs at least three points");
  if (travels.size() != n) throw std::invalid_argument("a profile needs a travel for every angle");
  for (std::size_t i = 0; i < n; ++i) {
    if (!std::isfinite(angles[i]) || !std::isfinite(travels[i])) throw std::invalid_argument("numbers must be finite");
    if (i > 0 && angles[i] <= angles[i - 1]) throw std::invalid_argument("angles must increase");
  }
  if (angles.back() - angles.front() >= kTurn)
    throw std::invalid_argument("angles must span less than 2 pi: the profile repeats itself after a turn");
  std::vector<double> h(n), d(n);
  for (std::size_t i = 0; i < n; ++i) {
    h[i] = i + 1 < n ? angles[i + 1] - angles[i] : angles[0] + kTurn - angles[i];
    d[i] = (travels[(i + 1) % n] - travels[i]) / h[i];
  }
  const Eigen::VectorXd m = periodic_spline(h, d);
  CamProfile profile;
  for (std::size_t i = 0; i < n; ++i) {
    const double next = m[(i + 1) % n];
    profile.pieces_.push_back(
        {angles[i], {travels[i], d[i] - h[i] * (2 * m[i] + next) / 6, 0.5 * m[i], (next - m[i]) / (6 * h[i])}});
  }
  return profile;
}

const CamProfile::Piece& CamProfile::piece_at(double u, double& t, double& turns) const {
  turns = std::floor((u - pieces_.front().begin) / kTurn);
  const double angle = u - turns * kTurn;
  const auto after = std::upper_bound(pieces_.begin() + 1, pieces_.end(), angle,
                                      [](double value, const Piece& piece) { return value < piece.begin; });
  const Piece& piece = *(after - 1);
  t = angle - piece.begin;
  return piece;
}

double CamProfile::value(double u) const {
  if (pieces_.empty()) return -2 * radius_ * std::pow(std::sin(0.5 * u), 2) - offset_;
  double t = 0, turns = 0;
  const double* c = piece_at(u, t, turns).c;
  return c[0] + t * (c[1] + t * (c[2] + t * c[3]));
}

double CamProfile::derivative(double u) const {
  if (pieces_.empty()) return -radius_ * std::sin(u);
  double t = 0, turns = 0;
  const double* c = piece_at(u, t, turns).c;
  return c[1] + t * (2 * c[2] + t * 3 * c[3]);
}

double CamProfile::second_derivative(double u) const {
  if (pieces_.empty()) return -radius_ * std::cos(u);
  double t = 0, turns = 0;
  const double* c = piece_at(u, t, turns).c;
  return 2 * c[2] + 6 * t * c[3];
}

double CamProfile::secant(double from, double to) const {
  if (pieces_.empty()) return -radius_ * std::sin(0.5 * (from + to)) * sinc(0.5 * (to - from));
  double a = 0, b = 0, turns_from = 0, turns_to = 0;
  const Piece &first = piece_at(from, a, turns_from), &last = piece_at(to, b, turns_to);
  if (&first == &last && turns_from == turns_to) {
    const double* c = first.c;
    return c[1] + c[2] * (a + b) + c[3] * (a * a + a * b + b * b);
  }
  // The secant passes a knot. If it is short, add up both parts, which have no cancellation.
  const bool forward = to > from;
  const double knot = forward ? last.begin + turns_to * kTurn : first.begin + turns_from * kTurn;
  if (std::abs(to - from) > 1e-3 || knot == from || knot == to) return (value(to) - value(from)) / (to - from);
  const Piece &low = forward ? first : last, &high = forward ? last : first;
  const double below = forward ? from : to, above = forward ? to : from, t_low = forward ? a : b,
               t_high = forward ? b : a;
  const double t_knot = t_low + (knot - below);
  const double left =
      low.c[1] + low.c[2] * (t_low + t_knot) + low.c[3] * (t_low * t_low + t_low * t_knot + t_knot * t_knot);
  const double right = high.c[1] + high.c[2] * t_high + high.c[3] * t_high * t_high;
  return (left * (knot - below) + right * (above - knot)) / (above - below);
}

double CamProfile::secant_derivative(double from, double to) const {
  const double change = to - from;
  // This is the integral of s f''(from + s change) over s in [0, 1]. Evaluate f'' at the centre of the weight s, s =
  // 2/3, which is accurate to second order.
  if (std::abs(change) < 1e-5) return 0.5 * second_derivative(from + 2.0 / 3 * change);
  return (derivative(to) - secant(from, to)) / change;
}

std::vector<double> CamProfile::numbers() const {
  std::vector<double> numbers{radius_, offset_};
  for (const Piece& piece : pieces_) {
    numbers.push_back(piece.begin);
    numbers.insert(numbers.end(), std::begin(piece.c), std::end(piece.c));
  }
  return numbers;
}

}  // namespace flexarm
