// Tests what the first picture of a scene shows: colours, masses without shapes, and grounds.
#include <cmath>

#include <gtest/gtest.h>

#include "flexarm/scene/scene_description.h"
#include "pictures/bare_links.h"
#include "pictures/color_scale.h"
#include "pictures/floors.h"

namespace flexarm::pictures {
namespace {

/// CIE 1976 lightness L* of a colour of sRGB.
double lightness(const std::array<double, 3>& color) {
  const auto linear = [](double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); };
  const double luminance = 0.2126 * linear(color[0]) + 0.7152 * linear(color[1]) + 0.0722 * linear(color[2]);
  return luminance > 0.008856 ? 116 * std::cbrt(luminance) - 16 : 903.3 * luminance;
}

// The eye must see equal steps as equal. It tells colours apart that differ by 2.3 (Mahy et al. 1994).
TEST(ColorScale, HasEqualStepsOfLightness) {
  constexpr double kJustSeen = 2.3, kParts = 70;
  const double dark = lightness(color_of_amount(0)), bright = lightness(color_of_amount(1));
  EXPECT_GT(bright - dark, 50);
  for (double k = 0; k <= kParts; ++k)
    EXPECT_NEAR(lightness(color_of_amount(k / kParts)), dark + (bright - dark) * k / kParts, kJustSeen) << k;
}

TEST(ColorScale, EndsAtItsEnds) {
  EXPECT_EQ(color_of_amount(-1), color_of_amount(0));
  EXPECT_EQ(color_of_amount(2), color_of_amount(1));
  EXPECT_EQ(color_of_amount(NAN), color_of_amount(0));
  EXPECT_EQ(color_of_amount(1), (std::array<double, 3>{0xfd / 255.0, 0xe7 / 255.0, 0x25 / 255.0}));
}

TEST(ColorScale, IsTheSameInPages) {
  const std::string json = color_scales_as_json();
  EXPECT_EQ(json.find("{\"amounts\": [\"#46327e\", \"#3b528b\""), 0u) << json;
  EXPECT_NE(json.find("\"signed\": [\"#1f5fc4\""), std::string::npos) << json;
}

TEST(MassBall, HasTheSizeOfABallOfThatInertia) {
  scene::LinkDescription link;
  link.name = "ball";
  EXPECT_FALSE(mass_ball(link));
  constexpr double kMass = 3, kRadius = 0.2;
  link.inertial = scene::RigidInertia{kMass, {1, 2, 3}, 0.4 * kMass * kRadius * kRadius * Matrix3::Identity()};
  const auto ball = mass_ball(link);
  ASSERT_TRUE(ball);
  EXPECT_NEAR(ball->radius, kRadius, 1e-15);
  EXPECT_EQ(ball->at, Vector3(1, 2, 3));
  EXPECT_NEAR(shown_radius(*ball, 5), kRadius, 1e-15);
  EXPECT_LT(shown_radius(*ball, 1), kRadius);        // not larger than the scene
  EXPECT_GT(shown_radius(*ball, 100), 5 * kRadius);  // still seen
  link.inertial->inertia.setZero();
  EXPECT_GT(shown_radius(*mass_ball(link), 1), 0);  // a point
  link.inertial->mass = 0;
  EXPECT_FALSE(mass_ball(link));
}

/// Returns the corner of a box that is `signs` half edges away from its centre.
Vector3 corner(const SceneExtent& extent, int k) {
  return extent.center + Vector3((k & 1 ? 1 : -1) * extent.half.x(), (k & 2 ? 1 : -1) * extent.half.y(),
                                 (k & 4 ? 1 : -1) * extent.half.z());
}

TEST(Floors, AreAsLargeAsTheShadowOfTheScene) {
  const Vector3 normal = Vector3(0.3, -0.2, 0.9).normalized();
  for (const double size : {0.01, 1.0, 300.0}) {
    const SceneExtent extent{size * Vector3(3, 4, 5), size * Vector3(2, 1, 0.5).norm(), size * Vector3(2, 1, 0.5)};
    const std::vector<Floor> floors = floors_of({{"floor", normal, 0.1 * size}}, Vector3::UnitZ(), extent);
    ASSERT_EQ(floors.size(), 1u);
    const Floor& floor = floors[0];
    EXPECT_TRUE(floor.is_ground);
    EXPECT_NEAR(normal.dot(floor.pose.position), 0.1 * size, 1e-12 * size);
    EXPECT_LT((floor.pose.orientation * Vector3::UnitZ() - normal).norm(), 1e-14);
    EXPECT_NEAR(std::remainder(floor.length, floor.cell), 0, 1e-9 * floor.cell);
    EXPECT_NEAR(std::remainder(floor.width, floor.cell), 0, 1e-9 * floor.cell);
    double farthest = 0;
    for (int k = 0; k < 8; ++k) {
      const Vector3 shadow = floor.pose.inverse() * corner(extent, k);
      EXPECT_LT(std::abs(shadow.x()), 0.5 * floor.length);
      EXPECT_LT(std::abs(shadow.y()), 0.5 * floor.width);
      farthest = std::max(farthest, std::abs(shadow.x()));
    }
    EXPECT_LT(0.5 * floor.length, farthest + 0.2 * extent.radius + floor.cell);
    // Grid lines go through the point of the plane that is nearest to the world's origin.
    const Vector3 nearest = floor.pose.inverse() * Vector3(0.1 * size * normal);
    EXPECT_NEAR(std::remainder(nearest.x() - 0.5 * floor.length, floor.cell), 0, 1e-9 * floor.cell);
    EXPECT_NEAR(std::remainder(nearest.y() - 0.5 * floor.width, floor.cell), 0, 1e-9 * floor.cell);
  }
}

TEST(Floors, WithoutGroundsAreAGridAcrossGravity) {
  const std::vector<Floor> floors = floors_of({}, up_of({9.81, 0, 0}), {{1, 2, 3}, 1, {0.1, 0.1, 1}});
  ASSERT_EQ(floors.size(), 1u);
  EXPECT_FALSE(floors[0].is_ground);
  EXPECT_NEAR(floors[0].pose.position.x(), 0, 1e-12);
  EXPECT_LT((floors[0].pose.orientation * Vector3::UnitZ() + Vector3::UnitX()).norm(), 1e-14);
  EXPECT_EQ(up_of(Vector3::Zero()), Vector3::UnitZ());
}

}  // namespace
}  // namespace flexarm::pictures
