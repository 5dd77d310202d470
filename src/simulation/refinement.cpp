#include "simulation/refinement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "building/beam_mesh.h"
#include "elements/halved_beam.h"
#include "flexarm/model/model_error.h"
#include "scene/flexible_link.h"

namespace flexarm {
namespace {

constexpr int kOrder = 2;
/// An element is halved if it is bent by more than this part of the angle that elements="auto" allows for an undeformed
/// line. The error of end values is of the fourth power of the angle, so it falls from 1 % to 0.06 %.
constexpr double kBent = 0.5;
/// Shortest element that is halved, relative to the section's radius: no element gets shorter than the section is wide,
/// since it would not be a beam any more.
constexpr double kShortest = 4;
/// Two halves are joined if together they are bent by less than this part. Then an element that was just halved is far
/// from being joined, and the reverse.
constexpr double kStraight = 0.125;
/// Largest change of energy when halves are joined, relative to kinetic and strain energy.
constexpr double kSmallChange = 1e-4;

const BeamElement<kOrder + 1>& element(const Model& model, const BeamLink& beam, std::size_t index) {
  return std::get<BeamGroup<kOrder + 1>>(model.beams).elements[beam.elements[index]];
}

/// How far the part of a beam from the beginning of an element to the end of it or of the next one is bent [rad].
double bending_between(const Model& model, const State& state, const BeamLink& beam, std::size_t first,
                       std::size_t last) {
  const auto &begin = element(model, beam, first).nodes, &end = element(model, beam, last).nodes;
  const std::array<int, 3> nodes = {begin[0], first == last ? begin[1] : end[0], end[2]};
  ThreeOrientations now, undeformed;
  for (int i = 0; i < 3; ++i) {
    now[i] = state.nodes[nodes[i]].orientation;
    undeformed[i] = model.nodes[nodes[i]].orientation;
  }
  return bending(now, undeformed);
}

/// Calls visit(link, beam) for all beams that are refined.
template <class Visit>
void for_each_refined(const Model& model, const Visit& visit) {
  for (std::size_t link = 0; link < model.links.size(); ++link)
    if (const auto& beam = model.links[link].beam; beam && beam->refines) visit(static_cast<int>(link), *beam);
}

/// Calls visit(link, beam, index of the element along the beam) for all elements that may be halved.
template <class Visit>
void for_each_divisible(const Model& model, const Visit& visit) {
  for_each_refined(model, [&](int link, const BeamLink& beam) {
    for (std::size_t k = 0; k < beam.elements.size(); ++k) {
      const double length = beam.element_ends[k] - (k == 0 ? 0.0 : beam.element_ends[k - 1]);
      if (beam.parts[k].part < 1 << kMostLevels && length >= kShortest * beam.radius) visit(link, beam, k);
    }
  });
}

[[noreturn]] void refuse_refinement(const scene::LinkDescription& link, const std::string& why) {
  const scene::SourceLocation& place = link.beam->location;
  throw ModelError(fmt::format("{}:{}: <beam> of link '{}': {}", place.file, place.line, link.name, why));
}

bool is_refined(const scene::LinkDescription& link) {
  return link.beam && link.beam->refine.value_or(false);
}

/// Whether the scheme keeps nothing at integration points but what can be extended over a half.
bool can_refine(const Scheme& scheme) {
  return !scheme.tableau && scheme.is_incremental() && scheme.nodal_rotary_inertia &&
         scheme.interpolation == Interpolation::Local;
}

/// Why the elements of a beam cannot be halved in a simulation of the scene; empty if they can.
std::string obstacle_to_halving(const scene::SceneDescription& scene, const scene::LinkDescription& link,
                                const Scheme& scheme, const Model& model) {
  if (!can_refine(scheme))
    return fmt::format(
        "scheme '{}' has no <beam refine=\"true\">, expected one of the energy-momentum family: em, em0, em_symmetric, "
        "em4, edmc1, edmc2",
        scheme.name);
  for (const TouchingPair& pair : model.touching_pairs)
    if (pair.first == link.name || pair.second == link.name)
      return fmt::format(
          "refine=\"true\" is not possible for a beam that may touch something, here '{}' and '{}': its contact points "
          "belong to its elements. Expected refine=\"false\", or a <no_contact> of these two",
          pair.first, pair.second);
  for (const scene::JointDescription& joint : scene.joints)
    if (joint.slide && joint.parent == link.name && !scene.loop_joints.empty())
      return fmt::format(
          "refine=\"true\" moves what slides there (joint '{}') a little, which would open loops: expected "
          "refine=\"false\" in a scene with a <loop_joint>",
          joint.name);
  for (const scene::JointDescription& joint : scene.loop_joints)
    if (joint.slide && joint.parent == link.name)
      return fmt::format(
          "refine=\"true\" is not possible where the <loop_joint> '{}' slides, expected refine=\"false\"", joint.name);
  return "";
}

}  // namespace

bool refines(const Model& model) {
  return std::any_of(model.links.begin(), model.links.end(),
                     [](const LinkFrame& link) { return link.beam && link.beam->refines; });
}

Bending bending_of(const Model& model, const State& state) {
  double largest = 0;
  for_each_divisible(model, [&](int, const BeamLink& beam, std::size_t k) {
    largest = std::max(largest, bending_between(model, state, beam, k, k));
  });
  const double most = turning_per_element(kOrder);
  return largest > most ? Bending::TooFar : largest > kBent * most ? Bending::Strong : Bending::Little;
}

std::vector<HalvedElement> with_bent_halved(const Model& model, const State& state) {
  std::vector<HalvedElement> halved = model.halved;
  for_each_divisible(model, [&](int link, const BeamLink& beam, std::size_t k) {
    if (bending_between(model, state, beam, k, k) > kBent * turning_per_element(kOrder))
      halved.push_back({link, beam.parts[k].element, beam.parts[k].part});
  });
  std::sort(halved.begin(), halved.end());
  return halved;
}

std::vector<HalvedElement> straight_elements(const Model& model, const State& state) {
  std::vector<std::pair<double, HalvedElement>> found;  // with the angles by which they are bent
  const auto has_wrench = [&](int node) {
    return std::any_of(state.wrenches.begin(), state.wrenches.end(),
                       [&](const NodalLoad& wrench) { return wrench.node == node; });
  };
  for_each_refined(model, [&](int link, const BeamLink& beam) {
    for (std::size_t k = 0; k + 1 < beam.elements.size(); ++k) {
      const ElementPart &first = beam.parts[k], &second = beam.parts[k + 1];
      const bool are_halves = first.element == second.element && first.part % 2 == 0 && second.part == first.part + 1;
      if (!are_halves) continue;
      const double angle = bending_between(model, state, beam, k, k + 1);
      if (angle > kStraight * turning_per_element(kOrder)) continue;
      if (has_wrench(element(model, beam, k).nodes[1]) || has_wrench(element(model, beam, k + 1).nodes[1])) continue;
      found.push_back({angle, {link, first.element, first.part / 2}});
    }
  });
  std::sort(found.begin(), found.end());
  std::vector<HalvedElement> elements;
  elements.reserve(found.size());
  for (const auto& one : found) elements.push_back(one.second);
  return elements;
}

bool is_small_change(const Energies& before, const Energies& after) {
  return std::abs(after.total() - before.total()) <= kSmallChange * (before.kinetic + before.strain);
}

void set_halved(const std::vector<HalvedElement>& halved, scene::SceneDescription& scene) {
  for (scene::LinkDescription& link : scene.links)
    if (link.beam) link.beam->halved.clear();
  for (const HalvedElement& one : halved) scene.links[one.link].beam->halved.push_back({one.element, one.part});
}

std::string halving_flaw(const Model& model, const std::vector<HalvedElement>& halved) {
  const std::set<HalvedElement> all(halved.begin(), halved.end());
  for (const HalvedElement& one : halved) {
    const bool is_link = one.link >= 0 && one.link < static_cast<int>(model.links.size()) &&
                         model.links[one.link].beam && model.links[one.link].beam->refines;
    const bool is_part = is_link && one.element >= 0 &&
                         one.element <= model.links[one.link].beam->parts.back().element && one.part >= 1 &&
                         one.part < 1 << kMostLevels;
    if (!is_part || (one.part > 1 && all.count({one.link, one.element, one.part / 2}) == 0))
      return fmt::format("part {} of element {} of link {} is halved, expected parts of beams with refine=\"true\"",
                         one.part, one.element, one.link);
  }
  if (all.size() != halved.size() || !std::is_sorted(halved.begin(), halved.end()))
    return "the halved parts are not in ascending order";
  return "";
}

void require_suitable_refinement(const scene::SceneDescription& scene, const Scheme& scheme, const Model& model) {
  for (const scene::LinkDescription& link : scene.links) {
    if (!is_refined(link)) continue;
    if (const std::string obstacle = obstacle_to_halving(scene, link, scheme, model); !obstacle.empty())
      refuse_refinement(link, obstacle);
  }
}

void refine_where_possible(const Scheme& scheme, const Model& model, scene::SceneDescription& scene) {
  for (scene::LinkDescription& link : scene.links) {
    const bool is_open = scene::is_flexible(link) && link.beam->order == kOrder && !link.beam->refine;
    if (is_open && obstacle_to_halving(scene, link, scheme, model).empty()) link.beam->refine = true;
  }
}

void require_constant_mesh(const scene::SceneDescription& scene, const std::string& what) {
  for (const scene::LinkDescription& link : scene.links)
    if (is_refined(link))
      refuse_refinement(link, "refine=\"true\" changes the mesh while it moves, which " + what +
                                  " cannot take along: expected refine=\"false\"");
}

}  // namespace flexarm
