// Tests stamps of steps by the wall clock: they are the times at which steps were due, however late steps and messages
// are.
#include <gtest/gtest.h>

#include "ros/stamps.h"

namespace flexarm::node {
namespace {

constexpr double kPeriod = 0.01, kRoundOff = 2e-9;  // [s]
const ros::Time kBegin(1000.0);

/// The stamp of step `n`, which is due `n` periods after the beginning, and whose news arrive `late` seconds later.
ros::Time stamp_of(Stamps& stamps, std::uint64_t n, double late) {
  const ros::Time due = kBegin + ros::Duration(static_cast<double>(n) * kPeriod);
  EXPECT_TRUE(stamps.advance(due + ros::Duration(late), n, late, Stamps::kLargestError));
  return stamps.last();
}

double seconds(const ros::Time& stamp) {
  return (stamp - kBegin).toSec();
}

TEST(Stamps, ALateFirstStepLeavesNoLead) {
  Stamps stamps(kPeriod);
  EXPECT_NEAR(seconds(stamp_of(stamps, 1, 0.0057)), 0.01, kRoundOff);
  for (std::uint64_t n = 2; n < 50; ++n)
    EXPECT_NEAR(seconds(stamp_of(stamps, n, 1e-5)), static_cast<double>(n) * kPeriod, kRoundOff);
}

TEST(Stamps, ThoseOfStepsAreEvenWhateverIsLate) {
  Stamps stamps(kPeriod);
  const double late[] = {0.001, 0.03, 0.021, 0.0112, 0.0001, 2.5, 1e-5};
  for (std::uint64_t n = 0; n < 7; ++n)
    EXPECT_NEAR(seconds(stamp_of(stamps, n + 1, late[n])), static_cast<double>(n + 1) * kPeriod, kRoundOff);
  EXPECT_NEAR(seconds(stamp_of(stamps, 20, 0)), 0.2, kRoundOff) << "steps that were dropped leave a gap";
}

TEST(Stamps, AreThePresentWhereNothingKeepsPace) {
  Stamps stamps(kPeriod);
  EXPECT_TRUE(stamps.last().isZero());
  EXPECT_TRUE(stamps.advance(kBegin + ros::Duration(0.5), 1, std::nullopt, Stamps::kLargestError));
  EXPECT_NEAR(seconds(stamps.last()), 0.5, kRoundOff);
  EXPECT_TRUE(stamps.advance(kBegin + ros::Duration(0.5), 2, std::nullopt, Stamps::kLargestError));
  EXPECT_EQ(stamps.last(), kBegin + ros::Duration(0.5) + ros::Duration(0, 1)) << "later than the one before";
  // Earlier steps whose news arrive later get stamps just after it, and stamps return to the right time.
  EXPECT_TRUE(stamps.advance(kBegin + ros::Duration(0.5), 3, 0.002, Stamps::kLargestError));
  EXPECT_EQ(stamps.last(), kBegin + ros::Duration(0.5) + ros::Duration(0, 2));
  EXPECT_TRUE(stamps.advance(kBegin + ros::Duration(0.51), 4, 0.002, Stamps::kLargestError));
  EXPECT_NEAR(seconds(stamps.last()), 0.508, kRoundOff);
}

TEST(Stamps, FollowAClockThatIsSet) {
  Stamps stamps(kPeriod);
  stamp_of(stamps, 1, 0);
  EXPECT_TRUE(stamps.advance(kBegin + ros::Duration(100), 2, 0.004, Stamps::kLargestError)) << "forth";
  EXPECT_NEAR(seconds(stamps.last()), 99.996, kRoundOff);
  EXPECT_FALSE(stamps.advance(kBegin + ros::Duration(50), 3, 0.004, Stamps::kLargestError)) << "back";
  EXPECT_NEAR(seconds(stamps.last()), 49.996, kRoundOff);
}

}  // namespace
}  // namespace flexarm::node
