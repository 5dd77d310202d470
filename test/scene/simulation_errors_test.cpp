#include "scene/scene_text.h"

namespace flexarm::scene {
namespace {

/// The good scene with one replacement has one error, at this line.
void expect_error(const std::string& from, const std::string& to, int line, const std::string& fragment) {
  SCOPED_TRACE(from + " -> " + to);
  expect_one_error(good_scene_with(from, to), line, fragment);
}

/// The good scene with one more entry of <simulation>, on line 68, has one error there.
void expect_entry_error(const std::string& entry, const std::string& fragment) {
  expect_error("  </simulation>", entry + "</simulation>", 68, fragment);
}

}  // namespace

TEST(SimulationErrors, Structure) {
  expect_entry_error("<friction/>", "<friction> of simulation: unknown element, expected gravity, integrator");
  expect_entry_error(R"(<gravity xyz="0 0 0"/>)", "at most one <gravity>");
  expect_error("</simulation>", "</simulation><simulation/>", 68, "at most one <simulation>");
  expect_error("<simulation>", R"(<simulation speed="1">)", 58, "unknown attribute, expected nothing, got 'speed'");
  expect_error(R"(xyz="0 0 -1.62")", R"(g="-1.62" xyz="0 0 -1.62")", 59, "unknown attribute, expected xyz, got 'g'");
  expect_error(R"( xyz="0 0 -1.62")", "", 59, "<gravity> of simulation: attribute 'xyz' is missing");
}

TEST(SimulationErrors, Integrator) {
  expect_error(R"(scheme="em0")", R"(scheme="rk4")", 60, "scheme must be one of auto, em, em0, m1, newmark, got 'rk4'");
  expect_error(
      R"(scheme="em0")", R"(scheme="hht2")", 60,
      "this scheme is not yet supported in this version; supported are auto, em, em0, m1, newmark, got 'hht2'");
  expect_error(R"(step="0.002")", R"(step="0")", 60, "<integrator> of simulation: step must be > 0, got '0'");
  expect_error(R"(tolerance="1e-9")", R"(tolerance="-1")", 60, "tolerance must be > 0");
  expect_error(R"(max_iterations="11")", R"(max_iterations="0")", 60,
               "max_iterations must be a whole number from 1 to");
  expect_error(R"(max_halvings="3")", R"(max_halvings="31")", 60, "max_halvings must be a whole number from 0 to 30");
  expect_error(R"(rho_infinity="0.9")", R"(rho_infinity="1.1")", 60, "rho_infinity must be from 0 to 1");
  for (const char* scheme : {"auto", "em", "em0", "m1", "newmark"})
    EXPECT_TRUE(read(good_scene_with(R"(scheme="em0")", "scheme=\"" + std::string(scheme) + "\"")).scene) << scheme;
}

TEST(SimulationErrors, InitialConditions) {
  expect_entry_error(R"(<initial position="1"/>)",
                     "<initial> of simulation: either attribute 'joint' or attribute 'link'");
  expect_entry_error(R"(<initial joint="elbow" link="tip"/>)", "either attribute 'joint' or attribute 'link'");
  expect_entry_error(R"(<initial joint="elbow"/>)", "attribute 'position' or 'velocity' is missing");
  expect_entry_error(R"(<initial link="tip"/>)", "attribute 'linear' or 'angular' is missing");
  expect_entry_error(R"(<initial joint="elbow" position="x"/>)", "position must be a finite number, got 'x'");
  expect_entry_error(R"(<initial joint="elbo" position="1"/>)",
                     "joint must be the name of a joint's coordinate, got 'elbo'");
  expect_entry_error(R"(<initial joint="wrist" position="1"/>)",
                     "joint must be one of 'wrist/1', 'wrist/2', got 'wrist'");
  expect_entry_error(R"(<initial joint="shoulder" position="1"/>)", "the coordinate has an entry of this kind already");
  expect_entry_error(R"(<initial joint="finger" position="1"/>)", "a joint that mimics another one has no coordinate");
  expect_entry_error(R"(<initial joint="wrist/2" position="1"/>)", "the coordinate's <motion> prescribes it already");
  expect_entry_error(R"(<initial link="leg" linear="1 0 0"/>)", "link must be a link of the scene, got 'leg'");
  expect_entry_error(R"(<initial link="forearm" linear="1 0 0"/>)", "the link has an initial velocity already");
  expect_entry_error(R"(<initial link="world" linear="1 0 0"/>)", "the root link is clamped and cannot move");
}

TEST(SimulationErrors, Loads) {
  expect_entry_error(R"(<load link="tip"/>)", "<load> of simulation: attribute 'force' or 'moment' is missing");
  expect_entry_error(R"(<load force="1 0 0"/>)", "attribute 'link' is missing");
  expect_entry_error(R"(<load link="toe" force="1 0 0"/>)", "link must be a link of the scene, got 'toe'");
  expect_entry_error(R"(<load link="tip" force="1 0"/>)", "force must be 3 finite numbers");
  expect_entry_error(R"(<load link="tip" force="1 0 0" frame="body"/>)",
                     "frame must be 'world' or 'follower', got 'body'");
  expect_entry_error(R"(<load link="tip" force="1 0 0" history="2*x"/>)",
                     "history is no function of time, got expression '2*x'");
  expect_entry_error(R"(<load link="tip" force="1 0 0" history="0:0 0:1"/>)", "expected strictly increasing times");
  expect_entry_error(R"(<load link="tip" force="1 0 0" history="1/t"/>)", "history must be finite at t = 0, got '1/t'");
  expect_entry_error(R"(<distributed_load link="tip"/>)", "attribute 'force' is missing");
  expect_entry_error(R"(<distributed_load link="hand" force="1 0 0"/>)",
                     "<distributed_load> of simulation: link must be flexible, that is have a <beam>, got 'hand'");
}

TEST(SimulationErrors, MotionsAndEfforts) {
  expect_entry_error(R"(<motion joint="wrist/1"/>)", "<motion> of simulation: attribute 'position' is missing");
  expect_entry_error(R"(<motion position="t"/>)", "attribute 'joint' is missing");
  expect_entry_error(R"(<motion joint="finger" position="t"/>)", "a joint that mimics another one has no coordinate");
  expect_entry_error(R"(<motion joint="wrist/2" position="t"/>)", "the coordinate has an entry of this kind already");
  expect_entry_error(R"(<motion joint="wrist/3" position="t"/>)", "joint must be the name of a joint's coordinate");
  expect_entry_error(R"(<effort joint="shoulder"/>)", "<effort> of simulation: attribute 'history' is missing");
  expect_entry_error(R"(<effort joint="elbow" history="1"/>)", "the coordinate has an entry of this kind already");
  expect_entry_error(R"(<effort joint="wrist/2" history="1"/>)", "the coordinate's <motion> prescribes it already");
}

TEST(SimulationErrors, Probes) {
  expect_entry_error(R"(<probe link="tip"/>)", "<probe> of simulation: attribute 'name' is missing");
  expect_entry_error(R"(<probe name="p"/>)", "attribute 'link' is missing");
  expect_entry_error(R"(<probe name="p" link="toe"/>)", "link must be a link of the scene, got 'toe'");
  expect_entry_error(R"(<probe name="end" link="tip"/>)", "<probe> 'end': name is taken, by line 67");
}

}  // namespace flexarm::scene
