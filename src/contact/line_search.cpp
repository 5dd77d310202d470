#include "contact/line_search.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "model/state.h"

namespace flexarm {
namespace {

/// Number of the line's elements that may act in a step: at most kMostNear, and kMoreNear more than the stations' side
/// can cover by its size.
constexpr int kMostNear = 8, kMoreNear = 3;
/// A place of an element moves at most by this factor times the largest motion of the element's nodes.
constexpr double kLebesgue = 1.7;
/// An element becomes at most this many times as long as undeformed.
constexpr double kLonger = 1.5;
/// If a place of the line is far, elements along the line are skipped over this part of the distance.
constexpr double kPassedOver = 0.5;
/// Stations between two tested ones may be nearer by this part of the radius.
constexpr double kInBetween = 0.25;

double shortest_of(const ContactLine& line) {
  return *std::min_element(line.lengths.begin(), line.lengths.end());
}

}  // namespace

double LineSearch::most_size(const ContactLine& line) {
  return (kMostNear - kMoreNear) * shortest_of(line);
}

Vector3 NodePlaces::position(int node) const {
  if (state_) return state_->nodes[node].position;
  const Vector3& begin = (*begin_)[node].position;
  return end_ ? Vector3(begin + part_ * ((*end_)[node].position - begin)) : begin;
}

Matrix3 NodePlaces::rotation(int node) const {
  assert(!end_);
  return state_ ? node_pose(state_->nodes[node]).rotation : (*begin_)[node].rotation;
}

LineSearch::LineSearch(LineTouch touch) : touch_(std::move(touch)) {
  assert(!side().nodes.empty() && pairs().size() <= kMostPairs && line().lengths.size() == line().elements.size());
  for (const LinePair& pair : pairs()) {
    largest_radius_ = std::max(largest_radius_, radius_of(pair));
    largest_arm_ = std::max(largest_arm_, station(pair).arm.norm());
    middle_arm_ += station(pair).arm / static_cast<double>(pairs().size());
  }
  for (const LinePair& pair : pairs()) arm_reach_ = std::max(arm_reach_, (station(pair).arm - middle_arm_).norm());
  const int stations = pairs().empty() ? 0 : pairs().back().station - pairs().front().station;
  const double size = touch_.spacing * stations + 2 * arm_reach_;
  most_near_ = static_cast<int>(std::min(kMoreNear + std::ceil(size / shortest_of(line())), 1.0 * kMostNear));
  const int most = static_cast<int>(side().nodes.size()) + most_near_ * (line().order + 1);
  most_nodes_ = std::min(most, static_cast<int>(reach().size()));
  // From one station to the next, the distance to the line changes at most by twice the deformed spacing: the station
  // moves, and so does the part of the line that it may touch.
  if (touch_.spacing == 0) return;
  const double change = 2 * kLonger * touch_.spacing;
  stride_ = std::max<std::size_t>(static_cast<std::size_t>(kInBetween * largest_radius_ / change), 1);
  between_ = static_cast<double>(stride_) * change;
}

std::vector<int> LineSearch::reach() const {
  std::vector<int> nodes;
  const auto add = [&](int node) {
    if (node >= 0 && std::find(nodes.begin(), nodes.end(), node) == nodes.end()) nodes.push_back(node);
  };
  for (const int node : side().nodes) add(node);
  for (const auto& element : line().elements) std::for_each_n(element.begin(), line().order + 1, add);
  return nodes;
}

bool LineSearch::is_listed(int element, const ListedNodes& listed) const {
  if (!listed.nodes) return true;
  const int* end = listed.nodes + listed.count;
  const auto& nodes = line().elements[element];
  return std::all_of(nodes.begin(), nodes.begin() + line().order + 1,
                     [&](int node) { return std::find(listed.nodes, end, node) != end; });
}

// ---------------------------------------------------------------- places

Vector3 LineSearch::middle(const ContactStation& station, const NodePlaces& places) const {
  if (moving_nodes() == 0) return station.arm;
  if (is_body()) return places.position(side().nodes[0]) + places.rotation(side().nodes[0]) * station.arm;
  Vector3 out = Vector3::Zero();
  for (std::size_t i = 0; i < side().nodes.size(); ++i) out += station.weights[i] * places.position(side().nodes[i]);
  return out;
}

LineSearch::Middles LineSearch::middles(const NodePlaces& places) const {
  Middles out{};
  for (std::size_t k = 0; k < pairs().size(); ++k) {
    const bool is_same = k > 0 && pairs()[k].station == pairs()[k - 1].station;
    out[k] = is_same ? out[k - 1] : middle(station(pairs()[k]), places);
  }
  return out;
}

Vector3 LineSearch::offset(const Vector3& point, const ClosestPoint& place, const NodePlaces& places) const {
  const ElementWeights weights = line_weights(line().order, place.xi).values;
  return point - sum(weights, place.element, [&](int node) { return places.position(node); });
}

LinePiece LineSearch::piece(int element, const NodePlaces& places) const {
  std::array<Vector3, 5> nodes;
  for (int i = 0; i <= line().order; ++i) nodes[i] = places.position(line().elements[element][i]);
  return line_piece(line().order, nodes);
}

/// A ball that contains the middles of all stations.
struct LineSearch::Cloud {
  Vector3 middle;
  double reach;
};

LineSearch::Cloud LineSearch::cloud(const NodePlaces& places) const {
  if (moving_nodes() == 0) return {middle_arm_, arm_reach_};
  const int first = side().nodes[0];
  if (is_body()) return {places.position(first) + places.rotation(first) * middle_arm_, arm_reach_};
  Cloud out{places.position(side().nodes[side().nodes.size() / 2]), 0};
  for (const int node : side().nodes) out.reach = std::max(out.reach, (places.position(node) - out.middle).norm());
  out.reach *= kLebesgue;
  return out;
}

/// If a place of the line is far from the cloud, its neighbours along the line are far, too: they are skipped.
template <class MarginOf, class Visit>
void LineSearch::for_each_near(const Cloud& cloud, const NodePlaces& places, const MarginOf& margin_of,
                               const Visit& visit) const {
  const int count = static_cast<int>(line().elements.size());
  for (int k = 0; k < count; ++k) {
    const Vector3 at = places.position(line().elements[k][line().order / 2]);
    const double margin = margin_of(k);
    const double beyond = (at - cloud.middle).norm() - cloud.reach - kLonger * line().lengths[k] - margin;
    if (beyond <= 0) {
      visit(k, margin);
      continue;
    }
    double passed = kPassedOver / kLonger * beyond;
    while (k + 1 < count && passed > line().lengths[k + 1]) passed -= line().lengths[++k];
  }
}

/// Returns the nearest place of a pair on one element. Its `element` is -1 if the pair does not belong to that element.
ClosestPoint LineSearch::closest(const LinePiece& piece, int element, std::size_t pair, const Vector3& middle) const {
  const LineRange& range = pairs()[pair].range;
  const double low = std::max(2 * (range.begin - element) - 1, -1.0);
  const double high = std::min(2 * (range.end - element) - 1, 1.0);
  if (low > high) return {};
  ClosestPoint found = closest_point(piece, middle, low, high);
  found.element = element;
  return found;
}

/// Whether any pair may be nearer to an element than the largest radius plus `margin`. May be true for slightly larger
/// distances.
bool LineSearch::is_any_near(int element, double margin, const NodePlaces& places) const {
  const LinePiece piece = this->piece(element, places);
  const double most = largest_radius_ + margin + between_;
  for (std::size_t p = 0; p < pairs().size(); p += stride_) {
    const Vector3 at = middle(station(pairs()[p]), places);
    if (piece.least_distance(at) < most && closest(piece, element, p, at).square < most * most) return true;
  }
  return false;
}

/// Returns the smallest gap between an element and the stations that may touch it [m]; infinity if there are none.
double LineSearch::least_gap(int element, const NodePlaces& places) const {
  const LinePiece piece = this->piece(element, places);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t p = 0; p < pairs().size(); ++p) {
    const ClosestPoint found = closest(piece, element, p, middle(station(pairs()[p]), places));
    if (found.element >= 0) least = std::min(least, std::sqrt(found.square) - radius_of(pairs()[p]));
  }
  return least;
}

