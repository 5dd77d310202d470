// Tests that states and checkpoints of another scene, damaged ones and impossible ones are refused with the reason.
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <functional>
#include <limits>
#include <sstream>

#include "flexarm/simulation/checkpoint.h"
#include "model/state_numbers.h"
#include "simulation/everything_scene.h"
#include "simulation/fingerprint.h"
#include "simulation/same_bits.h"
#include "support/refusal.h"
#include "support/runs.h"

namespace flexarm::test {
namespace {

/// A change of the scene, and a text that the error message must contain.
struct Change {
  const char* name;
  std::string told;
  std::function<void(scene::SceneDescription&)> make;
};

class CheckpointOfAChangedScene : public ::testing::TestWithParam<Change> {};

TEST_P(CheckpointOfAChangedScene, IsRefusedAndSaysWhatDiffers) {
  const std::string path = ::testing::TempDir() + "flexarm_changed_scene_test.state";
  SceneBuilder original = everything_scene();
  original.scene.integrator.scheme = "hht2";
  Simulation simulation(original.scene);
  ASSERT_TRUE(simulation.step().converged);
  write_checkpoint(simulation, path);
  scene::SceneDescription changed = original.scene;
  GetParam().make(changed);
  Simulation other(changed);
  const std::string message = refusal<std::runtime_error>([&] { read_checkpoint(other, path); });
  expect_contains(message, path);
  expect_contains(message, GetParam().told);
  std::remove(path.c_str());
}

scene::DirectSection& section_of(scene::SceneDescription& scene) {
  return std::get<scene::DirectSection>(scene.links[1].beam->section);
}

const double kAUnit = 1 + std::numeric_limits<double>::epsilon();  // the smallest relative change of a number

void change_cam(scene::SceneDescription& scene) {
  for (scene::JointDescription& joint : scene.joints)
    if (joint.profile) joint.profile = std::make_shared<CamProfile>(CamProfile::eccentric(0.05, 0.01 * kAUnit));
}

INSTANTIATE_TEST_SUITE_P(
    Changes, CheckpointOfAChangedScene,
    ::testing::Values(
        Change{"elements", "link 'beam1' beam elements: expected '5', found ",
               [](auto& scene) { scene.links[1].beam->elements = 5; }},
        Change{"stiffness", "link 'beam1' beam section ei3: expected ",
               [](auto& scene) { section_of(scene).ei3 *= kAUnit; }},
        Change{"density", "link 'beam1' beam section mass: expected ",
               [](auto& scene) { section_of(scene).mass *= kAUnit; }},
        Change{"geometry", "link 'beam2'", [](auto& scene) { scene.links[2].beam->centreline[1].to.x() *= kAUnit; }},
        Change{"material_damping", "link 'beam3'",
               [](auto& scene) { scene.links[3].beam->mass_proportional_damping *= kAUnit; }},
        Change{"inertia", "link 'continuous_body'",
               [](auto& scene) { scene.links[5].inertial->inertia(1, 1) *= kAUnit; }},
        Change{"axis", "joint 'elbow'", [](auto& scene) { scene.joints[3].axis = Vector3(0, 0.6, 0.8); }},
        Change{"limit", "joint 'hinge' limits upper: expected ",
               [](auto& scene) { scene.joints[1].limits->upper *= kAUnit; }},
        Change{"friction_law", "joint 'elbow'", [](auto& scene) { scene.joints[3].friction_law.coefficient = 0.1; }},
        Change{"cam", "joint 'cam'", change_cam},
        Change{"loop", "loop_joint 'loop'", [](auto& scene) { scene.loop_joints[0].damping *= kAUnit; }},
        Change{"gravity", "gravity", [](auto& scene) { scene.gravity.z() *= kAUnit; }},
        Change{"initial", "initial", [](auto& scene) { scene.initial_joints[0].velocity *= kAUnit; }},
        Change{"load", "load", [](auto& scene) { scene.loads[0].force.x() *= kAUnit; }},
        Change{"history", "load", [](auto& scene) { scene.loads[0].history = TimeFunction::parse("cos(3*t)"); }},
        Change{"distributed_load", "distributed_load",
               [](auto& scene) { scene.distributed_loads[0].frame = scene::LoadFrame::World; }},
        Change{"motion", "motion",
               [](auto& scene) { scene.motions[0].position = TimeFunction::parse("0.05*sin(6*t)"); }},
        Change{"effort", "effort", [](auto& scene) { scene.efforts[0].history = TimeFunction::parse("0.5"); }},
        Change{"scheme", "scheme: expected 'hht1', found 'hht2'",
               [](auto& scene) { scene.integrator.scheme = "hht1"; }},
        Change{"step", "step: expected '0.004', found '0.002'", [](auto& scene) { scene.integrator.step *= 2; }},
        Change{"alpha", "alpha: expected '-0.1', found '-0.05'", [](auto& scene) { scene.integrator.alpha = -0.1; }}),
    [](const auto& info) { return info.param.name; });

// A checkpoint may be read with other probes, and with other limits of Newton's method: they do not change the motion.
TEST(CheckpointOfAChangedScene, IsReadWithOtherProbesAndLimits) {
  const std::string path = ::testing::TempDir() + "flexarm_other_limits_test.state";
  SceneBuilder b = everything_scene();
  Simulation simulation(b.scene);
  ASSERT_TRUE(simulation.step().converged);
  write_checkpoint(simulation, path);
  b.scene.probes.clear();
  b.scene.file = "elsewhere.urdf";
  b.scene.joints[0].location = {"elsewhere.urdf", 17};
  b.scene.integrator.scheme = "auto";  // em by its other name
  b.scene.integrator.tolerance = 1e-6;
  b.scene.integrator.max_iterations = 50;
  b.scene.integrator.max_halvings = 10;
  Simulation other(b.scene);
  read_checkpoint(other, path);
  EXPECT_TRUE(same_bits(state_of(other), state_of(simulation)));
  std::remove(path.c_str());
}

// Each change makes a state that the simulator could not have reached; it is detected.
TEST(RestoredState, WithImpossibleValuesIsRefused) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  Simulation simulation(everything_scene().scene, options("hht2"));
  for (int n = 0; n < 3; ++n) ASSERT_TRUE(simulation.step().converged);
  const std::pair<const char*, std::function<void(State&)>> changes[] = {
      {"the time is nan", [](State& s) { s.time = kNan; }},
      {"position is inf", [](State& s) { s.nodes[4].position.y() = std::numeric_limits<double>::infinity(); }},
      {"angular velocity is nan", [](State& s) { s.nodes[4].angular_velocity.y() = kNan; }},
      {"an effort is nan", [](State& s) { s.efforts[1] = kNan; }},
      {"an increment is nan", [](State& s) { s.history.increments[1][2] = kNan; }},
      {"a reaction is nan", [](State& s) { s.study.reactions[3][2] = kNan; }},
      {"norm of a node's orientation is 1.1", [](State& s) { s.nodes[4].orientation.coeffs() *= 1.1; }},
      {"norm of a joint's rotation is 0", [](State& s) { s.released[2].rotation.coeffs().setZero(); }},
      {"a mark of rest is 0.5", [](State& s) { s.rests[2] = 0.5; }},
      {"halving level is 41, expected 0 to 40", [](State& s) { s.halving_level = 41; }},
      {"halving level is -1, expected 0 to 40", [](State& s) { s.halving_level = -1; }},
      {"good steps is -1", [](State& s) { s.good_steps = -1; }},
      {"number of steps is -1", [](State& s) { s.steps = -1; }},
      {"past increments is 6, expected 0 to 5", [](State& s) { s.history.count = 6; }},
      {"order of extrapolation is 3, expected -1 to 2", [](State& s) { s.history.order = 3; }},
      {"length of a past step is 0", [](State& s) { s.history.steps[0] = 0; }},
      {"left its line is 2, expected one that may", [](State& s) { s.left_lines = {2}; }},
      {"left its line is 1000, expected one that may", [](State& s) { s.left_lines = {1000}; }},
      {"number of nodes", [](State& s) { s.nodes.pop_back(); }},
      {"number of mass points", [](State& s) { s.study.mass_points.pop_back(); }},
      {"number of strain rates", [](State& s) { s.study.strain_rates.clear(); }},
      {"number of nodal forces", [](State& s) { s.study.forces.clear(); }},
      {"number of reactions", [](State& s) { s.study.reactions.pop_back(); }},
  };
  for (const auto& [told, change] : changes) {
    const State before = state_of(simulation);
    State state = before;
    change(state);
    expect_contains(refusal<std::invalid_argument>([&] { restore(simulation, state); }), told);
    EXPECT_TRUE(same_bits(state_of(simulation), before)) << told;
  }
}

class DamagedCheckpoint : public ::testing::Test {
 protected:
  void SetUp() override {
    SceneBuilder b;
    b.beam("arm", {{1, 0, 0}}, section(1e4, 5e3, 20, 20, 1, 0.02, 0.01), 1, 1);
    b.joint("hinge", scene::JointKind::Revolute, "world", "arm", {0, 0, 0}, {0, 0, 1});
    simulation_.emplace(b.scene);
    simulation_->command_effort(0, 1);
    for (int n = 0; n < 5; ++n) ASSERT_TRUE(simulation_->step().converged);
    write_checkpoint(*simulation_, path_);
    std::ifstream in(path_, std::ios::binary);
    std::stringstream buffer;
    buffer << in.rdbuf();
    text_ = buffer.str();
    ASSERT_GT(text_.size(), 100u);
  }
  void TearDown() override { std::remove(path_.c_str()); }

