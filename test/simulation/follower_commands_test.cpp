// Tests joints that mimic others: at which position a mimic of a fixed joint is held, and which error a command to a
// mimic gives.
#include <cmath>

#include "flexarm/simulation/command_refusal.h"
#include "support/refusal.h"
#include "support/runs.h"
#include "support/scene_text.h"

namespace flexarm::test {
namespace {

/// Two fingers on hinges about y. The right one mimics the left one with the offset 0.3.
Simulation gripper(const std::string& type, const std::string& more = "", const std::string& entries = "") {
  const auto finger = [](const std::string& name) { return body(name, 1, {1e-3, 1e-2, 1e-2}, {0.1, 0, 0}); };
  const std::string across = "<axis xyz='0 1 0'/>";
  const std::string text =
      robot(joint("left", type, "world", "lf", across) + finger("lf") +
                joint("right", "continuous", "world", "rf", across + "<mimic joint='left' offset='0.3'/>") +
                finger("rf") + more,
            entries);
  return Simulation(type == "fixed" ? scene_warned_of(text) : scene_of(text));
}

template <class Command>
std::string refused(const Command& command) {
  return refusal<std::invalid_argument>(command);
}

}  // namespace

TEST(FollowerOfAFixedJoint, IsHeldAtItsOffset) {
  Simulation simulation = gripper("fixed");
  EXPECT_EQ(simulation.degrees_of_freedom(), 0);
  const std::size_t right = *simulation.find_coordinate("right");
  run(simulation, 10);
  EXPECT_EQ(simulation.position(right), 0.3);
  EXPECT_EQ(simulation.velocity(right), 0);
  // The effort against gravity is m g times the horizontal distance of the centre of mass. A positive rotation about y
  // turns x towards -z, which gives the sign.
  EXPECT_NEAR(simulation.effort(right), -9.81 * 0.1 * std::cos(0.3), 1e-12);
}

// A third joint mimics the mimic of the fixed joint. It is held, too.
TEST(FollowerOfAFixedJoint, MayLeadOthers) {
  Simulation simulation = gripper(
      "fixed",
      joint("third", "continuous", "rf", "tf", "<axis xyz='0 1 0'/><mimic joint='right' multiplier='-2' offset='1'/>") +
          body("tf", 1));
  ASSERT_TRUE(simulation.step().converged);
  EXPECT_EQ(simulation.position(*simulation.find_coordinate("right")), 0.3);
  EXPECT_EQ(simulation.position(*simulation.find_coordinate("third")), 0.4);
}

TEST(FollowerCommands, NameTheJointThatIsFollowed) {
  Simulation simulation = gripper("continuous");
  const std::size_t left = *simulation.find_coordinate("left"), right = *simulation.find_coordinate("right");
  const std::string told = "'right' mimics 'left' and takes no commands of its own: command that one";
  EXPECT_EQ(refused([&] { simulation.command_effort(right, 1); }), told);
  EXPECT_EQ(refused([&] { simulation.command_set_point(right, 1); }), told);
  EXPECT_EQ(refused([&] { simulation.switch_mode(right, ServoMode::Effort); }), told);
  EXPECT_EQ(refusal_of_commands(simulation, right), told);
  EXPECT_EQ(refusal_of_set_points(simulation, right), told);
  EXPECT_EQ(refusal_of_commands(simulation, left), "");
  EXPECT_EQ(
      refusal_of_set_points(simulation, left),
      "'left' has no servo: write <servo joint=\"left\" mode=\"position\" kp=\"...\" kd=\"...\"/> into the scene");
  EXPECT_EQ(refused([&] { simulation.command_effort(left, 1); }), "");
}

TEST(FollowerCommands, ToThoseOfFixedJointsSayThatTheyAreHeld) {
  Simulation simulation = gripper("fixed");
  const std::size_t right = *simulation.find_coordinate("right");
  const std::string told = "'right' mimics 'left' and is held, since a fixed joint leads it";
  EXPECT_EQ(refused([&] { simulation.command_effort(right, 1); }), told);
  EXPECT_EQ(refused([&] { simulation.command_set_point(right, 1); }), told);
}

TEST(Commands, ToUnknownJointsNameTheKnownOnesTheNearestFirst) {
  EXPECT_EQ(unknown_coordinate(gripper("continuous"), "rigth"),
            "there is no joint coordinate 'rigth'; the scene has right, left");
}

TEST(FollowerCommands, ToPrescribedJointsSaySo) {
  Simulation simulation = gripper("continuous", "", "<motion joint='left' position='t'/>");
  const std::size_t left = *simulation.find_coordinate("left");
  EXPECT_EQ(refused([&] { simulation.command_effort(left, 1); }), "the motion of 'left' is prescribed");
}

}  // namespace flexarm::test
