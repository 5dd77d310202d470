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

/// The number of scalars that ride, over all parts, and that of the largest border. `unexpected`: the largest number of
/// scalars in a border beyond riders, the inboard node, and what lines couple there.
struct Riders {
  int in_all = 0, largest_border = 0, unexpected = 0;
};

Riders riders_of(const std::string& text) {
  const scene::ReadResult read = scene::read_scene_text(text, "riders.urdf");
  const Model model = build_model(read.scene.value());
  const DegreesOfFreedom dof(model);
  const TreeOrder order(model, dof);
  Riders out;
  for (std::size_t p = 0; p < order.parts().size(); ++p) {
    const TreePart& part = order.parts()[p];
    int border = 0;
    for (int i = 0; i < part.border_count; ++i) border += order.dof().size[order.border(part)[i]];
    out.in_all += order.most_riders(static_cast<int>(p));
    out.largest_border = std::max(out.largest_border, border);
    int own = 6 + 6 * static_cast<int>(part.pieces.size());
    for (const auto& factor : part.factors) own += order.dof().size[order.auxiliary(factor.coupling, factor.group)];
    for (const auto& [coupling, row, column] : part.inners) own += 2 * order.dof().size[order.auxiliary(coupling, row)];
    out.unexpected = std::max(out.unexpected, border - own - order.most_riders(static_cast<int>(p)));
  }
  return out;
}

// The legs are leaves, so no other unknowns pass through them. The multipliers of a leg couple only the table and this
// leg, so the number of riders grows linearly with the number of legs.
TEST(TreeOrder, VariablesRideOnlyWhereTheyPass) {
  const int four = riders_of(table_on(4)).in_all, eight = riders_of(table_on(8)).in_all,
            sixteen = riders_of(table_on(16)).in_all;
  EXPECT_GT(eight, four);
  EXPECT_EQ(sixteen - eight, 2 * (eight - four));
}

/// Returns a beam with a body at the end of each element, and a line over all bodies.
std::string beam_with_line(int elements, double friction = 0) {
  std::string text = fmt::format(
      R"(<robot name="line"><link name="world"/><link name="rod"><beam elements="{}"><centerline><line to="1 0 0"/>
         </centerline><section ea="1e5" ga2="4e4" ga3="4e4" gj="20" ei2="30" ei3="30" mass="1" j1="1e-3" j2="5e-4" j3="5e-4"/>
         </beam></link><joint name="clamp" type="fixed"><parent link="world"/><child link="rod"/></joint>)",
      elements);
  std::string guides;
  for (int i = 1; i <= elements; ++i) {
    text += fmt::format(R"(<link name="disc{0}"><inertial><mass value="1"/>
                           <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
                           <joint name="glue{0}" type="fixed"><parent link="rod"/><child link="disc{0}"/>
                           <origin xyz="{1} 0 0"/></joint>)",
                        i, static_cast<double>(i) / elements);
    guides +=
        fmt::format(R"(<via link="disc{}" at="0 0 0.1" friction="{}"/>)", i, 1 < i && i < elements ? friction : 0);
  }
  return text + R"(<tendon name="line" ea="1e3">)" + guides + R"(</tendon><winch name="hoist" tendon="line">
    <drive rotor_inertia="1"/></winch></robot>)";
}

// Each piece of the line couples two neighbours, and the auxiliary variable couples all of them. Bodies that are
// numbered behind all elements are eliminated between them.
TEST(TreeOrder, ALineOverManyBodiesKeepsBordersSmall) {
  const Riders ten = riders_of(beam_with_line(10)), twenty = riders_of(beam_with_line(20)),
               forty = riders_of(beam_with_line(40));
  EXPECT_EQ(forty.in_all - twenty.in_all, 2 * (twenty.in_all - ten.in_all));
  EXPECT_EQ(forty.largest_border, ten.largest_border);
  EXPECT_EQ(forty.unexpected, 0);
  EXPECT_LE(forty.largest_border, 6 + 6 + 2);  // the inboard node, the next body, and both changes of length
}

// Each part has three auxiliary variables, which couple neighbours.
TEST(TreeOrder, ALineWithFrictionOverManyBodiesKeepsBordersSmall) {
  const Riders ten = riders_of(beam_with_line(10, 0.1)), twenty = riders_of(beam_with_line(20, 0.1)),
               forty = riders_of(beam_with_line(40, 0.1));
  EXPECT_EQ(forty.in_all - twenty.in_all, 2 * (twenty.in_all - ten.in_all));
  EXPECT_EQ(forty.largest_border, ten.largest_border);
  EXPECT_EQ(forty.unexpected, 0);
  // The inboard node, the next body, the winch's node, and the parts on both sides and those beside them.
  EXPECT_LE(forty.largest_border, 6 + 6 + 6 + 4 * 3);
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
