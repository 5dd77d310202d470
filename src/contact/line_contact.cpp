#include "contact/line_contact.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "joints/penetration.h"
#include "math/cayley.h"
#include "math/so3.h"
#include "model/state.h"

namespace flexarm {
namespace {

using so3::hat;

/// Elements of a line that may act in a step.
constexpr int kMostNear = 8;
/// Ways that a step may come to beyond those at the speed of its beginning: times that, and of the radii.
constexpr double kWayAhead = 2, kAside = 0.02;
/// No place of an element moves more than this times the largest motion of its nodes; and a line is not longer than
/// this times what it was, nor less than an arc over its chord.
constexpr double kLebesgue = 1.7, kLonger = 1.5;
/// Part of the way to a line by which places along it are passed over.
constexpr double kPassedOver = 0.5;
/// Cosine of normals at both ends of a step that goes to the other side.
constexpr double kTurnedOver = -0.5;

std::vector<int> reach_of(const ContactStations& side, const ContactLine& line) {
  std::vector<int> nodes;
  const auto add = [&](int node) {
    if (node >= 0 && std::find(nodes.begin(), nodes.end(), node) == nodes.end()) nodes.push_back(node);
  };
  for (const int node : side.nodes) add(node);
  for (const auto& element : line.elements) std::for_each_n(element.begin(), line.order + 1, add);
  return nodes;
}

auto poses_of(const std::vector<NodePose>& nodes) {
  return [&nodes](int node) { return node < 0 ? NodePose() : nodes[node]; };
}
auto poses_of(const State& state) {
  return [&state](int node) { return node < 0 ? NodePose() : node_pose(state.nodes[node]); };
}
auto positions_of(const std::vector<NodePose>& nodes) {
  return [&nodes](int node) -> const Vector3& { return nodes[node].position; };
}
auto positions_of(const State& state) {
  return [&state](int node) -> const Vector3& { return state.nodes[node].position; };
}

/// Numbers of an element's nodes times something of them.
template <class Of>
Vector3 sum_of(const ElementWeights& weights, const std::array<int, 5>& nodes, int order, const Of& of) {
  Vector3 out = Vector3::Zero();
  for (int i = 0; i <= order; ++i) out += weights[i] * of(nodes[i]);
  return out;
}

}  // namespace

template <class PositionOf>
Vector3 LineContact::offset(const Vector3& point, const ClosestPoint& place, const PositionOf& position_of) const {
  return point - sum_of(line_weights(line_.order, place.xi).values, line_.elements[place.element], line_.order,
                        position_of);
}

/// A ball around all middles.
struct LineContact::Cloud {
  Vector3 middle;
  double reach;
};

LineContact::LineContact(std::vector<std::string> links, ContactStations side, ContactLine line,
                         std::vector<LinePair> pairs, const ContactLaw& law)
    : ForceElement("", reach_of(side, line)),
      links_(std::move(links)),
      side_(std::move(side)),
      line_(std::move(line)),
      pairs_(std::move(pairs)),
      law_(law) {
  assert(!side_.nodes.empty() && pairs_.size() <= kMostPairs && line_.lengths.size() == line_.elements.size());
  for (const LinePair& pair : pairs_) largest_radius_ = std::max(largest_radius_, radius_of(pair));
}

std::string LineContact::description() const {
  return fmt::format("{} points against a line, {:.4g} N/m each, friction {:g}", pairs_.size(), law_.stiffness,
                     law_.friction);
}

int LineContact::most_nodes() const {
  const int most = static_cast<int>(side_.nodes.size()) + kMostNear * (line_.order + 1);
  return std::min(most, static_cast<int>(reach().size()));
}

ContactLaw LineContact::law_of(const LinePair& pair) const {
  ContactLaw law = law_;
  law.stiffness *= side_.stations[pair.station].share;
  law.grip *= side_.stations[pair.station].share;
  return law;
}

// ---------------------------------------------------------------- what is near

bool LineContact::is_listed(int element, const Listed& listed) const {
  if (!listed.nodes) return true;
  const auto is_in = [&](int node) { return std::find(listed.nodes, listed.nodes + listed.count, node); };
  const auto& nodes = line_.elements[element];
  return std::all_of(nodes.begin(), nodes.begin() + line_.order + 1,
                     [&](int node) { return is_in(node) != listed.nodes + listed.count; });
}

template <class PositionOf>
LinePiece LineContact::piece(int element, const PositionOf& position_of) const {
  std::array<Vector3, 5> nodes;
  for (int i = 0; i <= line_.order; ++i) nodes[i] = position_of(line_.elements[element][i]);
  return line_piece(line_.order, nodes);
}

template <class PoseOf>
LineContact::Middles LineContact::middles(const PoseOf& pose_of) const {
  Middles out;
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    const bool is_same = k > 0 && pairs_[k].station == pairs_[k - 1].station;
    out[k] = is_same ? out[k - 1] : middle_of(side_, side_.stations[pairs_[k].station], pose_of);
  }
  return out;
}

