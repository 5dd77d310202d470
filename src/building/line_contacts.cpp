#include "building/line_contacts.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <memory>
#include <utility>

#include "math/pi.h"

namespace flexarm {
namespace {

/// Relative to the depth beyond which a contact gives way no further: at this depth crossed lines have the law's
/// stiffness.
constexpr double kCrossingDepth = 0.25;
/// Most intervals between the stations along an element. With two parts of the line for each station, there are as many
/// pairs as may touch.
constexpr int kMostLineSpans = LineSearch::kMostPairs / 2 - 1;

ContactLine line_of(const Model& model, const ScenePlan& plan, int link) {
  const BeamLink& beam = *model.links[link].beam;
  ContactLine out;
  out.order = beam.order;
  out.radius = beam.radius;
  for (std::size_t k = 0; k < beam.elements.size(); ++k) {
    const auto& nodes = plan.meshes[link]->mesh.elements[k].nodes;
    std::array<int, 5> element{};
    std::transform(nodes.begin(), nodes.end(), element.begin(),
                   [&](int node) { return model.links[link].frame.node + node; });
    out.elements.push_back(element);
    out.lengths.push_back(beam.element_ends[k] - (k == 0 ? 0.0 : beam.element_ends[k - 1]));
  }
  return out;
}

/// Parts of a line without the elements that have this node.
std::vector<LineRange> ranges_without(const ContactLine& line, int node) {
  std::vector<LineRange> out;
  bool is_open = false;
  for (std::size_t k = 0; k < line.elements.size(); ++k) {
    const auto& nodes = line.elements[k];
    const bool has = std::find(nodes.begin(), nodes.begin() + line.order + 1, node) != nodes.begin() + line.order + 1;
    if (!has && !is_open) out.push_back({1.0 * k, 0});
    if (!has) out.back().end = k + 1.0;
    is_open = !has;
  }
  return out;
}

void place(const LinkPair& links, const LineTouch& touch, ContactLaw law, double crossing, const Model& model,
           ForceElementList& placed) {
  if (touch.pairs.empty()) return;
  allow_start(law, LineContact(links.names, touch, law, crossing).deepest(model.nodes));
  placed.push_back(std::make_shared<LineContact>(links.names, touch, law, crossing, links.is_reversed));
}

/// Parameter of a beam's line at an arc length: element + (xi + 1) / 2.
double parameter_at(const BeamLink& beam, double arc_length) {
  const ElementPlace at = element_at(beam, std::clamp(arc_length, 0.0, beam.length));
  return at.element + 0.5 * (at.xi + 1);
}

/// Parts of its own line that a station at an arc length may touch. If a tube bends no more tightly than its radius, it
/// can only touch itself after half a circle, which is pi times the radius away. The two ends of a ring are near to
/// each other, too.
std::vector<LineRange> own_ranges(const BeamLink& beam, double arc_length, bool is_ring) {
  const double apart = kPi * beam.radius, low = is_ring ? arc_length + apart - beam.length : 0.0;
  const double high = is_ring ? arc_length - apart + beam.length : beam.length;
  std::vector<LineRange> out;
  if (arc_length - apart > std::max(low, 0.0))
    out.push_back({parameter_at(beam, low), parameter_at(beam, arc_length - apart)});
  if (arc_length + apart < std::min(high, beam.length))
    out.push_back({parameter_at(beam, arc_length + apart), parameter_at(beam, high)});
  return out;
}

/// Adds contacts of the stations of one beam with the line of another one, or with its own.
void join_stations_to_line(const Model& model, const ScenePlan& plan, const LinkPair& links, const ContactLaw& law,
                           ForceElementList& placed) {
  const auto& [first, second, names, is_reversed] = links;
  const BeamLink& beam = *model.links[first].beam;
  const ContactLine own = line_of(model, plan, first);
  LineTouch touch;
  touch.line = line_of(model, plan, second);
  const double depth = kCrossingDepth * law.depth, half = std::sqrt(2 * (own.radius + touch.line.radius) * depth);
  const auto place_of = [&](int node) { return model.nodes[node].position; };
  const Vector3 gap = place_of(own.elements.back()[own.order]) - place_of(own.elements.front()[0]);
  const bool is_self = first == second, is_ring = gap.norm() < own.radius;
  double begin = 0;
  for (std::size_t k = 0; k < own.elements.size(); ++k) {
    const double length = own.lengths[k];
    // Stations are so near to each other that several of them touch where lines cross.
    const int spans = std::min(static_cast<int>(std::ceil(length / (0.5 * half))), kMostLineSpans);
    touch.side = {{own.elements[k].begin(), own.elements[k].begin() + own.order + 1}, {}};
    touch.pairs.clear();
    touch.spacing = length / spans;
    const int at_once = std::max(static_cast<int>(LineSearch::most_size(touch.line) / touch.spacing), 1);
    for (int i = 0; i <= spans; ++i) {
      const LineWeights weights = line_weights(own.order, -1 + 2.0 * i / spans);
      ContactStation station;
      station.weights = weights.values;
      station.radius = own.radius;
      station.share = (i == 0 || i == spans ? 0.5 : 1.0) * touch.spacing / beam.length;
      touch.side.stations.push_back(station);
      const double at = begin + i * touch.spacing;
      for (const LineRange& range : is_self ? own_ranges(beam, at, is_ring) : std::vector<LineRange>{{}})
        touch.pairs.push_back({i, range, weights.slopes});
    }
    begin += length;
    // Where lines cross, the stations together have the law's stiffness, at that depth. (docs/notes/contact.md 6)
    const double crossing = 15.0 / 16 * beam.length / half;
    const std::vector<LinePair> pairs = std::move(touch.pairs);
    for (int first = 0; first <= spans; first += at_once) {
      touch.pairs.clear();
      std::copy_if(pairs.begin(), pairs.end(), std::back_inserter(touch.pairs),
                   [&](const LinePair& pair) { return pair.station >= first && pair.station < first + at_once; });
      place(links, touch, law, crossing, model, placed);
    }
  }
}

/// Divides the stations of a body into groups of at most this size [m].
std::vector<std::vector<int>> groups_of(const ContactStations& body, double size) {
  Vector3 least = body.stations[0].arm, most = least;
  for (const ContactStation& station : body.stations) {
    least = least.cwiseMin(station.arm);
    most = most.cwiseMax(station.arm);
  }
  const bool is_one = (most - least).norm() <= size;
  std::map<std::array<double, 3>, std::vector<int>> cells;  // cubes whose diagonals have that size
  for (std::size_t i = 0; i < body.stations.size(); ++i) {
    std::array<double, 3> cell{};
    for (int k = 0; k < 3 && !is_one; ++k)
      cell[k] = std::floor(std::sqrt(3.0) / size * (body.stations[i].arm[k] - least[k]));
    cells[cell].push_back(static_cast<int>(i));
  }
  std::vector<std::vector<int>> groups;
  groups.reserve(cells.size());
  for (auto& [cell, stations] : cells) groups.push_back(std::move(stations));
  return groups;
}

}  // namespace

bool touches_line(double ball_radius, const BeamLink& beam) {
  return ball_radius * static_cast<double>(beam.elements.size()) < beam.length;
}

bool has_room_for_corners(const BeamLink& beam, int most_spans) {
  double longest = 0;
  for (std::size_t k = 0; k < beam.elements.size(); ++k)
    longest = std::max(longest, beam.element_ends[k] - (k == 0 ? 0.0 : beam.element_ends[k - 1]));
  return longest > most_spans * beam.radius;
}

void join_with_line(const Model& model, const ScenePlan& plan, const LinkPair& links,
                    const std::vector<ContactStations>& bodies, const ContactLaw& law, ForceElementList& placed) {
  LineTouch touch;
  touch.line = line_of(model, plan, links.second);
  for (const ContactStations& body : bodies) {
    const std::vector<LineRange> ranges = ranges_without(touch.line, body.nodes[0]);
    touch.side = body;
    for (const std::vector<int>& group : groups_of(body, LineSearch::most_size(touch.line))) {
      for (const int station : group) {
        if (touch.pairs.size() + ranges.size() > LineSearch::kMostPairs) {
          place(links, touch, law, 0, model, placed);
          touch.pairs.clear();
        }
        for (const LineRange& range : ranges) touch.pairs.push_back({station, range, {}});
      }
      place(links, touch, law, 0, model, placed);
      touch.pairs.clear();
    }
  }
}

void join_lines(const Model& model, const ScenePlan& plan, const LinkPair& links, const ContactLaw& law,
                ForceElementList& placed) {
  ContactLaw half = law;  // for each direction
  half.stiffness *= 0.5;
  half.grip *= 0.5;
  join_stations_to_line(model, plan, links, half, placed);
  const LinkPair back{links.second, links.first, links.names, !links.is_reversed};
  if (links.first != links.second) join_stations_to_line(model, plan, back, half, placed);
}

}  // namespace flexarm
