#include "bench/random_arms.h"

#include <random>

#include <fmt/format.h>

#include "math/pi.h"

namespace flexarm::bench {
namespace {

constexpr unsigned kSeed = 2004;

/// Random numbers that do not depend on the implementation of the standard library.
class Numbers {
 public:
  explicit Numbers(int index) : engine_(kSeed + static_cast<unsigned>(index)) {}
  double between(double from, double to) { return from + (to - from) * (engine_() / 4294967296.0); }
  bool chance(double probability) { return between(0, 1) < probability; }

 private:
  std::mt19937 engine_;
};

/// An aluminium rod along x, flexible or rigid.
std::string link(Numbers& numbers, int i, double length, bool is_flexible, bool is_automatic) {
  const double radius = length * numbers.between(0.015, 0.04), mass = 2700 * kPi * radius * radius * length;
  if (is_flexible)
    return fmt::format(
        R"(  <link name="link{0}">
    <beam{1}>
      <centerline> <line to="{2:.6f} 0 0"/> </centerline>
      <circle radius="{3:.6f}"/> <material young="70e9" poisson="0.33" density="2700"/>
      <damping stiffness_proportional="{4:.3g}"/>
    </beam>
  </link>
)",
        i, is_automatic ? "" : fmt::format(" elements=\"{}\"", 2 + static_cast<int>(numbers.between(0, 3))), length,
        radius, numbers.between(2e-4, 2e-3));
  const double across = mass * length * length / 12, along = 0.5 * mass * radius * radius;
  return fmt::format(
      R"(  <link name="link{0}">
    <inertial> <origin xyz="{1:.6f} 0 0"/> <mass value="{2:.6f}"/>
      <inertia ixx="{3:.6g}" ixy="0" ixz="0" iyy="{4:.6g}" iyz="0" izz="{4:.6g}"/> </inertial>
  </link>
)",
      i, 0.5 * length, mass, along, across + along);
}

}  // namespace

int random_arm_joints(int index) {
  return 1 + index % 7;
}

std::string random_arm(int index) {
  Numbers numbers(index);
  const int joints = random_arm_joints(index);
  std::string text = fmt::format("<robot name=\"random_arm_{}\">\n  <link name=\"world\"/>\n", index), initial;
  double reach = 0, length = 0;
  std::string parent = "world";
  for (int i = 1; i <= joints; ++i) {
    const char* axis = i == 1 ? "0 1 0" : numbers.chance(0.3) ? "0 0 1" : numbers.chance(0.3) ? "1 0 0" : "0 1 0";
    text += fmt::format(
        "  <joint name=\"joint{0}\" type=\"continuous\"> <parent link=\"{1}\"/> <child link=\"link{0}\"/>\n"
        "    <origin xyz=\"{2:.6f} 0 0\"/> <axis xyz=\"{3}\"/> <dynamics damping=\"{4:.3g}\"/> </joint>\n",
        i, parent, reach, axis, numbers.between(0.05, 0.5));
    initial += fmt::format("    <initial joint=\"joint{}\" position=\"{:.4f}\"/>\n", i, numbers.between(-1, 1));
    length = numbers.between(0.25, 0.8);
    const bool is_flexible = i == joints ? numbers.chance(0.7) : numbers.chance(0.4);
    text += link(numbers, i, length, is_flexible, index % 2 == 1);
    reach = length;
    parent = fmt::format("link{}", i);
  }
  return text + fmt::format(
                    "  <simulation>\n    <integrator step=\"0.001\"/>\n{}    <probe name=\"tip\" link=\"{}\" "
                    "at=\"{:.6f} 0 0\"/>\n  </simulation>\n</robot>\n",
                    initial, parent, length);
}

}  // namespace flexarm::bench