LineContact::Cloud LineContact::cloud(const Middles& middles) const {
  Cloud out{Vector3::Zero(), 0};
  const double share = 1.0 / static_cast<double>(pairs_.size());
  for (std::size_t k = 0; k < pairs_.size(); ++k) out.middle += share * middles[k];
  for (std::size_t k = 0; k < pairs_.size(); ++k) out.reach = std::max(out.reach, (middles[k] - out.middle).norm());
  return out;
}

template <class PositionOf, class MarginOf, class Visit>
void LineContact::for_each_near(const Cloud& cloud, const PositionOf& position_of, const MarginOf& margin_of,
                                const Visit& visit) const {
  const int count = static_cast<int>(line_.elements.size());
  for (int k = 0; k < count; ++k) {
    const Vector3& at = position_of(line_.elements[k][line_.order / 2]);
    const double margin = margin_of(k);
    const double beyond = (at - cloud.middle).norm() - cloud.reach - kLonger * line_.lengths[k] - margin;
    if (beyond <= 0) {
      visit(k, margin);
      continue;
    }
    double passed = kPassedOver / kLonger * beyond - line_.lengths[k];
    while (k + 1 < count && passed > line_.lengths[k + 1]) passed -= line_.lengths[++k];
  }
}

template <class PositionOf>
LineContact::Places LineContact::closest(const Middles& middles, double margin, const PositionOf& position_of,
                                         const Listed& listed) const {
  Places out;
  const Cloud cloud = this->cloud(middles);
  const auto margin_of = [&](int) { return largest_radius_ + margin; };
  for_each_near(cloud, position_of, margin_of, [&](int k, double) {
    if (!is_listed(k, listed)) return;
    const LinePiece piece = this->piece(k, position_of);
    for (std::size_t p = 0; p < pairs_.size(); ++p) {
      const double low = std::max(2 * (pairs_[p].range.begin - k) - 1, -1.0);
      const double high = std::min(2 * (pairs_[p].range.end - k) - 1, 1.0);
      const double most = std::min(std::sqrt(out[p].square), radius_of(pairs_[p]) + margin);
      if (low > high || (middles[p] - piece.middle()).norm() - piece.reach > most) continue;
      ClosestPoint found = closest_point(piece, middles[p], low, high);
      if (found.square > most * most || found.square >= out[p].square) continue;
      found.element = k;
      out[p] = found;
    }
  });
  return out;
}

