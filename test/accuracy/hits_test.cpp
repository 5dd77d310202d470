/// Tests runs to an accuracy in which bodies hit each other, against motions that scipy has computed with events.

#include "flexarm/accuracy/accurate_run.h"
#include "flexarm/accuracy/companion.h"
#include "support/scene_text.h"

namespace flexarm::test {
namespace {

/// A scene whose motion is known, from scripts/outside_references: the law of docs/notes/contact.md 2 in continuous
/// time, by scipy's DOP853 with a tolerance of 1e-12 from event to event.
struct Hits {
  std::string text;
  double until;                     ///< [s]
  std::vector<Trajectory> motions;  ///< of the probes, at tenths of the time [m]
};

/// A ball that may touch others, with its centre at `at`.
std::string hitting(const std::string& name, double radius, double mass, double moment,
                    const Vector3& at = Vector3::Zero()) {
  return body(name, mass, Vector3::Constant(moment), at, collision(fmt::format("<sphere radius='{}'/>", radius), at));
}

std::string flying(const std::string& name, const std::string& at) {
  return joint("free_" + name, "floating", "world", name, "<origin xyz='" + at + "'/>");
}

const std::string kWeight = gravity({0, -9.81, 0});

Hits bouncing_ball() {
  return {robot("<ground name='floor' normal='0 1 0'/>" + hitting("b", 0.04, 0.3, 0.0012) + flying("b", "0 0.4 0") +
                    "<contact first='b' second='floor' restitution='0.6' stiffness='2e4'/>",
                kWeight + "<initial link='b' linear='0.2 0 0'/><probe name='b' link='b'/>"),
          1.2,
          {{{0, 0.4, 0},
            {0.024, 0.329368000, 0},
            {0.048, 0.117472000, 0},
            {0.072, 0.139871255, 0},
            {0.096, 0.157994101, 0},
            {0.120, 0.038626658, 0},
            {0.144, 0.081796235, 0},
            {0.168, 0.053904262, 0},
            {0.192, 0.043840760, 0},
            {0.216, 0.039857582, 0},
            {0.240, 0.039854401, 0}}}};
}

/// A pendulum that swings against a wall, and meets it anywhere in the steps.
Hits pendulum_on_wall() {
  return {robot("<ground name='wall' normal='1 0 0' offset='-0.05'/>" + hitting("b", 0.05, 0.8, 0.0032, {0, -0.5, 0}) +
                    joint("h", "continuous", "world", "b", "<axis xyz='0 0 1'/>") +
                    "<contact first='b' second='wall' restitution='0.8' stiffness='3e4'/>",
                kWeight + "<initial joint='h' position='0.7'/><probe name='b' link='b' at='0 -0.5 0'/>"),
          1.5,
          {{{0.322108844, -0.382421094, 0},
            {0.267269871, -0.422571670, 0},
            {0.101275444, -0.489635869, 0},
            {0.089276315, -0.491965181, 0},
            {0.222176908, -0.447925688, 0},
            {0.263521354, -0.424919399, 0},
            {0.207453473, -0.454931925, 0},
            {0.063266760, -0.495981166, 0},
            {0.084543224, -0.492800612, 0},
            {0.186791204, -0.463798497, 0},
            {0.212592639, -0.452553168, 0}}}};
}

/// Two free balls that meet obliquely.
Hits two_balls() {
  return {robot(hitting("a", 0.08, 1, 0.004) + flying("a", "0 0 0") + hitting("b", 0.06, 0.4, 0.0016) +
                    flying("b", "0.5 0.05 0") + "<contact first='a' second='b' restitution='0.7' stiffness='2e4'/>",
                "<gravity xyz='0 0 0'/><initial link='a' linear='1.5 0 0'/><initial link='b' linear='-1 0 0'/>"
                "<probe name='a' link='a'/><probe name='b' link='b'/>"),
          0.6,
          {{{0, 0, 0},
            {0.09, 0, 0},
            {0.18, 0, 0},
            {0.237997694, -0.012672279, 0},
            {0.265031615, -0.037610512, 0},
            {0.292065536, -0.062548745, 0},
            {0.319099457, -0.087486979, 0},
            {0.346133377, -0.112425212, 0},
            {0.373167298, -0.137363445, 0},
            {0.400201219, -0.162301679, 0},
            {0.427235140, -0.187239912, 0}},
           {{0.5, 0.05, 0},
            {0.44, 0.05, 0},
            {0.38, 0.05, 0},
            {0.400005766, 0.081680697, 0},
            {0.497420963, 0.144026280, 0},
            {0.594836161, 0.206371863, 0},
            {0.692251359, 0.268717447, 0},
            {0.789666556, 0.331063030, 0},
            {0.887081754, 0.393408613, 0},
            {0.984496952, 0.455754196, 0},
            {1.081912149, 0.518099780, 0}}}};
}

/// Runs differ in the places of hits within their intervals. The steps of all tries together are a small part of those
/// that a search without located hits takes, 1.5 million.
TEST(Hits, KeepTheAccuracy) {
  for (const Hits& hits : {bouncing_ball(), pendulum_on_wall(), two_balls()})
    for (const int intervals : {100, 70, 30})
      for (const double accuracy : {1e-2, 1e-3, 1e-4}) {
        Simulation simulation(scene_of(hits.text));
        RunWatcher nobody;
        const AccurateRun run = run_to_accuracy(simulation, {accuracy, hits.until, intervals}, nobody);
        EXPECT_EQ(run.end, AccurateRun::End::Met) << to_string(run.end) << ", " << accuracy << ", " << intervals;
        EXPECT_LT(run.steps, 50000) << accuracy << ", " << intervals;
        JudgedMotion tenths(hits.motions.size()), truth(hits.motions.size());
        truth.points = hits.motions;
        for (std::size_t p = 0; p < hits.motions.size(); ++p)
          for (int i = 0; i <= intervals; i += intervals / 10) tenths.points[p].push_back(run.motion.points[p][i]);
        EXPECT_LE(motion_error(tenths, truth, run.scale), accuracy) << accuracy << ", " << intervals;
      }
}

/// The estimate of a companion contains a bound of what the steps over a hit may do: the jump of the velocity times
/// half of the step, times the time since then. It holds against the same motion from scipy.
TEST(Hits, AreCornersForACompanion) {
  const Hits hits = bouncing_ball();
  scene::SceneDescription scene = scene_of(hits.text);
  scene.integrator.step = 1e-3;
  Simulation simulation(scene);
  Companion companion(simulation);
  double estimate = 0;
  for (int i = 1; i <= 480; ++i) {
    ASSERT_TRUE(simulation.step().converged);
    estimate = companion.follow(simulation);
    if (i % 120 != 0) continue;
    const double error =
        (simulation.probe_pose(0).position - hits.motions[0][static_cast<std::size_t>(i / 120)]).norm();
    EXPECT_GE(estimate + 1e-12, error) << i;  // before the hit both are round-off of many steps
  }
}

}  // namespace
}  // namespace flexarm::test
