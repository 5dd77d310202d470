/// Tests runs to an accuracy over jumps, stops, friction and play, against closed forms and independent programs.
#include <algorithm>
#include <array>
#include <cmath>

#include "flexarm/accuracy/accurate_run.h"
#include "support/runs.h"
#include "support/scene_builder.h"
#include "support/scene_text.h"

namespace flexarm::test {
namespace {

/// A link of 1 kg on a hinge about `axis`, with its centre of mass at `centre` and `moment` of inertia about it.
scene::SceneDescription hinge(const std::string& axis, const Vector3& centre, double moment,
                              const std::string& of_joint, const std::string& others, const std::string& entries) {
  const char* const type = of_joint.find("limit") == std::string::npos ? "continuous" : "revolute";
  return scene_of(robot(body("a", 1, Vector3::Constant(moment), centre) +
                            joint("h", type, "world", "a", "<axis xyz='" + axis + "'/>" + of_joint) + others,
                        entries));
}

/// The true error of a run, at every tenth of its time, and the run's own estimate.
struct Outcome {
  double error, estimate;
  long steps;  ///< of all tries
};
/// `truth`: positions at multiples of `until` / 10.
Outcome outcome(const scene::SceneDescription& scene, double until, double accuracy, const Trajectory& truth) {
  Simulation simulation(scene);
  RunWatcher nobody;
  const AccurateRun run = run_to_accuracy(simulation, {accuracy, until}, nobody);
  EXPECT_EQ(run.end, AccurateRun::End::Met) << to_string(run.end) << ", " << accuracy;
  EXPECT_NEAR(simulation.time(), until, 1e-12);
  Trajectory tenths;
  for (std::size_t i = 0; i <= 100; i += 10) tenths.push_back(run.motion.points[0][i]);
  return {trajectory_distance(tenths, truth) / run.scale, run.estimate(), run.steps};
}

/// A constant torque rotates a body. Between jumps, equal steps are exact, and so is the run.
TEST(Corners, JumpsOfLoadsAreEndsOfSteps) {
  for (const double jump : {0.3125, 1 / M_PI, std::sqrt(0.5)}) {
    const std::string time = std::to_string(jump);
    const double at = std::stod(time);
    const scene::SceneDescription scene = hinge("0 0 1", {0, 0, 0}, 1, "", "",
                                                "<gravity xyz='0 0 0'/><effort joint='h' history='t &lt; " + time +
                                                    " ? 3 : -3'/><probe name='p' link='a' at='1 0 0'/>");
    Trajectory truth;
    for (int i = 0; i <= 10; ++i) {
      const double t = 0.1 * i, behind = std::max(t - at, 0.0), angle = 1.5 * t * t - 3 * behind * behind;
      truth.emplace_back(std::cos(angle), std::sin(angle), 0);
    }
    for (const double accuracy : {1e-3, 1e-5}) {
      const Outcome run = outcome(scene, 1, accuracy, truth);
      // A hinge turns by 2 atan(h w / 2) in a step, an error of third order. Only this error remains.
      EXPECT_LE(run.error, accuracy) << jump;
      EXPECT_LE(run.steps, 1000) << "three tries of one to three steps in an interval";
    }
  }
}

/// Where a set point jumps by J, the derivative of a servo strikes the block with kd J. Then m e'' + kd e' + kp e = 0.
TEST(Corners, StrikesOfServosTakeNoTime) {
  const double mass = 2, kp = 250, kd = 20, jump = 0.3;
  const double decay = kd / (2 * mass), rate = std::sqrt(kp / mass - decay * decay);
  for (const char* at : {"0.5", "0.3137"}) {  // one is the end of an interval
    const std::string parts = body("a", 2) + rail("rail", "a", "1 0 0") +
                              "<servo joint='rail' mode='position' kp='250' kd='20' set_point='t &lt; " + at +
                              " ? 0 : 0.3'/>";
    Trajectory truth;
    for (int i = 0; i <= 10; ++i) {
      const double t = std::max(0.1 * i - std::stod(at), 0.0);
      const double left = std::exp(-decay * t) * (std::cos(rate * t) - decay / rate * std::sin(rate * t));
      truth.emplace_back(0.1 * i < std::stod(at) ? 0 : jump * (1 - left), 0, 0);
    }
    for (const char* scheme : {"auto", "em", "em4"}) {
      scene::SceneDescription scene = scene_of(robot(parts, gravity({0, 0, 0})));
      scene.integrator.scheme = scheme;
      for (const double accuracy : {1e-3, 1e-6}) {
        const Outcome run = outcome(scene, 1, accuracy, truth);
        EXPECT_LE(run.error, accuracy) << scheme << " " << at;
        EXPECT_LE(run.estimate, accuracy);
        // A smooth motion at this rate needs 4000 steps of em for 1e-6. At first order there would be 3 million.
        EXPECT_LE(run.steps, 20000) << scheme << " " << at;
      }
    }
  }
}

/// Closed form of a block that friction brings to rest within a step.
TEST(Corners, StopsByFrictionAreFound) {
  SceneBuilder b;
  b.body("block", 2, Vector3::Zero(), Matrix3::Identity());
  scene::JointDescription& rail =
      b.joint("rail", scene::JointKind::Prismatic, "world", "block", Vector3::Zero(), Vector3::UnitX());
  rail.friction = 4;
  rail.friction_law.law = scene::FrictionDescription::Law::Coulomb;
  b.scene.initial_joints.push_back({"rail", 0, 1.313, {}});
  b.probe("block", "block", {0, 0, 0});
  Trajectory truth;
  for (int i = 0; i <= 10; ++i) {
    const double t = std::min(0.1 * i, 1.313 / 2);  // deceleration 2 m/s^2, until 0.6565 s
    truth.emplace_back(1.313 * t - t * t, 0, 0);
  }
  // Between events, steps of the midpoint rule are exact. If the block stops in the first thousandth of a step, it is
  // at rest at the end of the step, after half of the distance of the initial rate: at most a h^2 / 2000 too far.
  EXPECT_LE(outcome(b.scene, 1, 1e-3, truth).error * truth.back().x(), 2.0 / 2000 * 0.01 * 0.01);
}

/// A body of inertia 1 and a servo that moves it to the angle 1, with efforts that are cut at `limit`. The solution is
/// in closed form between the instants at which the demand reaches or leaves the limit; bisection finds these.
class CutServo {
 public:
  static constexpr double proportional = 100, derivative = 2, limit = 10;
  double angle = 0;

