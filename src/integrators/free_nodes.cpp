#include "integrators/free_nodes.h"

#include <algorithm>
#include <cassert>

#include "integrators/gathered.h"
#include "math/cayley.h"
#include "math/lanes.h"
#include "math/simd.h"

namespace flexarm {
namespace {

constexpr int kLanes = Pack::kLanes;

/// Normalises a quaternion, since round-off changes the length of products of unit quaternions.
[[gnu::always_inline]] inline QuaternionT<Pack> normalised(const QuaternionT<Pack>& q) {
  const Pack norm = sqrt(q.w() * q.w() + q.x() * q.x() + q.y() * q.y() + q.z() * q.z());
  return {q.w() / norm, q.x() / norm, q.y() / norm, q.z() / norm};
}

}  // namespace

FreeNodes::FreeNodes(const DegreesOfFreedom& dof) {
  for (int i = 0; i < dof.node_count; ++i) {
    if (dof.slave_joint[i] >= 0) continue;
    if (packs_.empty() || packs_.back().lanes == kLanes) packs_.emplace_back();
    Four& pack = packs_.back();
    for (int lane = pack.lanes; lane < kLanes; ++lane) {
      pack.nodes[lane] = i;
      pack.equations[lane] = dof.equation[dof.first[i]];
    }
    ++pack.lanes;
  }
}

template <class Turn>
void FreeNodes::move(const std::vector<NodePose>& from, const Eigen::VectorXd& increment, const Turn& turn,
                     std::vector<NodePose>& to) const {
  assert(to.size() == from.size());
  simd::run([&] {
    for (const Four& pack : packs_) {
      const auto pose = [&](int lane) -> const NodePose& { return from[pack.nodes[lane]]; };
      const auto rotation = gathered_vector(
          [&](int lane) { return Eigen::Map<const Vector3>(increment.data() + pack.equations[lane] + 3); });
      const auto orientation =
          gathered_quaternion([&](int lane) -> const Quaternion& { return pose(lane).orientation; });
      const QuaternionT<Pack> turned = normalised(turn(rotation) * orientation);
      const Matrix3T<Pack> matrix = turned.toRotationMatrix();
      std::array<double*, kLanes> quaternions = {}, matrices = {};
      for (int lane = 0; lane < pack.lanes; ++lane) {
        NodePose& moved = to[pack.nodes[lane]];
        moved.position = pose(lane).position + Eigen::Map<const Vector3>(increment.data() + pack.equations[lane]);
        quaternions[lane] = moved.orientation.coeffs().data();
        matrices[lane] = moved.rotation.data();
      }
      add_lanes<4, true>(turned.coeffs().data(), pack.lanes, quaternions.data());
      add_lanes<9, true>(matrix.data(), pack.lanes, matrices.data());
    }
  });
}

void FreeNodes::update(const Eigen::VectorXd& increment, std::vector<NodePose>& poses) const {
  move(
      poses, increment, [](const Vector3T<Pack>& spin) { return so3::exp_quaternion(spin); }, poses);
}

void FreeNodes::advance(const std::vector<NodePose>& begin, const Eigen::VectorXd& increment,
                        std::vector<NodePose>& end) const {
  move(
      begin, increment, [](const Vector3T<Pack>& rotation) { return cayley::quaternion(rotation); }, end);
}

void set_increments(const std::vector<NodePose>& begin, const std::vector<NodePose>& end,
                    std::vector<Vector3>& increments) {
  assert(begin.size() == end.size() && increments.size() == end.size());
  const int count = static_cast<int>(end.size());
  simd::run([&] {
    for (int first = 0; first < count; first += kLanes) {
      const auto node = [&](int lane) { return std::min(first + lane, count - 1); };
      const auto at = [&](const std::vector<NodePose>& poses) {
        return gathered_quaternion([&](int lane) -> const Quaternion& { return poses[node(lane)].orientation; });
      };
      const Vector3T<Pack> increment = cayley::increment(at(begin), at(end));
      for (int lane = 0; lane < std::min(kLanes, count - first); ++lane)
        increments[first + lane] = get_lane(increment, lane);
    }
  });
}

}  // namespace flexarm
