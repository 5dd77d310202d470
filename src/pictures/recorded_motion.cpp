#include "pictures/recorded_motion.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "flexarm/scene/scene_description.h"
#include "flexarm/simulation/result_columns.h"
#include "model/carried_origin.h"
#include "scene/joint_kinds.h"
#include "simulation/inside.h"

namespace flexarm::pictures {
namespace {

bool is_known(const Pose& pose) {
  return pose.position.allFinite() && pose.orientation.coeffs().allFinite();
}

}  // namespace

RecordedMotion::RecordedMotion(const Simulation& simulation, const RecordedColumns& columns)
    : columns_(columns), moved_(simulation.copy()), shown_(simulation.copy()) {
  for (const std::string& name : moved_.coordinate_names()) {
    positions_.push_back(columns.find("joint/" + name + "/position"));
    has_positions_ = has_positions_ || positions_.back();
  }
  for (std::size_t i = 0; i < moved_.link_names().size(); ++i) add_link(i);
  is_exact_ = has_all_frames_ && std::all_of(links_.begin(), links_.end(), [&](const Link& link) {
                return link.beam.sections.empty() || !link.sections.empty();
              });
}

void RecordedMotion::add_link(std::size_t index) {
  const std::string& name = moved_.link_names()[index];
  Link& link = links_.emplace_back();
  link.frame = columns_.find_pose("frame/" + name + "/");
  const Attachment& frame = model_of(moved_).links[index].frame;
  if (link.frame)
    has_frames_ = true;
  else if (frame.node >= 0)
    has_all_frames_ = false;
  if (moved_.is_flexible(index))
    add_beam(index, link);
  else if (frame.node >= 0)
    link.nodes.push_back({frame.node, frame.offset.inverse()});
}

void RecordedMotion::add_beam(std::size_t index, Link& link) {
  const std::string& name = moved_.link_names()[index];
  link.tip = columns_.find_pose("frame/" + name + "/tip/");
  std::vector<BeamPoint> points;
  moved_.beam_points(index, 0, points);
  const Model& model = model_of(moved_);
  const State& state = state_of(moved_);
  const Vector3 origin = world_origin(model, state);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const int node = model.links[index].frame.node + static_cast<int>(k);
    const Pose pose{origin + state.nodes[node].position, state.nodes[node].orientation};
    link.nodes.push_back({node, points[k].pose.inverse() * pose});
    for (const ResultColumn& part : section_columns())
      if (const auto column = columns_.find(fmt::format("beam/{}/{}/{}", name, k, part.name)))
        link.sections.push_back(*column);
    link.beam.arc_lengths.push_back(points[k].arc_length);
  }
  if (link.sections.size() != points.size() * section_columns().size()) link.sections.clear();
  link.beam.sections = moved_.undeformed_sections(index, 0);
  find_child(index, link);
}

void RecordedMotion::find_child(std::size_t index, Link& link) const {
  const scene::SceneDescription& scene = moved_.scene();
  const Vector3 end = link.beam.sections.back().position;
  for (const scene::JointDescription& joint : scene.joints) {
    if (joint.parent != scene.links[index].name || joint.kind == scene::JointKind::Slide) continue;
    if ((joint.origin.position - end).norm() > 1e-6 * link.beam.arc_lengths.back()) continue;
    const auto is_child = [&](const scene::LinkDescription& other) { return other.name == joint.child; };
    const auto child = std::find_if(scene.links.begin(), scene.links.end(), is_child) - scene.links.begin();
    link.child = static_cast<std::size_t>(child);
    link.child_stays = scene::traits_of(joint.kind).keeps_place;
    link.coordinates.clear();
    for (const std::string& suffix : scene::coordinate_suffixes(joint))
      if (const auto coordinate = moved_.find_coordinate(joint.name + suffix)) link.coordinates.push_back(*coordinate);
    if (joint.kind == scene::JointKind::Fixed) return;  // tells most
  }
}

// ---------------------------------------------------------------- a row