  void advance(double time) {
    constexpr int kParts = 1000;  // so short that the limit is crossed at most once in each
    for (int i = 0; i < kParts; ++i) {
      double rest = time / kParts;
      CutServo end = after(rest);
      if (end.side() != side_) {
        double low = 0, high = rest;
        while (high - low > 1e-16) {
          const double middle = 0.5 * (low + high);
          (after(middle).side() == side_ ? low : high) = middle;
        }
        *this = after(high);
        side_ = end.side();
        rest -= high;
        end = after(rest);
      }
      *this = end;
    }
  }

 private:
  int side() const {
    const double asked = proportional * (1 - angle) - derivative * rate_;
    return asked > limit ? 1 : asked < -limit ? -1 : 0;
  }
  CutServo after(double t) const {
    CutServo out = *this;
    if (side_ != 0) {
      out.angle += t * (rate_ + 0.5 * t * side_ * limit);
      out.rate_ += t * side_ * limit;
      return out;
    }
    const double decay = derivative / 2, frequency = std::sqrt(proportional - decay * decay), error = angle - 1;
    const double c = std::cos(frequency * t), s = std::sin(frequency * t), sine = (rate_ + decay * error) / frequency;
    const double part = std::exp(-decay * t);
    out.angle = 1 + part * (error * c + sine * s);
    out.rate_ = part * ((sine * frequency - decay * error) * c - (error * frequency + decay * sine) * s);
    return out;
  }

