// Tests the thesis's algorithms for sliders: which conditions and quantities each of them keeps, on a slider in free
// flight and in the example 12.2.
#include <cstdio>

#include "building/model_builder.h"
#include "joints/joint_kinematics.h"
#include "reference/slide_scenes.h"
#include "simulation/inside.h"
#include "support/refusal.h"

namespace flexarm::test {
namespace {

using scene::JointKind;

/// The integration scheme to which a slide scheme belongs.
std::string owner(const std::string& slide) {
  return slide == "sme" ? "std" : slide == "alg2" ? "m2" : "m1";
}

Simulation runner(const std::string& slide, JointKind rotation, double step, bool smooth = false) {
  SceneBuilder b = runner_on_a_free_beam(rotation);
  for (scene::JointDescription& joint : b.scene.joints)
    if (joint.slide) joint.slide->scheme = slide, joint.slide->smooth = smooth;
  return Simulation(b.scene, options(owner(slide), step, 1e-11));
}

/// The configuration of a slider before and after a step.
struct Contact {
  explicit Contact(const Simulation& simulation) : simulation_(simulation) {
    const Model& model = model_of(simulation);
    for (joint_ = 0; model.joints[joint_].kind != JointMapKind::Slide;) ++joint_;
    observe();
  }
  /// Makes the configuration after the last step the one before the next step.
  void observe() {
    before_ = poses_;
    slave_before_ = slave_;
    from_ = to_;
    const State& state = state_of(simulation_);
    poses_.clear();
    for (const NodeState& node : state.nodes) poses_.push_back(node_pose(node));
    slave_ = poses_[model_of(simulation_).joints[joint_].slave].position;
    to_ = state.released[joint_].displacement[0];
  }
  const SlideLine& line() const { return model_of(simulation_).slide_lines[model_of(simulation_).joints[joint_].line]; }
  bool crossed() const { return line().piece_at(from_) != line().piece_at(to_); }
  /// Distance of the slave from the line at the end of the step [m].
  double at_end() const { return (slave_ - slide_pose(line(), poses_, to_).position).norm(); }
  /// Distance in the middle of the step, with the mean weights of both ends, or with the weights of the end.
  double in_middle(bool weights_of_end) const {
    const auto place = [&](double x) {
      return Vector3(0.5 * (slide_pose(line(), before_, x).position + slide_pose(line(), poses_, x).position));
    };
    const Vector3 middle = weights_of_end ? place(to_) : Vector3(0.5 * (place(from_) + place(to_)));
    return (0.5 * (slave_before_ + slave_) - middle).norm();
  }

