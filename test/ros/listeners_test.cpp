/// Tests that messages and results without a subscriber are not computed.

#include <flexarm/SimulatorStatus.h>
#include <geometry_msgs/WrenchStamped.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <tf2_msgs/TFMessage.h>

#include <string>

#include "flexarm/scene/urdf_reader.h"
#include "ros/beam_state_publisher.h"
#include "ros/sensor_publisher.h"
#include "ros/state_publisher.h"
#include "ros/status_publisher.h"
#include "simulation/inside.h"

namespace flexarm::node {
namespace {

const ros::WallDuration kPatience(10), kPause(0.01);

Simulation make_simulation() {
  std::string path;
  ros::NodeHandle().getParam("/listeners/scene", path);
  scene::ReadResult result = scene::read_scene_file(path);
  if (!result.scene) throw std::runtime_error(scene::to_text(result.diagnostics));
  return Simulation(*std::move(result.scene));
}

/// The publishers of a node, with a simulation.
class Listeners : public ::testing::Test {
 protected:
  MadeForOutput made_by_a_step() {
    EXPECT_TRUE(simulation_.step().converged);
    stamp_ += ros::Duration(1);  // at which all messages are due
    state_.publish(stamp_, false);
    beams_.publish(stamp_, false);
    sensors_.publish(stamp_);
    status_.publish(stamp_, false);
    return made_for_output(simulation_);
  }

  template <class Message>
  ros::Subscriber listen(const std::string& topic) {
    ros::Subscriber subscriber =
        node_.subscribe<Message>(topic, 10, [this](const boost::shared_ptr<const Message>&) { ++heard_; });
    const ros::WallTime end = ros::WallTime::now() + kPatience;
    while (subscriber.getNumPublishers() == 0 && ros::WallTime::now() < end) kPause.sleep();
    EXPECT_EQ(subscriber.getNumPublishers(), 1u) << topic;
    return subscriber;
  }

  void expect_message() {
    const int before = heard_;
    made_by_a_step();
    const ros::WallTime end = ros::WallTime::now() + kPatience;
    while (heard_ == before && ros::WallTime::now() < end) {
      ros::spinOnce();
      kPause.sleep();
    }
    EXPECT_GT(heard_, before);
  }

  ros::NodeHandle node_;
  RunState run_;
  Simulation simulation_ = make_simulation();
  StatePublisher state_{node_, simulation_, run_, 100, ""};
  BeamStatePublisher beams_{node_, simulation_, run_, 100, ""};
  SensorPublisher sensors_{node_, simulation_, run_, ""};
  StatusPublisher status_{node_, simulation_, run_, 10, ""};
  ros::Time stamp_{1};
  int heard_ = 0;
};

TEST_F(Listeners, NobodyCostsNothing) {
  for (int n = 0; n < 5; ++n) EXPECT_TRUE(made_by_a_step().is_nothing());
}

TEST_F(Listeners, OfFramesPayForNoVelocities) {
  const ros::Subscriber subscriber = listen<tf2_msgs::TFMessage>("/tf");
  EXPECT_TRUE(made_by_a_step().is_nothing());
  expect_message();
}

TEST_F(Listeners, OfJointsPayForTheirRates) {
  const ros::Subscriber subscriber = listen<sensor_msgs::JointState>("joint_states");
  const MadeForOutput made = made_by_a_step();
  EXPECT_TRUE(made.rates);
  EXPECT_FALSE(made.velocities || made.accelerations || made.energies || made.momenta);
  expect_message();
}

TEST_F(Listeners, OfTheStatusPayForEnergiesAndMomenta) {
  const ros::Subscriber subscriber = listen<SimulatorStatus>("status");
  const MadeForOutput made = made_by_a_step();
  EXPECT_TRUE(made.energies && made.momenta);
  EXPECT_FALSE(made.rates || made.velocities || made.accelerations);
  expect_message();
}

}  // namespace
}  // namespace flexarm::node

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "listeners");
  ros::NodeHandle node;  // keeps ROS up between the tests
  return RUN_ALL_TESTS();
}
