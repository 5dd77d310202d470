// Tests the messages of live pages.
#include "pictures/live_stream.h"

#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "flexarm/scene/urdf_reader.h"
#include "pictures/page.h"
#include "support/source_path.h"

namespace flexarm::pictures {
namespace {

Simulation simulation_of(const std::string& file) {
  return Simulation(scene::read_scene_file(test::source_path(file)).scene.value());
}

Simulation two_link_arm() {
  return simulation_of("config/examples/flexible_two_link_arm.urdf");
}

/// Numbers of a message.
std::vector<double> numbers_in(const std::string& message) {
  std::vector<double> numbers(message.size() / sizeof(double));
  std::memcpy(numbers.data(), message.data(), message.size());
  return numbers;
}

std::size_t arrows_in(const YAML::Node& picture) {
  std::size_t count = 0;
  for (const YAML::Node& arrows : picture["arrows"]) count += arrows["count"].as<std::size_t>();
  return count;
}

/// How many tracks docs/notes/page.md gives the picture.
std::size_t tracks_of(const YAML::Node& picture) {
  std::size_t count = 7 * picture["links"].size() + 3 * picture["probes"].size() + picture["columns"].size();
  for (const YAML::Node& beam : picture["beams"]) count += 19 * beam["sections"].size();
  return count + 9 * arrows_in(picture);
}

TEST(LiveStream, EachInstantHasTheTimeAndAllTracks) {
  Simulation simulation = two_link_arm();
  LiveStream stream(simulation, "arm");
  const YAML::Node picture = YAML::Load(stream.picture());
  EXPECT_EQ(picture["title"].as<std::string>(), "arm");
  EXPECT_EQ(picture["frames"].as<int>(), 0);
  EXPECT_EQ(picture["mesh_data"].as<std::string>(), "");
  for (int n = 0; n < 3; ++n) {
    ASSERT_TRUE(simulation.step().converged);
    const LiveMessages messages = stream.next(simulation);
    EXPECT_EQ(messages.picture, "");
    const std::vector<double> numbers = numbers_in(messages.instant);
    ASSERT_EQ(numbers.size(), 1 + tracks_of(picture));
    EXPECT_EQ(numbers[0], simulation.time());
    const std::size_t payload = simulation.link_names().size() - 1;
    for (int i = 0; i < 3; ++i) EXPECT_EQ(numbers[1 + 7 * payload + i], simulation.link_pose(payload).position[i]);
    // The first column is the time
    EXPECT_EQ(numbers[numbers.size() - picture["columns"].size()], simulation.time());
  }
}

TEST(LiveStream, MoreForcesThanThereArePlacesForComeWithAnotherPicture) {
  Simulation simulation = two_link_arm();
  LiveStream stream(simulation, "arm");
  const std::size_t places = arrows_in(YAML::Load(stream.picture()));
  AppliedWrench wrench;
  wrench.link = simulation.link_names().size() - 1;
  wrench.wrench.force = {0, 0, 7};
  simulation.apply_wrenches(std::vector<AppliedWrench>(5, wrench));
  const LiveMessages messages = stream.next(simulation);
  const YAML::Node picture = YAML::Load(messages.picture);
  EXPECT_GT(arrows_in(picture), places + 1);
  const std::vector<double> numbers = numbers_in(messages.instant);
  ASSERT_EQ(numbers.size(), 1 + tracks_of(picture));
  // The loads come behind the efforts of two joints
  const std::size_t first = numbers.size() - picture["columns"].size() - 9 * arrows_in(picture) + 2 * 9;
  for (int k = 0; k < 5; ++k) EXPECT_EQ(numbers[first + 9 * k + 5], 7);
  EXPECT_EQ(numbers[first + 9 * 5 + 5], 0);
  EXPECT_EQ(stream.next(simulation).picture, "");
}

TEST(LiveStream, SignsOfQuaternionsChangeContinuously) {
  Simulation simulation = two_link_arm();
  LiveStream stream(simulation, "arm");
  const auto orientation = [](const std::vector<double>& numbers) {
    return Eigen::Map<const Eigen::Vector4d>(numbers.data() + 1 + 7 + 3);  // of the second link
  };
  std::vector<double> last = numbers_in(stream.next(simulation).instant);
  for (int n = 0; n < 50; ++n) {
    simulation.set_joint_state({{0, n % 2 == 0 ? 2.4 : -2.4, {}}});  // a quarter of a turn and a half apart
    const std::vector<double> now = numbers_in(stream.next(simulation).instant);
    EXPECT_GE(orientation(last).dot(orientation(now)), 0);
    last = now;
  }
}

TEST(LiveStream, MeshesComeWithThePicture) {
  const std::string file = testing::TempDir() + "/flexarm_live_stream.stl";
  std::ofstream(file) << "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
                         "endloop\nendfacet\nendsolid s\n";
  const std::string text = "<robot name='plate'> <link name='plate'> <visual> <geometry> <mesh filename='file://" +
                           file + "'/> </geometry> </visual> </link> </robot>";
  const Simulation simulation(scene::read_scene_text(text, "plate.urdf").scene.value());
  const YAML::Node picture = YAML::Load(LiveStream(simulation, "plate").picture());
  ASSERT_EQ(picture["meshes"].size(), 1) << picture["notes"];
  const YAML::Node mesh = picture["meshes"][0];
  const std::size_t bytes = 48 + 6 * mesh["vertices"].as<std::size_t>() + 12 * mesh["triangles"].as<std::size_t>();
  EXPECT_EQ(picture["mesh_data"].as<std::string>().size(), (bytes + 2) / 3 * 4);
}

TEST(LivePage, AsksForTheStreamInThePlaceOfRuns) {
  const std::string page = live_page();
  EXPECT_NE(page.find("<script type=\"application/json\" class=\"flexarm-live\">{\"stream\": \"/stream\"}</script>"),
            std::string::npos);
  EXPECT_EQ(page.find("<!-- runs -->"), std::string::npos);
  EXPECT_EQ(page.find("<script src="), std::string::npos);
}

}  // namespace
}  // namespace flexarm::pictures
