// Tests the energy-momentum kernels on packs: each lane gives the same result as its element in all lanes.
#include <limits>
#include <memory>

#include "elements/conserving_kernel.h"
#include "elements/conserving_node.h"
#include "elements/kernel_checks.h"
#include "elements/tested_step.h"
#include "math/simd.h"

namespace flexarm {
namespace {

using namespace test;

/// Size of the increments in the second lane.
constexpr double kSmallStep = 1e-3;

struct PackOptions {
  bool is_corrected, is_damped, is_coupled;
  MidFunctions mid = MidFunctions::Explicit;
  int dissipation_order = 0;

  TimeRule rule() const { return time_rule(is_corrected, mid, dissipation_order); }
};

const PackOptions kPackOptions[] = {
    {true, false, true},
    {true, true, false},
    {false, true, true},
    {true, false, true, MidFunctions::Symmetric},
    {true, true, true, MidFunctions::Explicit, 2},
};

/// Four elements: one with a large step, one with a small step, one at rest, and one whose nodes rotate far relative to
/// each other.
template <int Nodes>
class Lanes {
 public:
  explicit Lanes(const PackOptions& options) : options_(options) {
    RandomSource random(3);
    for (int lane = 0; lane < Pack::kLanes; ++lane) {
      steps_[lane] = std::make_unique<RandomStep<Nodes>>(random, lane == 0 ? 0.5 : lane == 1 ? kSmallStep : 0.1);
      RandomStep<Nodes>& step = *steps_[lane];
      if (lane == 2) stop(step);
      if (lane == 3) turn_far(step);
      step.set_begin_points();
      if (options.is_damped) step.element.stiffness_damping = step.element.mass_damping = 0.1 * (lane + 1);
      if (!options.is_coupled) {
        for (auto& point : step.element.stiffness_points) {
          // The stiffness is also uniform along the element
          point.stiffness = step.element.stiffness_points[0].stiffness;
          point.stiffness.template topRightCorner<3, 3>().setZero();
          point.stiffness.template bottomLeftCorner<3, 3>().setZero();
        }
      }
      functions_[lane] = functions_at<Nodes>(step.element, step.begin_orientation);
      for (StrainMemory& memory : memory_[lane])
        memory = {0.1 * random.vector6(), 0.1 * random.vector6(), 0.1 * random.vector6()};
    }
  }
  LaneInput<Nodes> input(int lane) const {
    const RandomStep<Nodes>& step = *steps_[lane];
    return {step.element, step.nodes, functions_[lane], step.begin_points.data(), memory_[lane].data()};
  }
  /// Puts element (l + shift) % 4 into lane l.
  void fill(int shift, KernelData<Nodes>& data) const {
    for (int lane = 0; lane < Pack::kLanes; ++lane) data.set(lane, input((lane + shift) % Pack::kLanes));
  }
  TimeRule rule() const { return options_.rule(); }

 private:
  static void stop(RandomStep<Nodes>& step) {
    step.nodes.end = step.nodes.begin;
    for (int i = 0; i < Nodes; ++i) step.set_orientation(i, step.begin_orientation[i]);
  }
  static void turn_far(RandomStep<Nodes>& step) {
    for (int i = 0; i < Nodes; ++i) {
      const Vector3 bend = 2.6 * i / (Nodes - 1) * Vector3(0.6, 0, 0.8);
      step.begin_orientation[i] = so3::exp_quaternion(bend) * step.begin_orientation[0];
      const Vector3 turn = 0.2 * Vector3(1, -1, i);
      step.set_orientation(i, so3::exp_quaternion(turn) * step.begin_orientation[i]);
    }
  }

  PackOptions options_;
  std::array<std::unique_ptr<RandomStep<Nodes>>, Pack::kLanes> steps_;
  std::array<ElementFunctions<Nodes>, Pack::kLanes> functions_;
  std::array<std::array<StrainMemory, Nodes - 1>, Pack::kLanes> memory_;
};

/// Results for one element.
template <int Nodes>
struct Output {
  ElementSystem<Nodes> system;
  std::array<PointKinematics, Nodes - 1> points;
  std::array<StrainMemory, Nodes - 1> memory;

