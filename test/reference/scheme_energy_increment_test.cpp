// Tests equations of chapter 6 of Muñoz 2004: the energy that M1 (6.17) and M2 (6.21) gain in a step, the sign of M2's
// gain, STD's energy (6.12), and its interpolation, which is not strain-invariant.
#include <cstdio>

#include "elements/beam_point.h"
#include "math/cayley.h"
#include "reference/dynamics_joint_chain.h"
#include "simulation/inside.h"
#include "study_schemes/referenced_rotation.h"

namespace flexarm::test {
namespace {

/// Terms of the right-hand sides of (6.17) and (6.21), evaluated from the states at both ends of a step.
struct EnergyIncrement {
  double unscaled = 0;  ///< int (1 - tan(w/2)/(w/2)) w . (mean r' x n) ds: Delta E_1 of (6.17)
  double lever = 0;     ///< -1/2 int w . (Delta r' x n) ds
  double backward = 0;  ///< -1/2 int |Delta v|^2 A_rho ds
};

template <int Nodes>
void add_increment(const BeamElement<Nodes>& element, const State& begin, const State& end, EnergyIncrement& out) {
  std::array<Vector3, Nodes> r0, r1, increment, dv;
  for (int i = 0; i < Nodes; ++i) {
    const NodeState &a = begin.nodes[element.nodes[i]], &b = end.nodes[element.nodes[i]];
    r0[i] = a.position;
    r1[i] = b.position;
    increment[i] = so3::log(Quaternion(b.orientation * a.orientation.conjugate()));
    dv[i] = b.velocity - a.velocity;
  }
  for (int k = 0; k < Nodes - 1; ++k) {
    const auto& point = element.stiffness_points[k];
    const int index = element.first_stiffness_point + k;
    const PointKinematics p0 = point_kinematics(begin.study.stiffness_rotations[index],
                                                interpolate<Nodes>(point.derivative, r0), point.reference_strain),
                          p1 = point_kinematics(end.study.stiffness_rotations[index],
                                                interpolate<Nodes>(point.derivative, r1), point.reference_strain);
    const Vector6 stress = point.stiffness * (0.5 * (p0.strain + p1.strain));
    const Vector3 n = 0.5 * (p0.rotation + p1.rotation) * stress.head<3>();
    const Vector3 w = interpolate<Nodes>(point.shape, increment);
    const double half = 0.5 * w.norm(), scaled = half > 0 ? std::tan(half) / half : 1;
    out.unscaled += point.weight * (1 - scaled) * w.dot((0.5 * (p0.tangent + p1.tangent)).cross(n));
    out.lever -= 0.5 * point.weight * w.dot((p1.tangent - p0.tangent).cross(n));
  }
  for (int i = 0; i < Nodes; ++i)
    for (int j = 0; j < Nodes; ++j) out.backward -= 0.5 * element.mass(i, j) * dv[i].dot(dv[j]);
}

EnergyIncrement energy_increment(const Model& model, const State& begin, const State& end) {
  EnergyIncrement out;
  for_each_element(model.beams, [&](const auto& element) { add_increment(element, begin, end, out); });
  return out;
}

/// Round-off of a step's balance. Newton's last update leaves a residual of epsilon times the forces that cancel in it:
/// section stiffness C times strains of rounded unit vectors, and inertia 4 m/h^2 times rounded positions of size r. It
/// works over the increments of the nodes. Ten operations each.
double round_off(const Simulation& simulation, const State& begin, double stiffness) {
  double work = 0;
  const double h = simulation.step_size(), inertia = 4 * total_mass(simulation) / (h * h);
  for (std::size_t i = 0; i < begin.nodes.size(); ++i) {
    const NodeState &a = begin.nodes[i], &b = state_of(simulation).nodes[i];
    const double increment = (b.position - a.position).norm() + b.orientation.angularDistance(a.orientation);
    work += increment * (stiffness + inertia * (1 + b.position.norm()));
  }
  return 10 * kEpsilon * (work + simulation.energies().total());
}

Simulation tumbling(const std::string& scheme, Interpolation interpolation) {
  SceneBuilder b = tumbling_beam();
  b.scene.integrator.scheme = scheme;
  b.scene.integrator.interpolation = interpolation;
  b.scene.integrator.step = 0.05;
  b.scene.integrator.tolerance = 1e-10;
  // quadratic convergence leaves only round-off
  return Simulation(b.scene, full_newton());
}

struct Identity {
  double largest_defect = 0, largest_gain = 0;  ///< [round-off]
};

/// Largest |E_{n+1} - E_n - predicted| and largest |predicted| over 200 steps, in multiples of round-off.
template <class Predict>
Identity check_identity(Simulation simulation, const Predict& predict) {
  Identity out;
  State before = state_of(simulation);
  double energy = simulation.energies().total();
  run(simulation, 200, [&] {
    const double gain = simulation.energies().total() - energy, unit = round_off(simulation, before, 2e3);
    const double predicted = predict(energy_increment(model_of(simulation), before, state_of(simulation)));
    out.largest_defect = std::max(out.largest_defect, std::abs(gain - predicted) / unit);
    out.largest_gain = std::max(out.largest_gain, std::abs(predicted) / unit);
    before = state_of(simulation);
    energy = simulation.energies().total();
  });
  return out;
}

TEST(EnergyIncrement, OfM1IsEquation617) {
  const Identity m1 =
      check_identity(tumbling("m1", Interpolation::Incremental), [](const EnergyIncrement& e) { return e.unscaled; });
  std::printf("M1: defect %.2g, gain %.2g units of round-off\n", m1.largest_defect, m1.largest_gain);
  EXPECT_LT(m1.largest_defect, 1);
  EXPECT_GT(m1.largest_gain, 1e4) << "the check must be able to fail";
}

TEST(EnergyIncrement, OfM2IsEquation621) {
  const auto sum = [](const EnergyIncrement& e) { return e.unscaled + e.lever + e.backward; };
  const Identity m2 = check_identity(tumbling("m2", Interpolation::Incremental), sum);
  std::printf("M2: defect %.2g, gain %.2g units of round-off\n", m2.largest_defect, m2.largest_gain);
  EXPECT_LT(m2.largest_defect, 1);
  EXPECT_GT(m2.largest_gain, 1e4);
  // Each of the three terms is necessary.
  for (int left_out = 0; left_out < 3; ++left_out) {
    const Identity part = check_identity(tumbling("m2", Interpolation::Incremental), [&](const EnergyIncrement& e) {
      return sum(e) - (left_out == 0 ? e.unscaled : left_out == 1 ? e.lever : e.backward);
    });
    EXPECT_GT(part.largest_defect, 1e4) << left_out;
  }
}

// The derivation interpolates increments with the test functions. So the equation does not hold for the total
// interpolation.
TEST(EnergyIncrement, NeedsInterpolatedIncrements) {
  const Identity total =
      check_identity(tumbling("m1", Interpolation::Total), [](const EnergyIncrement& e) { return e.unscaled; });
  EXPECT_GT(total.largest_defect, 1e3);
}

// ---------------------------------------------------------------- the sign of M2's increment

/// A free straight beam that vibrates across and along its axis, with tip velocities of `amplitude` [m/s].
Simulation vibrating(const std::string& scheme, double step, double amplitude) {
  SceneBuilder b;
  b.beam("beam", {{2, 0, 0}}, soft_section(), 4, 2);
  b.joint("free", scene::JointKind::Floating, "world", "beam", {-1, 0, 0});
  b.scene.integrator.interpolation = Interpolation::Incremental;
  SimulationOptions set = options(scheme, step, 1e-10);
  set.reuse_factorisation = false;
  Simulation simulation(b.scene, set);
  State state = state_of(simulation);
  for (NodeState& node : state.nodes) {
    const double x = node.position.x();
    node.velocity = amplitude * Vector3(x, 1.5 * (x * x - 1.0 / 3), 0);
    node.angular_velocity = amplitude * Vector3(0, 0, 3 * x);
  }
  for_each_element(model_of(simulation).beams, [&](const auto& element) {
    for (std::size_t k = 0; k < element.mass_points.size(); ++k) {
      Vector3& W = state.study.mass_points[element.first_mass_point + k].angular_velocity;
      W.setZero();
      for (std::size_t i = 0; i < element.nodes.size(); ++i)
        W += element.mass_points[k].shape[i] * state.nodes[element.nodes[i]].angular_velocity;
    }
  });
  restore(simulation, state);
  return simulation;
}

// For velocities and deformations of small size a, the term w.(e_1 x n) vanishes to first order in a for extension, and
// is of size a^2 for shear. It is multiplied by 1 - tan(w/2)/(w/2) of size a^2. In w.(Delta r' x n), w is normal to the
// plane, and Delta r' and n are transverse in the plane; this term is of size a^4, too. |Delta v|^2 is of size a^2, so
// it decides the sign.
TEST(EnergyOfM2, FallsInEveryStepOfASmallVibration) {
  Simulation m2 = vibrating("m2", 2e-3, 1e-2), m1 = vibrating("m1", 2e-3, 1e-2);
  const double begin = m2.energies().total();
  double energy = begin, others = 0, drift_of_m1 = 0;
  State before = state_of(m2);
  run(m2, 500, [&] {
    const EnergyIncrement e = energy_increment(model_of(m2), before, state_of(m2));
    const double now = m2.energies().total();
    EXPECT_LT(now, energy) << "t = " << m2.time();
    others = std::max(others, std::abs((e.unscaled + e.lever) / e.backward));
    energy = now;
    before = state_of(m2);
  });
  run(m1, 500, [&] { drift_of_m1 = std::max(drift_of_m1, std::abs(m1.energies().total() - begin)); });
  std::printf("M2 loses %.1f %%, largest part of the other terms %.1e; M1 changes by %.1e\n",
              100 * (1 - energy / begin), others, drift_of_m1 / begin);
  EXPECT_LT(others, 0.1);
  EXPECT_GT(begin - energy, 0.01 * begin);
  EXPECT_LT(drift_of_m1, 1e-4 * (begin - energy));
}

// M1's increment (6.17) may have either sign.
TEST(EnergyOfM1, RisesAndFalls) {
  Simulation m1 = tumbling("m1", Interpolation::Incremental);
  double energy = m1.energies().total(), highest = 0, lowest = 0;
  run(m1, 200, [&] {
    const double now = m1.energies().total();
    highest = std::max(highest, now - energy);
    lowest = std::min(lowest, now - energy);
    energy = now;
  });
  EXPECT_GT(highest, 1e-8 * energy);
  EXPECT_LT(lowest, -1e-8 * energy);
}

// With Delta v = h a (1 + O(omega h)), a step from a vibrating state loses (h^2/2) int |a|^2 A_rho ds to leading order.
// The waves that give most of the acceleration have omega of about 50 / s.
TEST(EnergyOfM2, LossPerStepIsHalfTheSquareOfStepTimesAcceleration) {
  const double coarsest = 1e-3;
  Simulation start = vibrating("m1", coarsest, 1e-3);  // so small that the other terms are 1e-5 of this one
  run(start, 50);
  const auto loss = [&](const std::string& scheme, double h, double& backward) {
    Simulation simulation = vibrating(scheme, h, 0);
    restore(simulation, state_of(start));
    const double energy = simulation.energies().total();
    run(simulation, 1);
    backward = energy_increment(model_of(simulation), state_of(start), state_of(simulation)).backward;
    return energy - simulation.energies().total();
  };
  double backward = 0;
  const double tiny = 1e-2 * coarsest;  // a = Delta v / h of M1, to second order in h at the middle of the step
  loss("m1", tiny, backward);
  const double half_square = -backward / (tiny * tiny);  // 1/2 int |a|^2 A_rho ds
  std::vector<double> losses;
  for (const double h : {coarsest, coarsest / 2, coarsest / 4, coarsest / 8}) {
    const double lost = loss("m2", h, backward);
    EXPECT_NEAR(lost / (h * h * half_square), 1, 50 * h);
    std::printf("h = %.2e: loss %.3e J, over the square - 1: %+.1e\n", h, lost, lost / (h * h * half_square) - 1);
    if (!losses.empty()) {
      EXPECT_NEAR(std::log2(losses.back() / lost), 2, 50 * 2 * h);
    }
    losses.push_back(lost);
  }
}

// ---------------------------------------------------------------- STD

TEST(EnergyOfStd, IsExactWithBothMomenta) {
  Simulation simulation(tumbling_beam().scene, options("std", 0.05, 1e-10));
  InvariantDrift drift(simulation);
  run(simulation, 2000, [&] { drift.observe(); });
  std::printf("STD: drift of energy %.1e, momentum %.1e, angular momentum %.1e\n", drift.energy(), drift.momentum(),
              drift.angular_momentum());
  EXPECT_LT(drift.energy(), 1e-11);
  EXPECT_LT(drift.momentum(), 1e-11);
  EXPECT_LT(drift.angular_momentum(), 1e-11);
}

/// Largest change of curvature when the end of a step from `begin` is rotated rigidly: by the interpolation of
/// tangent-scaled increments from `begin`, and by the local interpolation.
struct CurvatureChange {
  double tangent_scaled = 0, local = 0;
};

CurvatureChange turned_curvature(const Model& model, const State& begin, const State& end, const Quaternion& rotation) {
  CurvatureChange out;
  for_each_element(model.beams, [&](const auto& element) {
    constexpr int N = std::decay_t<decltype(element)>::kNodes;
    std::array<Vector3, N> plain, turned;
    std::array<Quaternion, N> end_plain, end_turned;
    for (int i = 0; i < N; ++i) {
      const Quaternion &q0 = begin.nodes[element.nodes[i]].orientation, &q1 = end.nodes[element.nodes[i]].orientation;
      plain[i] = cayley::increment(q0, q1);
      turned[i] = cayley::increment(q0, Quaternion(rotation * q1));
      end_plain[i] = q1;
      end_turned[i] = rotation * q1;
    }
    const ReferencedRotations<N> a(RotationParameters::TangentScaled, plain),
        b(RotationParameters::TangentScaled, turned);
    const LocalRotations<N> local(end_plain), local_turned(end_turned);
    for (int k = 0; k < N - 1; ++k) {
      const auto& point = element.stiffness_points[k];
      const PointRotation& reference = begin.study.stiffness_rotations[element.first_stiffness_point + k];
      GeneralisedShapeFunctions<N> unused;
      const Vector3 change = b.evaluate(point.shape, point.derivative, reference, unused).curvature -
                             a.evaluate(point.shape, point.derivative, reference, unused).curvature;
      const Vector3 local_change = local_turned.evaluate(point.shape, point.derivative).curvature -
                                   local.evaluate(point.shape, point.derivative).curvature;
      out.tangent_scaled = std::max(out.tangent_scaled, change.norm());
      out.local = std::max(out.local, local_change.norm());
    }
  });
  return out;
}

// The price of STD's exact energy: a rigid rotation after the step changes its strains.
TEST(EnergyOfStd, ItsStrainsAreNotInvariant) {
  Simulation simulation(tumbling_beam().scene, options("std", 0.05, 1e-10));
  run(simulation, 20);
  const State before = state_of(simulation);
  run(simulation, 1);
  const CurvatureChange change = turned_curvature(model_of(simulation), before, state_of(simulation),
                                                  Quaternion(Eigen::AngleAxisd(0.5, Vector3(1, 2, -2) / 3)));
  std::printf("rigid turn by 0.5 rad: curvature changes by %.1e (STD), %.1e (local)\n", change.tangent_scaled,
              change.local);
  EXPECT_LT(change.local, 100 * kEpsilon);
  EXPECT_GT(change.tangent_scaled, 1e6 * kEpsilon) << "far above round-off";
}

}  // namespace
}  // namespace flexarm::test
