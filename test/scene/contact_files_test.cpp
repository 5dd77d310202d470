// Tests what contacts take from other files and programs: SRDFs, Gazebo's surfaces, files given by URLs.
#include <filesystem>
#include <fstream>

#include "flexarm/scene/resource_path.h"
#include "scene/scene_text.h"

namespace flexarm::scene::contact_files {
namespace {

namespace fs = std::filesystem;

fs::path folder() {
  const fs::path path = fs::path(::testing::TempDir()) / "contact_files";
  fs::create_directories(path);
  return path;
}

fs::path written(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  std::ofstream(path) << text;
  return path;
}

std::string robot(const std::string& more) {
  std::string text = R"(<robot name="r"><link name="world"/>)";
  for (const std::string name : {"a", "b", "c"})
    text +=
        "<link name=\"" + name +
        R"("><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>)"
        "<joint name=\"to_" +
        name + R"(" type="floating"><parent link="world"/><child link=")" + name + "\"/></joint>";
  return text + "\n" + more + "</robot>\n";
}

std::vector<std::pair<std::string, std::string>> pairs_of(const ReadResult& result) {
  EXPECT_TRUE(result.scene) << to_text(result.diagnostics);
  std::vector<std::pair<std::string, std::string>> out;
  for (const ContactPair& pair : result.scene.value().no_contacts) out.emplace_back(pair.first, pair.second);
  return out;
}

// Pairs with a missing link, and pairs for which the scene itself has a contact, are left out.
TEST(Srdf, DisablesPairs) {
  written(folder() / "r.srdf", R"(<?xml version="1.0"?><robot name="r"><group name="arm"/>
    <disable_collisions link1="a" link2="b" reason="Never"/><disable_collisions link1="b" link2="a" reason="Adjacent"/>
    <disable_collisions link1="c" link2="b"/><disable_collisions link1="a" link2="gone"/>
    <disable_collisions link1="a" link2="c"/><disable_collisions link1="a"/></robot>)");
  const fs::path scene = written(folder() / "r.urdf", robot(R"(<no_contact srdf="r.srdf"/>
    <contact first="*" second="*"/><contact first="a" second="c"/>)"));
  const std::vector<std::pair<std::string, std::string>> expected = {{"a", "b"}, {"c", "b"}};
  EXPECT_EQ(pairs_of(read_scene_file(scene)), expected);
}

TEST(Srdf, ThatCannotBeReadIsAnError) {
  const auto said = [](const std::string& srdf) {
    const ReadResult result = read_scene_text(robot("<no_contact srdf=\"" + srdf + "\"/>"), "/nowhere/r.urdf");
    EXPECT_FALSE(result.scene);
    return to_text(result.diagnostics);
  };
  EXPECT_EQ(said("r.srdf"),
            "/nowhere/r.urdf:2: <no_contact> of robot 'r': its file cannot be read: there is no file /nowhere/r.srdf, "
            "got 'r.srdf'\n");
  const fs::path broken = written(folder() / "broken.srdf", "<robot><disable_collisions></robot>");
  EXPECT_NE(said("file://" + broken.string()).find("broken.srdf:1: "), std::string::npos);
  EXPECT_NE(said("package://nobody/r.srdf").find("package 'nobody' is neither in ROS_PACKAGE_PATH nor"),
            std::string::npos);
}

TEST(Surfaces, AreThoseOfGazebo) {
  const ReadResult result = read(robot(R"(<gazebo reference="a"><mu1>0.7</mu1><mu2>0.5</mu2><kp>1e5</kp></gazebo>
    <gazebo reference="b"><mu1>${mu}</mu1><kp>0</kp></gazebo><gazebo><mu1>3</mu1></gazebo>
    <gazebo reference="c"><mu2> 0.2 </mu2></gazebo>)"));
  ASSERT_TRUE(result.scene) << to_text(result.diagnostics);
  const auto& surfaces = result.scene->surfaces;
  ASSERT_EQ(surfaces.size(), 2u) << "what is no number, and no stiffness, says nothing";
  EXPECT_EQ(surfaces.at("a").friction, 0.5);
  EXPECT_EQ(surfaces.at("a").stiffness, 1e5);
  EXPECT_EQ(surfaces.at("c").friction, 0.2);
  EXPECT_EQ(surfaces.at("c").stiffness, std::nullopt);
}

TEST(Resources, AreFoundByTheirUrls) {
  const fs::path workspace = folder() / "workspace";
  written(workspace / "src/stack/arm_description/package.xml", "<package/>");
  written(workspace / "src/stack/arm_description/meshes/hand.stl", "");
  const std::string scene = workspace / "src/stack/arm_description/urdf/arm.urdf";
  const std::string hand = workspace / "src/stack/arm_description/meshes/hand.stl";
  const auto same = [&](const std::string& path) { return fs::weakly_canonical(path) == fs::weakly_canonical(hand); };
  EXPECT_TRUE(same(path_of_resource("file://" + hand, "")));
  EXPECT_TRUE(same(path_of_resource("../meshes/hand.stl", scene)));
  ::unsetenv("ROS_PACKAGE_PATH");
  EXPECT_TRUE(same(path_of_resource("package://arm_description/meshes/hand.stl", scene)));
  EXPECT_THROW(path_of_resource("package://arm_description/meshes/hand.stl", "/nowhere/arm.urdf"), std::runtime_error);
  ::setenv("ROS_PACKAGE_PATH", ("/nowhere:" + (workspace / "src").string()).c_str(), 1);
  EXPECT_TRUE(same(path_of_resource("package://arm_description/meshes/hand.stl", "/nowhere/arm.urdf")));
  ::unsetenv("ROS_PACKAGE_PATH");
  EXPECT_THROW(path_of_resource("http://host/hand.stl", scene), std::runtime_error);
}

}  // namespace
}  // namespace flexarm::scene::contact_files
