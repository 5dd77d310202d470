#include "solver/tree_order.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "building/model_builder.h"
#include "flexarm/scene/urdf_reader.h"

namespace flexarm {
namespace {

/// A table on so many rigid legs, each hinged to the ground and to the table.
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

// The legs are leaves, which nothing rides over; what their multipliers couple comes to the table and its own leg.
TEST(TreeOrder, VariablesRideOnlyWhereTheyPass) {
  const int four = riders_in_all(4), eight = riders_in_all(8), sixteen = riders_in_all(16);
  EXPECT_GT(eight, four);
  EXPECT_EQ(sixteen - eight, 2 * (eight - four));
}

}  // namespace
}  // namespace flexarm
