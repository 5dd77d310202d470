// Tests the table of schemes: names, consistency, options.
#include "schemes/scheme.h"

#include "building/model_builder.h"
#include "flexarm/schemes/integrator_description.h"

#include <set>
#include <string>

#include <gtest/gtest.h>

namespace flexarm {
namespace {

TEST(Schemes, NamesAreFoundAndUnique) {
  std::set<std::string_view> names;
  for (const std::vector<Scheme>* list : {&schemes(), &explicit_schemes()})
    for (const Scheme& scheme : *list) {
      EXPECT_TRUE(names.insert(scheme.name).second);
      ASSERT_TRUE(find_scheme(scheme.name));
      EXPECT_EQ(find_scheme(scheme.name)->name, scheme.name);
      EXPECT_FALSE(scheme.description.empty());
    }
  const std::vector<std::string_view>& allowed = scheme_names();
  names.insert("auto");
  EXPECT_EQ(names, std::set<std::string_view>(allowed.begin(), allowed.end()));
}

TEST(Schemes, AutoIsTheFirst) {
  EXPECT_EQ(find_scheme("auto")->name, schemes().front().name);
}

TEST(Schemes, UnknownNames) {
  for (const char* name : {"", "EM", "em ", "euler"}) EXPECT_FALSE(find_scheme(name)) << name;
}

// Properties that the rest of the code relies on.
TEST(Schemes, AreConsistent) {
  for (const Scheme& scheme : schemes()) {
    EXPECT_EQ(scheme.is_incremental(), scheme.stress != StressRule::EndPoint);
    EXPECT_TRUE(!scheme.conserves_energy || scheme.conserves_momenta);
    // If energy is conserved exactly, joints and bodies must map increments exactly.
    EXPECT_TRUE(!scheme.conserves_energy || scheme.body_rotation == RotationRule::TangentScaled);
    EXPECT_TRUE(!scheme.nodal_rotary_inertia || scheme.body_rotation == RotationRule::TangentScaled);
    EXPECT_GE(scheme.gamma, 0.5);  // no negative damping
  }
}

IntegratorDescription integrator(const std::string& scheme) {
  IntegratorDescription description;
  description.scheme = scheme;
  return description;
}

void expect_refused(const IntegratorDescription& description, const std::string& what) {
  try {
    make_scheme(description);
    ADD_FAILURE() << "accepted: " << what;
  } catch (const ModelError& error) {
    EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
  }
}

TEST(MakeScheme, TakesOptions) {
  IntegratorDescription hht = integrator("hht2");
  hht.alpha = -0.1;
  EXPECT_DOUBLE_EQ(make_scheme(hht).gamma, 0.6);
  EXPECT_DOUBLE_EQ(make_scheme(hht).beta, 0.3025);
  IntegratorDescription newmark = integrator("newmark");
  newmark.beta = 0.3, newmark.gamma = 0.6;
  EXPECT_EQ(make_scheme(newmark).beta, 0.3);
  EXPECT_EQ(make_scheme(newmark).order, 1);
  IntegratorDescription automatic = integrator("auto");
  automatic.rho_infinity = 0.9;
  EXPECT_EQ(make_scheme(automatic).name, "edmc2");
  automatic.rho_infinity = 1;
  EXPECT_EQ(make_scheme(automatic).name, schemes().front().name);
}

TEST(MakeScheme, RefusesOptionsOfOthers) {
  expect_refused(integrator("euler"), "unknown integration scheme 'euler'");
  IntegratorDescription description = integrator("em");
  description.alpha = -0.1;
  expect_refused(description, "alpha: scheme 'em' does not have this option");
  description = integrator("em");
  description.interpolation = Interpolation::Total;
  expect_refused(description, "scheme 'em' is built on the local interpolation");
  description = integrator("std");
  description.interpolation = Interpolation::Local;
  expect_refused(description, "scheme 'std' interpolates its own");
  description = integrator("newmark");
  description.weak_form = WeakForm::Additive;
  expect_refused(description, "interpolation=\"total\"");
  description = integrator("hht1");
  description.alpha = -0.5;
  expect_refused(description, "alpha must be from -1/3 to 0");
}

TEST(WithScheme, ForgetsWhatDoesNotSuit) {
  IntegratorDescription description = integrator("hht2");
  description.alpha = -0.1;
  description.interpolation = Interpolation::Total;
  const IntegratorDescription other = with_scheme(description, "m1");
  EXPECT_EQ(other.scheme, "m1");
  EXPECT_FALSE(other.alpha);
  EXPECT_EQ(other.interpolation, Interpolation::Total);
  EXPECT_FALSE(with_scheme(description, "em").interpolation);
}

}  // namespace
}  // namespace flexarm