int LineContact::find_nodes(const ForceStart& start, int* nodes) const {
  const auto position_of = positions_of(start.poses);
  const auto speed_of = [&](int node) { return start.velocities[node].head<3>().norm(); };
  const Cloud cloud = this->cloud(middles(poses_of(start.poses)));
  double fastest = 0;
  for (int i = 0; i < moving_nodes(); ++i) {
    const int node = side_.nodes[i];
    const double arm = (cloud.middle - start.poses[node].position).norm() + cloud.reach;
    const bool is_body = side_.nodes.size() == 1;
    fastest = std::max(fastest, is_body ? speed_of(node) + start.velocities[node].tail<3>().norm() * arm
                                        : kLebesgue * speed_of(node));
  }
  const auto margin_of = [&](int k) {
    // Of an equilibrium: what it may come to by a step of the load.
    if (start.duration == 0) return 4 * largest_radius_ + cloud.reach;
    double speed = 0;
    for (int i = 0; i <= line_.order; ++i) speed = std::max(speed, speed_of(line_.elements[k][i]));
    return (1 + kAside) * largest_radius_ + kWayAhead * std::abs(start.duration) * (fastest + kLebesgue * speed);
  };
  std::array<std::pair<double, int>, kMostNear> near;  // by how near they are
  int found = 0;
  for_each_near(cloud, position_of, margin_of, [&](int k, double margin) {
    const double distance = std::sqrt(closest_point(piece(k, position_of), cloud.middle, -1, 1).square);
    const double beyond = distance - cloud.reach - margin;
    if (beyond > 0) return;
    if (found == kMostNear && beyond >= near[found - 1].first) return;
    if (found < kMostNear) ++found;
    int at = found - 1;
    for (; at > 0 && near[at - 1].first > beyond; --at) near[at] = near[at - 1];
    near[at] = {beyond, k};
  });
  if (found == 0) return 0;
  int count = 0;
  const auto add = [&](int node) {
    if (std::find(nodes, nodes + count, node) == nodes + count) nodes[count++] = node;
  };
  std::for_each_n(side_.nodes.begin(), moving_nodes(), add);
  for (int i = 0; i < found; ++i) std::for_each_n(line_.elements[near[i].second].begin(), line_.order + 1, add);
  return count;
}

bool LineContact::needs_halves(const ForceStep& step, const int* nodes, int count) const {
  if (step.duration == 0) return false;
  const auto begin_of = positions_of(step.begin), end_of = positions_of(step.end);
  const Middles from = middles(poses_of(step.begin)), to = middles(poses_of(step.end));
  double moved = 0, way = -1;
  for (std::size_t k = 0; k < pairs_.size(); ++k) moved = std::max(moved, (to[k] - from[k]).norm());
  const auto margin_of = [&](int k) {
    double most = 0;
    for (int i = 0; i <= line_.order; ++i) {
      const int node = line_.elements[k][i];
      most = std::max(most, (end_of(node) - begin_of(node)).norm());
    }
    return largest_radius_ + moved + kLebesgue * most;
  };
  for_each_near(cloud(from), begin_of, margin_of,
                [&](int, double margin) { way = std::max(way, margin - largest_radius_); });
  if (way < 0) return false;  // nothing was touched
  const Places begin = closest(from, way, begin_of, {}), end = closest(to, way, end_of, {});
  const Listed listed{nodes, count};
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    if (begin[k].element < 0 || end[k].element < 0) continue;
    const double radius = radius_of(pairs_[k]);
    const Vector3 first = offset(from[k], begin[k], begin_of), last = offset(to[k], end[k], end_of);
    ContactChange change{radius - first.norm(), radius - last.norm(), std::abs(step.duration)};
    if (change.begin <= 0 && change.end <= 0) {
      if (passes_through(k, begin[k], end[k], way, step)) return true;
      continue;
    }
    const bool is_seen = count > 0 && (change.begin <= 0 || is_listed(begin[k].element, listed)) &&
                         (change.end <= 0 || is_listed(end[k].element, listed));
    if (!is_seen || first.dot(last) < kTurnedOver * first.norm() * last.norm()) return true;
    const double rate = begin_rate(pairs_[k], begin[k], step);
    change.speed = approach_speed(change.begin, rate, step.memory[LineMemory::kSize * k]);
    if (is_coarse_hit(law_, change, rate, step.refinement)) return true;
  }
  return false;
}

