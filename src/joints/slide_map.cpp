#include "joints/slide_map.h"

#include <algorithm>
#include <cassert>

#include "joints/slide_step.h"

namespace flexarm {

using slide::Complex;

namespace {

NodePose section_pose(const SlideLine& line, const std::vector<NodePose>& nodes, const slide::Place& place) {
  const slide::LineNodes poses{line, nodes};
  NodePose pose;
  pose.position.setZero();
  for (int i = 0; i < place.weights.count; ++i)
    pose.position += place.weights.values[i] * poses(place.weights.first + i).position;
  pose.orientation = Quaternion(place.frame.rotation).normalized();
  pose.rotation = pose.orientation.toRotationMatrix();
  return pose;
}

}  // namespace

SlideMaps::SlideMaps(std::size_t most_nodes) {
  left.reserve(most_nodes);
  right.reserve(most_nodes);
  released_master.reserve(most_nodes);
  master_released.reserve(most_nodes);
  moment_master.reserve(most_nodes * most_nodes);
}

std::size_t most_active_nodes(const std::vector<SlideLine>& lines) {
  std::size_t most = 0;
  for (const SlideLine& line : lines) most = std::max(most, line.most_active_nodes());
  return most;
}

void slide::set_active(const SlideLine& line, int piece, int other_piece, bool with_tangent, SlideMaps& maps) {
  const NodeRange active = line.support(std::min(piece, other_piece), std::max(piece, other_piece));
  maps.first = active.first;
  maps.count = active.end - active.first;
  assert(maps.first >= 0 && maps.count > 0);
  maps.left.assign(maps.count, Matrix6::Zero());
  maps.right.assign(maps.count, Matrix6::Zero());
  if (!with_tangent) return;
  maps.released_released = 0;
  maps.released_master.assign(maps.count, Vector6::Zero());
  maps.master_released.assign(maps.count, Vector6::Zero());
  maps.moment_master.resize(static_cast<std::size_t>(maps.count) * maps.count);
}

slide::Place slide_place(const SlideLine& line, const std::vector<NodePose>& nodes, double arc_length) {
  assert(!line.pieces.empty());
  slide::Place place;
  place.piece = line.piece_at(arc_length);
  place.frames = slide::piece_frames<double>(line, place.piece, slide::LineNodes{line, nodes});
  place.weights = slide::line_weights(line, place.piece, arc_length);
  place.frame = frame_at(line, place.piece, arc_length, place.frames);
  return place;
}

NodePose slide_pose(const SlideLine& line, const std::vector<NodePose>& nodes, double arc_length) {
  return section_pose(line, nodes, slide_place(line, nodes, arc_length));
}

NodePose slide_pose(const SlideTravel& travel, const Vector3& begin_position) {
  assert(travel.begin.size() == travel.end.size());
  const slide::TravelPlaces places(travel);
  NodePose pose = section_pose(travel.line, travel.end, places.end());
  const slide::ContactRule rule = slide::contact_rule(travel.step(), travel.arm_weight);
  if (!rule.is_in_middle) return pose;
  pose.position = -begin_position;
  const auto add = [&](double factor, const slide::LineWeights<double>& weights) {
    for (int i = 0; i < weights.count; ++i) {
      const int node = travel.line.nodes[weights.first + i];
      pose.position += factor * weights.values[i] * (travel.begin[node].position + travel.end[node].position);
    }
  };
  add(1 - rule.weight, places.begin().weights);
  add(rule.weight, places.end().weights);
  return pose;
}

void slide_variational_maps(const SlideLine& line, const std::vector<NodePose>& nodes, double arc_length,
                            const Vector6& g, SlideMaps& maps, bool with_tangent) {
  assert(!line.pieces.empty());
  const int piece = line.piece_at(arc_length);
  const slide::LineNodes poses{line, nodes};
  slide::set_active(line, piece, piece, with_tangent, maps);
  const slide::LineWeights<double> w = slide::line_weights(line, piece, arc_length);
  const FrameVariation frame(line, piece, arc_length, poses);
  const Vector3 &k = frame.spatial_curvature, force = g.head<3>(), moment = g.tail<3>();
  Vector3 tangent = Vector3::Zero();
  for (int j = 0; j < maps.count; ++j) {
    tangent += w.derivatives[j] * poses(w.first + j).position;
    maps.left[j].diagonal().setConstant(w.values[j]);
    maps.right[j].topLeftCorner<3, 3>().diagonal().setConstant(w.values[j]);
    maps.right[j].bottomRightCorner<3, 3>() = frame.values[j];
  }
  maps.released_left << tangent, k;
  maps.released_right = maps.released_left;
  if (!with_tangent) return;
  for (auto& block : maps.moment_master) block.setZero();
  for (int j = 0; j < maps.count; ++j) {  // d(k) = I_g' spin + (I_g spin) x k
    maps.released_master[j] << w.derivatives[j] * force,
        frame.derivatives[j].transpose() * moment + frame.values[j].transpose() * k.cross(moment);
    maps.master_released[j] = w.derivatives[j] * g;
  }
  const Section<Complex> moved =
      section_at(line, piece, Complex(arc_length, slide::kComplexStep), slide::ComplexLineNodes{line, nodes});
  const Vector3 bend = moved.tangent.imag(), change = moved.spatial_curvature.imag();
  maps.released_released = (bend.dot(force) + change.dot(moment)) / slide::kComplexStep;
}

}  // namespace flexarm
