// Measures how fast a scene runs: wall time per step, as fast as possible and paced at real time.
//
//   bench_real_time SCENE [STEPS] [JOINT EFFORT PERIOD]
//
// JOINT is driven by a square wave of EFFORT [N m or N] with PERIOD [s]. For the demo, type
//   bench_real_time config/demo_arm.urdf 1000 shoulder_yaw 1000 0.5
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <optional>
#include <thread>
#include <vector>

#include "flexarm/scene/urdf_reader.h"
#include "flexarm/simulation/simulation.h"

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

struct Drive {
  std::optional<std::size_t> coordinate;
  double effort = 0, period = 1;

  void apply(flexarm::Simulation& simulation) const {
    if (!coordinate) return;
    const bool first_half = std::fmod(simulation.time(), period) < 0.5 * period;
    simulation.command_effort(*coordinate, first_half ? effort : -effort);
  }
};

/// Returns the wall time of each step [s]. If `paced`, each step waits for its time, as in the node.
std::vector<double> run(flexarm::Simulation& simulation, const Drive& drive, int steps, bool paced) {
  std::vector<double> times;
  times.reserve(steps);
  const Clock::time_point begin = Clock::now();
  for (int k = 0; k < steps; ++k) {
    if (paced) {
      const auto due = begin + std::chrono::duration_cast<Clock::duration>(
                                   std::chrono::duration<double>(k * simulation.step_size()));
      std::this_thread::sleep_until(due);
    }
    drive.apply(simulation);
    const Clock::time_point start = Clock::now();
    const flexarm::StepResult result = simulation.step();
    times.push_back(seconds_since(start));
    if (!result.converged) {
      std::fprintf(stderr, "t = %g s: %s\n", simulation.time(), flexarm::to_string(result.reason));
      std::exit(1);
    }
  }
  return times;
}

void report(const char* what, std::vector<double> times, double step) {
  const double sum = std::accumulate(times.begin(), times.end(), 0.0);
  std::sort(times.begin(), times.end());
  const auto overruns = std::count_if(times.begin(), times.end(), [&](double t) { return t > step; });
  std::printf(
      "%-13s %zu steps of %g s: median %.1f us, 99 %% %.1f us, largest %.1f us, overruns %ld, real-time factor %.1f\n",
      what, times.size(), step, 1e6 * times[times.size() / 2], 1e6 * times[times.size() * 99 / 100], 1e6 * times.back(),
      static_cast<long>(overruns), step * static_cast<double>(times.size()) / sum);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2 && argc != 3 && argc != 6) {
    std::fprintf(stderr, "usage: bench_real_time SCENE [STEPS] [JOINT EFFORT PERIOD]\n");
    return 2;
  }
  const flexarm::scene::ReadResult read = flexarm::scene::read_scene_file(argv[1]);
  std::fputs(flexarm::scene::to_text(read.diagnostics).c_str(), stderr);
  if (!read.scene) return 2;
  const int steps = argc > 2 ? std::max(1, std::atoi(argv[2])) : 1000;
  flexarm::Simulation simulation(*read.scene);
  Drive drive;
  if (argc == 6) {
    drive.coordinate = simulation.find_coordinate(argv[3]);
    drive.effort = std::atof(argv[4]);
    drive.period = std::atof(argv[5]);
  }
  std::printf("%zu degrees of freedom, scheme %s\n", simulation.degrees_of_freedom(), simulation.scheme().c_str());
  report("free-running:", run(simulation, drive, steps, false), simulation.step_size());
  simulation.reset();
  report("paced:", run(simulation, drive, steps, true), simulation.step_size());
}
