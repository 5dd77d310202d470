// Tests the outputs of contacts against statics and closed forms: columns, sensors, contact points.
#include <map>

#include "flexarm/model/model_error.h"
#include "reference/contact_scenes.h"
#include "support/refusal.h"

namespace flexarm::test::touching {
namespace {

constexpr double kMass = 3;
/// At rest, forces are those of statics. The contact's overdamped mode decays by exp(-50 t/s) in steps of 1 ms
/// (docs/notes/contact.md 2). So after 1 s only Newton's tolerance is left: 1e-12 of the scene's length, about 1 m,
/// times at most 10^6 N/m.
constexpr double kForceError = 1e-6;

Simulation at_rest(const std::string& parts, const std::string& starts = "", double step = 1e-3, double weight = kG) {
  return Simulation(scene_of(robot(parts, gravity({0, 0, -weight}) + integrator("em", step, 1e-12) + starts)));
}

const Vector3 kSize(0.2, 0.15, 0.1);

/// A block on the floor.
Simulation block(const std::string& more) {
  return at_rest(box("block", kMass, kSize) + floating("block") + kFloor + more,
                 "<initial joint='of_block/z' position='0.05'/>");
}

/// Force, number of points and gap of the only pair with columns.
std::vector<double> columns_of(const Simulation& simulation, const std::string& pair) {
  ResultColumns columns(simulation, ResultColumns::Solver::Without, {"contact/*"});
  const char* names[] = {"fx", "fy", "fz", "points", "gap"};
  const char* units[] = {"N", "N", "N", "1", "m"};
  EXPECT_EQ(columns.columns().size(), 6u);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(columns.columns()[1 + i].name, "contact/" + pair + "/" + names[i]);
    EXPECT_EQ(columns.columns()[1 + i].unit, units[i]);
  }
  const std::vector<double>& row = columns.row(simulation, {});
  return {row.begin() + 1, row.end()};
}

Vector3 force_of(const std::vector<double>& values) {
  return {values[0], values[1], values[2]};
}

TEST(ContactOutputs, FloorCarriesTheWeightOfABlock) {
  Simulation simulation = block(contact_of("block", "floor", "friction='0.5'"));
  run_until(simulation, 1.5);
  const std::vector<double> values = columns_of(simulation, "block/floor");
  EXPECT_LE((force_of(values) - Vector3(0, 0, kMass * kG)).norm(), kForceError);
  EXPECT_GE(values[3], 4) << "its corners at least";
  EXPECT_NEAR(values[4], simulation.link_pose(1).position.z() - 0.05, 1e-12);
  EXPECT_LT(values[4], 0);
  std::vector<ActingContact> contacts;
  simulation.contacts(contacts);
  ASSERT_EQ(static_cast<double>(contacts.size()), values[3]);
  Vector3 force = Vector3::Zero(), moment = Vector3::Zero();
  for (const ActingContact& contact : contacts) {
    EXPECT_EQ(contact.first, "block");
    EXPECT_EQ(contact.second, "floor");
    EXPECT_NEAR((contact.normal - Vector3::UnitZ()).norm(), 0, 1e-15);
    EXPECT_NEAR(contact.position.z(), -contact.penetration, 1e-12);
    force += contact.force;
    moment += contact.position.cross(contact.force);
  }
  EXPECT_LE((force - force_of(values)).norm(), 1e-12 * kMass * kG);
  EXPECT_LE(moment.norm(), kForceError) << "the block does not tilt";
}

// The columns have the names in the order of the file, whichever link has the contact points.
TEST(ContactOutputs, AreOfTheFirstThatAContactNames) {
  Simulation simulation = block(contact_of("floor", "block"));
  run_until(simulation, 1.5);
  EXPECT_LE((force_of(columns_of(simulation, "floor/block")) - Vector3(0, 0, -kMass * kG)).norm(), kForceError);
}

TEST(ContactOutputs, OfAllOthersHaveNoColumns) {
  Simulation simulation = block(contact_of("block", "*"));
  EXPECT_THROW(columns_of(simulation, ""), std::invalid_argument);
  run_until(simulation, 1.5);
  std::vector<ActingContact> contacts;
  simulation.contacts(contacts);
  double force = 0;
  for (const ActingContact& contact : contacts) force += contact.force.z();
  EXPECT_NEAR(force, kMass * kG, kForceError) << "but they are told";
}

// A block sticks on an incline. The floor's normal force and friction balance m g. The sticking contact's vibration
// decays by 0.98 in each step (docs/notes/contact.md 3): to 1e-26 in 3000 steps.
TEST(ContactOutputs, FrictionHoldsABlockOnAnIncline) {
  const double slope = 0.4;
  const Vector3 normal(-std::sin(slope), 0, std::cos(slope));
  const Vector3 start = 0.05 * normal;
  Simulation simulation =
      at_rest(box("block", kMass, kSize) + floating("block") + "<ground name='floor' normal='" + xyz(normal) + "'/>" +
                  contact_of("block", "floor", "friction='0.6'"),
              fmt::format("<initial joint='of_block/x' position='{:.17g}'/><initial joint='of_block/z' "
                          "position='{:.17g}'/><initial joint='of_block/ry' position='{:.17g}'/>",
                          start.x(), start.z(), -slope));
  run_until(simulation, 3);
  const Vector3 force = force_of(columns_of(simulation, "block/floor"));
  const double push = force.dot(normal);
  EXPECT_NEAR(push, kMass * kG * std::cos(slope), kForceError);
  EXPECT_NEAR((force - push * normal).norm(), kMass * kG * std::sin(slope), kForceError);
}

constexpr double kBallMass = 2, kStiffness = 2e4, kSpeed = 0.5;
const double kOmega = std::sqrt(kStiffness / kBallMass);

/// A weightless ball that just touches the floor, in steps of 1/500 of a radian of its contact's oscillation.
Simulation hit(double restitution) {
  return at_rest(
      body("ball", kBallMass, Vector3::Constant(0.01), Vector3::Zero(), collision("<sphere radius='0.1'/>")) + kFloor +
          floating("ball") +
          contact_of("ball", "floor", fmt::format("restitution='{}' stiffness='{}'", restitution, kStiffness)),
      fmt::format("<initial joint='of_ball/z' position='0.1'/><initial link='ball' linear='0 0 {}'/>", -kSpeed),
      1 / kOmega / 500, 0);
}

// An undamped contact stops a mass m of speed v and stores all of its energy: k x^2 = m v^2 at the deepest point, with
// the hardened x = p / (1 - (p/d)^2)^2 of the penetration p. d = 0.01 m is a tenth of the ball's radius. The force is k
// x dx/dp = v sqrt(k m) dx/dp. The largest sample misses a few 1e-6 of it, since samples are 1/500 of a radian apart.
TEST(ContactOutputs, AnElasticHitHasTheForceOfItsClosedForm) {
  Simulation simulation = hit(1);
  double largest = 0, penetration = 0;
  ResultColumns columns(simulation, ResultColumns::Solver::Without, {"contact/*"});
  for (int n = 0; n < 1800; ++n) {
    ASSERT_TRUE(simulation.step().converged);
    const std::vector<double>& row = columns.row(simulation, {});
    largest = std::max(largest, row[3]);
    penetration = std::max(penetration, -row[5]);
  }
  const double deepest = penetration, part = deepest / 0.01, room = 1 - part * part;
  EXPECT_NEAR(deepest / (room * room), kSpeed / kOmega, 1e-4 * kSpeed / kOmega) << "all of its energy is in it";
  const double slope = (1 + 3 * part * part) / (room * room * room);
  EXPECT_NEAR(largest, slope * kSpeed * std::sqrt(kStiffness * kBallMass), 1e-4 * largest);
  EXPECT_EQ(columns.row(simulation, {})[3], 0) << "it is off again";
  EXPECT_GT(columns.row(simulation, {})[5], 0);
}

// The reported forces, including damping, integrate to the change of momentum. The integral is by the trapezoidal rule
// with 500 steps per radian, of order 2.
TEST(ContactOutputs, ForcesOfAHitAreItsChangeOfMomentum) {
  Simulation simulation = hit(0.5);
  ResultColumns columns(simulation, ResultColumns::Solver::Without, {"contact/*/fz"});
  const double before = simulation.momentum().z();
  double sum = 0, last = 0;
  for (int n = 0; n < 2500; ++n) {
    ASSERT_TRUE(simulation.step().converged);
    const double force = columns.row(simulation, {})[1];
    sum += 0.5 * (force + last) * simulation.step_size();
    last = force;
  }
  EXPECT_EQ(last, 0) << "it is off again";
  const double change = simulation.momentum().z() - before;
  EXPECT_NEAR(change, 1.5 * kBallMass * kSpeed, 1e-3 * change) << "with the restitution 0.5";
  EXPECT_NEAR(sum, change, 1e-4 * change);
}

// A fixed pad is rotated by a quarter turn about y, so that its x axis points down. It carries a block beside its
// middle.
TEST(ContactOutputs, SensorUnderABlockMeasuresItsWeight) {
  Simulation simulation =
      at_rest(box("block", kMass, {0.1, 0.1, 0.1}) + floating("block") + box("pad", 1, {0.1, 0.4, 0.4}) +
                  joint("of_pad", "fixed", "world", "pad", "<origin xyz='0 0 0.2' rpy='0 1.5707963267948966 0'/>") +
                  contact_of("block", "*", "friction='0.5'") +
                  "<sensor name='cell' kind='contact' link='pad' at='0 0.02 0'/>"
                  "<sensor name='felt' kind='contact' link='world' group='block' bias='1 0 0 0 0 0'/>"
                  "<sensor name='none' kind='contact' link='pad' group='block pad'/>",
              "<initial joint='of_block/x' position='0.05'/><initial joint='of_block/z' position='0.3'/>");
  run_until(simulation, 1.5);
  const double weight = kMass * kG;
  const auto values = [&](std::size_t i) {
    Vector6 out;
    for (int k = 0; k < 6; ++k) out[k] = simulation.sample(i).values[static_cast<std::size_t>(k)];
    return out;
  };
  const Vector3 place = simulation.link_pose(1).position;
  // The pad's x axis is the world's -z, its y the world's y, its z the world's x. The block's middle is at x = 0.05
  // and, from `at`, y = -0.02.
  const Vector3 arm(0.0, place.y() - 0.02, place.x());
  Vector6 expected;
  expected << weight, 0, 0, Vector3(arm.cross(Vector3(weight, 0, 0)));
  EXPECT_LE((values(0) - expected).norm(), kForceError);
  expected << 1, 0, weight, Vector3(place.cross(Vector3(0, 0, weight)));
  EXPECT_LE((values(1) - expected).norm(), kForceError) << "on the block, about the world's origin, with its bias";
  EXPECT_EQ(values(2), Vector6(Vector6::Zero())) << "within a group forces cancel";
}

// A flexible blade lies on the floor. Contact points are reported along it, and the clamp carries what the floor does
// not.
TEST(ContactOutputs, FloorAndClampCarryABeam) {
  Simulation simulation = at_rest(
      round_beam("arm", "<line to='1 0 0'/>", 0.004, "<material young='7e9' poisson='0.3' density='2700'/>", 10) +
      joint("clamp", "fixed", "world", "arm") + "<ground name='low' offset='-0.05'/>" +
      contact_of("low", "arm", "stiffness='1e6'") +
      "<sensor name='root' kind='reaction' link='arm'/>"
      "<sensor name='felt' kind='contact' link='arm' at='1 0 0'/>");
  ASSERT_TRUE(simulation.solve_static(1).converged);
  run_until(simulation, 0.01);
  const double weight = 2700 * 3.14159265358979323846 * 0.004 * 0.004 * kG;
  const double floor = -columns_of(simulation, "low/arm")[2], clamp = simulation.sample(0).values[2];
  EXPECT_GT(floor, 0.05 * weight);
  EXPECT_NEAR(floor + clamp, weight, 1e-4 * weight) << "it starts in equilibrium, to what statics leave";

  // The sensor's moment is about the tip, where it is now.
  const Vector3 tip = simulation.section(1, 1).pose.position;
  EXPECT_LT(tip.z(), -0.04);
  Vector3 moment(0, 0, 0);
  std::vector<ActingContact> contacts;
  simulation.contacts(contacts);
  for (const ActingContact& contact : contacts)
    moment += (contact.first == "arm" ? 1 : -1) * (contact.position - tip).cross(contact.force);
  const auto& felt = simulation.sample(1).values;
  EXPECT_LE((Vector3(felt[3], felt[4], felt[5]) - moment).norm(), 1e-12 * moment.norm());
}

// The motor's 40 N move two fingers, the second of which mimics the first. By virtual work each finger presses with 20
// N. Friction at each carries half of the block's weight. The last motion has ended 2 s before.
TEST(ContactOutputs, FingersOfAGripperShareEffortAndWeight) {
  Simulation simulation(scene_at("config/examples/gripper.urdf"));
  run_until(simulation, 4);
  std::map<std::string, Vector3> forces;
  std::vector<ActingContact> contacts;
  simulation.contacts(contacts);
  for (const ActingContact& contact : contacts) {
    EXPECT_EQ(contact.second, "block") << "in the scene's order: its <contact> is with all others";
    forces.emplace(contact.first, Vector3::Zero()).first->second += contact.force;
  }
  ASSERT_EQ(forces.size(), 2u);
  for (const auto& [finger, force] : forces) {
    EXPECT_NEAR(std::hypot(force.x(), force.y()), 20, kForceError) << finger;
    EXPECT_NEAR(force.z(), -0.5 * 0.5 * kG, kForceError) << finger;
  }
}

TEST(ContactOutputs, SensorsOfWhatNothingTouchesAreRefused) {
  const std::string contact = contact_of("block", "floor");
  const auto refused = [&](const std::string& more) { return refusal<ModelError>([&] { block(more); }); };
  EXPECT_EQ(refused(contact + "<sensor name='cell' kind='contact' link='world'/>"),
            "test.urdf:1: <sensor> 'cell': no <contact> lets anything touch link 'world'");
  EXPECT_EQ(refused("<sensor name='cell' kind='contact' link='world' group='block floor'/>"),
            "test.urdf:1: <sensor> 'cell': no <contact> lets anything touch its group");
  EXPECT_EQ(refused(contact + "<sensor name='cell' kind='contact' link='world' group='block'/>"), "");
}

}  // namespace
}  // namespace flexarm::test::touching
