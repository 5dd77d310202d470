// Compares residuals of every scheme with an independent numpy implementation (scripts/reference_steps.py).
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "building/beam_mesh.h"
#include "elements/conserving_kernel.h"
#include "elements/differences.h"
#include "schemes/scheme.h"
#include "study_schemes/average_rotary.h"
#include "study_schemes/newmark_beam.h"
#include "study_schemes/nodal_inertia.h"
#include "support/node_poses.h"
#include "support/source_path.h"

namespace flexarm {
namespace {

using namespace test;

/// One random step with the reference's results, read from the table.
class ReferenceStep {
 public:
  explicit ReferenceStep(int nodes) {
    std::ifstream file(source_path("test/elements/reference_steps.csv"));
    for (std::string line; std::getline(file, line);) {
      if (line.empty() || line.front() == '#') continue;
      std::istringstream cells(line);
      std::string cell, key;
      std::getline(cells, cell, ',');
      if (std::stoi(cell) != nodes) continue;
      std::getline(cells, key, ',');
      while (std::getline(cells, cell, ',')) values_[key].push_back(std::stod(cell));
    }
  }
  double number(const std::string& key) const { return values_.at(key).at(0); }
  Vector3 vector(const std::string& key, int i) const { return Vector3::Map(values_.at(key).data() + 3 * i); }
  Quaternion quaternion(const std::string& key, int i) const {
    const double* q = values_.at(key).data() + 4 * i;
    return Quaternion(q[0], q[1], q[2], q[3]).normalized();
  }
  template <int Size>  // symmetric, so row by row is column by column
  Eigen::Matrix<double, Size, Size> matrix(const std::string& key) const {
    return Eigen::Matrix<double, Size, Size>::Map(values_.at(key).data());
  }
  Eigen::VectorXd all(const std::string& key) const {
    return Eigen::VectorXd::Map(values_.at(key).data(), values_.at(key).size());
  }

 private:
  std::map<std::string, std::vector<double>> values_;
};

template <int Nodes>
class Comparison {
 public:
  Comparison() : data_(Nodes), step_(data_.number("step")) {
    BeamMesh mesh;
    mesh.order = Nodes - 1;
    SectionProperties section;
    section.stiffness = data_.matrix<6>("stiffness");
    section.inertia = data_.matrix<3>("inertia");
    section.mass = data_.number("section_mass");
    mesh.section = SectionLine(section);
    MeshElement in_mesh;
    for (int i = 0; i < Nodes; ++i) {
      in_mesh.nodes.push_back(i);
      mesh.nodes.push_back(
          {0, {data_.vector("undeformed_position", i), data_.quaternion("undeformed_orientation", i)}});
      nodes_.begin[i] = data_.vector("begin_position", i);
      nodes_.end[i] = data_.vector("end_position", i);
      begin_orientation_[i] = data_.quaternion("begin_orientation", i);
      nodes_.orientation[i] = data_.quaternion("end_orientation", i);
      nodes_.increment[i] = cayley::increment(begin_orientation_[i], nodes_.orientation[i]);
      nodes_.increment_inverse_tangent[i] = cayley::inverse_tangent(nodes_.increment[i]);
      nodes_.velocity[i] = data_.vector("velocity", i);
      nodes_.acceleration[i] = data_.vector("acceleration", i);
    }
    element_ = beam_element<Nodes>(mesh, in_mesh, scene::BeamDescription());
    const LocalRotations<Nodes> local(begin_orientation_);
    for (int k = 0; k < Nodes - 1; ++k) {
      const auto& point = element_.stiffness_points[k];
      begin_stiffness_[k] = local.evaluate(point.shape, point.derivative);
      begin_points_[k] = point_kinematics(begin_stiffness_[k], interpolate<Nodes>(point.derivative, nodes_.begin),
                                          point.reference_strain);
    }
    for (int k = 0; k < Nodes; ++k) {
      const auto& point = element_.mass_points[k];
      begin_mass_[k] = local.evaluate(point.shape, point.derivative);
      mass_points_[k] = {data_.vector("point_angular_velocity", k), data_.vector("point_angular_acceleration", k)};
    }
  }

  void check_all() {
    check("static", static_forces(nodes_));
    for (const char* scheme : {"newmark", "hht2"}) check(scheme, newmark(scheme));
    for (const char* scheme : {"m1", "m2", "std", "beta1", "beta1_repaired"}) check(scheme, momentum(scheme));
    check("em0", with_nodal_inertia("em0", conserving(false)));
    check("em", with_nodal_inertia("em", conserving(true)));
    element_.stiffness_damping = data_.number("damping");
    check("em0_damped", with_nodal_inertia("em0", conserving(false)));
    check("em_damped", with_nodal_inertia("em", conserving(true)));
  }

