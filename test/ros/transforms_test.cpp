/// Tests the messages of a bent arm against the same simulation without ROS, which is deterministic.

#include <flexarm/BeamStateArray.h>
#include <flexarm/SimulatorStatus.h>
#include <flexarm/Step.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <std_srvs/Empty.h>
#include <tf2_ros/transform_listener.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>
#include <string>

#include "flexarm/scene/urdf_reader.h"
#include "flexarm/simulation/simulation.h"

namespace flexarm {
namespace {

constexpr int kSteps = 200;
/// Tolerance: a chain of six frames, each a product of unit quaternions and lengths of about 1 m.
constexpr double kRoundOff = 100 * std::numeric_limits<double>::epsilon();
const ros::Duration kPatience(10);

Pose to_pose(const geometry_msgs::Transform& transform) {
  return {Vector3(transform.translation.x, transform.translation.y, transform.translation.z),
          Quaternion(transform.rotation.w, transform.rotation.x, transform.rotation.y, transform.rotation.z)};
}

void expect_equal(const Pose& actual, const Pose& expected, const std::string& frame) {
  EXPECT_LE((actual.position - expected.position).norm(), kRoundOff) << frame;
  EXPECT_LE(actual.orientation.angularDistance(expected.orientation), 10 * kRoundOff) << frame;
}

Simulation make_simulation() {
  std::string path;
  ros::NodeHandle().getParam("/flexarm/scene", path);
  scene::ReadResult result = scene::read_scene_file(path);
  if (!result.scene) throw std::runtime_error(scene::to_text(result.diagnostics));
  return Simulation(*std::move(result.scene));
}

/// The node, launched paused, and a twin of its simulation, both `kSteps` steps after the start.
class BentArm : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    ASSERT_TRUE(ros::service::waitForService("/flexarm/step", kPatience));
    std_srvs::Empty reset;
    ASSERT_TRUE(ros::service::call("/flexarm/reset", reset));
    listener_ = new tf2_ros::TransformListener(buffer_);
    twin_ = new Simulation(make_simulation());
    const std::vector<std::string>& links = twin_->link_names();
    boom_ = static_cast<std::size_t>(std::find(links.begin(), links.end(), "boom") - links.begin());
    ASSERT_LT(boom_, links.size());
    ASSERT_TRUE(twin_->is_flexible(boom_));
    flexarm::Step step;
    step.request.steps = kSteps;
    ASSERT_TRUE(ros::service::call("/flexarm/step", step));
    ASSERT_TRUE(step.response.success) << step.response.message;
    for (int i = 0; i < kSteps; ++i) {
      last_step_ = twin_->step();
      ASSERT_TRUE(last_step_.converged);
      halvings_ += last_step_.halvings;
    }
    ASSERT_NEAR(step.response.time, twin_->time(), kRoundOff);
  }
  static void TearDownTestSuite() {
    delete listener_;
    delete twin_;
  }

  /// The joint states. A paused simulation sends them to every new subscriber.
  static sensor_msgs::JointState joint_states() {
    const auto message = ros::topic::waitForMessage<sensor_msgs::JointState>("/joint_states", kPatience);
    return message ? *message : sensor_msgs::JointState();
  }

  static tf2_ros::Buffer buffer_;
  static tf2_ros::TransformListener* listener_;
  static Simulation* twin_;
  static std::size_t boom_;  ///< the flexible link
  static StepResult last_step_;
  static int halvings_;
};
tf2_ros::Buffer BentArm::buffer_;
tf2_ros::TransformListener* BentArm::listener_ = nullptr;
Simulation* BentArm::twin_ = nullptr;
std::size_t BentArm::boom_ = 0;
StepResult BentArm::last_step_;
int BentArm::halvings_ = 0;

TEST_F(BentArm, IsBent) {
  const Pose tip = twin_->link_pose(boom_).inverse() * twin_->tip_pose(boom_);
  EXPECT_GT((tip.position - Vector3(1.5, 0, 0)).norm(), 0.01);
}