bool LineContact::passes_through(std::size_t index, const ClosestPoint& begin, const ClosestPoint& end, double way,
                                 const ForceStep& step) const {
  const double radius = radius_of(pairs_[index]);
  double gone = std::sqrt(begin.square) - radius;
  if (gone + std::sqrt(end.square) - radius >= way) return false;
  const auto begin_of = positions_of(step.begin), end_of = positions_of(step.end);
  const ContactStation& station = side_.stations[pairs_[index].station];
  const Vector3 from = middle_of(side_, station, poses_of(step.begin));
  const Vector3 to = middle_of(side_, station, poses_of(step.end));
  // Towards a straight line distances are convex: lowest at an end unless they fall first and rise then.
  const auto rate = [&](const ClosestPoint& place, const Vector3& at, const auto& position_of) {
    return offset(at, place, position_of).dot(offset(to, place, end_of) - offset(from, place, begin_of));
  };
  if (rate(begin, from, begin_of) >= 0 || rate(end, to, end_of) <= 0) return false;
  constexpr double kLeast = 1.0 / 64;  // of the way, per look
  while (gone < way) {
    const double part = gone / way;
    Middles middles;
    for (std::size_t k = 0; k < pairs_.size(); ++k) middles[k] = from + part * (to - from);
    const auto position_of = [&](int node) { return Vector3(begin_of(node) + part * (end_of(node) - begin_of(node))); };
    const ClosestPoint place = closest(middles, way, position_of, {})[index];
    const double gap = place.element < 0 ? way : std::sqrt(place.square) - radius;
    if (gap < 0) return true;
    gone += std::max(gap, kLeast * way);
  }
  return false;
}

// ---------------------------------------------------------------- what it does

/// A pair that touches, over a step.
struct LineContact::Acting {
  struct Node {
    int at = 0;                              // in the action
    double side = 0, line = 0, nearest = 0;  // weights of the station, of the line in means, and where it is nearest
    double slope = 0;                        // of the last, by xi
    Matrix3 by_spin;                         // of its tangent-scaled turn
  };
  std::array<Node, 3 * 5> nodes;
  int count = 0;
  int body = -1;                                             // of these, where the station is a body's
  Vector3 arm = Vector3::Zero(), end_arm = Vector3::Zero();  // of the station from there
  double weight = 0.5;                                       // of the end
  Vector3 middle;                                            // from the line to the station
  Vector3 nearest, tangent;                                  // at the end: from the nearest place, by xi there
  double rise = 0;                                           // of nearest . tangent by -xi; 0: the place stays
  LineAction local;

  Node& node(int at) {
    for (int i = 0; i < count; ++i)
      if (nodes[i].at == at) return nodes[i];
    nodes[count].at = at;
    return nodes[count++];
  }
  Vector3 normal() const { return nearest / std::max(nearest.norm(), 1e-300); }
};

Vector3 LineContact::velocity(const LinePair& pair, const LineWeights& weights, int element,
                              const ForceStep& step) const {
  const ContactStation& station = side_.stations[pair.station];
  const auto linear = [&](int node) { return Vector3(step.velocities[node].head<3>()); };
  Vector3 out = -sum_of(weights.values, line_.elements[element], line_.order, linear);
  for (int i = 0; i < moving_nodes(); ++i) {
    const int node = side_.nodes[i];
    out += station.weights[i] *
           (linear(node) + step.velocities[node].tail<3>().cross(step.begin[node].rotation * station.arm));
  }
  return out;
}

/// Of the penetration [m/s].
double LineContact::begin_rate(const LinePair& pair, const ClosestPoint& begin, const ForceStep& step) const {
  const LineWeights weights = line_weights(line_.order, begin.xi);
  const Vector3 offset =
      middle_of(side_, side_.stations[pair.station], poses_of(step.begin)) -
      sum_of(weights.values, line_.elements[begin.element], line_.order, positions_of(step.begin));
  const double distance = offset.norm();
  return distance > 0 ? -offset.dot(velocity(pair, weights, begin.element, step)) / distance : 0.0;
}

