// Tests FarElements, which skips force elements whose nodes are too far apart to act: a skipped element must not be one
// that would act.
#include "integrators/far_elements.h"

#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "contact/contact_element.h"
#include "contact/line_contact.h"
#include "math/cayley.h"
#include "support/gripping_law.h"
#include "support/node_poses.h"

namespace flexarm::test::far {
namespace {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double number() { return number_(engine_); }
  /// Braces guarantee that the numbers are drawn in the same order with every compiler.
  Vector3 vector(double size) { return size * Vector3{number(), number(), number()}; }

 private:
  std::mt19937 engine_;
  std::uniform_real_distribution<double> number_{-1, 1};
};

constexpr int kNodes = 5;  // nodes of a body with points, a body with a shape, and an element of a beam
constexpr double kStep = 0.01;

std::vector<std::unique_ptr<ForceElement>> elements() {
  ContactStation ball, corner, tube;
  ball.arm = {0.1, 0.05, -0.1};
  ball.radius = 0.05;
  corner.arm = {-0.2, 0.1, 0.1};
  tube.weights = {0.3, 0.5, 0.2};
  tube.radius = 0.02;
  const ContactStations body{{0}, {ball, corner}}, beam{{2, 3, 4}, {tube}};
  const ContactShape box{Box{{0.2, 0.1, 0.05}}, {{0.1, 0.3, 0}, Quaternion::Identity()}};
  ContactLine line;
  line.order = 2;
  line.elements = {{2, 3, 4}};
  line.lengths = {0.4};
  line.radius = 0.02;
  const ContactLaw law = gripping_law(0.3, 0.5, 0.1);
  const std::vector<std::string> links = {"", ""};
  std::vector<std::unique_ptr<ForceElement>> out;
  for (const int base : {1, -1})
    for (const ContactStations& side : {body, beam})
      out.push_back(std::make_unique<ContactElement>(links, side, ContactSurface{base, {box}}, law));
  out.push_back(std::make_unique<LineContact>(links, LineTouch{body, line, {{0, {}, {}}, {1, {}, {}}}, 0}, law));
  return out;
}

std::vector<NodePose> apart(Random& random) {
  std::vector<NodePose> poses;
  const Vector3 beam = random.vector(1);
  for (const Vector3& place : {random.vector(1), random.vector(1), beam, Vector3(beam + Vector3(0.2, 0, 0)),
                               Vector3(beam + Vector3(0.4, 0, 0))})
    poses.push_back(node_at(place, so3::exp_quaternion(random.vector(3))));
  return poses;
}

TEST(FarElements, AreNotFoundToActAndNeedNoHalves) {
  const auto all = elements();
  int far = 0, asked = 0, found = 0;
  for (unsigned seed = 0; seed < 1800; ++seed) {
    // One third of the runs only translates, one third only rotates: each kind of motion must count by itself.
    const double ways = seed % 3 == 2 ? 0 : 1.5, turns = seed % 3 == 1 ? 0 : 2;
    Random random(seed);
    FarElements tracked(all.size(), kNodes);
    std::vector<NodePose> poses = apart(random);
    for (int i = 0; i < 50; ++i) {
      std::vector<Vector6> velocities(kNodes);
      for (Vector6& velocity : velocities) {
        velocity.head<3>() = random.vector(ways);
        velocity.tail<3>() = random.vector(turns);
      }
      const ForceStart start{poses, velocities, kStep};
      std::vector<NodePose> end = poses;
      for (int k = 0; k < kNodes; ++k)
        end[k] = moved(poses[k], 1.9 * kStep * std::abs(random.number()) * velocities[k]);
      tracked.begin(start);
      tracked.end(poses, end);
      for (std::size_t k = 0; k < all.size(); ++k) {
        std::vector<int> nodes(all[k]->most_nodes());
        const int count = all[k]->find_nodes(start, nodes.data());
        const bool was_far = tracked.is_far(k);
        EXPECT_FALSE(was_far && count > 0) << k << " " << seed << " " << i;
        if (!was_far) tracked.set_room(k, count > 0 ? ForceRoom{} : all[k]->room(start));
        const std::vector<double> memory(all[k]->memory_size(), 0.0);
        ForceStep step{poses, end, velocities};
        step.duration = kStep;
        step.memory = memory.data();
        EXPECT_FALSE(tracked.stays_far(k) && all[k]->needs_halves(step, nodes.data(), count)) << k << " " << seed;
        (was_far ? far : asked) += 1;
        found += count > 0;
      }
      poses = end;
    }
  }
  EXPECT_GT(far, asked) << "most of the time nothing is asked";
  EXPECT_GT(found, 500) << "but some come near";
}

Vector6 velocity_of(const Vector3& linear, const Vector3& angular) {
  Vector6 velocity;
  velocity << linear, angular;
  return velocity;
}

// An element is evaluated again if its nodes were moved near, or are fast enough to come near.
TEST(FarElements, WakeWhereTheyAreSetNearer) {
  FarElements tracked(1, 1);
  const std::vector<Vector6> still(1, Vector6::Zero());
  const std::vector<NodePose> here{node_at({0, 0, 0}, Quaternion::Identity())},
      there{node_at({0.6, 0, 0}, Quaternion::Identity())}, turned{node_at({0, 0, 0}, Quaternion(0, 0, 0, 1))};
  tracked.begin({here, still, kStep});
  EXPECT_FALSE(tracked.is_far(0)) << "it has not been asked";
  tracked.set_room(0, {1, 2, 0.3});
  tracked.begin({here, still, kStep});
  EXPECT_TRUE(tracked.is_far(0));
  tracked.begin({turned, still, kStep});
  EXPECT_TRUE(tracked.is_far(0)) << "pi times 0.3 is less than 1";
  tracked.begin({here, still, kStep});
  EXPECT_FALSE(tracked.is_far(0)) << "twice that is not";
  tracked.set_room(0, {1, 2, 0.3});
  tracked.begin({here, still, kStep});
  EXPECT_TRUE(tracked.is_far(0));
  tracked.begin({there, still, kStep});
  EXPECT_FALSE(tracked.is_far(0)) << "2 times 0.6 is more than 1";
  tracked.set_room(0, {1, 2, 0.3});
  for (const Vector6& velocity : {velocity_of({60, 0, 0}, {0, 0, 0}), velocity_of({0, 0, 0}, {0, 0, 200})}) {
    tracked.begin({there, {velocity}, kStep});
    EXPECT_FALSE(tracked.is_far(0)) << "what twice the step goes through is more than the room";
  }
  tracked.begin({there, still, kStep});
  EXPECT_TRUE(tracked.is_far(0));
  tracked.begin({there, still, 0});
  EXPECT_FALSE(tracked.is_far(0)) << "an equilibrium may be anywhere";
}

}  // namespace
}  // namespace flexarm::test::far
