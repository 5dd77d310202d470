/// Tests the order in which the tree of a mechanism is eliminated, and which unknowns are carried along to other fronts
/// ("riders").
#include "solver/tree_order.h"

#include <algorithm>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "building/model_builder.h"
#include "flexarm/scene/urdf_reader.h"

namespace flexarm {
namespace {

/// Returns a table on `legs` rigid legs. Each leg is hinged to the ground and to the table.
std::string table_on(int legs) {
  const std::string inertial =
      R"(<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>)";
  std::string text = R"(<robot name="table"><link name="world"/>)";
  for (int i = 0; i < legs; ++i)
    text +=
        fmt::format(R"(<link name="leg{0}">{1}</link><joint name="foot{0}" type="continuous"><parent link="world"/>)"
                    R"(<child link="leg{0}"/><origin xyz="{0} 0 0"/><axis xyz="0 1 0"/></joint>)",
                    i, inertial);
  text += fmt::format(R"(<link name="table">{}</link><joint name="head0" type="continuous"><parent link="leg0"/>)"
                      R"(<child link="table"/><origin xyz="0 0 1"/><axis xyz="0 1 0"/></joint>)",
                      inertial);
  for (int i = 1; i < legs; ++i)
    text += fmt::format(R"(<loop_joint name="head{0}" type="continuous"><parent link="leg{0}"/><child link="table"/>)"
                        R"(<origin xyz="0 0 1"/><child_origin xyz="{0} 0 0"/><axis xyz="0 1 0"/></loop_joint>)",
                        i);
  return text + "</robot>";
}

int riders_in_all(int legs) {
  const scene::ReadResult read = scene::read_scene_text(table_on(legs), "table.urdf");
  const Model model = build_model(*read.scene);
  const DegreesOfFreedom dof(model);
  const TreeOrder order(model, dof);
  int riders = 0;
  for (std::size_t p = 0; p < order.parts().size(); ++p) riders += order.most_riders(static_cast<int>(p));
  return riders;
}

// The legs are leaves, so no other unknowns pass through them. The multipliers of a leg couple only the table and this
// leg, so the number of riders grows linearly with the number of legs.
TEST(TreeOrder, VariablesRideOnlyWhereTheyPass) {
  const int four = riders_in_all(4), eight = riders_in_all(8), sixteen = riders_in_all(16);
  EXPECT_GT(eight, four);
  EXPECT_EQ(sixteen - eight, 2 * (eight - four));
}

constexpr const char* kSlider = R"(<robot name="slider"><link name="world"/>
  <link name="rail"><beam elements="9" order="2"><centerline><line to="1 0 0"/></centerline>
    <section ea="1e5" ga2="4e4" ga3="4e4" gj="20" ei2="30" ei3="30" mass="1" j1="1e-3" j2="5e-4" j3="5e-4"/></beam></link>
  <link name="rider"><inertial><mass value="1"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <joint name="clamp" type="fixed"><parent link="world"/><child link="rail"/></joint>
  <joint name="slide" type="floating"><parent link="rail"/><child link="rider"/><slide start="0.5"/></joint></robot>)";

// The front of a slider contains all elements of the slider's window as a whole. It passes on no more than the block of
// one node.
TEST(TreeOrder, TheWindowOfASliderIsOneFront) {
  const scene::ReadResult read = scene::read_scene_text(kSlider, "slider.urdf");
  ASSERT_TRUE(read.scene);
  const Model model = build_model(*read.scene);
  const DegreesOfFreedom dof(model);
  TreeOrder order(model, dof);
  const auto slider = std::find_if(model.joints.begin(), model.joints.end(),
                                   [](const JointMap& joint) { return joint.kind == JointMapKind::Slide; });
  ASSERT_NE(slider, model.joints.end());
  const SlideLine& line = model.slide_lines[slider->line];
  for (int piece = 0; piece < static_cast<int>(line.pieces.size()); ++piece) {
    const NodeRange window = line.support(piece, piece);
    order.set_window(static_cast<int>(slider - model.joints.begin()), window);
    order.update();
    const std::vector<TreePart>& parts = order.parts();
    const int front = parts[order.completion(slider->slave)].front;
    EXPECT_TRUE(parts[front].passes_node);
    EXPECT_EQ(parts[front].first_member, order.completion(slider->slave));
    for (int k = window.first + 1; k < window.end; ++k)
      EXPECT_EQ(parts[order.completion(line.nodes[k])].front, front) << "piece " << piece << ", node " << k;
    for (std::size_t p = 0; p < parts.size(); ++p)
      EXPECT_TRUE(parts[p].front == static_cast<int>(p) || parts[p].front == front);
  }
}

}  // namespace
}  // namespace flexarm