/// Where the nearest place will be in the middle of the step, as it moves at its beginning.
double LineContact::foreseen(const LinePair& pair, const ClosestPoint& begin, const Vector3& middle,
                             const ForceStep& step) const {
  if (begin.is_clamped || step.duration == 0) return begin.xi;
  const LineWeights weights = line_weights(line_.order, begin.xi);
  const auto& nodes = line_.elements[begin.element];
  const auto position_of = positions_of(step.begin);
  const auto linear = [&](int node) { return Vector3(step.velocities[node].head<3>()); };
  const Vector3 offset = middle - sum_of(weights.values, nodes, line_.order, position_of);
  const Vector3 tangent = sum_of(weights.slopes, nodes, line_.order, position_of);
  const double rise =
      tangent.squaredNorm() - offset.dot(sum_of(weights.curvatures, nodes, line_.order, position_of));
  const double drive = velocity(pair, weights, begin.element, step).dot(tangent) +
                       offset.dot(sum_of(weights.slopes, nodes, line_.order, linear));
  if (!(rise > 0)) return begin.xi;
  const double way = std::clamp(0.5 * step.duration * drive / rise, -0.5, 0.5);
  return std::clamp(begin.xi + way, -1.0, 1.0);
}

LineContact::Acting LineContact::acting(std::size_t index, const ClosestPoint& begin, const ClosestPoint& end,
                                        const ForceStep& step, const Listed& listed, bool with_slope) const {
  const LinePair& pair = pairs_[index];
  const ContactStation& station = side_.stations[pair.station];
  Acting out;
  out.weight = step.at_end ? 1 : 0.5;
  const Vector3 from = middle_of(side_, station, poses_of(step.begin));
  const Vector3 to = middle_of(side_, station, poses_of(step.end));
  const auto begin_of = positions_of(step.begin), end_of = positions_of(step.end);
  const auto& line = line_.elements[begin.element];
  const auto& nearest = line_.elements[end.element];
  const LineWeights at_end = line_weights(line_.order, end.xi);
  const ElementWeights weights = line_weights(line_.order, foreseen(pair, begin, from, step)).values;
  LineMotion motion;
  motion.begin = from - sum_of(weights, line, line_.order, begin_of);
  motion.end = to - sum_of(weights, line, line_.order, end_of);
  motion.begin_distance = std::sqrt(begin.square);
  motion.end_distance = std::sqrt(end.square);
  motion.turn = motion.line_turn = Vector3::Zero();
  motion.duration = step.duration;
  motion.at_end = step.at_end;
  const auto at = [&](int node) {
    return static_cast<int>(std::find(listed.nodes, listed.nodes + listed.count, node) - listed.nodes);
  };
  const auto turn_of = [&](int node) {
    return cayley::increment(step.begin[node].orientation, step.end[node].orientation);
  };
  for (int i = 0; i < moving_nodes(); ++i) {
    out.node(at(side_.nodes[i])).side = station.weights[i];
    motion.turn += station.weights[i] * turn_of(side_.nodes[i]);
  }
  for (int i = 0; i <= line_.order; ++i) {
    out.node(at(line[i])).line = weights[i];
    motion.line_turn += weights[i] * turn_of(line[i]);
    Acting::Node& node = out.node(at(nearest[i]));
    node.nearest = at_end.values[i];
    node.slope = at_end.slopes[i];
  }
  if (moving_nodes() == 1) {
    out.body = 0;
    out.end_arm = step.end[side_.nodes[0]].rotation * station.arm;
    out.arm = out.weight * out.end_arm + (1 - out.weight) * (step.begin[side_.nodes[0]].rotation * station.arm);
  }
  if (step.duration != 0) motion.begin_rate = begin_rate(pair, begin, step);
  out.middle = out.weight * motion.end + (1 - out.weight) * motion.begin;
  out.nearest = to - sum_of(at_end.values, nearest, line_.order, end_of);
  out.tangent = sum_of(at_end.slopes, nearest, line_.order, end_of);
  out.rise = out.tangent.squaredNorm() - out.nearest.dot(sum_of(at_end.curvatures, nearest, line_.order, end_of));
  if (end.is_clamped || !(out.rise > 0)) out.rise = 0;
  const double* memory = step.memory + LineMemory::kSize * index;
  const LineMemory old{memory[0], Eigen::Map<const Vector3>(memory + 1)};
  out.local = line_action(law_of(pair), {station.radius, radius_of(pair)}, motion, old, with_slope);
  if (!with_slope) return out;
  for (int i = 0; i < out.count; ++i)
    out.nodes[i].by_spin = cayley::inverse_tangent(turn_of(listed.nodes[out.nodes[i].at]));
  return out;
}