TEST_F(BentArm, TransformsAgreeWithTheSimulation) {
  const ros::Time stamp = joint_states().header.stamp;
  const std::string& world = twin_->scene().root_link;
  for (std::size_t link = 0; link < twin_->link_names().size(); ++link) {
    const std::string& name = twin_->link_names()[link];
    ASSERT_TRUE(buffer_.canTransform(world, name, stamp, kPatience)) << name;
    expect_equal(to_pose(buffer_.lookupTransform(world, name, stamp).transform), twin_->link_pose(link), name);
    if (!twin_->is_flexible(link)) continue;
    const std::string tip = name + "/tip";
    ASSERT_TRUE(buffer_.canTransform(world, tip, stamp, kPatience)) << tip;
    expect_equal(to_pose(buffer_.lookupTransform(world, tip, stamp).transform), twin_->tip_pose(link), tip);
  }
}

TEST_F(BentArm, TransformsAgreeWithTheJointStates) {
  const sensor_msgs::JointState joints = joint_states();
  const auto tip_to_forearm = buffer_.lookupTransform("boom/tip", "forearm", joints.header.stamp, kPatience);
  const auto elbow = std::find(joints.name.begin(), joints.name.end(), "elbow");
  ASSERT_NE(elbow, joints.name.end());
  const double angle = joints.position.at(elbow - joints.name.begin());
  EXPECT_GT(std::abs(angle), 0.01);  // it has swung; otherwise the next check would also hold for an arm at rest
  const Quaternion expected(Eigen::AngleAxisd(angle, Vector3::UnitY()));
  expect_equal(to_pose(tip_to_forearm.transform), {Vector3::Zero(), expected}, "forearm on the boom's tip");
}

TEST_F(BentArm, JointStatesAreTheSimulations) {
  const sensor_msgs::JointState joints = joint_states();
  ASSERT_EQ(joints.name, twin_->coordinate_names());
  for (std::size_t i = 0; i < joints.name.size(); ++i) {
    EXPECT_DOUBLE_EQ(joints.position[i], twin_->position(i)) << joints.name[i];
    EXPECT_DOUBLE_EQ(joints.velocity[i], twin_->velocity(i)) << joints.name[i];
    EXPECT_DOUBLE_EQ(joints.effort[i], twin_->effort(i)) << joints.name[i];
  }
}

TEST_F(BentArm, BeamStatesAreTheSimulations) {
  const auto message = ros::topic::waitForMessage<flexarm::BeamStateArray>("/beam_states", kPatience);
  ASSERT_TRUE(message);
  ASSERT_EQ(message->beams.size(), 1u);
  const flexarm::BeamState& beam = message->beams.front();
  EXPECT_EQ(beam.link, "boom");
  std::vector<BeamPoint> points;
  twin_->beam_points(boom_, 0, points);
  ASSERT_EQ(beam.pose.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_DOUBLE_EQ(beam.arc_length[i], points[i].arc_length);
    EXPECT_DOUBLE_EQ(beam.pose[i].position.z, points[i].pose.position.z());
    EXPECT_DOUBLE_EQ(beam.strain[i].x, points[i].strain[0]);
    EXPECT_DOUBLE_EQ(beam.curvature[i].y, points[i].strain[4]);
    EXPECT_DOUBLE_EQ(beam.resultant[i].force.z, points[i].resultant[2]);
    EXPECT_DOUBLE_EQ(beam.resultant[i].torque.y, points[i].resultant[4]);
  }
}

TEST_F(BentArm, MarkersLieAroundTheDeformedCentreline) {
  const auto message = ros::topic::waitForMessage<visualization_msgs::MarkerArray>("/beam_markers", kPatience);
  ASSERT_TRUE(message);
  ASSERT_GE(message->markers.size(), 1u);
  const visualization_msgs::Marker& marker = message->markers.front();
  EXPECT_EQ(marker.ns, "boom");
  EXPECT_EQ(marker.header.frame_id, twin_->scene().root_link);
  ASSERT_EQ(marker.points.size(), marker.colors.size());
  ASSERT_GT(marker.points.size(), 0u);
  ASSERT_EQ(marker.points.size() % 3, 0u);
  std::vector<BeamPoint> points;
  twin_->beam_points(boom_, 3, points);
  double largest_distance = 0;
  for (const geometry_msgs::Point& corner : marker.points) {
    double distance = std::numeric_limits<double>::infinity();
    for (const BeamPoint& point : points) {
      distance = std::min(distance, (Vector3(corner.x, corner.y, corner.z) - point.pose.position).norm());
    }
    largest_distance = std::max(largest_distance, distance);
  }
  EXPECT_LE(largest_distance, twin_->beam_radius(boom_) + kRoundOff);
}