LineSearch::Places LineSearch::closest(const Middles& middles, double margin, const NodePlaces& places,
                                       const ListedNodes& listed, const Chosen* only) const {
  Places out;
  Cloud cloud{middles[0], 0};
  for (std::size_t p = 1; p < pairs().size(); ++p)
    cloud.reach = std::max(cloud.reach, (middles[p] - cloud.middle).norm());
  const auto margin_of = [&](int) { return largest_radius_ + margin; };
  for_each_near(cloud, places, margin_of, [&](int k, double) {
    if (!is_listed(k, listed)) return;
    const LinePiece piece = this->piece(k, places);
    for (std::size_t p = 0; p < pairs().size(); ++p) {
      const double most = radius_of(pairs()[p]) + margin, square = std::min(most * most, out[p].square);
      if (only && !(*only)[p]) continue;
      const double distance = piece.least_distance(middles[p]);
      if (distance > 0 && distance * distance > square) continue;
      const ClosestPoint found = closest(piece, k, p, middles[p]);
      if (found.square < square) out[p] = found;
    }
  });
  return out;
}

// ---------------------------------------------------------------- steps

/// Returns a bound of the stations' speeds [m/s].
double LineSearch::fastest(const ForceStart& start) const {
  double fastest = 0;
  for (int i = 0; i < moving_nodes(); ++i) {
    const Vector6& motion = start.velocities[side().nodes[i]];
    fastest = std::max(fastest, is_body() ? motion.head<3>().norm() + motion.tail<3>().norm() * largest_arm_
                                          : kLebesgue * motion.head<3>().norm());
  }
  return fastest;
}

