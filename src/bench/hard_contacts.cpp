// Hard cases of contact: wedges, several hits at once, edges, extreme masses, stiffnesses, steps, sizes and speeds.
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "bench/hard_group.h"
#include "bench/urdf.h"
#include "math/pi.h"

namespace flexarm::bench {
namespace {

using namespace urdf;

const std::string kGravity = gravity({0, 0, -9.81});
const std::string kFloor = "<ground name=\"floor\"/>\n";

std::string collision(const std::string& geometry, const Vector3& at = Vector3::Zero()) {
  return fmt::format("<collision> <origin xyz=\"{}\"/> <geometry> <{}/> </geometry> </collision>", triple(at),
                     geometry);
}
std::string sphere(double radius) {
  return fmt::format("sphere radius=\"{:.17g}\"", radius);
}
std::string cuboid(const Vector3& size) {
  return fmt::format("box size=\"{}\"", triple(size));
}
/// A cylinder along z.
std::string barrel(double radius, double length) {
  return fmt::format("cylinder radius=\"{}\" length=\"{}\"", radius, length);
}

/// A free body on a floating joint called `name`.
std::string free_body(const std::string& name, double mass, const Vector3& inertia, const std::string& collisions) {
  return joint(name, "floating", "world", name + "_body") +
         fmt::format(
             "<link name=\"{}_body\"> <inertial> <mass value=\"{}\"/> <inertia ixx=\"{}\" iyy=\"{}\" izz=\"{}\" "
             "ixy=\"0\" ixz=\"0\" iyz=\"0\"/> </inertial> {} </link>\n",
             name, mass, inertia.x(), inertia.y(), inertia.z(), collisions);
}
std::string ball(const std::string& name, double mass, double radius) {
  return free_body(name, mass, Vector3::Constant(0.4 * mass * radius * radius), collision(sphere(radius)));
}
std::string box(const std::string& name, double mass, const Vector3& size) {
  const Vector3 squares = size.cwiseAbs2();
  return free_body(name, mass, mass / 12 * (Vector3::Constant(squares.sum()) - squares), collision(cuboid(size)));
}
std::string cube(const std::string& name, double mass = 1, double size = 0.1) {
  return box(name, mass, Vector3::Constant(size));
}
std::string can(const std::string& name, double mass, double radius, double length) {
  const double across = mass * (3 * radius * radius + length * length) / 12;
  return free_body(name, mass, {across, across, mass * radius * radius / 2}, collision(barrel(radius, length)));
}
/// A link that is fixed to the world.
std::string built(const std::string& name, const std::string& geometry, const Vector3& at = Vector3::Zero(),
                  const Vector3& rpy = Vector3::Zero()) {
  return fmt::format(
      "<joint name=\"{0}\" type=\"fixed\"> <parent link=\"world\"/> <child link=\"{0}_body\"/> <origin xyz=\"{1}\" "
      "rpy=\"{2}\"/> </joint>\n<link name=\"{0}_body\"> {3} </link>\n",
      name, triple(at), triple(rpy), collision(geometry));
}
std::string half_space(const std::string& name, const Vector3& normal, double offset) {
  return fmt::format("<ground name=\"{}\" normal=\"{}\" offset=\"{}\"/>\n", name, triple(normal), offset);
}
/// Contact between all links and grounds; `law`: attributes.
std::string contact(const std::string& law) {
  return "<contact first=\"*\" second=\"*\" " + law + "/>\n";
}

/// Initial position of a free body, rotation about x, y, z, velocity and angular velocity.
std::string start(const std::string& name, const Vector3& at, const Vector3& rotation = Vector3::Zero(),
                  const Vector3& velocity = Vector3::Zero(), const Vector3& rate = Vector3::Zero()) {
  std::string out;
  for (int k = 0; k < 3; ++k)
    out += fmt::format(
        "<initial joint=\"{0}/{1}\" position=\"{2:.17g}\"/> <initial joint=\"{0}/r{1}\" position=\"{3:.17g}\"/>\n",
        name, "xyz"[k], at[k], rotation[k]);
  return out + initial_field(name + "_body", velocity, rate);
}

/// A flexible free body "b_body" on the floating joint "b".
std::string free_beam(const Vector3& to, const std::string& section, int elements, const std::string& more = "") {
  return joint("b", "floating", "world", "b_body") + beam("b_body", to, section, elements, more);
}

HardCase& add(HardGroup& group, const std::string& name, const std::string& parts, const std::string& simulation,
              double step, double until, const std::optional<Target>& target = {}) {
  HardCase& hard = group.add(name, scene(parts, simulation), step, until, target);
  hard.touches = true;
  return hard;
}

const Vector3 kZero = Vector3::Zero();

void add_wedges(HardGroup& group) {
  for (const double slope : {0.6, 0.02}) {
    const Vector3 left(std::cos(slope), 0, std::sin(slope)), right(-left.x(), 0, left.z());
    const std::string wedge = half_space("left", left, 0) + half_space("right", right, 0);
    add(group, fmt::format("ball falls into a wedge of {:g} rad", 2 * slope),
        ball("b", 1, 0.05) + wedge + contact("friction=\"0.3\""),
        kGravity + start("b", {1e-3, 0, 0.05 / std::sin(slope) + 0.05}), 1e-3, 1, coordinate_at("b/x", 0, 0.05, 0.1));
  }
  const Vector3 left(std::cos(0.3), 0, std::sin(0.3)), right(-left.x(), 0, left.z());
  add(group, "cube driven into a wedge at 5 m/s, friction 1",
      cube("b") + half_space("left", left, 0) + half_space("right", right, 0) + contact("friction=\"1\""),
      kGravity + start("b", {0, 0, 0.3}, kZero, {0, 0, -5}), 1e-3, 0.5, coordinate_at("b/x", 0, 0.05, 0.1));
  add(group, "peg set aslant on a slot as wide as it",
      box("b", 1, {0.05, 0.05, 0.2}) + built("left", cuboid({0.1, 0.2, 0.2}), {-0.0751, 0, 0}) +
          built("right", cuboid({0.1, 0.2, 0.2}), {0.0751, 0, 0}) + contact("friction=\"0.5\""),
      kGravity + start("b", {0, 0, 0.21}, {0, 0.05, 0}), 1e-3, 0.5);
  const std::string gap = half_space("ceiling", {0, 0, -1}, -0.098);
  add(group, "cube between floor and ceiling, 2 mm too low", cube("b") + kFloor + gap + contact("friction=\"0.5\""),
      kGravity + start("b", {0, 0, 0.049}, kZero, {1, 0, 0}), 1e-3, 0.5, coordinate_at("b/z", 0.049, 0.001, 1));
}

void add_several_at_once(HardGroup& group) {
  std::string balls, starts;
  for (int i = 0; i < 3; ++i) {
    const double angle = 2 * kPi * i / 3;
    const Vector3 outwards(std::cos(angle), std::sin(angle), 0);
    balls += ball(fmt::format("b{}", i), 1, 0.05);
    starts += start(fmt::format("b{}", i), 0.2 * outwards, kZero, -outwards);
  }
  // The balls meet when their centres are 0.1 m apart, 0.0577 m from the middle, and return the way they came.
  add(group, "three balls meet at once", balls + contact("restitution=\"1\""), starts, 1e-3, 0.4,
      coordinate_at("b0/x", 0.4 - 0.2 + 2 * 0.1 / std::sqrt(3), 0.2, 0.05));
  std::string rack, racked;
  int count = 0;
  for (int row = 0; row < 4; ++row)
    for (int k = 0; k <= row; ++k, ++count) {
      rack += ball(fmt::format("b{}", count), 0.17, 0.028);
      racked += start(fmt::format("b{}", count), {0.0486 * row, 0.0561 * (k - 0.5 * row), 0.028});
    }
  add(group, "ten balls in a rack, hit at 8 m/s",
      rack + ball("cue", 0.17, 0.028) + kFloor + contact("restitution=\"0.95\" friction=\"0.1\""),
      kGravity + racked + start("cue", {-0.3, 0.002, 0.028}, kZero, {8, 0, 0}), 1e-3, 0.3);
  std::string table;
  for (const double x : {-0.3, 0.0, 0.3})
    for (const double y : {-0.3, 0.0, 0.3}) table += collision(cuboid({0.04, 0.04, 0.4}), {x, y, -0.2});
  add(group, "table on nine legs: redundant",
      free_body("b", 5, {0.5, 0.5, 0.9}, table) + kFloor + contact("friction=\"0.5\""),
      kGravity + start("b", {0, 0, 0.41}, {0.02, 0.01, 0}), 1e-3, 1, coordinate_at("b/z", 0.4, 0.002, 1));
  // An arm that is stretched straight against a wall, and one that is hit along its axis.
  const std::string arm = joint("shoulder", "continuous", "world", "upper", {0, 0, 1}, axis({0, 1, 0})) +
                          body("upper", 1, 0.01, {0.25, 0, 0}) +
                          joint("elbow", "continuous", "upper", "fore", {0.5, 0, 0}, axis({0, 1, 0})) +
                          "<link name=\"fore\"> <inertial> <origin xyz=\"0.25 0 0\"/> <mass value=\"1\"/> <inertia "
                          "ixx=\"0.01\" iyy=\"0.01\" "
                          "izz=\"0.01\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/> </inertial> " +
                          collision(sphere(0.05), {0.5, 0, 0}) + " </link>\n";
  add(group, "stretched arm pushed along a wall",
      arm + half_space("wall", {-1, 0, 0}, -1.0499) + contact("friction=\"0.5\""), effort("shoulder", "20"), 1e-3, 1);
  add(group, "stretched arm hit along itself", arm + ball("b", 1, 0.05) + contact("restitution=\"0.5\""),
      start("b", {1.2, 0, 1}, kZero, {-5, 0, 0}), 1e-3, 0.5);
}

void add_masses_and_stiffnesses(HardGroup& group) {
  for (const double mass : {1e3, 1e6}) {
    add(group, fmt::format("ball of 1 kg falls on a block of {:g} kg", mass),
        ball("b", 1, 0.05) + box("block", mass, {0.3, 0.3, 0.1}) + kFloor + contact("restitution=\"0.5\""),
        kGravity + start("b", {0, 0, 0.2}) + start("block", {0, 0, 0.05}), 1e-3, 1,
        coordinate_at("b/z", 0.15, 0.005, 1));
    add(group, fmt::format("block of {:g} kg on a ball of 1 kg", mass),
        ball("b", 1, 0.05) + box("block", mass, {0.3, 0.3, 0.1}) + kFloor + contact("friction=\"0.5\""),
        kGravity + start("b", {0, 0, 0.05}) + start("block", {0, 0, 0.151}), 1e-3, 0.3,
        coordinate_at("b/z", 0.0475, 0.005, 1));
  }
  add(group, "grain of 1e-6 kg between two blocks that meet",
      ball("b", 1e-6, 0.002) + cube("one") + cube("other") + contact("restitution=\"0.5\""),
      start("b", kZero) + start("one", {-0.06, 0, 0}, kZero, {1, 0, 0}) +
          start("other", {0.06, 0, 0}, kZero, {-1, 0, 0}),
      1e-3, 0.1);
  for (const double stiffness : {1e3, 1e8, 1e12})
    add(group, fmt::format("cube falls on its corner, {:g} N/m", stiffness),
        cube("b") + kFloor + contact(fmt::format("friction=\"0.5\" stiffness=\"{}\"", stiffness)),
        kGravity + start("b", {0, 0, 0.15}, {0.6, 0.6, 0}), 1e-3, 0.5);
  add(group, "cube comes to rest, 1e12 N/m", cube("b") + kFloor + contact("friction=\"0.5\" stiffness=\"1e12\""),
      kGravity + start("b", {0, 0, 0.06}), 1e-3, 0.8, coordinate_at("b/z", 0.05, 1e-4, 1));
  add(group, "elastic beam on a floor of 1e12 N/m",
      free_beam({1, 0, 0}, circle(0.01), 8) + kFloor + contact("restitution=\"1\" stiffness=\"1e12\""),
      kGravity + start("b", {0, 0, 0.3}, {0, 0.2, 0}), 1e-3, 0.4);
}

void add_short_hits(HardGroup& group) {
  // A ball falls from 0.05 m with an initial velocity of 3 m/s.
  const double fast = std::sqrt(9 + 2 * 9.81 * 0.05), fall = (fast - 3) / 9.81, round = 2 * fast / 9.81;
  const double last = std::fmod(2 - fall, round);
  add(group, "elastic hits of a thousandth of a step, steps of 0.01 s",
      ball("b", 1, 0.05) + kFloor + contact("restitution=\"1\" stiffness=\"1e10\""),
      kGravity + start("b", {0, 0, 0.1}, kZero, {0, 0, -3}), 1e-2, 2,
      coordinate_at("b/z", 0.05 + fast * last - 0.5 * 9.81 * last * last, fast * round / 4, 0.05));
  add(group, "rattles between two walls, ten hits a step",
      ball("b", 1, 0.05) + half_space("left", {1, 0, 0}, -0.051) + half_space("right", {-1, 0, 0}, -0.051) +
          contact("restitution=\"1\" stiffness=\"1e8\""),
      start("b", kZero, kZero, {20, 0, 0}), 1e-3, 0.1);
  add(group, "balls meet head-on at 100 m/s",
      ball("b", 1, 0.05) + ball("other", 1, 0.05) + contact("restitution=\"1\""),
      start("b", {-0.2, 0, 0}, kZero, {50, 0, 0}) + start("other", {0.2, 0, 0}, kZero, {-50, 0, 0}), 1e-3, 0.3,
      coordinate_at("b/x", -0.05 - 50 * (0.3 - 0.15 / 50), 15, 0.01))
      .is_free = true;
  add(group, "beam dropped end-on at 100 m/s",
      free_beam({0, 0, 1}, circle(0.01), 8) + kFloor + contact("restitution=\"0.5\""),
      start("b", {0, 0, 0.1}, kZero, {0, 0, -100}), 1e-3, 0.05);
  add(group, "ball hits a clamped rod at 100 m/s",
      ball("b", 1, 0.05) + joint("clamp", "fixed", "world", "rod", {0, -0.5, 0}) +
          beam("rod", {0, 1, 0}, circle(0.005), 8) +
          loop_joint("other_clamp", "fixed", "world", "rod", {0, 0.5, 0}, {0, 1, 0}) + contact("restitution=\"0.5\""),
      start("b", {-0.5, 0.013, 1e-3}, kZero, {100, 0, 0}), 1e-3, 0.05);
}

/// The body "b_body" must stay below this height.
Bound lower_than(double height) {
  return {"is thrown up", [height](const Simulation& s) { return position_of(s, "b/z") / height; }};
}

void add_edges(HardGroup& group) {
  const double onto_corner = std::asin(1 / std::sqrt(3.0));
  add(group, "corner falls on a corner",
      cube("b") + built("other", cuboid({0.1, 0.1, 0.1}), kZero, {kPi / 4, onto_corner, 0}) +
          contact("friction=\"0.5\""),
      kGravity + start("b", {0, 0, 0.3}, {kPi / 4, onto_corner, 0}), 1e-3, 0.5);
  add(group, "edge falls across an edge",
      box("b", 1, {0.1, 0.4, 0.1}) + built("other", cuboid({0.4, 0.1, 0.1}), kZero, {kPi / 4, 0, 0}) +
          contact("friction=\"0.5\""),
      kGravity + start("b", {0, 0, 0.3}, {0, kPi / 4, 0}), 1e-3, 0.5);
  add(group, "plate falls over a knife's edge",
      box("b", 1, {0.4, 0.4, 0.02}) + built("other", cuboid({0.1, 1, 0.1}), kZero, {0, kPi / 4, 0}) +
          contact("friction=\"0.5\""),
      kGravity + start("b", {0.05, 0, 0.2}), 1e-3, 0.6);
  const std::string table = built("table", cuboid({0.5, 0.5, 0.1}), {0, 0, -0.05});
  add(group, "cube slides off a table",
      cube("b") + table + half_space("low", {0, 0, 1}, -0.5) + contact("friction=\"0.2\""),
      kGravity + start("b", {0, 0, 0.05}, kZero, {2, 0, 0}), 1e-3, 0.6, coordinate_at("b/z", -0.43, 0.03, 1))
      .bound = lower_than(0.051);
  add(group, "cube slides from a table to another one",
      cube("b") + table + built("other", cuboid({0.5, 0.5, 0.1}), {0.5, 0, -0.05}) + contact("friction=\"0.1\""),
      kGravity + start("b", {0, 0, 0.05}, kZero, {2, 0, 0}), 1e-3, 0.3,
      coordinate_at("b/x", 2 * 0.3 - 0.5 * 0.1 * 9.81 * 0.09, 0.6, 0.02))
      .bound = lower_than(0.051);
  add(group, "can rolls off a table",
      can("b", 1, 0.05, 0.1) + table + half_space("low", {0, 0, 1}, -0.2) + contact("friction=\"0.5\""),
      kGravity + start("b", {0.1, 0, 0.05}, {kPi / 2, 0, 0}, {1, 0, 0}, {0, 20, 0}), 1e-3, 0.8,
      coordinate_at("b/z", -0.15, 0.005, 1));
  add(group, "can falls on its rim", can("b", 1, 0.05, 0.1) + kFloor + contact("friction=\"0.5\" restitution=\"0.5\""),
      kGravity + start("b", {0, 0, 0.2}, {0.5, 0, 0}), 1e-3, 1);
}

void add_starts_inside(HardGroup& group) {
  add(group, "coinciding balls", ball("b", 1, 0.05) + ball("other", 1, 0.05) + contact(""),
      start("b", kZero) + start("other", kZero), 1e-3, 0.3)
      .is_free = true;
  add(group, "coinciding cubes, one moves", cube("b") + cube("other") + contact(""),
      start("b", kZero, kZero, {1, 0, 0}) + start("other", kZero), 1e-3, 0.3);
  add(group, "ball starts in the middle of a fixed can",
      ball("b", 1, 0.02) + built("can", barrel(0.1, 0.3)) + contact(""), start("b", kZero), 1e-3, 0.3);
  add(group, "cube starts half in the floor", cube("b") + kFloor + contact("friction=\"0.5\""),
      kGravity + start("b", kZero), 1e-3, 3, coordinate_at("b/z", 0.05, 0.005, 1));
  add(group, "beam starts within a box",
      free_beam({1, 0, 0}, circle(0.005, 1e9, 1000), 8) + built("box", cuboid({0.2, 0.2, 0.2}), {0.5, 0, 0}) +
          contact(""),
      start("b", {0, 0, 0.05}), 1e-3, 0.3);
  std::string cubes, starts;
  for (int i = 0; i < 4; ++i) {
    cubes += cube(fmt::format("b{}", i));
    starts += start(fmt::format("b{}", i), {0.01 * i, 0.005 * i, 0.06 + 0.07 * i});
  }
  add(group, "pile of cubes 30 mm inside of each other", cubes + kFloor + contact("friction=\"0.5\""),
      kGravity + starts, 1e-3, 1);
}

void add_steps_sizes_speeds(HardGroup& group) {
  for (const double step : {0.05, 0.5})
    add(group, fmt::format("cube tumbles and rests, steps of {:g} s", step),
        cube("b") + kFloor + contact("friction=\"0.5\""), kGravity + start("b", {0, 0, 1}, kZero, kZero, {1, 2, 3}),
        step, 60 * step, coordinate_at("b/z", 0.05, 0.005, 1));
  add(group, "beam falls, steps of 0.05 s",
      free_beam({1, 0, 0}, circle(0.01), 8) + kFloor + contact("friction=\"0.5\""),
      kGravity + start("b", {0, 0, 1}, {0, 0.3, 0}), 0.05, 2);
  add(group, "cube of 10 um", cube("b", 1e-12, 1e-5) + kFloor + contact("friction=\"0.5\""),
      kGravity + start("b", {0, 0, 1.5e-5}, {0.3, 0.2, 0}), 1e-5, 5e-3, coordinate_at("b/z", 5e-6, 5e-7, 1));
  // It hits the ground after 0.5 ms and leaves with half of its speed.
  add(group, "shot of 0.1 mm at 100 m/s", ball("b", 4e-9, 5e-5) + kFloor + contact("restitution=\"0.5\""),
      start("b", {0, 0, 0.05005}, kZero, {0, 0, -100}), 1e-3, 0.02,
      coordinate_at("b/z", 5e-5 + 50 * 0.0195, 0.975, 0.02));
  add(group, "boulder of 1 m on a planet of 1000 km",
      ball("planet", 1e20, 1e6) + ball("b", 1000, 1) + contact("restitution=\"0.5\""),
      start("planet", kZero) + start("b", {0, 0, 1e6 + 10}, kZero, {0, 0, -10}), 1e-2, 3,
      coordinate_at("b/z", 1e6 + 1 + 5 * 2.1, 10, 0.05));
  add(group, "top at 1000 rad/s on its tip",
      free_body("b", 0.1, {1e-4, 1e-4, 5e-5}, collision(sphere(0.002), {0, 0, -0.05})) + kFloor +
          contact("friction=\"0.3\""),
      kGravity + start("b", {0, 0, 0.053}, {0.1, 0, 0}, kZero, {0, 0, 1000}), 1e-4, 0.3);
  add(group, "box at 500 rad/s falls on the floor",
      box("b", 1, {0.2, 0.1, 0.05}) + kFloor + contact("friction=\"0.5\" restitution=\"0.5\""),
      kGravity + start("b", {0, 0, 0.3}, kZero, kZero, {500, 20, 100}), 1e-3, 0.5);
  add(group, "ball with a backspin of 1000 rad/s", ball("b", 0.2, 0.03) + kFloor + contact("friction=\"0.4\""),
      kGravity + start("b", {0, 0, 0.03}, kZero, {5, 0, 0}, {0, -1000, 0}), 1e-3, 0.5,
      coordinate_at("b/x", 2.5 - 0.5 * 0.4 * 9.81 * 0.25, 2.5, 0.01));
}

void add_stacks(HardGroup& group) {
  std::string cubes, balls, starts, askew;
  for (int i = 0; i < 10; ++i) {
    const std::string name = fmt::format("b{}", i);
    cubes += cube(name);
    balls += ball(name, 1, 0.05);
    starts += start(name, {0, 0, 0.05 + 0.1 * i});
    askew += start(name, {1e-4 * (i % 3), 1e-4 * (i % 2), 0.05 + 0.1 * i});
  }
  for (const double friction : {0.0, 0.5})
    add(group, fmt::format("stack of ten cubes, friction {:g}", friction),
        cubes + kFloor + contact(fmt::format("friction=\"{}\"", friction)), kGravity + starts, 2e-3, 1,
        coordinate_at("b9/z", 0.95, 0.05, 1));
  add(group, "stack of ten cubes, hit at 20 m/s", cubes + ball("b", 2, 0.05) + kFloor + contact("friction=\"0.5\""),
      kGravity + starts + start("b", {-1, 0.01, 0.55}, kZero, {20, 0, 0}), 2e-3, 0.4);
  add(group, "ten balls on each other", balls + kFloor + contact("friction=\"0.5\""), kGravity + askew, 2e-3, 1);
  for (const auto& [restitution, friction] :
       {std::pair(0.05, 0.3), std::pair(1.0, 0.3), std::pair(0.5, 0.0), std::pair(0.5, 10.0)})
    add(group, fmt::format("box tumbles, restitution {:g}, friction {:g}", restitution, friction),
        box("b", 1, {0.2, 0.1, 0.05}) + kFloor +
            contact(fmt::format("restitution=\"{}\" friction=\"{}\"", restitution, friction)),
        kGravity + start("b", {0, 0, 0.5}, kZero, {1, 0, 0}, {3, 5, 1}), 1e-3, 1.5);
  add(group, "rod pushed over a floor, friction 10: Painleve",
      free_body("b", 1, {1e-4, 1.0 / 12, 1.0 / 12}, collision(sphere(1e-3), {-0.5, 0, 0})) + kFloor +
          contact("friction=\"10\" restitution=\"0.5\""),
      kGravity + start("b", {0, 0, 1e-3 + 0.5 * std::sin(1.0)}, {0, -1, 0}, {-3, 0, 0}), 1e-3, 0.3);
  add(group, "board of 1 m and 1 mm on two posts",
      box("b", 1, {1, 0.1, 0.001}) + built("left", cuboid({0.02, 0.2, 0.1}), {-0.4, 0, 0}) +
          built("right", cuboid({0.02, 0.2, 0.1}), {0.4, 0, 0}) + contact("friction=\"0.5\""),
      kGravity + start("b", {0, 0, 0.052}), 1e-3, 1, coordinate_at("b/z", 0.0505, 1e-4, 1));
  add(group, "needle of 1 m and 1 mm on its point",
      box("b", 0.01, {0.001, 0.001, 1}) + kFloor + contact("friction=\"0.5\""),
      kGravity + start("b", {0, 0, 0.6}, {0.01, 0, 0}), 1e-3, 1.5);
}

void add_beams(HardGroup& group) {
  const std::string whip = joint("hub", "continuous", "world", "whip", {0, 0, 1}, axis({0, 1, 0})) +
                           beam("whip", {1.2, 0, 0}, circle(0.004, 5e9, 1200), 12);
  add(group, "beam whipped on a floor", whip + kFloor + contact("friction=\"0.4\" restitution=\"0.5\""),
      motion("hub", "t < 0.3 ? 1.5*(t/0.3)*(t/0.3)*(3 - 2*t/0.3) : 1.5"), 1e-3, 0.5);
  add(group, "beam whipped on the edge of a box",
      whip + built("box", cuboid({0.4, 0.4, 0.4}), {0.7, 0, 0.2}, {0, kPi / 4, 0}) +
          contact("friction=\"0.4\" restitution=\"0.5\""),
      motion("hub", "t < 0.3 ? 1.2*(t/0.3)*(t/0.3)*(3 - 2*t/0.3) : 1.2"), 1e-3, 0.5);
  add(group, "beam whipped round a post",
      whip + built("post", barrel(0.05, 1), {0.5, 0, 0.5}, {kPi / 2, 0, 0}) + contact("friction=\"0.4\""),
      motion("hub", "t < 0.3 ? 1.5*(t/0.3)*(t/0.3)*(3 - 2*t/0.3) : 1.5"), 1e-3, 0.5);
  add(group, "rope heaped on a floor",
      free_beam({0, 0, 1}, circle(0.005, 1e6, 1000), 16, "<damping stiffness_proportional=\"1e-3\"/>") + kFloor +
          contact("friction=\"0.5\""),
      kGravity + start("b", {0, 0, 0.02}, {0.05, 0, 0}), 1e-3, 0.8);
  add(group, "cantilever pressed on a plane by 1000 of its weights",
      joint("clamp", "fixed", "world", "arm") + beam("arm", {1, 0, 0}, circle(0.01, 2e9, 1000), 8) +
          half_space("low", {0, 0, 1}, -0.05) + contact("friction=\"0.5\""),
      kGravity + load("arm", {1, 0, 0}, {0, 0, -3000}, "min(10*t, 1)"), 1e-3, 0.3);
}

}  // namespace

void add_contact_cases(std::vector<HardCase>& cases) {
  HardGroup group(cases, "contact");
  add_wedges(group);
  add_several_at_once(group);
  add_masses_and_stiffnesses(group);
  add_short_hits(group);
  add_edges(group);
  add_starts_inside(group);
  add_steps_sizes_speeds(group);
  add_stacks(group);
  add_beams(group);
}

}  // namespace flexarm::bench
