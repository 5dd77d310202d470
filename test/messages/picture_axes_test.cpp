/// Axes of rviz's picture.

#include <gtest/gtest.h>

#include "messages/picture_axes.h"

namespace flexarm::messages {
namespace {

TEST(PictureAxes, AreARightHandedFrame) {
  const PictureAxes axes = picture_axes();
  EXPECT_NEAR((axes.right.cross(axes.up) - axes.to_camera).norm(), 0, 1e-12);
  EXPECT_NEAR(axes.up.norm(), 1, 1e-12);
  EXPECT_GT(axes.up.z(), 0.8);
}

}  // namespace
}  // namespace flexarm::messages
