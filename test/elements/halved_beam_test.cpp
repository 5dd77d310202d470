// Tests where nodes are placed when an element is halved.
#include "elements/halved_beam.h"

#include <cmath>

#include <gtest/gtest.h>

#include "building/beam_mesh.h"
#include "building/centreline.h"
#include "math/so3.h"
#include "support/scene_builder.h"

namespace flexarm::test {
namespace {

/// A straight element of 1 m with EA = GA = 1e6 EI / L^2, and its halves.
struct Halves {
  BeamElement<3> whole;
  std::array<BeamElement<3>, 2> half;

  ElementChain chain() const { return {&half[0], &half[1]}; }

  Halves() {
    scene::BeamDescription beam;
    scene::CentrelinePiece piece;
    piece.to = Vector3::UnitX();
    beam.centreline = {piece};
    beam.elements = 1;
    beam.section = section(1e6, 1e6, 0.8, 1, 1, 2e-6, 1e-6);
    const Centreline line(beam.centreline, beam.section_y);
    BeamMesh mesh = mesh_beam(beam, line, {});
    whole = beam_element<3>(mesh, mesh.elements[0], beam);
    beam.halved = {{0, 1}};
    mesh = mesh_beam(beam, line, {});
    for (const int i : {0, 1}) half[i] = beam_element<3>(mesh, mesh.elements[i], beam);
  }
};

/// The element's nodes, bent by an angle so that it is neither stretched nor sheared at its stiffness points: this is
/// how the element represents an arc.
ElementNodeStates arc(double angle) {
  const double gauss = 1 / std::sqrt(3.0), at = gauss * angle / 2;
  const Vector3 mean(std::cos(at), 0, 0), slope(0, std::sin(at) / gauss, 0);
  ElementNodeStates nodes;
  for (const int i : {0, 1, 2}) {
    const double xi = i - 1;
    nodes[i].position = 0.5 * (xi * mean + 0.5 * xi * xi * slope);
    nodes[i].orientation = so3::exp_quaternion(Vector3(0, 0, 0.5 * xi * angle));
  }
  return nodes;
}

std::vector<NodeState> halved(const ElementNodeStates& nodes, const Halves& halves, bool settled) {
  std::vector<NodeState> out = {nodes[0], interpolated_node(nodes, -0.5), nodes[1], interpolated_node(nodes, 0.5),
                                nodes[2]};
  if (settled) settle_between(halves.chain(), Vector6::Zero(), out);
  return out;
}

double energy_of(const Halves& halves, const std::vector<NodeState>& nodes) {
  return strain_energy(halves.chain(), Vector6::Zero(), nodes);
}

double energy_of(const Halves& halves, const ElementNodeStates& nodes) {
  return strain_energy({&halves.whole}, Vector6::Zero(), {nodes.begin(), nodes.end()});
}

TEST(HalvedBeam, HalvesOfAnEvenlyStrainedElementHaveItsEnergy) {
  const Halves halves;
  ElementNodeStates nodes = arc(0);
  for (const int i : {0, 1, 2}) {
    nodes[i].position *= 1.01;
    nodes[i].orientation = so3::exp_quaternion(Vector3(0.7 * (i - 1), 0, 0));
  }
  const double whole = energy_of(halves, nodes);
  EXPECT_NEAR(energy_of(halves, halved(nodes, halves, true)), whole, 1e-13 * whole);
}

TEST(HalvedBeam, EnergyHardlyChangesBySettling) {
  const Halves halves;
  const auto change = [&](double angle, bool settled) {
    const ElementNodeStates nodes = arc(angle);
    return energy_of(halves, halved(nodes, halves, settled)) / energy_of(halves, nodes) - 1;
  };
  // The element's energy is exact up to the fourth power of the angle, and so is that of its halves.
  EXPECT_NEAR(std::log2(change(0.8, true) / change(0.4, true)), 4, 0.1);
  EXPECT_LT(std::abs(change(1, true)), 1e-4);
  // Without settling, the halves are stretched in proportion to the square of the angle, whatever its stiffness.
  EXPECT_NEAR(std::log2(change(0.8, false) / change(0.4, false)), 2, 0.1);
}

TEST(HalvedBeam, ForcesOnTheNodesBetweenBalance) {
  const Halves halves;
  ElementNodeStates nodes = arc(0.9);
  nodes[1].position += Vector3(1e-4, -2e-4, 5e-4);
  nodes[2].orientation = so3::exp_quaternion(Vector3(0.2, 0.1, 0)) * nodes[2].orientation;
  const std::vector<NodeState> settled = halved(nodes, halves, true);
  for (const int i : {1, 2, 3})
    for (int k = 0; k < 6; ++k) {
      const auto energy_at = [&](double way) {
        std::vector<NodeState> moved = settled;
        if (k < 3)
          moved[i].position[k] += way;
        else
          moved[i].orientation = so3::exp_quaternion(Vector3(way * Vector3::Unit(k - 3))) * moved[i].orientation;
        return energy_of(halves, moved);
      };
      const double h = 1e-6, least = energy_at(0), force = (energy_at(h) - energy_at(-h)) / (2 * h),
                   stiffness = (energy_at(h) - 2 * least + energy_at(-h)) / (h * h);
      // The energy is at its least up to the part at which the iteration ends, and round-off of the differences.
      EXPECT_LE(0.5 * force * force / stiffness, 1e-9 * least) << "node " << i << ", " << k;
    }
}

TEST(HalvedBeam, BendingIsCountedBeyondHalfATurn) {
  for (const double angle : {0.3, 2.0, 4.0, 6.0}) {
    const ElementNodeStates nodes = arc(angle), straight = arc(0);
    const ThreeOrientations bent = {nodes[0].orientation, nodes[1].orientation, nodes[2].orientation},
                            unbent = {straight[0].orientation, straight[1].orientation, straight[2].orientation};
    EXPECT_NEAR(bending(bent, unbent), angle, 1e-13);
    EXPECT_EQ(bending(bent, bent), 0);
  }
}

}  // namespace
}  // namespace flexarm::test