 private:
  const Simulation& simulation_;
  std::size_t joint_ = 0;
  std::vector<NodePose> before_, poses_;
  Vector3 slave_before_, slave_;
  double from_ = 0, to_ = 0;
};

class SlideSchemes : public ::testing::TestWithParam<JointKind> {};
INSTANTIATE_TEST_SUITE_P(Rotations, SlideSchemes,
                         ::testing::Values(JointKind::Fixed, JointKind::Revolute, JointKind::Spherical));

// joints.md 4.4, last column but one: the contact condition, at the instant at which the algorithm claims it.
TEST_P(SlideSchemes, HoldTheirContactConditions) {
  for (const char* slide : {"alg1", "alg2", "alg3", "alg4", "sme"})
    for (const bool smooth : {false, true}) {
      Simulation simulation = runner(slide, GetParam(), 0.005, smooth);
      Contact contact(simulation);
      const std::string name = slide;
      int crossings = 0;
      for (int i = 0; i < 120; ++i) {
        const int level = state_of(simulation).halving_level;
        const StepResult result = simulation.step();
        if (!result.converged && name == "alg4") break;  // as in the thesis, its transitions excite the line
        ASSERT_TRUE(result.converged) << slide;
        contact.observe();
        if (result.halvings > 0 || level > 0) continue;  // the step consists of several sub-steps
        const bool crossed = contact.crossed();
        crossings += crossed;
        const bool in_middle = name == "alg4" || (name == "alg1" && !crossed);
        EXPECT_LE(in_middle ? contact.in_middle(crossed) : contact.at_end(), 1e-14) << slide << " " << i;
      }
      EXPECT_GE(crossings, 1) << slide;
    }
}

/// Largest change of momentum and angular momentum within the steps that the filter accepts.
template <class Filter>
Vector3 momentum_jumps(Simulation& simulation, int steps, const Filter& filter) {
  Contact contact(simulation);
  const Vector3 linear = simulation.momentum();
  Vector3 out = Vector3::Zero(), angular = simulation.angular_momentum();
  for (int i = 0; i < steps; ++i) {
    if (!simulation.step().converged) break;
    contact.observe();
    const Vector3 now = simulation.angular_momentum();
    out[0] = std::max(out[0], (simulation.momentum() - linear).norm());
    if (filter(contact)) out[1] = std::max(out[1], (now - angular).norm());
    out[2] += filter(contact);
    angular = now;
  }
  return out;
}

TEST_P(SlideSchemes, KeepMomenta) {
  const auto within = [](const Contact& contact) { return !contact.crossed(); };
  const auto always = [](const Contact&) { return true; };
  for (const bool smooth : {false, true}) {
    const auto check = [&](const char* slide, const auto& filter, int least) {
      Simulation simulation = runner(slide, GetParam(), 0.01, smooth);
      const Vector3 jumps = momentum_jumps(simulation, 60, filter);
      std::printf("%s%s: momentum %.1e, angular momentum %.1e in %.0f steps\n", slide, smooth ? " smooth" : "",
                  jumps[0], jumps[1], jumps[2]);
      EXPECT_LE(jumps[0], 1e-11) << slide;
      EXPECT_LE(jumps[1], 1e-11) << slide;
      EXPECT_GE(jumps[2], least) << slide;
    };
    check("alg1", within, 40);
    check("alg2", within, 40);
    check("alg4", always, 20);
    check("sm_em", always, 60);
    check("sme", always, 60);
  }
}

// The loss e x g_f of the table is of third order in each step.
TEST_P(SlideSchemes, Alg3LosesAngularMomentumInThirdOrder) {
  // Starts until the line is bent, far from the borders of its elements
  Simulation start = runner("alg3", GetParam(), 2e-3);
  run(start, 20);
  const auto jump = [&](double step) {
    Simulation simulation = runner("alg3", GetParam(), step);
    restore(simulation, state_of(start));
    const Vector3 before = simulation.angular_momentum();
    EXPECT_TRUE(simulation.step().converged);
    return (simulation.angular_momentum() - before).norm();
  };
  const double coarse = jump(4e-3), fine = jump(2e-3);
  EXPECT_GT(fine, 1e-9) << "far above round-off";
  EXPECT_NEAR(std::log2(coarse / fine), 3, 0.15);
}

TEST(SlideScheme, EnergyOfSmeIsExact) {
  for (const JointKind rotation : {JointKind::Fixed, JointKind::Spherical}) {
    Simulation simulation = runner("sme", rotation, 0.01);
    InvariantDrift drift(simulation);
    run(simulation, 200, [&] { drift.observe(); });
    EXPECT_LT(drift.energy(), 1e-11);
    EXPECT_LT(drift.angular_momentum(), 1e-11);
  }
}

// ---------------------------------------------------------------- smooth lines

/// A bead on a clamped cable that sags under its weight. The bead slides to the lowest point.
SceneBuilder cable(bool smooth, int elements) {
  SceneBuilder b;
  b.beam("line", {{2, 0, 0}}, soft_section(), elements, 2);
  b.body("bead", 3, Vector3::Zero(), 1e-2 * Matrix3::Identity());
  b.joint("clamp", JointKind::Fixed, "world", "line", Vector3::Zero());
  add_slide(b, "run", "line", "bead", 1.13, JointKind::Fixed).damping = 2;
  b.scene.joints.back().slide->smooth = smooth;
  b.scene.gravity = {0, 0, -5};
  return b;
}

// Statics of a bead that is held at a border of elements. There, plain and smooth lines are identical, and so are their
// deflections. Elsewhere they differ by the elements' error.
TEST(SmoothLine, StaticsAgreesWithTheElementsAtNodes) {
  const auto deflection = [](bool smooth, double place) {
    SceneBuilder b = cable(smooth, 4);
    b.scene.motions.push_back({"run", TimeFunction(place), {}});
    Simulation simulation(b.scene, options("em", 0.01, 1e-12));
    EXPECT_TRUE(simulation.solve_static(2).converged);
    return simulation.link_pose(2).position;
  };
  EXPECT_LE((deflection(true, 1.0) - deflection(false, 1.0)).norm(), 1e-10);
  const double difference = (deflection(true, 1.13) - deflection(false, 1.13)).norm();
  EXPECT_GT(difference, 1e-9);
  EXPECT_LT(difference, 1e-2);
}

// A smoothly growing load moves the bead over a border of the line. Both schemes converge with second order to the same
// path.
TEST(SmoothLine, NewmarkAndM1ConvergeToOnePath) {
  const auto place = [](const char* scheme, double step) {
    SceneBuilder b = cable(true, 4);
    b.scene.gravity.setZero();
    b.load("bead", Vector3::Zero(), {-40, 0, -10}, Vector3::Zero(), "1-cos(2*t)");
    Simulation simulation(b.scene, options(scheme, step, 1e-12));
    run(simulation, static_cast<int>(std::lround(0.8 / step)));
    EXPECT_LT(simulation.position(0), 0.99);
    return simulation.position(0);
  };
  double fine[2];
  for (const bool is_newmark : {false, true}) {
    const char* scheme = is_newmark ? "newmark" : "m1";
    const double a = place(scheme, 8e-3), b = place(scheme, 4e-3), c = place(scheme, 2e-3);
    std::printf("%s: %.3e %.3e\n", scheme, a - b, b - c);
    EXPECT_NEAR(std::log2(std::abs((a - b) / (b - c))), 2, 0.3);
    fine[is_newmark] = c + (c - b) / 3;
  }
  EXPECT_NEAR(fine[0], fine[1], 1e-6);
}

// ---------------------------------------------------------------- the thesis's example 12.2

struct Flight {
  double energy = 0, angular = 0;  ///< largest |E/E_0 - 1| and |L - L_0|
  double arrival = 0;              ///< time at which the slider reached the end; 0: not reached
  double end = 0;                  ///< time of the last converged step [s]
  double transitions[3] = {};      ///< first arrival in the third, second, and first element
  int halvings = 0;
  double energy_before = 0;  ///< largest before the first transition
};

Flight thesis_run(const std::string& slide, const std::string& scheme, double step, bool smooth, double until) {
  scene::SlideDescription description;
  description.scheme = slide;
  description.smooth = smooth;
  Simulation simulation = thesis_free_sliding_mass(scheme, step, description);
  const std::size_t s = *simulation.find_coordinate("run/s");
  const double energy = simulation.energies().total();
  const Vector3 angular = simulation.angular_momentum();
  Flight out;
  while (simulation.time() < until - 1e-9) {
    const StepResult result = simulation.step();
    if (!result.converged) break;
    out.halvings += result.halvings;
    const double x = simulation.position(s) / kThesisLineLength;
    for (int i = 0; i < 3; ++i)
      if (out.transitions[i] == 0 && x < 0.75 - 0.25 * i) out.transitions[i] = simulation.time();
    out.end = simulation.time();
    if (x <= 0) {
      out.arrival = simulation.time();
      break;
    }
    out.energy = std::max(out.energy, std::abs(simulation.energies().total() / energy - 1));
    out.angular = std::max(out.angular, (simulation.angular_momentum() - angular).norm());
    if (out.transitions[0] == 0) out.energy_before = out.energy;
  }
  std::printf("%s/%s%s, h = %g: to %.3f, arrival %.3f, transitions %.3f %.3f %.3f, |E| %.1e, |L| %.1e, %d halvings\n",
              scheme.c_str(), slide.c_str(), smooth ? " smooth" : "", step, out.end, out.arrival, out.transitions[0],
              out.transitions[1], out.transitions[2], out.energy, out.angular, out.halvings);
  return out;
}

// The expected figures come from an independent program. Times must agree to within a step, and errors to within a
// factor of two.
TEST(SlideScheme, ThesisAlg3ArrivesOnTheLine) {
  const Flight flight = thesis_run("alg3", "m1", 0.004, false, 0.5);
  EXPECT_NEAR(flight.arrival, 0.432, 0.004);
  EXPECT_EQ(flight.halvings, 0);
  EXPECT_NEAR(flight.transitions[0], 0.092, 0.004);
  EXPECT_NEAR(flight.transitions[1], 0.160, 0.004);
  EXPECT_NEAR(flight.transitions[2], 0.256, 0.004);
  EXPECT_NEAR(std::log2(flight.energy / 1.6e-5), 0, 1);
  EXPECT_NEAR(std::log2(flight.angular / 2.6e-3), 0, 1);
}

TEST(SlideScheme, ThesisAlg4BlowsUpAfterItsFirstTransition) {
  const Flight flight = thesis_run("alg4", "m1", 0.002, false, 0.5);
  EXPECT_NEAR(flight.transitions[0], 0.090, 0.002);
  EXPECT_LT(flight.energy_before, 1e-5);
  EXPECT_GT(flight.energy, 1);
  EXPECT_LT(flight.angular, 1e-11);
  EXPECT_GE(flight.end, 0.150);
  EXPECT_LE(flight.end, 0.162) << "the thesis: fails at 0.1597, here in the notes: 0.156";
  EXPECT_EQ(flight.arrival, 0);
}

TEST(SlideScheme, ThesisAlg2DissipatesAndArrives) {
  const Flight flight = thesis_run("alg2", "m2", 0.004, false, 0.5);
  EXPECT_GT(flight.arrival, 0.42);
  EXPECT_GT(flight.energy, 1e-2);
  EXPECT_LT(flight.energy, 5e-2);
}

// At its transitions, it changes from mid-point to end-point contact. The slave's distance from the line then jumps.
TEST(SlideScheme, ThesisAlg1PassesTransitionsWithJumps) {
  const Flight flight = thesis_run("alg1", "m1", 0.002, false, 0.24);
  EXPECT_NEAR(flight.transitions[1], 0.158, 0.002);
  EXPECT_GT(flight.energy, 1e-4);
  EXPECT_GT(flight.angular, 1e-5);
}

TEST(SlideScheme, ThesisSmoothLine) {
  const Flight flight = thesis_run("sm_em", "em", 0.004, true, 0.5);
  EXPECT_GT(flight.arrival, 0.41);
  EXPECT_LT(flight.energy, 1e-12);
  EXPECT_LT(flight.angular, 1e-11);
}

// ---------------------------------------------------------------- combinations of schemes

TEST(SlideScheme, BelongsToAnIntegrationScheme) {
  SceneBuilder b = runner_on_a_free_beam(JointKind::Fixed);
  for (scene::JointDescription& joint : b.scene.joints)
    if (joint.slide) joint.slide->scheme = "alg1", joint.slide->location = {"arm.urdf", 17};
  const std::string refused = refusal_of(b.scene, options("em", 0.01));
  expect_contains(refused, "arm.urdf:17");
  expect_contains(refused, "slide scheme 'alg1' belongs to integrator scheme 'm1', not to 'em'");
  EXPECT_NO_THROW(Simulation(b.scene, options("m1", 0.01)));
  // The Newmark family has its own form: the option has no effect.
  Simulation plain(runner_on_a_free_beam(JointKind::Fixed).scene, options("newmark", 0.01)),
      same(b.scene, options("newmark", 0.01));
  run(plain, 5);
  run(same, 5);
  EXPECT_EQ(plain.position(0), same.position(0));
}

}  // namespace
}  // namespace flexarm::test
