#pragma once
/// Random beam elements and random steps of them, for tests of kernels.

#include <random>

#include "building/beam_mesh.h"
#include "math/cayley.h"
#include "math/pi.h"
#include "math/so3.h"
#include "model/state.h"
#include "schemes/time_rule.h"
#include "study_schemes/element_nodes.h"

namespace flexarm::test {

/// Reproducible random numbers, vectors, rotations and symmetric positive definite matrices of order one.
class RandomSource {
 public:
  explicit RandomSource(unsigned seed = 1) : engine_(seed) {}
  double number() { return uniform_(engine_); }  ///< in (-1, 1)
  Vector3 vector() { return {number(), number(), number()}; }
  Vector6 vector6() {
    Vector6 v;
    v << vector(), vector();
    return v;
  }
  Vector3 unit() { return vector().normalized(); }
  /// A rotation by a random angle up to `angle`. Compilers differ in the order in which they evaluate factors, so the
  /// numbers are drawn in separate statements.
  Quaternion rotation(double angle) {
    const Vector3 axis = unit();
    return so3::exp_quaternion(Vector3(angle * number() * axis));
  }
  Pose pose(double length, double angle) { return {length * vector(), rotation(angle)}; }
  template <int Size>
  Eigen::Matrix<double, Size, Size> positive_definite() {
    Eigen::Matrix<double, Size, Size> root;
    for (int i = 0; i < root.size(); ++i) root.data()[i] = number();
    return root * root.transpose() + Eigen::Matrix<double, Size, Size>::Identity();
  }

 private:
  std::mt19937 engine_;
  std::uniform_real_distribution<double> uniform_{-1, 1};
};

/// The rotation vector of `relative` that is nearer to `other`: two rotation vectors give the same rotation.
inline Vector3 nearest_vector(const Quaternion& relative, const Vector3& other) {
  const Vector3 theta = so3::log(relative);
  const double angle = theta.norm();
  if (angle < 1e-3) return theta;
  const Vector3 around = (1 - 2 * kPi / angle) * theta;
  return (theta - other).norm() <= (around - other).norm() ? theta : around;
}

/// A random step of an element with a curved and twisted undeformed line. Its section matrices are full and change
/// along the line. The interpolation is local, unless set_interpolation() chooses another one.
template <int Nodes>
struct RandomStep {
  using Element = BeamElement<Nodes>;

  /// `size`: size of the rotation and displacement increments.
  RandomStep(RandomSource& random, double size) {
    BeamMesh mesh;
    mesh.order = Nodes - 1;
    SectionProperties section;
    section.stiffness = random.positive_definite<6>();
    section.inertia = random.positive_definite<3>();
    section.mass = 1.3;
    mesh.section = SectionLine(section);
    MeshElement in_mesh;
    for (int i = 0; i < Nodes; ++i) {
      in_mesh.nodes.push_back(i);
      const double x = 1.5 * i / (Nodes - 1);
      const Pose pose{Vector3(x, 0.3 * x * x, -0.2 * x) + 0.05 * random.vector(),
                      Quaternion(random.rotation(0.1) * so3::exp_quaternion(Vector3(0.4 * x, 0, 0.5 * x)))};
      mesh.nodes.push_back({x, pose, -1});
      undeformed_position[i] = pose.position;
      undeformed_orientation[i] = pose.orientation;
    }
    element = beam_element<Nodes>(mesh, in_mesh, scene::BeamDescription());
    // The section changes along the line, by a different amount at every point.
    for (int k = 1; k < Element::kStiffnessPoints; ++k) element.stiffness_points[k].stiffness *= 1 + 0.2 * k;
    for (int k = 1; k < Element::kMassPoints; ++k) element.mass_points[k].inertia *= 1 + 0.1 * k;

    const Quaternion moved = random.rotation(3.0);
    for (int i = 0; i < Nodes; ++i) {
      nodes.begin[i] = moved * undeformed_position[i] + 0.1 * random.vector();
      begin_orientation[i] = (moved * undeformed_orientation[i] * random.rotation(0.3)).normalized();
      nodes.velocity[i] = random.vector();
      nodes.acceleration[i] = random.vector();
    }
    const Vector3 turn = random.vector();
    for (int i = 0; i < Nodes; ++i) {
      nodes.end[i] = nodes.begin[i] + size * random.vector();
      set_orientation(i, so3::exp_quaternion(Vector3(size * (turn + 0.5 * random.vector()))) * begin_orientation[i]);
    }
    set_begin_points();
    for (MassPointState& state : mass_points) state = {random.vector(), random.vector()};
  }
  /// Sets a different damping for each strain, one of them zero.
  void damp_unevenly(double stiffness_damping) {
    element.stiffness_damping = stiffness_damping;
    element.damping_scale << 1, 0.7, 0.2, 0.9, 0, 0.5;
  }
  // Not copyable, because `nodes` has pointers into this object.
  RandomStep(const RandomStep&) = delete;
  RandomStep& operator=(const RandomStep&) = delete;

