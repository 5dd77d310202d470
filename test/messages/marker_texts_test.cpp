// Tests the texts and the legend that show a simulation's numbers in rviz: what they say, and where.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "messages/conversions.h"
#include "messages/marker_messages.h"
#include "messages/picture_axes.h"
#include "messages/shown_arm.h"
#include "pictures/color_scale.h"

namespace flexarm::messages {
namespace {

// The legend's bar has the colours of pages from its lower to its upper end, shaded in one way.
TEST_F(Markers, LegendHasTheColoursOfPages) {
  MarkerMessages messages = this->messages();
  const MarkerArray message = shown(messages);
  const Marker& bar = *std::find_if(message.markers.begin(), message.markers.end(), [](const Marker& marker) {
    return marker.ns == "legend" && marker.type == Marker::TRIANGLE_LIST;
  });
  const Vector3 up = picture_axes().up;
  const auto lower = [&](const geometry_msgs::Point& a, const geometry_msgs::Point& c) {
    return to_vector(a).dot(up) < to_vector(c).dot(up);
  };
  const auto ends = std::minmax_element(bar.points.begin(), bar.points.end(), lower);
  const auto expect_color = [&](std::vector<geometry_msgs::Point>::const_iterator point, double part) {
    const auto& color = bar.colors[static_cast<std::size_t>(point - bar.points.begin())];
    const auto expected = pictures::color_of_amount(part);
    EXPECT_NEAR(color.r / color.b, expected[0] / expected[2], 1e-5);
    EXPECT_NEAR(color.g / color.b, expected[1] / expected[2], 1e-5);
  };
  expect_color(ends.first, 0);
  expect_color(ends.second, 1);
}

TEST_F(Markers, TextHasTimeFactorAndEnergies) {
  MarkerMessages messages = this->messages();
  simulation_.command_effort(0, 5);
  step(50);
  const std::string text = find(shown(messages), "text")->text;
  for (const char* part : {"t = 0.50 s", "0.50 x real time", "kinetic", "strain", "potential", "work", "dissipated"})
    EXPECT_NE(text.find(part), std::string::npos) << text;
  const std::string error = text.substr(text.find("error of the steps") + 19);
  EXPECT_LT(std::abs(std::stod(error)), 1e-9 * simulation_.energies().kinetic) << text;
  EXPECT_EQ(find(messages.make(ros::Time(1), std::nullopt), "text")->text.find("real time"), std::string::npos);
}

/// Returns the offset of a marker's middle from the scene's middle in the picture, to the right and up, in radii.
std::pair<double, double> place_in_picture(const Marker& marker, const pictures::SceneExtent& extent) {
  const Vector3 from_center = (to_vector(marker.pose.position) - extent.center) / extent.radius;
  const PictureAxes axes = picture_axes();
  EXPECT_NEAR(from_center.dot(axes.to_camera), 0, 1e-12);
  return {from_center.dot(axes.right), from_center.dot(axes.up)};
}

TEST_F(Markers, SayWhyNothingMovesAboveTheScene) {
  MarkerMessages messages = this->messages();
  const auto state_of = [](const MarkerArray& message) {
    const auto found = std::find_if(message.markers.begin(), message.markers.end(),
                                    [](const Marker& marker) { return marker.ns == "text" && marker.id == 2; });
    return found == message.markers.end() ? Marker() : *found;
  };
  EXPECT_EQ(state_of(messages.make(ros::Time(1), 1.0)).text, "");
  EXPECT_EQ(state_of(messages.make(ros::Time(1), 1.0, "PAUSED")).text, "PAUSED");
  EXPECT_EQ(state_of(messages.make(ros::Time(1), 1.0)).action, Marker::DELETE);
  std::string reason = "FAILED:";
  for (int n = 0; n < 100; ++n) reason += " because of this";
  const Marker state = state_of(messages.make(ros::Time(1), 1.0, reason));
  EXPECT_EQ(std::count(state.text.begin(), state.text.end(), '\n'), 4);
  EXPECT_EQ(state.text.substr(state.text.size() - 3), "...");
  // The lower edge of this text and the upper edge of the text below are outside of everything that the arm reaches.
  const pictures::SceneExtent extent = pictures::scene_extent(simulation_);
  const double line = 1.3 * state.scale.z / extent.radius;  // line height in rviz
  EXPECT_GT(place_in_picture(state, extent).second - 2.5 * line, kOutline);
  EXPECT_LT(place_in_picture(*find(shown(messages), "text"), extent).second + 1.5 * line, -kOutline);
}

TEST_F(Markers, LegendIsBesideAllThatTheArmReaches) {
  const std::vector<Marker> texts = full_legend();
  const pictures::SceneExtent extent = pictures::scene_extent(simulation_);
  EXPECT_FALSE(texts.empty());
  for (const Marker& marker : texts) {
    constexpr double kLetter = 0.5;  // width of a letter relative to its height
    const double half = 0.5 * kLetter * marker.scale.z * static_cast<double>(marker.text.size()) / extent.radius;
    EXPECT_LT(place_in_picture(marker, extent).first + half, -kOutline) << marker.text;
  }
}

// With all that it can have, the legend is lower than 60 % of what the arm reaches.
TEST_F(Markers, LegendIsLow) {
  const std::vector<Marker> texts = full_legend();
  const pictures::SceneExtent extent = pictures::scene_extent(simulation_);
  double lowest = 1, highest = -1;
  for (const Marker& marker : texts) {
    const double half = 0.5 * marker.scale.z / extent.radius, height = place_in_picture(marker, extent).second;
    lowest = std::min(lowest, height - half);
    highest = std::max(highest, height + half);
  }
  EXPECT_GE(texts.size(), 8u);  // title, three strains, force, moment, two or more kinds of arrows
  EXPECT_LT(highest - lowest, 1.2);
}

}  // namespace
}  // namespace flexarm::messages
