/// Tests the order in which the tree of a mechanism is eliminated, and which unknowns are carried along to other fronts
/// ("riders").
#include "solver/tree_order.h"

#include <algorithm>

#include "building/model_builder.h"
#include "support/scene_text.h"

namespace flexarm {
namespace {

using namespace test;

/// Returns a table on `legs` rigid legs. Each leg is hinged to the ground and to the table.
std::string table_on(int legs) {
  const std::string across = "<axis xyz='0 1 0'/>";
  std::string text;
  for (int i = 0; i < legs; ++i) {
    const std::string leg = fmt::format("leg{}", i), at = fmt::format("xyz='{} 0 0'/>", i);
    text +=
        body(leg, 1) + joint(fmt::format("foot{}", i), "continuous", "world", leg, "<origin " + at + across) +
        joint(fmt::format("head{}", i), "continuous", leg, "table",
              "<origin xyz='0 0 1'/>" + (i > 0 ? "<child_origin " + at : "") + across, i > 0 ? "loop_joint" : "joint");
  }
  return robot(text + body("table", 1));
}

/// The number of scalars that ride, over all parts, and that of the largest border. `unexpected`: the largest number of
/// scalars in a border beyond riders, the inboard node, and what lines couple there.
struct Riders {
  int in_all = 0, largest_border = 0, unexpected = 0;
};

Riders riders_of(const std::string& text) {
  const Model model = build_model(scene_of(text));
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
      R"(<link name="rod"><beam elements="{}"><centerline><line to="1 0 0"/>
         </centerline><section ea="1e5" ga2="4e4" ga3="4e4" gj="20" ei2="30" ei3="30" mass="1" j1="1e-3" j2="5e-4" j3="5e-4"/>
         </beam></link>)",
      elements);
  text += joint("clamp", "fixed", "world", "rod");
  std::string guides;
  for (int i = 1; i <= elements; ++i) {
    const std::string disc = fmt::format("disc{}", i);
    text += body(disc, 1) + joint("of_" + disc, "fixed", "rod", disc,
                                  fmt::format("<origin xyz='{} 0 0'/>", static_cast<double>(i) / elements));
    guides +=
        fmt::format(R"(<via link="disc{}" at="0 0 0.1" friction="{}"/>)", i, 1 < i && i < elements ? friction : 0);
  }
  return robot(text + R"(<tendon name="line" ea="1e3">)" + guides + R"(</tendon><winch name="hoist" tendon="line">
    <drive rotor_inertia="1"/></winch>)");
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

const std::string kSlider = robot(R"(<link name="rail"><beam elements="9" order="2"><centerline><line to="1 0 0"/>
    </centerline><section ea="1e5" ga2="4e4" ga3="4e4" gj="20" ei2="30" ei3="30" mass="1" j1="1e-3" j2="5e-4" j3="5e-4"/>
    </beam></link>)" + body("rider", 1) +
                                  joint("clamp", "fixed", "world", "rail") +
                                  joint("slide", "floating", "rail", "rider", "<slide start='0.5'/>"));

// The front of a slider contains all elements of the slider's window as a whole. It passes on no more than the block of
// one node.
TEST(TreeOrder, TheWindowOfASliderIsOneFront) {
  const Model model = build_model(scene_of(kSlider));
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