void LineContact::evaluate(const ForceStep& step, const int* nodes, ForceAction& action) const {
  std::fill(step.new_memory, step.new_memory + memory_size(), 0.0);
  action.residual.setZero();
  action.tangent.setZero();
  const auto stretch = [&](std::size_t k) { return Eigen::Map<const Vector3>(step.memory + LineMemory::kSize * k + 1); };
  const auto let_go = [&](std::size_t k) {
    action.dissipated += 0.5 * law_of(pairs_[k]).grip * stretch(k).squaredNorm();
  };
  const Listed listed{nodes, static_cast<int>(action.residual.size() / 6)};
  const auto begin_of = positions_of(step.begin), end_of = positions_of(step.end);
  Middles from, to;
  Places begin, end;
  if (listed.count > 0) {
    from = middles(poses_of(step.begin));
    to = middles(poses_of(step.end));
    begin = closest(from, 0, begin_of, listed);
    end = closest(to, 0, end_of, listed);
  }
  const auto touches = [&](std::size_t k) { return begin[k].element >= 0 || end[k].element >= 0; };
  std::array<bool, kMostPairs> does_touch{};
  bool any = false;
  for (std::size_t k = 0; k < pairs_.size(); ++k) any = (does_touch[k] = touches(k)) || any;
  if (any) {
    constexpr double kAnywhere = std::numeric_limits<double>::infinity();
    begin = closest(from, kAnywhere, begin_of, listed);
    end = closest(to, kAnywhere, end_of, listed);
  }
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    if (!does_touch[k]) {
      let_go(k);
      continue;
    }
    if (begin[k].element < 0 || end[k].element < 0) {  // poses that are not finite
      action.residual.setConstant(std::numeric_limits<double>::quiet_NaN());
      return;
    }
    const bool with_slope = action.tangent.size() > 0;
    const Acting acting = this->acting(k, begin[k], end[k], step, listed, with_slope);
    action.dissipated += acting.local.dissipated;
    double* memory = step.new_memory + LineMemory::kSize * k;
    memory[0] = acting.local.memory.speed;
    Eigen::Map<Vector3>(memory + 1) = acting.local.memory.stretch;
    if (!acting.local.acts) continue;
    add(acting, action);
    if (with_slope) add_tangent(acting, action);
    if (step.at_end) add_push_at_end(acting, action);
  }
}

/// Of the wrench: {force, moment} on each node.
void LineContact::add(const Acting& acting, ForceAction& action) const {
  const Vector3 force = acting.local.wrench.head<3>(), couple = acting.local.wrench.tail<3>();
  const Vector3 on_side = acting.arm.cross(force) + couple, on_line = acting.middle.cross(force) + couple;
  for (int i = 0; i < acting.count; ++i) {
    const Acting::Node& node = acting.nodes[i];
    action.residual.segment<3>(6 * node.at) -= (node.side - node.line) * force;
    action.residual.segment<3>(6 * node.at + 3) -= node.side * on_side - node.line * on_line;
  }
}

