// Tests two strands that are wound around each other against the closed form of a ply.
#include "math/pi.h"
#include "reference/contact_scenes.h"

namespace flexarm::test::touching {
namespace {

constexpr double kRadius = 0.01, kLength = 0.6, kYoung = 1e5, kPoisson = 0.3;  // soft cords [m, Pa]
const double kArea = kPi * kRadius * kRadius, kBending = kYoung * kArea * kRadius * kRadius / 4;
const double kShearModulus = kYoung / (2 * (1 + kPoisson)), kTorsion = kShearModulus * kArea * kRadius * kRadius / 2;
const double kStretching = kYoung * kArea;
const double kShearing = 6 * (1 + kPoisson) / (7 + 6 * kPoisson) * kShearModulus * kArea;  // Cowper's shear coefficient

// ---------------------------------------------------------------- the closed form

/// Results for one strand, per length of its undeformed line.
struct Ply {
  double contact = 0;               ///< force between the strands [N/m]
  double bending = 0, tension = 0;  ///< of a section [N m, N]
  double moment = 0;                ///< about the axis, including the arm of the force [N m]
  double turn = 0;                  ///< rotation of the helix about the axis [rad/m]
};

/// The uniform ply without friction of J. M. T. Thompson, G. H. M. van der Heijden and S. Neukirch, Supercoiling of DNA
/// plasmids: mechanics of the generalized ply, Proc. R. Soc. Lond. A 458 (2002) 959. Stretch and shear of the strand's
/// law are added as in docs/notes/contact.md 6 and test/elements/scripts/reference_ply.py. `radius` of the helix [m],
/// `angle` of its tangent with the axis [rad], `twist` of a section [rad/m], `axial` force of a strand [N]. `give` 0:
/// the ply of the paper, whose strands neither stretch nor shear; 1: with stretch and shear.
Ply ply(double radius, double angle, double twist, double axial, double give) {
  Ply out;
  double stretch = 1, beta = angle;
  for (int i = 0; i < 50; ++i) {
    out.turn = stretch * std::sin(angle) / radius;
    out.bending = kBending * out.turn * std::sin(beta);
    const double around = kTorsion * twist * std::sin(beta) - out.bending * std::cos(beta);
    const double across = std::tan(angle) * (axial - around / radius);
    out.contact = out.turn * across;
    out.tension = across * std::sin(beta) + axial * std::cos(beta);
    out.moment = out.bending * std::sin(beta) + kTorsion * twist * std::cos(beta) + radius * across;
    const double shear = give * (axial * std::sin(beta) - across * std::cos(beta)) / kShearing,
                 along = 1 + give * out.tension / kStretching;
    beta = angle + std::atan2(shear, along);
    stretch = std::hypot(shear, along);
  }
  return out;
}

// ---------------------------------------------------------------- the strands

std::string strand(const std::string& name, double place, int elements) {
  const std::string head = fmt::format("0 0 {}", kLength), beside = fmt::format("{} 0 0", place);
  return round_beam(name, "<line to='" + head + "'/>", kRadius,
                    fmt::format("<material young='{}' poisson='{}' density='1000'/><damping mass_proportional='20' "
                                "stiffness_proportional='0.02'/>",
                                kYoung, kPoisson),
                    elements) +
         joint("of_" + name, "fixed", "world", name, "<origin xyz='" + beside + "'/>") +
         joint("end_" + name, "fixed", name, "head", "<origin xyz='" + head + "'/><child_origin xyz='" + beside + "'/>",
               "loop_joint");
}

/// Both strands are clamped at one end. At the other end they are clamped in a head that turns by 6 rad and is pulled
/// along the axis by twice `axial`. They start a hundredth of their radius apart, which is also the contact's
/// penetration.
Simulation twisted(int elements, double axial) {
  const double place = 1.005 * kRadius;
  return simulation_of(
      strand("one", place, elements) + strand("two", -place, elements) + body("slide", 0.05, Vector3::Constant(1e-5)) +
          body("head", 0.05, Vector3::Constant(1e-5)) +
          joint("along", "prismatic", "world", "slide",
                fmt::format("<origin xyz='0 0 {}'/><axis xyz='0 0 1'/><dynamics damping='3'/>", kLength) + kFarLimits) +
          joint("turn", "continuous", "slide", "head", "<axis xyz='0 0 1'/>") +
          contact_of("one", "two", fmt::format("stiffness='{}' restitution='1'", 0.03 * kYoung * kLength)),
      fmt::format("<motion joint='turn' position='0:0:0 0.6:6:0'/><load link='slide' force='0 0 {:.17g}'/>", 2 * axial),
      0.01, Vector3::Zero());
}

/// The middle third of a strand, per length of its undeformed line.
struct Middle {
  double radius = 0, angle = 0;  ///< of the helix [m, rad]
  double turn = 0;               ///< rotation of the helix about the axis [rad/m]
  double twist_by_ends = 0;      ///< of sections: mean rotation about the line over the whole strand [rad/m]
  double contact = 0, bending = 0, tension = 0, torsion = 0;  ///< [N/m, N m, N, N m]
};

double angle_about_z(const Vector3& from, const Vector3& to) {
  return std::atan2(from.x() * to.y() - from.y() * to.x(), from.x() * to.x() + from.y() * to.y());
}

/// Computes the helix on which the strand's nodes are.
void read_helix(const Simulation& simulation, int elements, Middle& out) {
  const auto place = [&](double s) { return simulation.section(1, s).pose.position; };
  constexpr int kFine = 40;
  const int first = elements / 3, count = elements - 2 * first;
  const double size = kLength / elements;
  for (int k = 0; k < elements * kFine; ++k) {
    const double from = k * size / kFine, to = std::min(kLength, from + size / kFine);
    const double angle = angle_about_z(place(from), place(to));
    const Matrix3 section = simulation.section(1, 0.5 * (from + to)).pose.orientation.toRotationMatrix();
    out.twist_by_ends += angle * section(2, 0) / kLength;
    if (k / kFine >= first && k / kFine < first + count) out.turn += angle / (count * size);
  }
  for (int k = first; k < first + count; ++k) out.radius += place(k * size).head<2>().norm() / count;
  const double pitch = (place((first + count) * size).z() - place(first * size).z()) / (count * size);
  out.angle = std::atan2(out.radius * out.turn, pitch);
}

/// Computes resultants at Gauss points, and forces between the strands by a smooth window.
void read_forces(const Simulation& simulation, int elements, Middle& out) {
  const int first = elements / 3, count = elements - 2 * first;
  const double size = kLength / elements;
  for (int k = first; k < first + count; ++k)
    for (const double at : {0.5 - std::sqrt(1.0 / 12), 0.5 + std::sqrt(1.0 / 12)}) {
      const BeamPoint point = simulation.section(1, (k + at) * size);
      out.tension += point.resultant[0] / (2 * count);
      out.torsion += point.resultant[3] / (2 * count);
      out.bending += point.resultant.tail<2>().norm() / (2 * count);
    }
  const double low = simulation.section(1, first * size).pose.position.z(),
               high = simulation.section(1, (first + count) * size).pose.position.z();
  std::vector<ActingContact> contacts;
  simulation.contacts(contacts);
  for (const ActingContact& contact : contacts) {
    const double part = (contact.position.z() - low) / (high - low);
    if (part > 0 && part < 1) out.contact += (1 - std::cos(2 * kPi * part)) * contact.force.norm() / (count * size);
  }
}

/// Relative differences from the closed form at the strand's radius, angle and twist.
struct Errors {
  double contact = 0, bending = 0;
};

Errors errors(int elements) {
  const double axial = 0.1 * kBending / (kRadius * kRadius);
  Simulation simulation = twisted(elements, axial);
  run_until(simulation, 1.2);
  Middle middle;
  read_helix(simulation, elements, middle);
  read_forces(simulation, elements, middle);
  EXPECT_GT(middle.angle, 0.1);
  const double twist = middle.torsion / kTorsion;
  const Ply exact = ply(middle.radius, middle.angle, twist, axial, 1);
  // Remainder of the motion: drag decays at least by exp(-10 t), for 0.6 s.
  const double rest = std::exp(-6.0);
  EXPECT_NEAR(middle.turn, exact.turn, 1e-3 * exact.turn);
  EXPECT_NEAR(middle.tension, exact.tension, rest * exact.tension);
  EXPECT_NEAR(twist, middle.twist_by_ends, rest * twist) << "which is one number along the strand";
  const double moment = simulation.effort(simulation.find_coordinate("turn").value()) / 2;
  EXPECT_NEAR(moment, exact.moment, rest * exact.moment);
  // Compares with the paper's strands, which neither stretch nor shear.
  const Ply paper = ply(middle.radius, middle.angle, twist, axial, 0);
  const double give = axial / kStretching + axial / kShearing;
  Errors out{middle.contact / exact.contact - 1, middle.bending / exact.bending - 1};
  EXPECT_NEAR(middle.contact, paper.contact, (give + std::abs(out.contact)) * paper.contact);
  EXPECT_NEAR(middle.bending, paper.bending, (give + std::abs(out.bending)) * paper.bending);
  return out;
}

// Where strands leave their clamps, the difference in bending decays by exp(-x sqrt(F / B)), to 0.2 % at the ends of
// the middle third. Elements of order 2 turn by 0.73 rad each. They have the curvature of a line to (0.73)^4 / 720 at
// these points, and the contact force with two derivatives more.
TEST(TwistedPair, IsTheUniformPlyOfTheClosedForm) {
  const Errors coarse = errors(6), fine = errors(9);
  EXPECT_LT(std::abs(fine.contact), 0.005);
  EXPECT_LT(std::abs(fine.bending), 0.002);
  // At least of order 2.
  EXPECT_GT(std::abs(coarse.contact), 2.25 * std::abs(fine.contact));
  EXPECT_GT(std::abs(coarse.bending), 2.25 * std::abs(fine.bending));
}

}  // namespace
}  // namespace flexarm::test::touching
