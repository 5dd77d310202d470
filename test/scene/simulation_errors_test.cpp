/// Tests errors in the entries of <simulation>.
#include "flexarm/schemes/integrator_description.h"
#include "scene/scene_text.h"

namespace flexarm::scene {
namespace {

/// Expects exactly one error on line 68, where `entry` is added to <simulation> of the good scene.
void expect_entry_error(const std::string& entry, const std::string& fragment) {
  expect_error("  </simulation>", entry + "</simulation>", 68, fragment);
}

}  // namespace

TEST(SimulationErrors, Structure) {
  expect_entry_error("<friction/>", "<friction> of simulation: unknown element, expected gravity, integrator");
  expect_entry_error(R"(<gravity xyz="0 0 0"/>)", "at most one <gravity>");
  expect_error("</simulation>", "</simulation><simulation/>", 68, "at most one <simulation>");
  expect_error("<simulation>", R"(<simulation speed="1">)", 58,
               "unknown attribute, expected start, massless, contact_time, got 'speed'");
  expect_error("<simulation>", R"(<simulation contact_time="0">)", 58, "contact_time must be > 0, got '0'");
  expect_error(R"(xyz="0 0 -1.62")", R"(g="-1.62" xyz="0 0 -1.62")", 59, "unknown attribute, expected xyz, got 'g'");
  expect_error(R"( xyz="0 0 -1.62")", "", 59, "<gravity> of simulation: attribute 'xyz' is missing");
}

TEST(SimulationErrors, Integrator) {
  expect_error(R"(scheme="edmc2")", R"(scheme="euler")", 60, "scheme must be one of auto, em, em0,");
  expect_error(R"(step="0.002")", R"(step="0")", 60,
               "<integrator> of simulation: step must be > 0 and at most 1e9, got '0'");
  for (const char* tolerance : {"-1", "0", "1.1", "1e300"})
    expect_error(R"(tolerance="1e-9")", "tolerance=\"" + std::string(tolerance) + "\"", 60,
                 "tolerance must be > 0 and at most 1, got '" + std::string(tolerance) + "'");
  expect_error(R"(max_iterations="11")", R"(max_iterations="0")", 60,
               "max_iterations must be a whole number from 1 to");
  expect_error(R"(max_halvings="3")", R"(max_halvings="31")", 60, "max_halvings must be a whole number from 0 to 30");
  expect_error(R"(rho_infinity="0.9")", R"(rho_infinity="1.1")", 60, "rho_infinity must be from 0 to 1");
  const std::string known =
      R"(scheme="edmc2" step="0.002" tolerance="1e-9" max_iterations="11" max_halvings="3" rho_infinity="0.9")";
  for (const std::string_view scheme : scheme_names())
    EXPECT_TRUE(read(good_scene_with(known, "scheme=\"" + std::string(scheme) + "\"")).scene) << scheme;
  for (const char* options :
       {R"(scheme="newmark" beta="0.3" gamma="0.6")", R"(scheme="hht2" alpha="-0.1" interpolation="iterative")",
        R"(scheme="m1" interpolation="incremental")", R"(scheme="newmark" interpolation="total" weak_form="additive")",
        R"(scheme="beta1" interpolation="local" weak_form="spin")", R"(scheme="auto" rho_infinity="0.8")",
        R"(on_failure="dissipate")", R"(scheme="em4" on_failure="dissipate")", R"(scheme="m1" on_failure="stop")"})
    EXPECT_TRUE(read(good_scene_with(known, options)).scene) << options;
  expect_error(known, R"(scheme="hht2" alpha="-0.5")", 60, "alpha must be from -1/3 to 0, got '-0.5'");
  expect_error(known, R"(scheme="newmark" beta="0")", 60, "beta must be > 0, got '0'");
  expect_error(known, R"(scheme="em" gamma="0.5")", 60, "scheme 'em' does not have this option; it belongs to newmark");
  expect_error(known, R"(scheme="m1" rho_infinity="0.9")", 60, "it belongs to auto, edmc1, edmc2, got '0.9'");
  expect_error(known, R"(on_failure="hope")", 60, "on_failure must be one of stop, dissipate, got 'hope'");
  expect_error(known, R"(dimension="2")", 60, "dimension must be one of auto, 3, got '2'");
  for (const char* options : {R"(scheme="m1" on_failure="dissipate")", R"(scheme="edmc2" on_failure="dissipate")",
                              R"(rho_infinity="0.9" on_failure="dissipate")"})
    expect_error(known, options, 60, "'dissipate' belongs to auto, em, em0, em_symmetric, em4, got");
  expect_error(known, R"(scheme="m1" interpolation="quadratic")", 60,
               "interpolation must be one of local, total, incremental, iterative, got 'quadratic'");
  expect_error(known, R"(scheme="em" interpolation="total")", 60, "scheme 'em' is built on the local interpolation");
  expect_error(known, R"(scheme="std" interpolation="local")", 60, "interpolates its own, tangent-scaled increments");
  expect_error(known, R"(scheme="hht3" interpolation="iterative")", 60, "evaluates two configurations");
  expect_error(known, R"(scheme="newmark" weak_form="weak")", 60, "weak_form must be 'spin' or 'additive', got 'weak'");
  expect_error(known, R"(scheme="newmark" weak_form="additive")", 60, "the additive form needs interpolation");
  expect_error(known, R"(scheme="m1" interpolation="total" weak_form="additive")", 60,
               "the additive form does not conserve momenta");
}

TEST(SimulationErrors, InitialConditions) {
  expect_entry_error(R"(<initial position="1"/>)",
                     "<initial> of simulation: one of the attributes 'joint', 'link' and 'equilibrium'");
  expect_entry_error(R"(<initial joint="elbow" link="tip"/>)",
                     "one of the attributes 'joint', 'link' and 'equilibrium'");
  expect_entry_error(R"(<initial joint="elbow"/>)", "attribute 'position' or 'velocity' is missing");
  expect_entry_error(R"(<initial link="tip"/>)", "attribute 'linear' or 'angular' is missing");
  expect_entry_error(R"(<initial joint="elbow" position="x"/>)", "position must be a finite number, got 'x'");
  expect_entry_error(R"(<initial joint="elbo" position="1"/>)",
                     "joint must be the name of a joint's coordinate (elbow, shoulder, wrist/1, wrist/2), got 'elbo'");
  expect_entry_error(R"(<initial joint="wrist" position="1"/>)",
                     "joint must be one of 'wrist/1', 'wrist/2', got 'wrist'");
  expect_entry_error(R"(<initial joint="shoulder" position="1"/>)", "the coordinate has an entry of this kind already");
  expect_entry_error(R"(<initial joint="finger" position="1"/>)",
                     "a joint that mimics another one, 'shoulder', has no coordinate");
  expect_entry_error(R"(<initial joint="wrist/2" position="1"/>)", "the coordinate's <motion> prescribes it already");
  expect_entry_error(R"(<initial link="leg" linear="1 0 0"/>)",
                     "link must be a link of the scene (tip, upper, hand, world, forearm), got 'leg'");
  expect_entry_error(R"(<initial link="forearm" linear="1 0 0"/>)", "the link has an initial velocity already");
  expect_entry_error(R"(<initial link="world" linear="1 0 0"/>)", "the root link is clamped and cannot move");
}

TEST(SimulationErrors, Loads) {
  expect_entry_error(R"(<load link="tip"/>)", "<load> of simulation: attribute 'force' or 'moment' is missing");
  expect_entry_error(R"(<load force="1 0 0"/>)", "attribute 'link' is missing");
  expect_entry_error(R"(<load link="toe" force="1 0 0"/>)",
                     "link must be a link of the scene (tip, world, upper, hand, forearm), got 'toe'");
  expect_entry_error(R"(<load link="tip" force="1 0"/>)", "force must be 3 finite numbers");
  expect_entry_error(R"(<load link="tip" force="1 0 0" frame="body"/>)",
                     "frame must be 'world' or 'follower', got 'body'");
  expect_entry_error(R"(<load link="tip" force="1 0 0" history="2*x"/>)",
                     "history is not a function of time, got expression '2*x'");
  expect_entry_error(R"(<load link="tip" force="1 0 0" history="0:0 0:1"/>)", "expected strictly increasing times");
  expect_entry_error(R"(<load link="tip" force="1 0 0" history="1/t"/>)", "history must be finite at t = 0, got '1/t'");
  expect_entry_error(R"(<distributed_load link="tip"/>)", "attribute 'force' is missing");
  expect_entry_error(R"(<distributed_load link="hand" force="1 0 0"/>)",
                     "<distributed_load> of simulation: link must have a <beam>, got 'hand'");
}

TEST(SimulationErrors, MotionsAndEfforts) {
  expect_entry_error(R"(<motion joint="wrist/1"/>)", "<motion> of simulation: attribute 'position' is missing");
  expect_entry_error(R"(<motion position="t"/>)", "attribute 'joint' is missing");
  expect_entry_error(R"(<motion joint="finger" position="t"/>)",
                     "a joint that mimics another one, 'shoulder', has no coordinate");
  expect_entry_error(R"(<motion joint="wrist/2" position="t"/>)", "the coordinate has an entry of this kind already");
  expect_entry_error(R"(<motion joint="wrist/3" position="t"/>)", "joint must be the name of a joint's coordinate");
  expect_entry_error(R"(<effort joint="shoulder"/>)", "<effort> of simulation: attribute 'history' is missing");
  expect_entry_error(R"(<effort joint="elbow" history="1"/>)", "the coordinate has an entry of this kind already");
  expect_entry_error(R"(<effort joint="wrist/2" history="1"/>)", "the coordinate's <motion> prescribes it already");
}

TEST(SimulationErrors, Probes) {
  expect_entry_error(R"(<probe link="tip"/>)", "<probe> of simulation: attribute 'name' is missing");
  expect_entry_error(R"(<probe name="p"/>)", "attribute 'link' is missing");
  expect_entry_error(R"(<probe name="p" link="toe"/>)",
                     "link must be a link of the scene (tip, world, upper, hand, forearm), got 'toe'");
  expect_entry_error(R"(<probe name="end" link="tip"/>)", "<probe> 'end': name is taken, by line 67");
}

// Elsewhere they would have no effect.
TEST(SimulationErrors, EntriesThatNameAJointOrALinkBelongInSimulation) {
  const auto expect = [](const std::string& entry, const std::string& tag) {
    expect_error("<!-- 2 -->", entry, 2, "<" + tag + "> of robot 'arm': <" + tag + "> must be a child of <simulation>");
  };
  expect(R"(<effort joint="elbow" history="1"/>)", "effort");
  expect(R"(<motion joint="elbow" position="1"/>)", "motion");
  expect(R"(<initial joint="elbow" position="1"/>)", "initial");
  expect(R"(<initial link="upper" linear="1 0 0"/>)", "initial");
  expect(R"(<load link="upper" force="1 0 0"/>)", "load");
  expect(R"(<distributed_load link="tip" force="1 0 0"/>)", "distributed_load");
  expect(R"(<probe name="p" link="tip"/>)", "probe");
  // Without a name of the scene it is another program's.
  expect_warning(read(good_scene_with("<!-- 2 -->", "<effort/>")), 2, "has no effect here: it belongs in <simulation>");
}

// ---------------------------------------------------------------- unknown names

TEST(UnknownNames, AreAnsweredWithTheNearestOnes) {
  const std::string links = "(hand, world, tip, upper, forearm)";
  expect_error(R"(<parent link="upper"/>)", R"(<parent link="hnad"/>)", 22,
               "<joint> 'elbow': parent must be a link of the scene " + links + ", got 'hnad'");
  expect_error(R"(<probe name="end" link="tip")", R"(<probe name="end" link="hnad")", 67,
               "link must be a link of the scene " + links + ", got 'hnad'");
  expect_error(R"(<effort joint="elbow")", R"(<effort joint="elbw")", 66,
               "joint must be the name of a joint's coordinate (elbow, ");
  expect_error(R"(<mimic joint="shoulder" m)", R"(<mimic joint="sholder" m)", 47,
               "mimic joint must be a joint of the scene (shoulder, ");
  expect_error(R"(first="*")", R"(first="hnad")", 76, "first must be a link or a ground of the scene (hand, ");
}

TEST(UnknownNames, AreNotSoughtForLong) {
  std::string text = R"(<robot name="r"><link name="world"/>)";
  for (int i = 0; i < 3000; ++i) {
    const std::string name = std::string(30, 'a') + std::to_string(i);
    text += "<link name=\"" + name + "\"/><joint name=\"j" + std::to_string(i) + "\" type=\"fixed\"><parent link=\"b" +
            name + "\"/><child link=\"" + name + "\"/></joint>\n";
  }
  const ReadResult result = read(text + "</robot>");
  EXPECT_FALSE(result.scene);
  EXPECT_NE(result.diagnostics.front().text().find("parent must be a link of the scene (aaa"), std::string::npos);
  EXPECT_NE(result.diagnostics[500].text().find("parent must be a link of the scene, got"), std::string::npos);
}

TEST(UnknownNames, OfAttributesAreAnsweredWithTheKnownOne) {
  const auto expect = [](const std::string& attribute, const std::string& meant) {
    const std::string servo = "<servo joint=\"elbow\" mode=\"position\" kp=\"1\" " + attribute + "=\"1\"/>";
    std::string text = good_scene_with("<!-- 2 -->", servo);
    const std::string found = findings_of(text);
    EXPECT_NE(found.find("did you mean '" + meant + "'?, got '" + attribute + "'"), std::string::npos) << found;
  };
  expect("p", "kp");
  expect("Kd", "kd");
  expect("setpoint", "set_point");
  expect_error(R"(<orientation y="0 2 0"/>)", R"(<orientation y="0 2 0" z="1 0 0"/>)", 33,
               "unknown attribute, expected y, got 'z'");
  expect_error(R"(<line to="1 0 0" twist="0.5"/>)", R"(<lines to="1 0 0" twist="0.5"/> <line to="1 0 0"/>)", 30,
               "unknown element, expected line, arc; did you mean 'line'?");
}

}  // namespace flexarm::scene