Pose RecordedMotion::link_pose(std::size_t row, std::size_t link) const {
  return links_[link].frame ? columns_.pose(row, *links_[link].frame) : shown_.link_pose(link);
}

void RecordedMotion::show(std::size_t row, double time) {
  move_joints(row);
  State state = state_of(moved_);
  state.time = time;
  const Vector3 origin = world_origin(model_of(moved_), state);
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const std::vector<Pose> frames = sections_in_row(row, i);
    for (std::size_t k = 0; k < frames.size(); ++k) {
      const auto& [index, offset] = links_[i].nodes[k];
      if (!is_known(frames[k])) continue;
      const Pose pose = frames[k] * offset;
      state.nodes[index].position = pose.position - origin;
      state.nodes[index].orientation = pose.orientation.normalized();
    }
  }
  // Contacts remember where they began, which was long before.
  for (const TouchingPair& pair : model_of(moved_).touching_pairs)
    for (const auto& [element, memory] : pair.elements)
      std::fill_n(state.force_memory.begin() + static_cast<std::ptrdiff_t>(memory),
                  model_of(moved_).force_elements[element]->memory_size(), 0.0);
  flexarm::show(state, shown_);
}

/// The frames that carry the nodes of a link; none if the row does not say where they are.
std::vector<Pose> RecordedMotion::sections_in_row(std::size_t row, std::size_t index) const {
  const Link& link = links_[index];
  std::vector<Pose> out;
  if (!link.sections.empty()) {
    const std::size_t width = section_columns().size();
    for (std::size_t k = 0; k < link.sections.size(); k += width) {
      PosePlaces places;
      std::copy_n(link.sections.begin() + static_cast<std::ptrdiff_t>(k), places.size(), places.begin());
      out.push_back(columns_.pose(row, places));
    }
  } else if (link.frame) {
    const Pose root = columns_.pose(row, *link.frame);
    if (!is_flexible(index)) return std::vector<Pose>(link.nodes.size(), root);
    const auto end = end_of(row, index, root);
    for (const Pose& section : end ? bent_sections(link.beam, *end) : link.beam.sections) out.push_back(root * section);
  }
  return out;
}

std::optional<BeamEnd> RecordedMotion::end_of(std::size_t row, std::size_t index, const Pose& root) const {
  const Link& link = links_[index];
  if (link.tip) return BeamEnd{root.inverse() * columns_.pose(row, *link.tip)};
  if (!link.child || !links_[*link.child].frame) return std::nullopt;
  const Pose child = columns_.pose(row, *links_[*link.child].frame);
  const bool is_joint_known = std::all_of(link.coordinates.begin(), link.coordinates.end(),
                                          [&](std::size_t coordinate) { return is_at(row, coordinate); });
  // From the child to the end it is as far as where the joints have moved both.
  if (is_joint_known)
    return BeamEnd{root.inverse() * child * (moved_.link_pose(*link.child).inverse() * moved_.tip_pose(index))};
  if (link.child_stays) return BeamEnd{root.inverse() * child, false};
  return std::nullopt;
}

/// Whether the joint is where the row has it.
bool RecordedMotion::is_at(std::size_t row, std::size_t coordinate) const {
  if (!positions_[coordinate]) return false;
  const double position = columns_.value(row, *positions_[coordinate]);
  return std::abs(moved_.position(coordinate) - position) <= 1e-9 * (1 + std::abs(position));
}

/// Joints that cannot be set stay.
void RecordedMotion::move_joints(std::size_t row) {
  std::vector<CoordinateState> states;
  for (std::size_t i = 0; i < positions_.size(); ++i)
    if (positions_[i] && std::isfinite(columns_.value(row, *positions_[i])) && moved_.is_commandable(i))
      states.push_back({i, columns_.value(row, *positions_[i]), {}});
  if (states.empty()) return;
  try {
    moved_.set_joint_state(states);
  } catch (const std::invalid_argument&) {
    for (const CoordinateState& state : states) try {
        moved_.set_joint_state({state});
      } catch (const std::invalid_argument&) {
      }
  }
}

}  // namespace flexarm::pictures