void LineContact::add_tangent(const Acting& acting, ForceAction& action) const {
  const LineAction& local = acting.local;
  const LineAction::Columns by_distance = local.by_distance * acting.normal().transpose();
  const Matrix3 arm = hat(acting.arm), end_arm = hat(acting.end_arm), middle = hat(acting.middle);
  const Matrix3 pressed = acting.weight * hat(Vector3(local.wrench.head<3>()));
  for (int j = 0; j < acting.count; ++j) {
    const Acting::Node& column = acting.nodes[j];
    const double way = column.side - column.line;
    Matrix6 slope;  // of the wrench
    slope.leftCols<3>() = way * local.by_end + (column.side - column.nearest) * by_distance;
    slope.rightCols<3>() = (column.side * local.by_turn + column.line * local.by_line_turn) * column.by_spin;
    Eigen::Matrix<double, 3, 6> moved = Eigen::Matrix<double, 3, 6>::Zero();  // the station less the line
    moved.leftCols<3>().diagonal().setConstant(way);
    if (j == acting.body) {
      slope.rightCols<3>() -= (local.by_end + by_distance) * end_arm;
      moved.rightCols<3>() = -end_arm;
    }
    Eigen::Matrix<double, 3, 6> on_side = arm * slope.topRows<3>() + slope.bottomRows<3>();
    if (j == acting.body) on_side.rightCols<3>() += pressed * end_arm;
    const Eigen::Matrix<double, 3, 6> on_line = middle * slope.topRows<3>() + slope.bottomRows<3>() - pressed * moved;
    for (int i = 0; i < acting.count; ++i) {
      const Acting::Node& row = acting.nodes[i];
      auto block = action.tangent.block<6, 6>(6 * row.at, 6 * column.at);
      block.topRows<3>() -= (row.side - row.line) * slope.topRows<3>();
      block.bottomRows<3>() -= row.side * on_side - row.line * on_line;
    }
  }
}

/// At an instant: the push along the normal, to where the line is nearest.
void LineContact::add_push_at_end(const Acting& acting, ForceAction& action) const {
  const ContactPush& push = acting.local.push;
  const Vector3 normal = acting.normal(), force = push.value * normal;
  const double distance = acting.nearest.norm();
  for (int i = 0; i < acting.count; ++i) {
    const Acting::Node& node = acting.nodes[i];
    action.residual.segment<3>(6 * node.at) -= (node.side - node.nearest) * force;
    if (i == acting.body) action.residual.segment<3>(6 * node.at + 3) -= acting.end_arm.cross(force);
  }
  if (action.tangent.size() == 0) return;
  using Row = Eigen::Matrix<double, 1, 6>;
  const Matrix3 across = push.value / distance * (Matrix3::Identity() - normal * normal.transpose());
  const Matrix3 arm = hat(acting.end_arm), stiffness = across - push.slope * normal * normal.transpose();
  for (int j = 0; j < acting.count; ++j) {
    const Acting::Node& column = acting.nodes[j];
    const double way = column.side - column.nearest;
    Eigen::Matrix<double, 3, 6> slope = Eigen::Matrix<double, 3, 6>::Zero();
    Row place = Row::Zero();  // how xi goes along
    slope.leftCols<3>() = way * stiffness;
    place.head<3>() = way * acting.tangent.transpose() + column.slope * acting.nearest.transpose();
    if (j == acting.body) {
      slope.rightCols<3>() = -stiffness * arm;
      place.tail<3>() = -acting.tangent.transpose() * arm;
    }
    place *= acting.rise > 0 ? 1 / acting.rise : 0.0;
    slope -= across * acting.tangent * place;
    for (int i = 0; i < acting.count; ++i) {
      const Acting::Node& row = acting.nodes[i];
      auto block = action.tangent.block<6, 6>(6 * row.at, 6 * column.at);
      block.topRows<3>() -= (row.side - row.nearest) * slope - row.slope * force * place;
      if (i != acting.body) continue;
      block.bottomRows<3>() -= arm * slope;
      if (j == acting.body) block.bottomRightCorner<3, 3>() -= hat(force) * arm;
    }
  }
}

// ---------------------------------------------------------------- energies, small motions

double LineContact::energy(const State& state, const double* memory) const {
  const Places places = closest(middles(poses_of(state)), 0, positions_of(state), {});
  double energy = 0;
  for (std::size_t k = 0; k < pairs_.size(); ++k, memory += LineMemory::kSize) {
    const ContactLaw law = law_of(pairs_[k]);
    energy += 0.5 * law.grip * Eigen::Map<const Vector3>(memory + 1).squaredNorm();
    if (places[k].element >= 0) energy += contact_energy(law, radius_of(pairs_[k]) - std::sqrt(places[k].square));
  }
  return energy;
}