/// Largest strain at the surface of the boom by bending alone. The markers show the same measure; bending is nearly all
/// of it.
double bending_strain(const std::vector<BeamPoint>& points, double radius) {
  double largest = 0;
  for (const BeamPoint& point : points) largest = std::max(largest, radius * point.strain.tail<2>().norm());
  return largest;
}

TEST_F(BentArm, LegendNamesTheLargestStrain) {
  const auto message = ros::topic::waitForMessage<visualization_msgs::MarkerArray>("/beam_markers", kPatience);
  ASSERT_TRUE(message);
  double largest = 0;
  std::set<int> ids;
  for (const visualization_msgs::Marker& marker : message->markers) {
    if (marker.ns != "legend" || marker.action != visualization_msgs::Marker::ADD) continue;
    EXPECT_TRUE(ids.insert(marker.id).second);
    char* end = nullptr;
    const double number = std::strtod(marker.text.c_str(), &end);
    if (std::string(end) == " %") largest = std::max(largest, number / 100);
  }
  EXPECT_GE(ids.size(), 5u);  // the bar, three numbers, their meaning; then arrows
  std::vector<BeamPoint> points;
  twin_->beam_points(boom_, 3, points);
  const double expected = bending_strain(points, twin_->beam_radius(boom_));
  ASSERT_GT(expected, 1e-4);
  // Torsion and shear add some per cent; the legend has two digits.
  EXPECT_NEAR(largest, expected, 0.1 * expected);
}

// services_test.py and process_test.py test the status of a simulation that runs, fails or lags behind.
TEST_F(BentArm, StatusIsTheSimulations) {
  const auto status = ros::topic::waitForMessage<flexarm::SimulatorStatus>("/flexarm/status", kPatience);
  ASSERT_TRUE(status);
  EXPECT_EQ(status->header.frame_id, "base");
  EXPECT_EQ(status->header.stamp, joint_states().header.stamp);
  EXPECT_DOUBLE_EQ(status->time, twin_->time());
  EXPECT_DOUBLE_EQ(status->step, twin_->step_size());
  EXPECT_EQ(status->steps, static_cast<std::uint64_t>(kSteps));
  EXPECT_TRUE(status->paused);
  EXPECT_FALSE(status->failed);
  EXPECT_EQ(status->message, "");
  EXPECT_EQ(status->real_time_factor, 0);
  EXPECT_EQ(status->overruns, 0u);
  EXPECT_EQ(status->scheme, twin_->scheme());
  EXPECT_EQ(status->iterations, static_cast<std::uint32_t>(last_step_.iterations));
  EXPECT_EQ(status->halvings, static_cast<std::uint32_t>(halvings_));
  const Energies energies = twin_->energies();
  EXPECT_DOUBLE_EQ(status->kinetic_energy, energies.kinetic);
  EXPECT_DOUBLE_EQ(status->strain_energy, energies.strain);
  EXPECT_DOUBLE_EQ(status->potential_energy, energies.potential);
  EXPECT_DOUBLE_EQ(status->total_energy, energies.total());
  EXPECT_DOUBLE_EQ(status->work, energies.work);
  EXPECT_DOUBLE_EQ(status->dissipated, energies.dissipated);
  EXPECT_GT(energies.work, 0);
  EXPECT_GT(energies.dissipated, 0);
  const auto expect_vector = [](const geometry_msgs::Vector3& actual, const Vector3& expected) {
    EXPECT_DOUBLE_EQ(actual.x, expected.x());
    EXPECT_DOUBLE_EQ(actual.y, expected.y());
    EXPECT_DOUBLE_EQ(actual.z, expected.z());
  };
  expect_vector(status->momentum, twin_->momentum());
  expect_vector(status->angular_momentum, twin_->angular_momentum());
}

TEST_F(BentArm, OnlyTheRigidWeldIsStatic) {
  const auto message = ros::topic::waitForMessage<tf2_msgs::TFMessage>("/tf_static", kPatience);
  ASSERT_TRUE(message);
  std::set<std::string> children;
  for (const auto& transform : message->transforms) children.insert(transform.child_frame_id);
  EXPECT_EQ(children, std::set<std::string>{"tool"});
}

}  // namespace
}  // namespace flexarm

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "transforms_test");
  ros::NodeHandle node;  // keeps ROS up between the tests
  return RUN_ALL_TESTS();
}