  double rate_ = 0;
  int side_ = 1;
};

TEST(Corners, LimitsOfMotorsAreFound) {
  const scene::SceneDescription scene = hinge(
      "0 0 1", {0, 0, 0}, 1, "", "<servo joint='h' mode='position' kp='100' kd='2' set_point='1' effort_limit='10'/>",
      "<gravity xyz='0 0 0'/><probe name='p' link='a' at='1 0 0'/>");
  Trajectory truth;
  CutServo servo;
  for (int i = 0; i <= 10; ++i) {
    truth.emplace_back(std::cos(servo.angle), std::sin(servo.angle), 0);
    servo.advance(0.2);
  }
  for (const double accuracy : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
    const Outcome run = outcome(scene, 2, accuracy, truth);
    EXPECT_LE(run.error, accuracy) << "said " << run.estimate;
  }
}

struct Case {
  std::string name;
  scene::SceneDescription scene;
  double until;
  std::vector<double> accuracies;
  Trajectory truth;
};

/// Positions at multiples of `until` / 10 by scipy: scripts/outside_references, DOP853 with 1e-12 and located events.
std::vector<Case> cases() {
  const std::string down = gravity({0, 0, -9.81}), weightless = gravity({0, 0, 0});
  std::vector<Case> out;
  out.push_back({"a pendulum falls on its stop",
                 hinge("0 -1 0", {0.5, 0, 0}, 0.05, "<limit lower='-0.4' upper='1.6' effort='0' velocity='0'/>", "",
                       down + "<initial joint='h' position='1'/><probe name='tip' link='a' at='1 0 0'/>"),
                 3,
                 {1e-3, 1e-4, 1e-5},
                 {{0.540302306, 0, 0.841470985},
                  {0.845992745, 0, 0.533194407},
                  {0.955764062, 0, -0.294134422},
                  {0.921001559, 0, -0.389558889},
                  {0.921001569, 0, -0.389558866},
                  {0.921001569, 0, -0.389558866},
                  {0.921001569, 0, -0.389558866},
                  {0.921001569, 0, -0.389558866},
                  {0.921001569, 0, -0.389558866},
                  {0.921001569, 0, -0.389558866},
                  {0.921001569, 0, -0.389558866}}});
  out.push_back({"Coulomb friction, pushed to and fro",
                 hinge("0 -1 0", {0, 0, -0.5}, 0.05, "<dynamics friction='0.5'/><friction law='coulomb'/>", "",
                       down + "<initial joint='h' position='1.2'/><effort joint='h' history='1.5*sin(6*t)'/>"
                              "<probe name='tip' link='a' at='0 0 -1'/>"),
                 4,
                 {1e-3, 1e-4, 1e-5},
                 {{0.932039086, 0, -0.362357754},
                  {0.435272853, 0, -0.900298586},
                  {-0.629468379, 0, -0.777026100},
                  {-0.645018533, 0, -0.764166927},
                  {0.689815379, 0, -0.723985319},
                  {0.559304041, 0, -0.828962599},
                  {-0.653092504, 0, -0.757278140},
                  {-0.207687866, 0, -0.978195149},
                  {0.185848976, 0, -0.982578322},
                  {0.187809460, 0, -0.982205481},
                  {-0.025137446, 0, -0.999684004}}});
  out.push_back({"smooth friction, pushed to and fro",
                 hinge("0 -1 0", {0, 0, -0.5}, 0.05, "<dynamics friction='0.7'/>", "",
                       down + "<initial joint='h' position='1'/><effort joint='h' history='2*sin(2.5*t)'/>"
                              "<probe name='tip' link='a' at='0 0 -1'/>"),
                 4,
                 {1e-3, 1e-4, 1e-5},
                 {{0.841470985, 0, -0.540302306},
                  {0.355482404, 0, -0.934682973},
                  {-0.036395120, 0, -0.999337478},
                  {0.243522116, 0, -0.969895344},
                  {0.064776998, 0, -0.997899765},
                  {-0.520694786, 0, -0.853742900},
                  {-0.567590028, 0, -0.823311339},
                  {0.110939261, 0, -0.993827188},
                  {0.731097079, 0, -0.682273450},
                  {0.590026389, 0, -0.807383961},
                  {-0.182044175, 0, -0.983290353}}});
  out.push_back({"a gear with play",
                 hinge("0 0 1", {0, 0, 0}, 0.35, "",
                       "<drive joint='h' gear='60' rotor_inertia='3e-05' stiffness='2000' damping='1' "
                       "backlash='0.05'/>",
                       weightless + "<effort joint='h' history='2*sin(6*t)'/><probe name='tip' link='a' at='1 0 0'/>"),
                 4,
                 {1e-2, 1e-3},
                 {{1, 0, 0},
                  {0.979241943, 0.202694884, 0},
                  {0.760771536, 0.649019776, 0},
                  {0.716047809, 0.698051241, 0},
                  {0.377225381, 0.926121489, 0},
                  {0.045044459, 0.998984983, 0},
                  {-0.056110989, 0.998424537, 0},
                  {-0.546746989, 0.837297874, 0},
                  {-0.659532320, 0.751676206, 0},
                  {-0.842251329, 0.539085058, 0},
                  {-0.992947660, 0.118553553, 0}}});
  return out;
}

/// A flexible arm falls on its stop. The hit starts waves, so that tries agree by chance. There is no closed form;
/// steps of `em4` that are 40 times shorter than those of any try have errors of some 1e-7.
TEST(Corners, HitsOfFlexibleArms) {
  const scene::SceneDescription scene =
      scene_of(robot("<link name='a'><beam elements='4' order='2'><centerline><line to='1 0 0'/></centerline><circle "
                     "radius='0.01'/><material young='70e9' poisson='0.33' density='2700'/><damping "
                     "stiffness_proportional='1e-3'/></beam></link>" +
                         joint("h", "revolute", "world", "a",
                               "<axis xyz='0 0 1'/><limit lower='-0.539' upper='1' effort='0' velocity='0'/>"),
                     gravity({0, -9.81, 0}) + "<probe name='p' link='a' at='1 0 0'/>"));
  Simulation fine(scene, options("em4", 4e-5));
  Trajectory truth = {fine.probe(0).pose.position};
  while (fine.time() < 0.8 - 1e-9) {
    run(fine, 2000);
    truth.push_back(fine.probe(0).pose.position);
  }
  for (const double accuracy : {1e-3, 1e-4, 1e-5}) EXPECT_LE(outcome(scene, 0.8, accuracy, truth).error, accuracy);
}

TEST(Corners, ErrorsAreWhatIsAskedFor) {
  for (const Case& one : cases())
    for (const double accuracy : one.accuracies) {
      const Outcome run = outcome(one.scene, one.until, accuracy, one.truth);
      EXPECT_LE(run.error, accuracy) << one.name << " to " << accuracy << ", said " << run.estimate;
    }
}

}  // namespace
}  // namespace flexarm::test