int LineSearch::find_nodes(const ForceStart& start, int* nodes) const {
  const NodePlaces places(start.poses);
  const Cloud cloud = this->cloud(places);
  const double way = kMoreWay * std::abs(start.duration), own = start.duration == 0 ? 0 : fastest(start);
  const auto margin_of = [&](int k) {
    // In an equilibrium: elements that a load step may bring into contact.
    if (start.duration == 0) return 4 * largest_radius_ + cloud.reach;
    double speed = 0;
    for (int i = 0; i <= line().order; ++i)
      speed = std::max(speed, start.velocities[line().elements[k][i]].head<3>().norm());
    return (1 + kNear) * largest_radius_ + way * (own + kLebesgue * speed);
  };
  std::array<std::pair<double, int>, kMostNear> near;  // {distance, element}, nearest first
  int found = 0;
  for_each_near(cloud, places, margin_of, [&](int k, double margin) {
    const double distance = std::sqrt(closest_point(piece(k, places), cloud.middle, -1, 1).square);
    double beyond = distance - cloud.reach - margin;
    if (beyond > 0) return;
    if (start.duration == 0) beyond = least_gap(k, places);  // what touches acts, even if more elements are near
    if (found == most_near_ && beyond >= near[found - 1].first) return;
    if (start.duration != 0 && !is_any_near(k, margin - largest_radius_, places)) return;
    if (found < most_near_) ++found;
    int at = found - 1;
    for (; at > 0 && near[at - 1].first > beyond; --at) near[at] = near[at - 1];
    near[at] = {beyond, k};
  });
  if (found == 0) return 0;
  int count = 0;
  const auto add = [&](int node) {
    if (std::find(nodes, nodes + count, node) == nodes + count) nodes[count++] = node;
  };
  std::for_each_n(side().nodes.begin(), moving_nodes(), add);
  for (int i = 0; i < found; ++i) std::for_each_n(line().elements[near[i].second].begin(), line().order + 1, add);
  return count;
}

ForceRoom LineSearch::room(const ForceStart& start) const {
  const NodePlaces places(start.poses);
  const Cloud cloud = this->cloud(places);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < line().elements.size(); ++k) {
    const double distance = (places.position(line().elements[k][line().order / 2]) - cloud.middle).norm();
    least = std::min(least, distance - kLonger * line().lengths[k]);
  }
  // The cloud and the line move, and the distance between two nodes of the cloud changes by the motions of both.
  return {least - cloud.reach - (1 + kNear) * largest_radius_, 2 + 2 * kLebesgue, 2 * largest_arm_};
}

double LineSearch::way(const ForceStep& step) const {
  const auto moved = [&](int node) { return (step.end[node].position - step.begin[node].position).norm(); };
  double own = 0, way = -1;
  if (is_body()) {
    const NodePose &begin = step.begin[side().nodes[0]], &end = step.end[side().nodes[0]];
    own = moved(side().nodes[0]) + (end.rotation - begin.rotation).norm() * largest_arm_;
  } else {
    for (int i = 0; i < moving_nodes(); ++i) own = std::max(own, kLebesgue * moved(side().nodes[i]));
  }
  const auto margin_of = [&](int k) {
    double most = 0;
    for (int i = 0; i <= line().order; ++i) most = std::max(most, moved(line().elements[k][i]));
    return largest_radius_ + own + kLebesgue * most;
  };
  const NodePlaces places(step.begin);
  for_each_near(cloud(places), places, margin_of, [&](int k, double margin) {
    const double most = margin - largest_radius_;
    if (most > way && is_any_near(k, most, places)) way = most;
  });
  return way;
}

bool LineSearch::passes_through(std::size_t index, const ClosestPoint& begin, const ClosestPoint& end, double way,
                                const ForceStep& step) const {
  const double radius = radius_of(pairs()[index]);
  double gone = std::sqrt(begin.square) - radius;
  if (gone + std::sqrt(end.square) - radius >= way) return false;
  const NodePlaces first(step.begin), last(step.end);
  const ContactStation& station = this->station(pairs()[index]);
  const Vector3 from = middle(station, first), to = middle(station, last);
  // The distance from a straight line is convex along the way. Its minimum is at an end, unless it first falls and then
  // rises.
  const auto change = [&](const ClosestPoint& place) {
    return Vector3(offset(to, place, last) - offset(from, place, first));
  };
  if (offset(from, begin, first).dot(change(begin)) >= 0 || offset(to, end, last).dot(change(end)) <= 0) return false;
  constexpr double kLeast = 1.0 / 64;  // smallest advance, relative to `way`
  while (gone < way) {
    const double part = gone / way;
    Middles middles;
    std::fill_n(middles.begin(), pairs().size(), Vector3(from + part * (to - from)));
    const ClosestPoint place = closest(middles, way, NodePlaces(step.begin, step.end, part), {})[index];
    const double gap = place.element < 0 ? way : std::sqrt(place.square) - radius;
    if (gap < -kGraze * radius) return true;
    gone += std::max(gap, kLeast * way);
  }
  return false;
}

}  // namespace flexarm
