// Measures the cost of the parts of a step with Google Benchmark: `bench_kernels --benchmark_filter=evaluate/em`.
//
// The beam is the right-angle cantilever of Simo and Vu-Quoc (1988) in motion. The counter "elements/s" is the number
// of elements that the processor handles per second.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <array>
#include <chrono>
#include <vector>

#include "bench/scenes.h"
#include "flexarm/scene/scene_description.h"
#include "flexarm/scene/urdf_reader.h"
#include "flexarm/simulation/linear_model.h"
#include "flexarm/simulation/simulation.h"
#include "integrators/step_system.h"
#include "joints/joint_map.h"
#include "math/lanes.h"
#include "math/local_rotation.h"
#include "math/quadrature.h"
#include "math/simd.h"
#include "math/so3.h"
#include "simulation/inside.h"
#include "solver/sparse_tangent.h"

namespace flexarm {
namespace {

constexpr int kElements = 32;
constexpr double kStep = 0.05;
constexpr int kStepsBefore = 10;

void count_elements(benchmark::State& state, int elements) {
  using benchmark::Counter;
  state.counters["elements/s"] = Counter(elements, Counter::kIsIterationInvariantRate);
}

Simulation cantilever_in_motion(const std::string& scheme, int elements, int order, bool reuse = false) {
  SimulationOptions options;
  options.scheme = scheme;
  options.step = kStep;
  options.reuse_factorisation = reuse;
  Simulation simulation(bench::right_angle_cantilever(elements, order), options);
  for (int n = 0; n < kStepsBefore; ++n)
    if (!simulation.step().converged) throw std::runtime_error("the cantilever failed");
  return simulation;
}

/// The equations of a step that begins in the middle of the motion.
struct StepUnderWay {
  Simulation simulation;
  StepSystem system;

