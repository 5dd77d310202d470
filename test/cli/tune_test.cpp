/// Tests `flexarm tune` by running the program: what it finds, what it writes, and how it ends.
#include <algorithm>
#include <filesystem>
#include <regex>

#include "cli/program.h"

namespace flexarm::cli {
namespace {

namespace fs = std::filesystem;

/// A scene with comments, odd spaces and entities, which tuning must keep.
const char* const kScene = R"(<?xml version="1.0"?>
<robot name="two arms">  <!-- <beam elements="7"> -->
  <link name="world"/>
  <joint name="clamp" type="fixed"> <parent link="world"/> <child link="a&amp;b"/> </joint>
  <link name="a&amp;b"><beam   order = '2'   elements="9" > <!-- fine -->
      <centerline> <line to="1 0 0"/> </centerline>
      <section ea="1e6" ga2="1e6" ga3="1e6" gj="1e3" ei2="1e3" ei3="1e3" mass="1" j1="1e-3" j2="1e-3" j3="1e-3"/>
    </beam></link>
  <joint name="weld" type="fixed"> <parent link="a&amp;b"/> <child link="c"/> <origin xyz="1 0 0"/> </joint>
  <link name="c">
    <beam>
      <centerline> <line to="0 0 0.5"/> </centerline>
      <section ea="1e6" ga2="1e6" ga3="1e6" gj="1e3" ei2="1e3" ei3="1e3" mass="1" j1="1e-3" j2="1e-3" j3="1e-3"/>
    </beam>
  </link>
  <simulation>   <!-- no integrator -->
    <probe name="tip" link="c" at="0 0 0.5"/>
  </simulation>
</robot>
)";

/// Returns the text without the attributes that tuning may change, and without an <integrator> that tuning added.
std::string untuned(const std::string& text) {
  const std::string beams = std::regex_replace(text, std::regex(R"( *\b(elements|order) *= *["'][^"']*["'])"), "");
  const std::string all = std::regex_replace(beams, std::regex(R"( *\b(scheme|step|tolerance)="[^"]*")"), "");
  return std::regex_replace(all, std::regex(R"(\n *<integrator/>)"), "");
}

void expect_tuned(const std::string& scene, const std::string& options) {
  const std::string output = temporary("tuned.urdf");
  const Outcome outcome = shell("flexarm tune " + scene + " " + options + " --output " + output);
  ASSERT_EQ(outcome.status, 0) << outcome.errors << outcome.output;
  expect_contains(outcome.output, "as estimated");
  expect_contains(outcome.output, "\nbest ");
  EXPECT_EQ(untuned(read_file(output)), untuned(read_file(scene)));
  EXPECT_NE(read_file(output), read_file(scene));
  EXPECT_EQ(shell("flexarm simulate --quiet --until 0.05 " + output).status, 0);
  const std::string data = read_file(fs::path(output).replace_extension(".csv").string());
  EXPECT_EQ(data.substr(0, data.find(',')), "role");
  EXPECT_NE(data.find("\nbest,"), std::string::npos);
  // On a busy machine the search says what it does.
  const std::string errors = std::regex_replace(outcome.errors, std::regex("flexarm: after [^\n]*\n"), "");
  EXPECT_EQ(fs::exists(fs::path(output).replace_extension(".png")), errors.empty()) << errors;
}

}  // namespace

TEST(Tune, ChangesNothingButItsAttributes) {
  expect_tuned(scene_file(kScene), "--accuracy 1e-2 --until 0.1");
}

TEST(Tune, RigidScene) {
  expect_tuned(example("rigid_double_pendulum"), "--accuracy 1e-3 --until 1");
}

TEST(Tune, ForASpeed) {
  expect_tuned(example("rigid_double_pendulum"), "--real-time 20 --until 1");
}

TEST(Tune, TakesAnAccuracyOfTheSceneAway) {
  std::string text = read_file(example("rigid_double_pendulum"));
  const std::string opening = "<simulation>";
  const std::size_t place = text.find(opening);
  ASSERT_NE(place, std::string::npos);
  text.insert(place + opening.size(), " <integrator accuracy=\"1e-4\"/>");
  const std::string output = temporary("tuned.urdf");
  EXPECT_EQ(shell("flexarm tune " + scene_file(text) + " --accuracy 1e-2 --until 0.5 --output " + output).status, 0);
  EXPECT_EQ(read_file(output).find("accuracy="), std::string::npos);
}

TEST(Tune, UsageErrors) {
  const std::string scene = example("rigid_double_pendulum");
  for (const std::string& arguments :
       {scene, scene + " --accuracy 0", scene + " --accuracy x", scene + " --accuracy 1e-3 --real-time 2",
        scene + " --accuracy 1e-3 --until 0", scene + " --accuracy 1e-3 --output " + scene,
        scene + " --accuracy 1e-3 --output -", scene + " --accuracy 1e-3 --output /no/such/folder/x.urdf",
        scene + " --accuracy 1e-3 --commands /no/such/file", std::string("/no/such/scene --accuracy 1e-3")})
    EXPECT_EQ(shell("flexarm tune " + arguments).status, 2) << arguments;
}

TEST(Tune, AccuracyThatCannotBeMetIsAFailureThatSaysWhatWasReached) {
  const std::string output = temporary("tuned.urdf");
  fs::remove(output);
  const Outcome outcome = shell("flexarm tune " + example("rigid_double_pendulum") +
                                " --accuracy 1e-15 --until 0.1 --budget 3 --output " + output);
  EXPECT_EQ(outcome.status, 1);
  expect_contains(outcome.output, "an error of 1e-15 cannot be met; this is the most accurate run that was found");
  EXPECT_FALSE(fs::exists(output));
}

TEST(Simulate, ChoosesAutomaticMeshesForAnAccuracy) {
  const std::string run = "flexarm simulate " + scene_file(kScene) + " --until 0.05 ";
  const Outcome chosen = shell(run + "--accuracy 1e-2");
  EXPECT_EQ(chosen.status, 0) << chosen.errors;
  expect_contains(chosen.output, "elements: c ");
  EXPECT_EQ(chosen.output.find("a&b"), std::string::npos) << "it has a number of elements";
  const Outcome without = shell(run);
  EXPECT_EQ(without.output.find("elements:"), std::string::npos);
  // A saved state belongs to the meshes of the scene itself, so the meshes are kept.
  const Outcome kept = shell(run + "--accuracy 1e-2 --checkpoint " + temporary("state"));
  EXPECT_EQ(kept.output.find("elements:"), std::string::npos);
}

TEST(Tune, SignalsKeepTheBestSoFar) {
  const std::string output = temporary("tuned.urdf");
  const Outcome outcome =
      shell(interruptible_program() + "tune " + example("flexible_two_link_arm") +
            " --accuracy 1e-5 --until 1000 --output " + output + " & sleep 2; kill -INT $!; wait $!");
  EXPECT_EQ(outcome.status, 130);
  expect_contains(outcome.errors, "interrupted");
  expect_contains(outcome.output, "runs, ");
}

}  // namespace flexarm::cli