  Output(const KernelData<Nodes>& data, int lane) {
    data.get(lane, true, system);
    data.get_end(lane, points.data(), memory.data());
  }
  bool operator==(const Output& other) const {
    bool equal = system.residual == other.system.residual && system.tangent == other.system.tangent &&
                 system.dissipated == other.system.dissipated;
    for (int k = 0; k < Nodes - 1; ++k) equal = equal && points[k].strain == other.points[k].strain;
    return equal;
  }
};

/// Kernels are compiled for several kinds of processors. While this object lives, they run in the given version.
class As {
 public:
  explicit As(simd::Version version) { simd::version = version; }
  ~As() { simd::version = simd::best_version(); }
  As(const As&) = delete;
  As& operator=(const As&) = delete;
};

/// The versions that this processor can run.
std::vector<simd::Version> versions() {
  std::vector<simd::Version> out;
  for (const simd::Version version : {simd::Version::Baseline, simd::Version::Wide})
    if (version <= simd::best_version()) out.push_back(version);
  return out;
}

template <class Count>
class PackBeam : public ::testing::Test {};
TYPED_TEST_SUITE(PackBeam, NodeCounts);

TYPED_TEST(PackBeam, LanesAreSingleElements) {
  constexpr int N = TypeParam::value;
  for (const PackOptions& options : kPackOptions) {
    const Lanes<N> lanes(options);
    for (const simd::Version version : versions()) {
      KernelData<N> pack;
      lanes.fill(0, pack);
      {
        const As processor(version);
        pack.evaluate(lanes.rule(), kStep, true);
      }
      for (int lane = 0; lane < Pack::kLanes; ++lane) {
        const As processor(simd::Version::Baseline);
        KernelData<N> single(lanes.input(lane));
        single.evaluate(lanes.rule(), kStep, true);
        const Output<N> expected(single, 0), actual(pack, lane);
        // The multiplier divides an absolute round-off by the square of the increments, and is multiplied by the
        // increments. Its derivative is divided once more.
        const double size = options.is_corrected && lane == 1 ? kSmallStep : 1;
        EXPECT_LE(largest(actual.system.residual - expected.system.residual),
                  kRoundOff / size * largest(expected.system.residual))
            << "lane " << lane;
        EXPECT_LE(largest(actual.system.tangent - expected.system.tangent),
                  kRoundOff / (size * size) * largest(expected.system.tangent))
            << "lane " << lane;
        EXPECT_NEAR(actual.system.dissipated, expected.system.dissipated, kRoundOff);
        for (int k = 0; k < N - 1; ++k) {
          EXPECT_LE(largest(actual.points[k].strain - expected.points[k].strain), kRoundOff);
          const StrainMemory &is = actual.memory[k], &should = expected.memory[k];
          if (options.dissipation_order > 0) {
            EXPECT_LE(largest(is.average - should.average), kRoundOff);
          }
          if (options.dissipation_order > 0 || options.is_damped) {
            EXPECT_LE(largest(is.rate - should.rate), kRoundOff);
          }
          if (options.is_damped) {
            EXPECT_LE(largest(is.delayed_rate - should.delayed_rate), kRoundOff);
          }
        }
      }
    }
  }
}

// Bit for bit, an element's result depends neither on its lane nor on the other lanes, not even if another lane is not
// a number.
TYPED_TEST(PackBeam, LanesDoNotFeelEachOther) {
  constexpr int N = TypeParam::value;
  for (const PackOptions& options : kPackOptions) {
    const Lanes<N> lanes(options);
    for (const simd::Version version : versions()) {
      const As processor(version);
      KernelData<N> pack, shifted;
      lanes.fill(0, pack);
      pack.evaluate(lanes.rule(), kStep, true);
      lanes.fill(1, shifted);
      shifted.nodes.end[0][0].set(3, std::numeric_limits<double>::quiet_NaN());
      shifted.nodes.orientation[0].w().set(3, std::numeric_limits<double>::quiet_NaN());
      shifted.evaluate(lanes.rule(), kStep, true);
      for (int lane = 1; lane < Pack::kLanes; ++lane)
        EXPECT_TRUE(Output<N>(pack, lane) == Output<N>(shifted, lane - 1)) << "lane " << lane;
    }
  }
}

// Ensures that the tests above run different versions: round-off differs with fused multiply-add.
TEST(PackBeamVersions, AreThoseThatAreAskedFor) {
  if (simd::best_version() == simd::Version::Baseline) GTEST_SKIP() << "this processor, or compiler, has one version";
  const Lanes<3> lanes(kPackOptions[0]);
  KernelData<3> baseline, wide;
  for (KernelData<3>* data : {&baseline, &wide}) {
    const As processor(data == &wide ? simd::Version::Wide : simd::Version::Baseline);
    lanes.fill(0, *data);
    data->evaluate(lanes.rule(), kStep, true);
  }
  EXPECT_FALSE(Output<3>(baseline, 0) == Output<3>(wide, 0));
}

TEST(PackNode, LanesAreSingleNodes) {
  RandomSource random(5);
  LumpedInertia<Pack> inertias;
  NodeMotion<Pack> motions;
  std::array<LumpedInertia<double>, Pack::kLanes> inertia;
  std::array<NodeMotion<double>, Pack::kLanes> motion;
  for (int lane = 0; lane < Pack::kLanes; ++lane) {
    const Quaternion begin = random.rotation(3);
    const Vector3 turn = (lane == 1 ? 0.0 : 0.5) * random.vector();
    const Quaternion end = so3::exp_quaternion(turn) * begin;
    const Vector3 increment = cayley::increment(begin, end);
    inertia[lane] = {1.0 + lane, random.positive_definite<3>()};
    motion[lane] = {begin.toRotationMatrix(),           end.toRotationMatrix(), random.vector(), increment,
                    cayley::inverse_tangent(increment), random.vector(),        random.vector()};
    set_lane(inertias.mass, lane, inertia[lane].mass);
    set_lane(inertias.rotary, lane, inertia[lane].rotary);
    set_lane(motions.begin, lane, motion[lane].begin);
    set_lane(motions.end, lane, motion[lane].end);
    set_lane(motions.displacement, lane, motion[lane].displacement);
    set_lane(motions.increment, lane, motion[lane].increment);
    set_lane(motions.inverse_tangent, lane, motion[lane].inverse_tangent);
    set_lane(motions.velocity, lane, motion[lane].velocity);
    set_lane(motions.angular_velocity, lane, motion[lane].angular_velocity);
  }
  simd::run([&] {
    const ConservingNode<Pack> pack(inertias, motions, 2, kStep, true);
    for (int lane = 0; lane < Pack::kLanes; ++lane) {
      const ConservingNode<double> single(inertia[lane], motion[lane], 2, kStep, true);
      EXPECT_LE(largest(get_lane(pack.residual, lane) - single.residual), kRoundOff * largest(single.residual));
      EXPECT_LE(largest(get_lane(pack.rotational, lane) - single.rotational), kRoundOff * largest(single.rotational));
      EXPECT_NEAR(pack.translational[lane], single.translational, kRoundOff * single.translational);
    }
  });
}

}  // namespace
}  // namespace flexarm