  StepUnderWay(const std::string& scheme, int elements, int order, BackendChoice backend = BackendChoice::Fastest)
      : simulation(cantilever_in_motion(scheme, elements, order)),
        system(model_of(simulation), find_scheme(scheme).value(), backend) {
    system.begin(state_of(simulation), kStep, Guess::Extrapolated);
  }
};

void evaluate(benchmark::State& state, const std::string& scheme, int elements, int order, bool with_tangent) {
  StepUnderWay step(scheme, elements, order);
  for (auto _ : state) benchmark::DoNotOptimize(step.system.evaluate(with_tangent));
  count_elements(state, elements);
}

void begin_step(benchmark::State& state, int order) {
  StepUnderWay step("em", kElements, order);
  for (auto _ : state) step.system.begin(state_of(step.simulation), kStep, Guess::Extrapolated);
  count_elements(state, kElements);
}

void gather(benchmark::State& state, int order) {
  const Simulation simulation = cantilever_in_motion("em", kElements, order);
  const DegreesOfFreedom dof(model_of(simulation));
  ReducedResidual rows(model_of(simulation), dof);
  SparseTangent tangent(model_of(simulation), dof);
  Eigen::VectorXd residual(dof.unknowns);
  for (auto _ : state) {
    rows.set_zero();
    tangent.set_zero();
    rows.gather(residual);
    tangent.finish();
    benchmark::ClobberMemory();
  }
  count_elements(state, kElements);
}

/// Adds the tangents of four elements, stored in packs, to the blocks of these elements.
template <int Nodes>
void scatter(benchmark::State& state) {
  constexpr int kBlocks = Nodes * Nodes;
  std::vector<Pack> tangent(36 * kBlocks, Pack(1.0));
  std::vector<double> blocks(Pack::kLanes * tangent.size());
  std::array<double*, Pack::kLanes> targets;
  for (auto _ : state) {
    simd::run([&] {
      for (int b = 0; b < kBlocks; ++b) {
        for (int lane = 0; lane < Pack::kLanes; ++lane) targets[lane] = blocks.data() + 36 * (kBlocks * lane + b);
        add_lanes<36>(tangent.data() + 36 * b, Pack::kLanes, targets.data());
      }
    });
    benchmark::ClobberMemory();
  }
  count_elements(state, Pack::kLanes);
}

void factorise_tree(benchmark::State& state, int order) {
  StepUnderWay step("em", kElements, order);
  for (auto _ : state) {
    step.system.evaluate(true);  // the factors overwrite the matrix, so it is computed again
    const auto begin = std::chrono::steady_clock::now();
    benchmark::DoNotOptimize(step.system.tangent().factorise());
    state.SetIterationTime(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  count_elements(state, kElements);
}

void solve_tree(benchmark::State& state, int order) {
  StepUnderWay step("em", kElements, order);
  step.system.evaluate(true);
  step.system.tangent().factorise();
  Eigen::VectorXd x(step.system.residual().size());
  for (auto _ : state) {
    x = step.system.residual();
    benchmark::DoNotOptimize(step.system.tangent().solve(x));
  }
  count_elements(state, kElements);
}

void factorise_matrix(benchmark::State& state, int order) {
  StepUnderWay step("em", kElements, order, BackendChoice::Matrix);
  step.system.evaluate(true);
  step.system.tangent().factorise();  // chooses pivots, which later factorisations keep
  for (auto _ : state) benchmark::DoNotOptimize(step.system.tangent().factorise());
  count_elements(state, kElements);
}

void solve_matrix(benchmark::State& state, int order) {
  StepUnderWay step("em", kElements, order, BackendChoice::Matrix);
  step.system.evaluate(true);
  step.system.tangent().factorise();
  Eigen::VectorXd x(step.system.residual().size());
  for (auto _ : state) {
    x = step.system.residual();
    benchmark::DoNotOptimize(step.system.tangent().solve(x));
  }
  count_elements(state, kElements);
}

void whole_step(benchmark::State& state, const std::string& scheme, int order, bool reuse) {
  Simulation simulation = cantilever_in_motion(scheme, kElements, order, reuse);
  long iterations = 0;
  for (auto _ : state) {
    const StepResult result = simulation.step();
    if (!result.converged) return state.SkipWithError(to_string(result.reason));
    iterations += result.iterations;
  }
  count_elements(state, kElements);
  state.counters["newton"] = static_cast<double>(iterations) / static_cast<double>(state.iterations());
}

/// Computes rotation, curvature and generalised shape functions at all stiffness points of one element.
template <int Nodes>
void interpolate_rotations(benchmark::State& state) {
  std::array<Quaternion, Nodes> rotations;
  for (int i = 0; i < Nodes; ++i) rotations[i] = so3::exp_quaternion(Vector3(0.1 * i, 0.2 - 0.05 * i, 0.07 * i * i));
  std::array<ShapeFunctions<Nodes>, Nodes - 1> functions;
  for (int k = 0; k < Nodes - 1; ++k) functions[k] = lagrange<Nodes>(GaussLegendre<Nodes - 1>::points[k]);
  GeneralisedShapeFunctions<Nodes> generalised;
  for (auto _ : state) {
    benchmark::DoNotOptimize(rotations);
    const LocalRotationVariation<Nodes> variation{LocalRotations<Nodes>(rotations)};
    for (const ShapeFunctions<Nodes>& f : functions) {
      benchmark::DoNotOptimize(variation.evaluate(f.values, f.derivatives, generalised));
      benchmark::DoNotOptimize(generalised);
    }
  }
  count_elements(state, 1);
}

/// Computes the maps of a revolute joint over a step, with lever arms on both sides.
void fold_maps(benchmark::State& state, bool with_tangent) {
  JointMap joint;
  joint.kind = JointMapKind::Scalar;
  joint.rotation = Vector3::UnitZ();
  joint.origin.position = Vector3(0.3, -0.2, 0.5);
  joint.arm = Vector3(0.1, 0.4, -0.2);
  const auto pose = [](const Vector3& position, const Vector3& turn) {
    const Quaternion orientation = so3::exp_quaternion(turn);
    return NodePose{position, orientation, orientation.toRotationMatrix()};
  };
  NodePose from = pose({0, 0, 0}, {0.1, 0.2, 0.3}), to = pose({0.01, 0.02, -0.01}, {0.12, 0.19, 0.33});
  Released released_from, released_to;
  released_to.displacement[0] = 0.02;
  const NodePose slave_from = slave_pose(joint, from, released_from), slave_to = slave_pose(joint, to, released_to);
  Vector6 force;
  force << 1, 2, 3, 4, 5, 6;
  FoldMaps maps;
  for (auto _ : state) {
    benchmark::DoNotOptimize(to);
    incremental_maps(joint, {from, slave_from, released_from}, {to, slave_to, released_to}, force, maps, with_tangent);
    benchmark::DoNotOptimize(maps);
  }
}

/// Linearises the demo scene: matrices, inputs, outputs.
void linearise_demo(benchmark::State& state) {
  Simulation simulation(*scene::read_scene_file(FLEXARM_SOURCE_DIR "/config/demo_arm.urdf").scene);
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(linearise(simulation).a.data());
}

template <class... Arguments>
benchmark::internal::Benchmark* add(const std::string& name, void (*run)(benchmark::State&, Arguments...),
                                    Arguments... arguments) {
  auto* added = benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) { run(state, arguments...); });
  return added->Unit(benchmark::kMicrosecond);
}

const bool registered = [] {
  for (const char* scheme : {"em", "em0", "m1", "newmark"})
    for (int order = 1; order <= 4; ++order)
      for (const int elements : {1, kElements})
        for (const bool with_tangent : {false, true})
          add<const std::string&, int, int, bool>(fmt::format("evaluate/{}/order:{}/elements:{}/{}", scheme, order,
                                                              elements, with_tangent ? "tangent" : "residual"),
                                                  evaluate, scheme, elements, order, with_tangent);
  add("interpolate_rotations/order:1", interpolate_rotations<2>);
  add("interpolate_rotations/order:2", interpolate_rotations<3>);
  add("interpolate_rotations/order:3", interpolate_rotations<4>);
  add("interpolate_rotations/order:4", interpolate_rotations<5>);
  add("scatter/order:1", scatter<2>);
  add("scatter/order:2", scatter<3>);
  add("scatter/order:3", scatter<4>);
  add("scatter/order:4", scatter<5>);
  add("fold_maps/revolute/residual", fold_maps, false);
  add("fold_maps/revolute/tangent", fold_maps, true);
  add("linearise/demo", linearise_demo);
  for (int order = 1; order <= 4; ++order) {
    add(fmt::format("begin/em/order:{}", order), begin_step, order);
    add(fmt::format("gather/order:{}", order), gather, order);
    add(fmt::format("factorise/tree/order:{}", order), factorise_tree, order)->UseManualTime();
    add(fmt::format("factorise/matrix/order:{}", order), factorise_matrix, order);
    add(fmt::format("solve/tree/order:{}", order), solve_tree, order);
    add(fmt::format("solve/matrix/order:{}", order), solve_matrix, order);
    for (const bool reuse : {false, true})
      add<const std::string&, int, bool>(
          fmt::format("step/em/order:{}/{}", order, reuse ? "kept_factors" : "full_newton"), whole_step, "em", order,
          reuse);
  }
  return true;
}();

}  // namespace
}  // namespace flexarm

BENCHMARK_MAIN();