  /// Sets the reference from which rotations are measured: the undeformed element (total), the beginning (incremental),
  /// or the end of the step (iterative). The latter two depend on past motion, which is simulated by a random rotation
  /// of each point.
  void set_interpolation(RandomSource& random, Interpolation chosen,
                         RotationParameters parameters = RotationParameters::Unscaled) {
    interpolation = chosen;
    nodes.parameters = parameters;
    if (interpolation == Interpolation::Local) return;
    reference_orientation = undeformed_orientation;
    if (interpolation == Interpolation::Incremental) reference_orientation = begin_orientation;
    if (interpolation == Interpolation::Iterative) reference_orientation = nodes.orientation;
    const LocalRotations<Nodes> local(reference_orientation);
    const auto reference = [&](const auto& point) {
      InterpolatedRotation<double> out = local.evaluate(point.shape, point.derivative);
      if (interpolation == Interpolation::Total) return out;
      out.rotation = random.rotation(0.1) * out.rotation;
      out.curvature += 0.1 * random.vector();
      return out;
    };
    for (int k = 0; k < Element::kStiffnessPoints; ++k) stiffness_reference[k] = reference(element.stiffness_points[k]);
    for (int k = 0; k < Element::kMassPoints; ++k) mass_reference[k] = reference(element.mass_points[k]);
    nodes.stiffness_reference = stiffness_reference.data();
    nodes.mass_reference = mass_reference.data();
    for (int i = 0; i < Nodes; ++i) {
      nodes.rotation_vector[i] = i > 0 ? nodes.rotation_vector[i - 1] : Vector3::Zero();
      set_orientation(i, nodes.orientation[i]);
    }
    set_begin_points();
  }

  /// The nodes with the end set to the beginning of the step.
  ElementNodes<Nodes> nodes_at_begin() const {
    ElementNodes<Nodes> out = nodes;
    out.end = out.begin;
    for (int i = 0; i < Nodes; ++i) set_orientation(i, begin_orientation[i], out);
    if (interpolation == Interpolation::Iterative) out.stiffness_reference = out.mass_reference = nullptr;
    return out;
  }
  void set_begin_points() {
    const ElementNodes<Nodes> begin = nodes_at_begin();
    const ElementRotations<Nodes> rotations(begin, false);
    GeneralisedShapeFunctions<Nodes> unused;
    for (int k = 0; k < Element::kStiffnessPoints; ++k) {
      const auto& point = element.stiffness_points[k];
      begin_points[k] =
          point_kinematics(rotations.evaluate(point.shape, point.derivative, &stiffness_reference[k], unused),
                           interpolate<Nodes>(point.derivative, nodes.begin), point.reference_strain);
    }
    for (int k = 0; k < Element::kMassPoints; ++k) {
      const auto& point = element.mass_points[k];
      begin_mass_rotations[k] = rotations.evaluate(point.shape, point.derivative, &mass_reference[k], unused).rotation;
    }
  }

  /// The same step, seen by an observer in a rotated frame.
  void turn(const Quaternion& rotation) {
    for (int i = 0; i < Nodes; ++i) {
      nodes.begin[i] = rotation * nodes.begin[i];
      nodes.end[i] = rotation * nodes.end[i];
      nodes.velocity[i] = rotation * nodes.velocity[i];
      begin_orientation[i] = rotation * begin_orientation[i];
      set_orientation(i, rotation * nodes.orientation[i]);
    }
    set_begin_points();
  }
  void set_orientation(int i, const Quaternion& orientation) { set_orientation(i, orientation, nodes); }
  void set_orientation(int i, const Quaternion& orientation, ElementNodes<Nodes>& of) const {
    of.orientation[i] = orientation.normalized();
    of.increment[i] = cayley::increment(begin_orientation[i], of.orientation[i]);
    of.increment_inverse_tangent[i] = cayley::inverse_tangent(of.increment[i]);
    if (interpolation == Interpolation::Local) return;
    const Quaternion relative = of.orientation[i] * reference_orientation[i].conjugate();
    of.rotation_vector[i] = nodes.parameters == RotationParameters::TangentScaled
                                ? cayley::increment(relative)
                                : nearest_vector(relative, of.rotation_vector[i]);
  }
  /// The nodes with the end displaced by h along coordinate `column` of {dr_0, spin_0, dr_1, ...}.
  ElementNodes<Nodes> perturbed(int column, double h) const {
    ElementNodes<Nodes> out = nodes;
    const int i = column / 6, k = column % 6;
    if (k < 3)
      out.end[i][k] += h;
    else
      set_orientation(i, so3::exp_quaternion(Vector3(h * Vector3::Unit(k - 3))) * nodes.orientation[i], out);
    return out;
  }
  /// Work of nodal forces and moments on the displacement and tangent-scaled rotation increments.
  double work(const Eigen::Matrix<double, 6 * Nodes, 1>& forces) const {
    double sum = 0;
    for (int i = 0; i < Nodes; ++i)
      sum += forces.template segment<3>(6 * i).dot(nodes.end[i] - nodes.begin[i]) +
             forces.template segment<3>(6 * i + 3).dot(nodes.increment[i]);
    return sum;
  }
  /// Strain energy of the given stiffness points.
  double strain_energy(const std::array<PointKinematics, Element::kStiffnessPoints>& points) const {
    double energy = 0;
    for (int k = 0; k < Element::kStiffnessPoints; ++k)
      energy += 0.5 * element.stiffness_points[k].weight *
                points[k].strain.dot(element.stiffness_points[k].stiffness * points[k].strain);
    return energy;
  }

  Element element;
  std::array<Vector3, Nodes> undeformed_position;
  std::array<Quaternion, Nodes> undeformed_orientation, begin_orientation;
  ElementNodes<Nodes> nodes;
  std::array<PointKinematics, Element::kStiffnessPoints> begin_points;
  std::array<Matrix3, Element::kMassPoints> begin_mass_rotations;
  std::array<MassPointState, Element::kMassPoints> mass_points;  ///< at the beginning
  Interpolation interpolation = Interpolation::Local;
  std::array<Quaternion, Nodes> reference_orientation;
  std::array<InterpolatedRotation<double>, Element::kStiffnessPoints> stiffness_reference;
  std::array<InterpolatedRotation<double>, Element::kMassPoints> mass_reference;
};

}  // namespace flexarm::test
