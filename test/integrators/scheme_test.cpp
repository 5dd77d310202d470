// The table of schemes.
#include "flexarm/integrators/scheme.h"

#include <set>
#include <string>

#include <gtest/gtest.h>

namespace flexarm {
namespace {

TEST(Schemes, NamesAreFoundAndUnique) {
  std::set<std::string_view> names;
  for (const Scheme& scheme : schemes()) {
    EXPECT_TRUE(names.insert(scheme.name).second);
    ASSERT_TRUE(find_scheme(scheme.name));
    EXPECT_EQ(find_scheme(scheme.name)->name, scheme.name);
    EXPECT_FALSE(scheme.description.empty());
  }
  EXPECT_EQ(names, (std::set<std::string_view>{"em", "em0", "m1", "newmark"}));
}

TEST(Schemes, AutoIsTheFirst) {
  EXPECT_EQ(find_scheme("auto")->name, schemes().front().name);
}

TEST(Schemes, UnknownNames) {
  for (const char* name : {"", "EM", "em ", "rk4"}) EXPECT_FALSE(find_scheme(name)) << name;
}

// What the rest of the code relies on.
TEST(Schemes, AreConsistent) {
  for (const Scheme& scheme : schemes()) {
    EXPECT_EQ(scheme.is_incremental(), scheme.stress != StressRule::EndPoint);
    EXPECT_TRUE(!scheme.conserves_energy || (scheme.conserves_momenta && scheme.nodal_rotary_inertia));
    EXPECT_TRUE(!scheme.nodal_rotary_inertia || scheme.rotation == RotationRule::TangentScaled);
    EXPECT_GE(scheme.gamma, 0.5);  // no negative damping
  }
}

}  // namespace
}  // namespace flexarm
