#include "study_schemes/rotation_reference.h"

#include <algorithm>

#include "math/pi.h"
#include "math/so3.h"

namespace flexarm {
namespace {

/// Of the two rotation vectors theta and theta - 2 pi e of a rotation, the one that is nearer to `other`.
Vector3 nearest_vector(const Vector3& theta, const Vector3& other) {
  const double angle = theta.norm();
  if (angle < 1e-3) return theta;
  const Vector3 around = theta - (2 * kPi / angle) * theta;
  return (theta - other).squaredNorm() <= (around - other).squaredNorm() ? theta : around;
}

}  // namespace

RotationReference::RotationReference(const Model& model, const TimeRule& rule)
    : model_(model),
      interpolation_(rule.interpolation),
      parameters_(rule.cayley_interpolation ? RotationParameters::TangentScaled : RotationParameters::Unscaled),
      keeps_total_(rule.interpolation == Interpolation::Total || rule.hht == HhtForm::AdditiveForces),
      nodes_(model.nodes.size()),
      vectors_(model.nodes.size(), Vector3::Zero()),
      begin_total_(model.nodes.size(), Vector3::Zero()),
      total_(model.nodes.size(), Vector3::Zero()) {
  if (!is_used()) return;
  State state;
  set_points(model.nodes, state);
  stiffness_ = end_stiffness_ = state.study.stiffness_rotations;
  mass_ = end_mass_ = state.study.mass_rotations;
  for (std::size_t i = 0; i < nodes_.size(); ++i) nodes_[i] = model.nodes[i].orientation;
}

void RotationReference::initialise(State& state) const {
  if (keeps_total_) {
    state.study.total_rotations.resize(model_.nodes.size(), Vector3::Zero());
    for (std::size_t i = 0; i < state.nodes.size(); ++i)
      state.study.total_rotations[i] =
          nearest_vector(total_rotation(i, state.nodes[i].orientation), state.study.total_rotations[i]);
  }
  forget_path(state);
}

void RotationReference::forget_path(State& state) const {
  std::vector<NodePose> nodes;
  for (const NodeState& node : state.nodes) nodes.push_back(node_pose(node));
  set_points(nodes, state);
}

void RotationReference::set_points(const std::vector<NodePose>& nodes, State& state) const {
  if (!is_used()) return;
  state.study.stiffness_rotations.resize(model_.stiffness_point_count);
  state.study.mass_rotations.resize(model_.mass_point_count);
  for_each_element(model_.beams, [&](const auto& element) {
    using Element = std::decay_t<decltype(element)>;
    std::array<Quaternion, Element::kNodes> orientation;
    for (int i = 0; i < Element::kNodes; ++i) orientation[i] = nodes[element.nodes[i]].orientation;
    const LocalRotations<Element::kNodes> local(orientation);
    for (int k = 0; k < Element::kStiffnessPoints; ++k)
      state.study.stiffness_rotations[element.first_stiffness_point + k] =
          local.evaluate(element.stiffness_points[k].shape, element.stiffness_points[k].derivative);
    for (int k = 0; k < Element::kMassPoints; ++k)
      state.study.mass_rotations[element.first_mass_point + k] =
          local.evaluate(element.mass_points[k].shape, element.mass_points[k].derivative);
  });
}

Vector3 RotationReference::total_rotation(std::size_t node, const Quaternion& orientation) const {
  return so3::log(orientation * model_.nodes[node].orientation.conjugate());
}

void RotationReference::begin(const State& state) {
  if (keeps_total_)
    std::copy(state.study.total_rotations.begin(), state.study.total_rotations.end(), begin_total_.begin());
  if (!is_used() || interpolation_ == Interpolation::Total) return;
  for (std::size_t i = 0; i < nodes_.size(); ++i) nodes_[i] = state.nodes[i].orientation;
  std::copy(state.study.stiffness_rotations.begin(), state.study.stiffness_rotations.end(), stiffness_.begin());
  std::copy(state.study.mass_rotations.begin(), state.study.mass_rotations.end(), mass_.begin());
}

void RotationReference::set_trial(const std::vector<NodePose>& nodes) {
  if (keeps_total_)
    for (std::size_t i = 0; i < nodes.size(); ++i)
      total_[i] = nearest_vector(total_rotation(i, nodes[i].orientation), begin_total_[i]);
  if (!is_used()) return;
  if (interpolation_ == Interpolation::Total) {
    std::copy(total_.begin(), total_.end(), vectors_.begin());
    return;
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Quaternion relative = nodes[i].orientation * nodes_[i].conjugate();
    vectors_[i] = parameters_ == RotationParameters::TangentScaled ? cayley::increment(relative) : so3::log(relative);
  }
  if (interpolation_ != Interpolation::Iterative) return;
  compute_points(stiffness_, mass_);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    nodes_[i] = nodes[i].orientation;
    vectors_[i].setZero();
  }
}

void RotationReference::accept(State& state) {
  if (keeps_total_) std::copy(total_.begin(), total_.end(), state.study.total_rotations.begin());
  if (!is_used()) return;
  compute_points(end_stiffness_, end_mass_);
  std::copy(end_stiffness_.begin(), end_stiffness_.end(), state.study.stiffness_rotations.begin());
  std::copy(end_mass_.begin(), end_mass_.end(), state.study.mass_rotations.begin());
}

void RotationReference::compute_points(std::vector<PointRotation>& stiffness, std::vector<PointRotation>& mass) const {
  for_each_element(model_.beams, [&](const auto& element) {
    using Element = std::decay_t<decltype(element)>;
    constexpr int N = Element::kNodes;
    ElementNodes<N> nodes{};  // initialised because GCC does not always see that gather() sets all of it
    gather(element, nodes);
    const ReferencedRotations<N> rotations(nodes.parameters, nodes.rotation_vector);
    GeneralisedShapeFunctions<N> unused;
    const int first_stiffness = element.first_stiffness_point, first_mass = element.first_mass_point;
    for (int k = 0; k < Element::kStiffnessPoints; ++k) {
      const auto& point = element.stiffness_points[k];
      stiffness[first_stiffness + k] =
          rotations.evaluate(point.shape, point.derivative, stiffness_[first_stiffness + k], unused);
    }
    for (int k = 0; k < Element::kMassPoints; ++k) {
      const auto& point = element.mass_points[k];
      mass[first_mass + k] = rotations.evaluate(point.shape, point.derivative, mass_[first_mass + k], unused);
    }
  });
}

}  // namespace flexarm
