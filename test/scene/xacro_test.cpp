#include "scene/scene_text.h"

namespace flexarm::scene {

TEST(Xacro, IsRefusedWithAHint) {
  const auto expect = [](const std::string& from, const std::string& to, int line, const std::string& got) {
    expect_one_error(good_scene_with(from, to), line, "this is xacro and must be expanded to URDF first");
    expect_one_error(good_scene_with(from, to), line, "got '" + got + "'");
  };
  expect("<!-- 2 -->", R"x(<xacro:include filename="$(find arm)/arm.xacro"/>)x", 2, "xacro:include");
  expect(R"(<mass value="2"/>)", R"(<mass value="${mass}"/>)", 16, "${mass}");
  expect(R"(<origin xyz="0 0 0.5")", R"x(<origin xyz="$(optenv HEIGHT 0 0 0.5)")x", 6, "$(optenv HEIGHT 0 0 0.5)");
  expect(R"(<child link="upper"/>)", R"(<child link="upper"/><xacro:limit side="left"/>)", 8, "xacro:limit");
}

TEST(Xacro, HasNoNameInARootWithoutOne) {
  expect_one_error("<robot xmlns:xacro=\"http://www.ros.org/wiki/xacro\">\n<xacro:macro name=\"leg\"/></robot>", 2,
                   "this is xacro");
}

TEST(Xacro, LeavesTracesThatDoNotMatter) {
  const ReadResult named = read(
      good_scene_with(R"(<robot name="arm">)", R"(<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">)"));
  EXPECT_TRUE(named.diagnostics.empty()) << to_text(named.diagnostics);
  const ReadResult foreign = read(good_scene_with(R"(<gazebo anything="goes"/>)", R"x(<gazebo path="$(find arm)"/>)x"));
  EXPECT_TRUE(foreign.diagnostics.empty()) << to_text(foreign.diagnostics);
}

}  // namespace flexarm::scene