  /// Appends the checksum that belongs to the text.
  static std::string sealed(const std::string& text) {
    Fingerprint fingerprint;
    fingerprint.add(text);
    return text + "checksum " + fingerprint.text() + "\n";
  }

  /// Expects that reading `text` fails with an error that names the file and contains `told`, and leaves the simulation
  /// unchanged.
  void expect_refused(const std::string& text, const std::string& what, const std::string& told = "") {
    std::ofstream(path_, std::ios::binary) << text;
    const State before = state_of(*simulation_);
    const std::string message = refusal<std::runtime_error>([&] { read_checkpoint(*simulation_, path_); });
    expect_contains(message, path_);
    expect_contains(message, told);
    EXPECT_TRUE(same_bits(state_of(*simulation_), before)) << what;
  }

  /// The text of an older format, whose states have four past steps.
  std::string without_oldest_step(const std::string& text) const {
    std::vector<bool> is_of_oldest;
    std::size_t increments = 0, lengths = 0;
    const State& state = state_of(*simulation_);
    const std::size_t unknowns = state.history.increments[0].size(), kept = IncrementHistory::kLength - 1;
    for_each_number(state, [&](const std::string& what, double) {
      const bool is_increment = what == "an increment", is_length = what == "the length of a past step";
      is_of_oldest.push_back((is_increment && increments >= kept * unknowns) || (is_length && lengths >= kept));
      increments += is_increment, lengths += is_length;
    });
    std::istringstream lines(text);
    std::string out;
    std::size_t number = 0;
    bool are_numbers = false;
    for (std::string line; std::getline(lines, line);) {
      const bool is_left_out = are_numbers && number < is_of_oldest.size() && is_of_oldest[number];
      number += are_numbers;
      are_numbers = are_numbers || line.rfind("steps ", 0) == 0;
      if (!is_left_out) out += line + "\n";
    }
    return out;
  }