double LineContact::deepest(const std::vector<NodePose>& poses) const {
  const Places places = closest(middles(poses_of(poses)), 0, positions_of(poses), {});
  double deepest = 0;
  for (std::size_t k = 0; k < pairs_.size(); ++k)
    if (places[k].element >= 0) deepest = std::max(deepest, radius_of(pairs_[k]) - std::sqrt(places[k].square));
  return deepest;
}

template <class Visit>
void LineContact::for_each_touching(const State& state, const Visit& visit) const {
  const Middles middles = this->middles(poses_of(state));
  const Places places = closest(middles, 0, positions_of(state), {});
  for (std::size_t k = 0; k < pairs_.size(); ++k)
    if (places[k].element >= 0) visit(pairs_[k], places[k], offset(middles[k], places[k], positions_of(state)));
}

ForceMeasures LineContact::measures(const State& state, const int* nodes) const {
  std::vector<NodePose> poses;
  for (const NodeState& node : state.nodes) poses.push_back(node_pose(node));
  std::vector<int> found(most_nodes());
  const int count = find_nodes({poses, {}}, found.data());
  const int each = law_.friction > 0 ? 3 : 1;
  Eigen::Index rows = 0;
  for_each_touching(state, [&](const LinePair&, const ClosestPoint&, const Vector3&) { rows += each; });
  ForceMeasures out{Eigen::MatrixXd::Zero(rows, 6 * count), Eigen::MatrixXd::Zero(rows, rows)};
  const auto at = [&](int node) { return 6 * (std::find(nodes, nodes + count, node) - nodes); };
  Eigen::Index row = 0;
  for_each_touching(state, [&](const LinePair& pair, const ClosestPoint& place, const Vector3& offset) {
    const ContactStation& station = side_.stations[pair.station];
    const ContactLaw law = law_of(pair);
    const ElementWeights weights = line_weights(line_.order, place.xi).values;
    const Vector3 normal = offset / std::max(offset.norm(), 1e-300), across = normal.unitOrthogonal();
    const Vector3 axes[] = {normal, across, normal.cross(across)};
    for (int k = 0; k < each; ++k, ++row) {
      // Sticking holds the surfaces, a radius below the station's middle.
      const Vector3 below = k == 0 ? Vector3(Vector3::Zero()) : Vector3(-station.radius * normal);
      for (int i = 0; i < moving_nodes(); ++i) {
        const Vector3 arm = poses[side_.nodes[i]].rotation * station.arm + below;
        out.rows.block<1, 3>(row, at(side_.nodes[i])) += station.weights[i] * axes[k].transpose();
        out.rows.block<1, 3>(row, at(side_.nodes[i]) + 3) += station.weights[i] * arm.cross(axes[k]).transpose();
      }
      for (int i = 0; i <= line_.order; ++i) {
        const Eigen::Index column = at(line_.elements[place.element][i]);
        out.rows.block<1, 3>(row, column) -= weights[i] * axes[k].transpose();
        out.rows.block<1, 3>(row, column + 3) -= weights[i] * (offset + below).cross(axes[k]).transpose();
      }
      out.stiffness(row, row) =
          k == 0 ? contact_push(law, {0, radius_of(pair) - offset.norm(), 0}).slope : law.grip;
    }
  });
  return out;
}

DamperTensions LineContact::dampers(const State& state, const Eigen::VectorXd& rates) const {
  const int each = law_.friction > 0 ? 3 : 1;
  Eigen::VectorXd slopes = Eigen::VectorXd::Zero(rates.size());
  Eigen::Index row = 0;
  for_each_touching(state, [&](const LinePair& pair, const ClosestPoint&, const Vector3& offset) {
    // Of what is pressed slowly, see contact_push().
    const double slope = hardened({radius_of(pair) - offset.norm(), law_.depth}).slope;
    slopes[row] = 2 * law_of(pair).stiffness * law_.damping / law_.frequency * slope;
    row += each;
  });
  return {slopes.cwiseProduct(rates), slopes.asDiagonal()};
}

}  // namespace flexarm
