// Tests the reading of reference motions that another program has computed, and the errors of bad files.
#include "bench/outside_references.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace flexarm::bench {
namespace {

/// Tests references of a body that falls from rest: y = -g t^2 / 2, with g = 8 m/s^2, in 1 s and 4 intervals.
class OutsideReferences : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = testing::TempDir() + "flexarm_outside_references";
    std::filesystem::create_directories(folder_);
    write("fall.urdf", R"(<robot name="fall"> <link name="world"/>
<link name="a"> <inertial> <mass value="1"/> <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/> </inertial> </link>
<joint name="s" type="prismatic"> <parent link="world"/> <child link="a"/> <axis xyz="0 1 0"/>
<limit lower="-9" upper="9" effort="0" velocity="0"/> </joint>
<simulation> <gravity xyz="0 -8 0"/> <probe name="p" link="a"/> </simulation> </robot>)");
    write("fall.csv", "time,x0,y0,z0\n0,0,0,0\n0.25,0,-0.25,0\n0.5,0,-1,0\n0.75,0,-2.25,0\n1,0,-4,0\n");
    write("index.csv", kHead + "fall,forces,\"fall, free\",1,1,4,1e-12,0,outside\n");
  }
  void write(const std::string& name, const std::string& text) { std::ofstream(folder_ + "/" + name) << text; }
  /// The error message for a folder that is refused.
  std::string refusal() const {
    try {
      read_outside_references(folder_);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "taken";
  }
  void expect_refusal(const std::string& part) const {
    EXPECT_NE(refusal().find(part), std::string::npos) << refusal();
  }

  const std::string kHead = "file,group,name,cornered,until,intervals,disagreement,events,reference\n";
  std::string folder_;
};

TEST_F(OutsideReferences, AreRead) {
  const std::vector<OutsideReference> found = read_outside_references(folder_);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].group, "forces");
  EXPECT_EQ(found[0].name, "fall, free");
  EXPECT_TRUE(found[0].is_cornered);
  EXPECT_EQ(found[0].intervals, 4);
  EXPECT_EQ(found[0].disagreement, 1e-12);
  ASSERT_EQ(found[0].motion.points.size(), 1u);
  ASSERT_EQ(found[0].motion.points[0].size(), 5u);
  EXPECT_EQ(found[0].motion.points[0][3], Vector3(0, -2.25, 0));
  EXPECT_EQ(read_outside_references(folder_, "forces: fall").size(), 1u);
  EXPECT_EQ(read_outside_references(folder_, "stops").size(), 0u);
}

TEST_F(OutsideReferences, WithoutAMotionAreJudgedByFinerRuns) {
  write("index.csv", kHead + "fall,forces,fall,0,1,4,0,0,finer\n");
  std::filesystem::remove(folder_ + "/fall.csv");
  const std::vector<OutsideReference> found = read_outside_references(folder_);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_FALSE(found[0].is_there);
  EXPECT_FALSE(found[0].is_cornered);
}

TEST_F(OutsideReferences, ThatDisagreeWithThemselvesAreRefused) {
  write("index.csv", kHead + "fall,forces,fall,1,1,4,2e-9,0,outside\n");
  expect_refusal("index.csv:2: the reference of 'fall' is not good: two runs of it differ by 2e-09 of its way");
  write("index.csv", kHead + "fall,forces,fall,1,1,4,nan,0,outside\n");
  expect_refusal("index.csv:2: disagreement: expected a finite number, got 'nan'");
}

TEST_F(OutsideReferences, BrokenTablesAreRefused) {
  write("fall.csv", "time,x0,y0,z0\n0,0,0,0\n0.25,0,-0.25,0\n0.5,0,-1,0\n0.75,0,-2.25,0\n");
  expect_refusal("fall.csv:5: expected 5 rows, got 4");
  write("fall.csv", "time,x0,y0,z0\n0,0,0,0\n0.25,0,-0.25,0\n0.6,0,-1,0\n0.75,0,-2.25,0\n1,0,-4,0\n");
  expect_refusal("fall.csv:4: expected the time 0.5, got '0.6'");
  write("fall.csv", "time,x0,y0,z0\n0,0,0,0\n0.25,0,inf,0\n0.5,0,-1,0\n0.75,0,-2.25,0\n1,0,-4,0\n");
  expect_refusal("fall.csv:3: y0: expected a finite number, got 'inf'");
  write("fall.csv", "time,x0,y0,z0\n0,0,0,0\n0.25,0,-0.25\n");
  expect_refusal("fall.csv:3: expected 4 columns, got 3");
  std::filesystem::remove(folder_ + "/fall.csv");
  expect_refusal("fall.csv: cannot be read");
}

TEST_F(OutsideReferences, OfAnotherSceneAreRefused) {
  write("fall.csv", "time,x0,y0,z0\n0,0,1e-8,0\n0.25,0,-0.25,0\n0.5,0,-1,0\n0.75,0,-2.25,0\n1,0,-4,0\n");
  expect_refusal("fall.csv:2: point 0 is 1e-08 m from where the scene starts");
  write("fall.csv",
        "time,x0,y0,z0,x1,y1,z1\n0,0,0,0,0,0,0\n0.25,0,-0.25,0,0,0,0\n0.5,0,-1,0,0,0,0\n"
        "0.75,0,-2.25,0,0,0,0\n1,0,-4,0,0,0,0\n");
  expect_refusal("fall.csv:1: it has 2 points, the scene 1");
}

}  // namespace
}  // namespace flexarm::bench