  const std::string path_ = ::testing::TempDir() + "flexarm_damaged_checkpoint_test.state";
  std::optional<Simulation> simulation_;
  std::string text_;
};

TEST_F(DamagedCheckpoint, IsRefused) {
  expect_refused("", "empty file");
  expect_refused("not a checkpoint\n" + text_, "wrong header");
  for (const double part : {0.2, 0.5, 0.9}) expect_refused(text_.substr(0, std::size_t(part * text_.size())), "cut");
  expect_refused(text_.substr(0, text_.size() - 1), "without its end");
  expect_refused(text_ + "\n", "with something behind its end");
}

TEST_F(DamagedCheckpoint, AnyFlippedBitIsRefused) {
  for (std::size_t i = 0; i < text_.size(); ++i) {
    std::string flipped = text_;
    flipped[i] ^= static_cast<char>(1 << i % 8);
    expect_refused(flipped, "byte " + std::to_string(i));
  }
}

// Files whose checksum is right, but whose content is wrong.
TEST_F(DamagedCheckpoint, WrongContentIsRefused) {
  const std::size_t counts = text_.find("\nsteps ") + 1, numbers = text_.find('\n', counts) + 1;
  const std::size_t second = text_.find('\n', numbers) + 1, end = text_.rfind("checksum ");
  const std::string head = text_.substr(0, counts), line = text_.substr(counts, numbers - counts);
  const std::string rest = text_.substr(numbers, end - numbers), others = text_.substr(second, end - second);
  const std::string good = "steps 5 level 0 good 5 increments 7";
  ASSERT_EQ(line.rfind(good, 0), 0u) << line;
  const auto line_of = [&](std::size_t place) {
    return "line " + std::to_string(1 + std::count(text_.begin(), text_.begin() + place, '\n')) + " is '";
  };
  const std::pair<std::string, std::string> wrong_counts[] = {
      {"steps 5 level 0 good 5 increments 99999999999", line_of(counts)},
      {"steps 5 level 0 good 5 increments -1", line_of(counts)},
      {"steps five level 0 good 5 increments 7", line_of(counts)},
      {"steps 5 level 0 good 5 increments 8", "expected the work"},
      {"steps -5 level 0 good 5 increments 7", "the number of steps is -5, expected 0 or more"},
      {"steps 5 level 41 good 5 increments 7", "the halving level is 41, expected 0 to 40"}};
  for (const auto& [wrong, told] : wrong_counts)
    expect_refused(sealed(head + wrong + line.substr(good.size()) + rest), wrong, told);
  for (const std::string time : {"nan", "inf", "xyz", "1p+2x", ""})
    expect_refused(sealed(head + line + time + "\n" + others), time,
                   line_of(numbers) + time + "', expected the time as a finite hexadecimal number");
  expect_refused(sealed(head + line + others), "a number is missing", "expected ");
  expect_refused(sealed(head + line + rest + "0p+0\n"), "a number too many", "expected the checksum");
  const std::size_t values = rest.find("values ");
  expect_refused(sealed(head + line + rest.substr(0, values) + "0p+0\n" + rest.substr(values)), "a number too many",
                 "expected the number of the scene's values");
  const std::size_t first_line = text_.find('\n');
  expect_refused(sealed("flexarm-checkpoint 8" + text_.substr(first_line, end - first_line)), "format",
                 "expected '" + text_.substr(0, first_line) + "'");
}

// Checkpoints of an older format do not contain the values of their scene.
TEST_F(DamagedCheckpoint, StatesWithoutValuesAreRead) {
  const std::string four_steps = without_oldest_step(text_);
  const std::size_t first_line = four_steps.find('\n'), values = four_steps.find("\nvalues ") + 1;
  const std::string old = "flexarm-checkpoint 13" + four_steps.substr(first_line, values - first_line);
  read_checkpoint_text(*simulation_, sealed(old), "text");
  const std::size_t arm = old.find("link 'arm' ");
  std::string other = old;
  other[arm + 12] ^= 1;
  expect_refused(sealed(other), "another scene", "': it belongs to another scene, scheme or step");
}

// Checkpoints of an older format do not say on which links wrenches act.
TEST_F(DamagedCheckpoint, LinksOfWrenches) {
  AppliedWrench wrench;
  wrench.link = 1;
  wrench.wrench.force = {5, -3, 0};
  simulation_->apply_wrenches({wrench});
  text_ = checkpoint_text(*simulation_);
  const std::string own = " on 1\n";
  const std::size_t place = text_.find(own), end = text_.rfind("checksum ");
  ASSERT_NE(place, std::string::npos);
  const auto with = [&](const std::string& links) {
    return sealed(text_.substr(0, place) + links + text_.substr(place + own.size(), end - place - own.size()));
  };
  expect_refused(with(" on 2\n"), "no such link", "the link of a wrench is 2, expected -1 to 1");
  expect_refused(with(" on\n"), "no link");
  expect_refused(with(" at 1\n"), "another word");
  read_checkpoint_text(*simulation_, with("\n"), "text");
  ASSERT_EQ(state_of(*simulation_).wrenches.size(), 1u);
  EXPECT_EQ(state_of(*simulation_).wrenches[0].link, -1);
  EXPECT_EQ(state_of(*simulation_).wrenches[0].force, wrench.wrench.force);
}

// Each number is finite and possible by itself, but the energies overflow.
TEST_F(DamagedCheckpoint, EnergiesThatAreNotFiniteAreRefused) {
  const std::size_t counts = text_.find("\nsteps ") + 1, end = text_.rfind("checksum ");
  // The line of the first node's velocity, after time, origin and pose
  std::size_t velocity = text_.find('\n', counts) + 1;
  for (int line = 0; line < 1 + 3 + 3 + 4; ++line) velocity = text_.find('\n', velocity) + 1;
  const std::size_t next = text_.find('\n', velocity);
  expect_refused(sealed(text_.substr(0, velocity) + "1p+600" + text_.substr(next, end - next)), "fast node",
                 "its energies are not finite");
}

TEST_F(DamagedCheckpoint, MissingFileAndUnwritablePlaceAreNamed) {
  EXPECT_THROW(read_checkpoint(*simulation_, "/nonexistent/state"), std::runtime_error);
  EXPECT_THROW(write_checkpoint(*simulation_, "/nonexistent/state"), std::runtime_error);
}

}  // namespace
}  // namespace flexarm::test
