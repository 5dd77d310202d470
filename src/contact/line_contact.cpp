#include "contact/line_contact.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "joints/penetration.h"
#include "math/cayley.h"
#include "model/state.h"

namespace flexarm {
namespace {

LineMemory line_memory_at(const double* numbers) {
  return {numbers[0], Eigen::Map<const Vector3>(numbers + 1), numbers[4], numbers[5], numbers[6]};
}
void put(const LineMemory& memory, double* numbers) {
  numbers[0] = memory.speed;
  Eigen::Map<Vector3>(numbers + 1) = memory.stretch;
  numbers[4] = memory.stiffening;
  numbers[5] = memory.start;
  numbers[6] = memory.root;
}

}  // namespace

LineContact::LineContact(std::vector<std::string> links, LineTouch touch, const ContactLaw& law, double crossing,
                         bool is_reversed)
    : ForceElement("", LineSearch(touch).reach()),
      links_(std::move(links)),
      search_(std::move(touch)),
      law_(law),
      crossing_(crossing),
      is_reversed_(is_reversed) {}

ContactLaw LineContact::law_of(const LinePair& pair, double stiffening) const {
  ContactLaw law = law_;
  const double share = search_.station(pair).share * (stiffening > 0 ? stiffening : 1.0);
  law.stiffness *= share;
  law.grip *= share;
  return law;
}

double LineContact::stiffening(const LinePair& pair, const ClosestPoint& place, const NodePlaces& places) const {
  if (crossing_ == 0) return 1;
  const std::vector<int>& nodes = search_.side().nodes;
  Vector3 own = Vector3::Zero();
  for (std::size_t i = 0; i < nodes.size(); ++i) own += pair.tangent[i] * places.position(nodes[i]);
  const ElementWeights slopes = line_weights(search_.line().order, place.xi).slopes;
  const Vector3 other = search_.sum(slopes, place.element, [&](int node) { return places.position(node); });
  const double size = own.norm() * other.norm(), sine = size > 0 ? own.cross(other).norm() / size : 0.0;
  return std::hypot(1.0, crossing_ * sine);
}

/// What a solved step does to one pair.
struct LineContact::Passage {
  std::size_t index;
  const ClosestPoint &begin, &end;  ///< nearest places
  Vector3 before, behind;           ///< from there to the station's middle [m]
  ContactChange change;
  double begin_rate;  ///< of the penetration [m/s]
};

/// Calls visit(passage, bound of the relative motion) for all pairs that are near at both ends of a solved step, until
/// it returns false.
template <class Visit>
void LineContact::for_each_passage(const ForceStep& step, const Visit& visit) const {
  const double way = search_.way(step);
  if (way < 0) return;  // nothing can have touched
  const NodePlaces first(step.begin), last(step.end);
  const LineSearch::Middles from = search_.middles(first), to = search_.middles(last);
  const LineSearch::Places begin = search_.closest(from, way, first, {}), end = search_.closest(to, way, last, {});
  for (std::size_t k = 0; k < search_.pairs().size(); ++k) {
    if (begin[k].element < 0 || end[k].element < 0) continue;
    const LinePair& pair = search_.pairs()[k];
    const double radius = search_.radius_of(pair);
    const Vector3 before = search_.offset(from[k], begin[k], first), behind = search_.offset(to[k], end[k], last);
    const double* memory = step.memory + LineMemory::kSize * k;
    const double start = line_memory_at(memory).start;
    Passage passage{k, begin[k], end[k], before, behind, {}, 0};
    passage.change = {radius - start - before.norm(), radius - let_out(law_, start, step.duration) - behind.norm(),
                      std::abs(step.duration)};
    if (passage.change.begin > 0 || passage.change.end > 0) {
      passage.begin_rate = rate(pair, begin[k], first, step.velocities) + let_out_rate(law_, start);
      passage.change.speed = approach_speed(passage.change.begin, passage.begin_rate, *memory);
    }
    if (!visit(passage, way)) return;
  }
}

bool LineContact::needs_halves(const ForceStep& step, const int* nodes, int count) const {
  if (step.duration == 0) return false;
  const ListedNodes listed{nodes, count};
  const auto is_too_long = [&](const Passage& passage, double way) {
    const ContactChange& change = passage.change;
    if (change.begin <= 0 && change.end <= 0)
      return search_.passes_through(passage.index, passage.begin, passage.end, way, step);
    const bool is_seen = count > 0 && (change.begin <= 0 || search_.is_listed(passage.begin.element, listed)) &&
                         (change.end <= 0 || search_.is_listed(passage.end.element, listed));
    return !is_seen ||
           passage.before.dot(passage.behind) < kOtherSide * passage.before.norm() * passage.behind.norm() ||
           is_coarse_hit(law_, change, passage.begin_rate, step.refinement);
  };
  bool found = false;
  for_each_passage(step, [&](const Passage& passage, double way) { return !(found = is_too_long(passage, way)); });
  return found;
}

void LineContact::put_penetrations(const ForceStep& step, const int*, int, const PenetrationTaker& take) const {
  if (step.duration == 0) return;
  for_each_passage(step, [&](const Passage& passage, double) {
    const ContactChange& change = passage.change;
    if (change.begin > 0 || change.end > 0) take(change.begin, change.end, passage.begin_rate);
    return true;
  });
}

// ---------------------------------------------------------------- forces

Vector3 LineContact::velocity(const LinePair& pair, const LineWeights& weights, int element, const NodePlaces& places,
                              const std::vector<Vector6>& velocities) const {
  const ContactStation& station = search_.station(pair);
  const auto linear = [&](int node) { return Vector3(velocities[node].head<3>()); };
  Vector3 out = -search_.sum(weights.values, element, linear);
  for (int i = 0; i < search_.moving_nodes(); ++i) {
    const int node = search_.side().nodes[i];
    out += station.weights[i] * linear(node);
    if (search_.is_body()) out += velocities[node].tail<3>().cross(places.rotation(node) * station.arm);
  }
  return out;
}

/// Rate of the penetration [m/s].
double LineContact::rate(const LinePair& pair, const ClosestPoint& place, const NodePlaces& places,
                         const std::vector<Vector6>& velocities) const {
  const Vector3 offset = search_.offset(search_.middle(search_.station(pair), places), place, places);
  const LineWeights weights = line_weights(search_.line().order, place.xi);
  const double distance = offset.norm();
  return distance > 0 ? -offset.dot(velocity(pair, weights, place.element, places, velocities)) / distance : 0.0;
}

/// Predicts xi of the nearest place in the middle of the step, from its speed along the line at the beginning.
double LineContact::foreseen(const LinePair& pair, const ClosestPoint& begin, const ForceStep& step) const {
  if (begin.is_clamped || step.duration == 0) return begin.xi;
  const NodePlaces places(step.begin);
  const auto position = [&](int node) { return places.position(node); };
  const auto linear = [&](int node) { return Vector3(step.velocities[node].head<3>()); };
  const LineWeights weights = line_weights(search_.line().order, begin.xi);
  const Vector3 offset = search_.offset(search_.middle(search_.station(pair), places), begin, places);
  const Vector3 tangent = search_.sum(weights.slopes, begin.element, position);
  const double rise = tangent.squaredNorm() - offset.dot(search_.sum(weights.curvatures, begin.element, position));
  const double drive = velocity(pair, weights, begin.element, places, step.velocities).dot(tangent) +
                       offset.dot(search_.sum(weights.slopes, begin.element, linear));
  if (!(rise > 0)) return begin.xi;
  const double way = std::clamp(0.5 * step.duration * drive / rise, -0.5, 0.5);
  return std::clamp(begin.xi + way, -1.0, 1.0);
}

LineActing LineContact::acting(std::size_t index, const ClosestPoint& begin, const ClosestPoint& end,
                               const ForceStep& step, const ListedNodes& listed, bool with_slope) const {
  const LinePair& pair = search_.pairs()[index];
  const ContactStation& station = search_.station(pair);
  const int order = search_.line().order;
  const NodePlaces first(step.begin), last(step.end);
  const auto begin_of = [&](int node) { return first.position(node); };
  const auto end_of = [&](int node) { return last.position(node); };
  const auto turn_of = [&](int node) {
    return cayley::increment(step.begin[node].orientation, step.end[node].orientation);
  };
  const auto at = [&](int node) {
    return static_cast<int>(std::find(listed.nodes, listed.nodes + listed.count, node) - listed.nodes);
  };
  const Vector3 from = search_.middle(station, first), to = search_.middle(station, last);
  const ElementWeights weights = line_weights(order, foreseen(pair, begin, step)).values;
  const LineWeights at_end = line_weights(order, end.xi);
  LineMotion motion;
  motion.begin = from - search_.sum(weights, begin.element, begin_of);
  motion.end = to - search_.sum(weights, begin.element, end_of);
  motion.begin_distance = std::sqrt(begin.square);
  motion.end_distance = std::sqrt(end.square);
  motion.turn = Vector3::Zero();
  motion.line_turn = search_.sum(weights, begin.element, turn_of);
  motion.duration = step.duration;
  motion.at_end = step.at_end;
  if (step.duration != 0) motion.begin_rate = rate(pair, begin, first, step.velocities);
  LineActing out;
  for (int i = 0; i < search_.moving_nodes(); ++i) {
    const int node = search_.side().nodes[i];
    out.node(at(node)).side = station.weights[i];
    motion.turn += station.weights[i] * turn_of(node);
  }
  for (int i = 0; i <= order; ++i) {
    out.node(at(search_.line().elements[begin.element][i])).line = weights[i];
    LineActing::Node& node = out.node(at(search_.line().elements[end.element][i]));
    node.nearest = at_end.values[i];
    node.slope = at_end.slopes[i];
  }
  out.weight = step.at_end ? 1 : 0.5;
  if (search_.is_body()) {
    const int node = search_.side().nodes[0];
    out.body = 0;
    out.end_arm = step.end[node].rotation * station.arm;
    out.arm = out.weight * out.end_arm + (1 - out.weight) * (step.begin[node].rotation * station.arm);
  }
  out.middle = out.weight * motion.end + (1 - out.weight) * motion.begin;
  out.nearest = to - search_.sum(at_end.values, end.element, end_of);
  out.tangent = search_.sum(at_end.slopes, end.element, end_of);
  out.rise = out.tangent.squaredNorm() - out.nearest.dot(search_.sum(at_end.curvatures, end.element, end_of));
  if (end.is_clamped || !(out.rise > 0)) out.rise = 0;
  LineMemory old = line_memory_at(step.memory + LineMemory::kSize * index);
  if (old.stiffening == 0) old.stiffening = stiffening(pair, begin, first);
  out.local =
      line_action(law_of(pair, old.stiffening), {station.radius, search_.radius_of(pair)}, motion, old, with_slope);
  if (!with_slope) return out;
  for (int i = 0; i < out.count; ++i)
    out.nodes[i].by_spin = cayley::inverse_tangent(turn_of(listed.nodes[out.nodes[i].at]));
  return out;
}

void LineContact::evaluate(const ForceStep& step, const int* nodes, ForceAction& action) const {
  std::fill(step.new_memory, step.new_memory + memory_size(), 0.0);
  action.residual.setZero();
  action.tangent.setZero();
  const std::size_t count = search_.pairs().size();
  const auto let_go = [&](std::size_t k) {
    const LineMemory old = line_memory_at(step.memory + LineMemory::kSize * k);
    if (old.stretch.isZero(0)) return;
    action.dissipated += 0.5 * law_of(search_.pairs()[k], old.stiffening).grip * old.stretch.squaredNorm();
  };
  const ListedNodes listed{nodes, static_cast<int>(action.residual.size() / 6)};
  if (listed.count == 0) {  // no nodes are near
    for (std::size_t k = 0; k < count; ++k) let_go(k);
    return;
  }
  const NodePlaces first(step.begin), last(step.end);
  const LineSearch::Middles from = search_.middles(first), to = search_.middles(last);
  LineSearch::Places begin = search_.closest(from, 0, first, listed), end = search_.closest(to, 0, last, listed);
  LineSearch::Chosen does_touch{};
  bool any = false;
  for (std::size_t k = 0; k < count; ++k) any = (does_touch[k] = begin[k].element >= 0 || end[k].element >= 0) || any;
  if (any) {
    constexpr double kAnywhere = std::numeric_limits<double>::infinity();
    begin = search_.closest(from, kAnywhere, first, listed, &does_touch);
    end = search_.closest(to, kAnywhere, last, listed, &does_touch);
  }
  const bool with_slope = action.tangent.size() > 0;
  for (std::size_t k = 0; k < count; ++k) {
    if (!does_touch[k]) {
      let_go(k);
      continue;
    }
    if (begin[k].element < 0 || end[k].element < 0) {  // some pose is not finite
      action.residual.setConstant(std::numeric_limits<double>::quiet_NaN());
      return;
    }
    const LineActing acting = this->acting(k, begin[k], end[k], step, listed, with_slope);
    action.dissipated += acting.local.dissipated;
    action.work += acting.local.work;
    put(acting.local.memory, step.new_memory + LineMemory::kSize * k);
    if (!acting.local.acts) continue;
    acting.add_to(action);
    if (step.at_end) acting.add_push_to(action);
  }
}

// ---------------------------------------------------------------- energies, small motions

double LineContact::energy(const State& state, const double* memory) const {
  const NodePlaces now(state);
  const LineSearch::Places places = search_.closest(search_.middles(now), 0, now, {});
  double energy = 0;
  for (std::size_t k = 0; k < search_.pairs().size(); ++k, memory += LineMemory::kSize) {
    const LinePair& pair = search_.pairs()[k];
    LineMemory old = line_memory_at(memory);
    if (old.stiffening == 0 && places[k].element >= 0) old.stiffening = stiffening(pair, places[k], now);
    const ContactLaw law = law_of(pair, old.stiffening);
    energy += 0.5 * law.grip * old.stretch.squaredNorm();
    if (places[k].element >= 0)
      energy += contact_energy(law, search_.radius_of(pair) - old.start - std::sqrt(places[k].square));
  }
  return energy;
}

std::vector<int> LineContact::nodes_at(const State& state) const {
  std::vector<NodePose> poses;
  poses.reserve(state.nodes.size());
  for (const NodeState& node : state.nodes) poses.push_back(node_pose(node));
  std::vector<int> nodes(most_nodes());
  nodes.resize(find_nodes({poses, {}}, nodes.data()));
  return nodes;
}

template <class Visit>
void LineContact::for_each_touching(const NodePlaces& now, const ListedNodes& listed, const Visit& visit) const {
  const LineSearch::Middles middles = search_.middles(now);
  const LineSearch::Places places = search_.closest(middles, 0, now, listed);
  for (std::size_t k = 0; k < search_.pairs().size(); ++k)
    if (places[k].element >= 0) visit(search_.pairs()[k], places[k], search_.offset(middles[k], places[k], now));
}

void LineContact::start(const State& state, const double*, double* memory) const {
  const NodePlaces now(state);
  const LineSearch::Places places = search_.closest(search_.middles(now), 0, now, {});
  for (std::size_t k = 0; k < search_.pairs().size(); ++k, memory += LineMemory::kSize) {
    if (places[k].element < 0) continue;
    const double inside = search_.radius_of(search_.pairs()[k]) - std::sqrt(places[k].square);
    if (inside > std::max(law_.most_start, kLeastStart)) put({0, Vector3::Zero(), 0, inside}, memory);
  }
}

double LineContact::deepest(const std::vector<NodePose>& poses) const {
  double deepest = 0;
  for_each_touching(NodePlaces(poses), {}, [&](const LinePair& pair, const ClosestPoint&, const Vector3& offset) {
    deepest = std::max(deepest, search_.radius_of(pair) - offset.norm());
  });
  return deepest;
}

double LineContact::touch(const ForceMotion& motion, const TouchingPointTaker& take) const {
  constexpr double kAnywhere = std::numeric_limits<double>::infinity();
  const NodePlaces now(motion.state);
  const LineSearch::Middles middles = search_.middles(now);
  const LineSearch::Places places = search_.closest(middles, kAnywhere, now, {});
  const double sign = is_reversed_ ? -1 : 1;
  double least = kAnywhere;
  for (std::size_t k = 0; k < search_.pairs().size(); ++k) {
    if (places[k].element < 0) continue;
    const LinePair& pair = search_.pairs()[k];
    const double distance = std::sqrt(places[k].square), gap = distance - search_.radius_of(pair);
    least = std::min(least, gap);
    if (gap >= 0 || distance == 0) continue;
    LineMemory old = line_memory_at(motion.memory + LineMemory::kSize * k);
    if (old.stiffening == 0) old.stiffening = stiffening(pair, places[k], now);
    const ContactLaw law = law_of(pair, old.stiffening);
    const Vector3 normal = search_.offset(middles[k], places[k], now) / distance;  // from the line to the station
    const double rate = this->rate(pair, places[k], now, motion.velocities) + let_out_rate(law, old.start);
    const double felt = std::max(0.0, -gap - old.start);
    const double push = push_at(law, felt, rate, approach_speed(felt, rate, old.speed));
    TouchingPoint point;
    point.position = middles[k] - search_.station(pair).radius * normal;
    point.normal = sign * normal;
    point.push = push * point.normal;
    point.friction.setZero();
    const double root = old.root > 0 ? old.root : 1;
    if (law.friction > 0)
      point.friction = -sign * law.grip * contact_grip(law, old.stretch, Vector3::Zero(), normal, push, root).pull;
    point.gap = gap;
    take(point);
  }
  return least;
}

ForceMeasures LineContact::measures(const State& state, const double*, const int*) const {
  const NodePlaces now(state);
  const std::vector<int> nodes = nodes_at(state);
  const int count = static_cast<int>(nodes.size());
  const ListedNodes listed{nodes.data(), count};
  const int each = law_.friction > 0 ? 3 : 1;
  Eigen::Index rows = 0;
  for_each_touching(now, listed, [&](const LinePair&, const ClosestPoint&, const Vector3&) { rows += each; });
  ForceMeasures out{Eigen::MatrixXd::Zero(rows, 6 * count), Eigen::MatrixXd::Zero(rows, rows)};
  const auto add = [&](Eigen::Index row, int node, double weight, const Vector3& axis, const Vector3& arm) {
    const Eigen::Index column = 6 * (std::find(nodes.begin(), nodes.end(), node) - nodes.begin());
    assert(column < out.rows.cols());
    out.rows.block<1, 3>(row, column) += weight * axis.transpose();
    out.rows.block<1, 3>(row, column + 3) += weight * arm.cross(axis).transpose();
  };
  Eigen::Index row = 0;
  for_each_touching(now, listed, [&](const LinePair& pair, const ClosestPoint& place, const Vector3& offset) {
    const ContactStation& station = search_.station(pair);
    const ContactLaw law = law_of(pair, stiffening(pair, place, now));
    const ElementWeights weights = line_weights(search_.line().order, place.xi).values;
    const Vector3 normal = offset / std::max(offset.norm(), 1e-300), across = normal.unitOrthogonal();
    const Vector3 axes[] = {normal, across, normal.cross(across)};
    for (int k = 0; k < each; ++k, ++row) {
      // Friction acts at the surface, which is below the station's middle by the radius.
      const Vector3 below = k == 0 ? Vector3(Vector3::Zero()) : Vector3(-station.radius * normal);
      for (int i = 0; i < search_.moving_nodes(); ++i) {
        const int node = search_.side().nodes[i];
        const Vector3 arm = search_.is_body() ? Vector3(now.rotation(node) * station.arm) : Vector3(Vector3::Zero());
        add(row, node, station.weights[i], axes[k], arm + below);
      }
      for (int i = 0; i <= search_.line().order; ++i)
        add(row, search_.line().elements[place.element][i], -weights[i], axes[k], offset + below);
      out.stiffness(row, row) =
          k == 0 ? contact_push(law, {0, search_.radius_of(pair) - offset.norm(), 0}).slope : law.grip;
    }
  });
  return out;
}

DamperTensions LineContact::dampers(const State& state, const double*, const Eigen::VectorXd& rates) const {
  const NodePlaces now(state);
  const std::vector<int> nodes = nodes_at(state);
  const ListedNodes listed{nodes.data(), static_cast<int>(nodes.size())};
  const int each = law_.friction > 0 ? 3 : 1;
  Eigen::VectorXd slopes = Eigen::VectorXd::Zero(rates.size());
  Eigen::Index row = 0;
  for_each_touching(now, listed, [&](const LinePair& pair, const ClosestPoint& place, const Vector3& offset) {
    // The damping for slow motions, see contact_push().
    const double rise = hardened({search_.radius_of(pair) - offset.norm(), law_.depth}).slope;
    slopes[row] = 2 * law_of(pair, stiffening(pair, place, now)).stiffness * law_.restitution.damping_of_slow_hits() /
                  law_.frequency * rise;
    row += each;
  });
  return {slopes.cwiseProduct(rates), slopes.asDiagonal()};
}

}  // namespace flexarm
