// A beam is moved down across another one, against a published example.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "reference/contact_scenes.h"

namespace flexarm::test::crossing_beams {
namespace {

// Example beam3_line2_genalpha_contact_penalty_twocrossedbeams of the tests of 4C Multiphysics, the program behind
// C. Meier, W. A. Wall, A. Popp, A unified approach for beam-to-beam contact, CMAME 315 (2017) 972, in its own units:
// a beam that is built in at both ends, and a straight one above it that is moved down and along it. It says where node
// 8 of 20 has gone.
constexpr double kLength = 5, kPenalty = 1e6, kPlace = 7 * kLength / 19;
const Vector3 kFrom(-2.5, 0, 0), kTo(1.830127018922193, -2.5, 0), kAbove(0.8550503583141718, 2.349231551964771, 1.32);
const Vector3 kPublished(-2.35320636690075330e-01, 8.03793046908387043e-02, -1.64147761604003972);
// Minimum of the energy by test/elements/scripts/reference_crossing.py: with the example's 19 straight elements and its
// contact 6e-5 off what is published; with finer meshes, and contact along the line that gives way by these depths,
// this (76 elements; 152 are within 6e-5).
constexpr double kDeep = 5.83e-3, kShallow = 2.083e-3;
const Vector3 kWhenDeep(-0.227972, 0.077691, -1.622773), kWhenShallow(-0.228708, 0.077855, -1.625315);

std::string beam(const std::string& name, const Vector3& to, double stiffer, int elements) {
  const double shear = 5e4 * 1.1 * 0.282743, mass = 1, turned = 0.045;  // slow motions: inertia does not count
  return fmt::format(
      "<link name=\"{0}\"><beam elements=\"{1}\" order=\"2\"><centerline><line to=\"{2:.17g} {3:.17g} 0\"/>"
      "</centerline><section ea=\"{4}\" ga2=\"{5}\" ga3=\"{5}\" gj=\"{6}\" ei2=\"{7}\" ei3=\"{7}\" mass=\"{8}\" "
      "j1=\"{9}\" j2=\"{10}\" j3=\"{10}\"/><damping mass_proportional=\"20\" stiffness_proportional=\"0\"/></beam>"
      "</link>",
      name, elements, to.x(), to.y(), 28274.3 * stiffer, shear * stiffer, 636.175 * stiffer, 636.173 * stiffer, mass,
      2 * turned, turned);
}

std::string place(const std::string& element, const Vector3& x) {
  return fmt::format("<{} xyz=\"{:.17g} {:.17g} {:.17g}\"/>", element, x.x(), x.y(), x.z());
}

/// The upper beam is 1e6 times as stiff, and held where it starts.
Simulation crossing(int elements) {
  const Vector3 along = kTo - kFrom, across(-2 * kAbove.x(), -2 * kAbove.y(), 0);
  const auto slider = [](const std::string& parent, const std::string& child, const std::string& axis) {
    return fmt::format(
        "<link name=\"{1}\">{3}</link><joint name=\"of_{1}\" type=\"prismatic\"><parent link=\"{0}\"/>"
        "<child link=\"{1}\"/><axis xyz=\"{2}\"/><limit effort=\"1e9\" velocity=\"1e9\" lower=\"-9\" upper=\"9\"/>"
        "</joint>",
        parent, child, axis, touching::inertial(1, Vector3::Constant(1)));
  };
  return touching::simulation_of(
      beam("lower", along, 1, elements) + beam("upper", across, 1e6, 8) + slider("world", "cart", "1 0 0") +
          slider("cart", "lift", "0 0 1") + "<joint name=\"clamp\" type=\"fixed\"><parent link=\"world\"/>" +
          "<child link=\"lower\"/>" + place("origin", kFrom) + "</joint><loop_joint name=\"end\" type=\"fixed\">" +
          "<parent link=\"lower\"/><child link=\"world\"/>" + place("origin", along) + place("child_origin", kTo) +
          "</loop_joint><joint name=\"grip\" type=\"fixed\"><parent link=\"lift\"/><child link=\"upper\"/>" +
          place("origin", kAbove) + "</joint>" +
          fmt::format("<contact first=\"lower\" second=\"upper\" stiffness=\"{}\" restitution=\"1\"/>", kPenalty),
      "<motion joint=\"of_cart\" position=\"0:0:0 1:-0.4:0\"/><motion joint=\"of_lift\" position=\"0:0:0 1:-2.5:0\"/>",
      0.02, Vector3::Zero());
}

/// By how much the place of node 8 is off the limit for what contact gives way by [of 1.66 that it moves].
double error(int elements) {
  Simulation simulation = crossing(elements);
  const Vector3 begin = simulation.section(1, kPlace).pose.position;
  touching::run(simulation, 1.04);
  const Vector3 moved = simulation.section(1, kPlace).pose.position - begin;
  std::vector<ActingContact> contacts;
  simulation.contacts(contacts);
  double depth = 0;
  for (const ActingContact& contact : contacts) depth = std::max(depth, contact.penetration);
  EXPECT_GT(depth, kShallow);
  EXPECT_LT(depth, kDeep);
  const double part = (depth - kShallow) / (kDeep - kShallow);
  const Vector3 limit = kWhenShallow + part * (kWhenDeep - kWhenShallow);
  const double error = (moved - limit).norm();
  EXPECT_LE((moved - kPublished).norm(), 0.0203 + error) << "its own mesh is so far off";
  return error;
}

// The line is bent within sqrt(EI / F) = 0.3 of where it is touched, as long as an element: the error falls by order 2
// at least. What is published, with straight elements of 0.26, is 0.02 off its own limit: here it is a sixth of that.
TEST(CrossingBeams, StandWhereAPublishedExampleHasThem) {
  const double coarse = error(12), fine = error(16);
  EXPECT_LT(fine, 0.02 / 6);
  EXPECT_LT(fine, coarse * std::pow(12.0 / 16, 2));
}

}  // namespace
}  // namespace flexarm::test::crossing_beams