 private:
  ElementSystem<Nodes> static_forces(const ElementNodes<Nodes>& nodes) {
    std::array<PointKinematics, Nodes - 1> end;
    std::array<Vector6, Nodes - 1> rates, new_rates;
    for (Vector6& rate : rates) rate.setZero();
    ElementSystem<Nodes> system;
    system.set_zero();
    endpoint_internal<Nodes>(element_, nodes, nullptr, begin_points_.data(), rates.data(), false, end.data(),
                             new_rates.data(), system);
    return system;
  }
  /// Inertia by Newmark's rule and the forces at t_{n+1+alpha}. (Hilber-Hughes-Taylor; forces conjugate to spins are
  /// interpolated.)
  ElementSystem<Nodes> newmark(const std::string& scheme) {
    const double alpha = scheme == "hht2" ? data_.number("alpha") : 0;
    ElementNodes<Nodes> begin = nodes_;
    begin.end = begin.begin;
    begin.orientation = begin_orientation_;
    ElementSystem<Nodes> system = static_forces(nodes_);
    system.residual = (1 + alpha) * system.residual - alpha * static_forces(begin).residual;
    const NewmarkRule rule{0.25 * (1 - alpha) * (1 - alpha), 0.5 - alpha, step_};
    newmark_translation<Nodes>(element_, nodes_, rule, false, system);
    for_each_mass_point(
        element_, nodes_, false,
        [&](int k, const InterpolatedRotation<double>& point, const GeneralisedShapeFunctions<Nodes>& generalised) {
          const RotaryRate rate = newmark_rotary_rate(element_.mass_points[0].inertia, begin_mass_[k].rotation,
                                                      point.rotation, mass_points_[k], rule);
          add_rotary_rate(element_, k, rate, generalised, false, system);
        });
    return system;
  }
  ElementSystem<Nodes> momentum(const std::string& name) {
    const Scheme scheme = *find_scheme(name);
    ElementNodes<Nodes> nodes = nodes_;
    if (scheme.interpolation == Interpolation::Incremental) {
      nodes.parameters = RotationParameters::TangentScaled;
      nodes.rotation_vector = nodes.increment;
      nodes.stiffness_reference = begin_stiffness_.data();
      nodes.mass_reference = begin_mass_.data();
    }
    std::array<Matrix3, Nodes> begin;
    for (int k = 0; k < Nodes; ++k) begin[k] = begin_mass_[k].rotation;
    AverageRotary<Nodes> rotary{element_, nodes, scheme.beam_rotation, begin, mass_points_, step_};
    std::array<PointKinematics, Nodes - 1> end;
    ElementSystem<Nodes> system;
    const auto add = [&](bool with, ElementEnergy<Nodes>* energy, ElementSystem<Nodes>& sum) {
      rotary(with, energy, sum);
    };
    momentum_beam<Nodes>(element_, nodes, scheme, begin_points_.data(), step_, add, false, end.data(), system);
    return system;
  }
  ElementSystem<Nodes> conserving(bool has_multiplier) {
    std::array<PointKinematics, Nodes - 1> end;
    ElementSystem<Nodes> system;
    // The reference uses Lagrange functions as test functions and for interpolation (beyond.md 1.1).
    ElementFunctions<Nodes> lagrange;
    for (int k = 0; k < Nodes - 1; ++k)
      for (int i = 0; i < Nodes; ++i) {
        lagrange[k].values[i] = element_.stiffness_points[k].shape[i] * Matrix3::Identity();
        lagrange[k].derivatives[i] = element_.stiffness_points[k].derivative[i] * Matrix3::Identity();
      }
    conserving_beam<Nodes>(has_multiplier, element_, nodes_, TimeRule(), lagrange, begin_points_.data(), nullptr, step_,
                           false, end.data(), nullptr, system);
    return system;
  }
  /// Adds the rotary inertia that the model lumps at the element's nodes.
  ElementSystem<Nodes> with_nodal_inertia(const char* scheme, ElementSystem<Nodes> system) {
    for (int i = 0; i < Nodes; ++i) {
      double length = 0;
      for (const auto& point : element_.mass_points) length += point.weight * point.shape[i];
      NodalInertia inertia;
      inertia.beam_rotary = length * element_.mass_points[0].inertia;
      const NodePose begin = node_at(nodes_.begin[i], begin_orientation_[i]);
      const NodePose end = node_at(nodes_.end[i], nodes_.orientation[i]);
      NodeState state;
      state.velocity = nodes_.velocity[i];
      state.angular_velocity = data_.vector("node_angular_velocity", i);
      const NodeStep step{begin, end, state, nodes_.increment[i], nodes_.increment_inverse_tangent[i], step_};
      system.residual.template segment<6>(6 * i) += nodal_inertia_action(inertia, *find_scheme(scheme), step).residual;
    }
    return system;
  }
  void check(const std::string& key, const ElementSystem<Nodes>& system) {
    const Eigen::VectorXd expected = data_.all(key);
    ASSERT_EQ(expected.size(), 6 * Nodes);
    // Tolerance: round-off of two implementations. The multiplier's numerator loses three digits of the stresses by
    // cancellation.
    EXPECT_LE(largest(system.residual - expected), 1e-12 * largest(expected)) << key << ", " << Nodes << " nodes";
  }

  ReferenceStep data_;
  double step_;
  BeamElement<Nodes> element_;
  std::array<Quaternion, Nodes> begin_orientation_;
  ElementNodes<Nodes> nodes_;
  std::array<PointKinematics, Nodes - 1> begin_points_;
  std::array<InterpolatedRotation<double>, Nodes - 1> begin_stiffness_;
  std::array<InterpolatedRotation<double>, Nodes> begin_mass_;
  std::array<MassPointState, Nodes> mass_points_;
};

TEST(ReferenceSteps, TwoNodes) {
  Comparison<2>().check_all();
}
TEST(ReferenceSteps, ThreeNodes) {
  Comparison<3>().check_all();
}
TEST(ReferenceSteps, FourNodes) {
  Comparison<4>().check_all();
}
TEST(ReferenceSteps, FiveNodes) {
  Comparison<5>().check_all();
}

}  // namespace
}  // namespace flexarm
