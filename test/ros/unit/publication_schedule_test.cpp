// Tests the schedule of published messages: the rate of messages and their stamps.
#include "ros/publication_schedule.h"

#include <gtest/gtest.h>

namespace flexarm::node {
namespace {

TEST(PublicationSchedule, KeepsTheRateWhereStepsDivideThePeriod) {
  PublicationSchedule schedule(100);
  int sent = 0;
  for (int step = 1; step <= 1000; ++step) sent += schedule.due(ros::Time(step * 0.001));
  EXPECT_NEAR(sent, 100, 1);  // the first message is sent at once
}

TEST(PublicationSchedule, KeepsTheMeanRateWhereStepsDoNotDivideThePeriod) {
  PublicationSchedule schedule(30);
  int sent = 0;
  for (int step = 1; step <= 10000; ++step) sent += schedule.due(ros::Time(step * 0.001));
  EXPECT_NEAR(sent, 300, 1);
}

// Stamps and periods are rounded to whole nanoseconds.
TEST(PublicationSchedule, SendsEveryStepOfItsOwnRate) {
  for (const double rate : {30.0, 700.0, 1000.0, 3000.0}) {
    PublicationSchedule schedule(rate);
    for (int step = 1; step <= 100000; ++step) ASSERT_TRUE(schedule.due(ros::Time(step / rate))) << rate << " " << step;
  }
}

TEST(PublicationSchedule, SendsEveryStepThatIsLongerThanThePeriod) {
  PublicationSchedule schedule(100);
  for (int step = 1; step <= 10; ++step) EXPECT_TRUE(schedule.due(ros::Time(step * 0.1)));
}

TEST(PublicationSchedule, NeverLetsAStampPassTwice) {
  PublicationSchedule schedule(100);
  EXPECT_TRUE(schedule.due(ros::Time(1)));
  EXPECT_FALSE(schedule.due(ros::Time(1)));
  EXPECT_FALSE(schedule.due(ros::Time(1), true));
  EXPECT_FALSE(schedule.due(ros::Time(0.5), true));
}

TEST(PublicationSchedule, ForcedMessagesGoOutBetweenTheOthers) {
  PublicationSchedule schedule(100);
  EXPECT_TRUE(schedule.due(ros::Time(1)));
  EXPECT_FALSE(schedule.due(ros::Time(1.001)));
  EXPECT_TRUE(schedule.due(ros::Time(1.001), true));
}

TEST(PublicationSchedule, DoesNotMakeUpForAGap) {
  PublicationSchedule schedule(100);
  EXPECT_TRUE(schedule.due(ros::Time(1)));
  EXPECT_TRUE(schedule.due(ros::Time(5)));
  EXPECT_FALSE(schedule.due(ros::Time(5.001)));
}

}  // namespace
}  // namespace flexarm::node
