// Tests functions of time that are columns of a file in the folder of the scene.
#include <cmath>

#include "scene/scene_text.h"

namespace flexarm::scene {
namespace {

const std::string kSetPoint = "set_point=\"sin(t)\"", kMotion = "position=\"sin(t)\"";
const std::string kMoves = "time, elbow ,elbow_rate,wrist\r\n0,0,0,1\r\n\n0.5,0.25,1,2\n1,1,2,3\n";

ReadResult read_with(const std::string& set_point, const std::string& table) {
  return read_with_table(good_scene_with(kSetPoint, "set_point=\"" + set_point + "\""), "flexarm_moves.csv", table);
}

void expect_table_error(const std::string& set_point, const std::string& table, const std::string& fragment) {
  const ReadResult result = read_with(set_point, table);
  EXPECT_FALSE(result.scene) << table;
  ASSERT_EQ(result.diagnostics.size(), 1u) << to_text(result.diagnostics);
  const std::string text = result.diagnostics[0].text();
  EXPECT_NE(text.find("<servo> of robot 'arm': " + fragment), std::string::npos) << text;
}

TEST(Trajectory, HasTheRatesOfAColumn) {
  const ReadResult result = read_with("flexarm_moves.csv#elbow, elbow_rate", kMoves);
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  const TimeFunction& set_point = result.scene->servos[0].set_point.value();
  for (const double t : {0.0, 0.3, 0.5, 0.9, 1.0}) {  // t^2 is reproduced, since pieces are cubic
    EXPECT_NEAR(set_point(t), t * t, 1e-15);
    EXPECT_NEAR(set_point.derivative(t), 2 * t, 1e-14);
  }
  EXPECT_EQ(set_point(7), 1);
}

TEST(Trajectory, RestsAtItsEndsWithoutRates) {
  const ReadResult result = read_with("flexarm_moves.csv#elbow", kMoves);
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  const TimeFunction& set_point = result.scene->servos[0].set_point.value();
  EXPECT_EQ(set_point(0.5), 0.25);
  EXPECT_EQ(set_point.derivative(0), 0);
  EXPECT_EQ(set_point.derivative(1), 0);
  // 2 (h + h) r = 3 (h d + h d), where the slopes d of the chords are 0.5 and 1.5.
  EXPECT_NEAR(set_point.derivative(0.5), 1.5, 1e-14);
}

TEST(Trajectory, OneFileMovesSeveralJointsByServosAndMotions) {
  std::string text = good_scene_with(kSetPoint, R"(set_point="flexarm_several.csv#elbow" )");
  text.replace(text.find(kMotion), kMotion.size(), R"(position="flexarm_several.csv#wrist")");
  const ReadResult result = read_with_table(text, "flexarm_several.csv", kMoves);
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  EXPECT_EQ(result.scene->servos[0].set_point.value()(1), 1);
  EXPECT_EQ(result.scene->motions[0].position(0.5), 2);
}

TEST(Trajectory, MayBeNamedByItsWholePath) {
  const ReadResult result = read_with(testing::TempDir() + "flexarm_moves.csv#elbow", kMoves);
  EXPECT_TRUE(result.scene) << to_text(result.diagnostics);
}

TEST(Trajectory, Errors) {
  const std::string good = "flexarm_moves.csv#elbow";
  expect_table_error("nothing.csv#elbow", kMoves,
                     "set_point must name a table that can be read, relative to the scene's folder, got 'nothing.csv#");
  for (const char* bad : {"#elbow", "flexarm_moves.csv#", "flexarm_moves.csv#elbow,elbow_rate,wrist"})
    expect_table_error(bad, kMoves, "set_point must be FILE#COLUMN or FILE#COLUMN,RATES, got '" + std::string(bad));
  expect_table_error("flexarm_moves.csv#knee", kMoves,
                     "flexarm_moves.csv:1: one column 'knee' is expected, got 'time,elbow,elbow_rate,wrist'");
  expect_table_error("flexarm_moves.csv#elbow,", kMoves, "set_point must be FILE#COLUMN");
  expect_table_error(good, "elbow\n1\n2\n", "flexarm_moves.csv:1: one column 'time' is expected, got 'elbow'");
  expect_table_error(good, "time,elbow,elbow\n", "flexarm_moves.csv:1: one column 'elbow' is expected");
  expect_table_error(good, "", "flexarm_moves.csv:1: one column 'time' is expected");
  expect_table_error(good, "time,elbow\n0,1\n", "flexarm_moves.csv:2: at least two points are expected");
  expect_table_error(good, "time,elbow\n0,1\n0.5,2\n0.5,3\n",
                     "flexarm_moves.csv:4: time must be > 0.5, the time of the row before, got '0.5'");
  expect_table_error(good, "time,elbow\n0,1\n1,nan\n", "flexarm_moves.csv:3: elbow must be a finite number, got 'nan'");
  expect_table_error(good, "time,elbow\n0,1\n1\n", "flexarm_moves.csv:3: 2 numbers are expected, got '1'");
  expect_table_error(good, "time,elbow\n0,-1e308\n1,1e308\n2,0\n", "flexarm_moves.csv:4: finite numbers");
}

// Columns that the scene does not use may contain anything.
TEST(Trajectory, LeavesOtherColumnsAlone) {
  const ReadResult result = read_with("flexarm_moves.csv#elbow", "time,note,elbow\n0,start,1\n1,,2\n");
  EXPECT_TRUE(result.scene) << to_text(result.diagnostics);
}

}  // namespace
}  // namespace flexarm::scene
