/// Measures how much results slow down the thread that steps, compared with reading nothing. A row of columns follows
/// each step, written by that thread itself or by a separate thread. Other cases copy the state to a mirror, as the
/// node does whether anybody listens or not, or read what the warnings at the end of a run need.
///
///   bench_writing SCENE [STEPS]

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <string>
#include <vector>

#include "flexarm/scene/urdf_reader.h"
#include "flexarm/simulation/csv_writer.h"
#include "flexarm/simulation/run_summary.h"
#include "simulation/background_writer.h"

namespace {

using namespace flexarm;

double seconds(clockid_t clock) {
  timespec time;
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// What is read after each step, and how.
struct Reading {
  const char* name;
  enum class Way { Nothing, Mirror, Summary, InPlace, Background } way;
  std::vector<std::string> columns = {};  ///< patterns; if empty, all columns
};

struct Cost {
  double wall, stepping, all;  // wall-clock time, time of the stepping thread, time of all threads [s]
};

std::unique_ptr<ResultWriter> make_writer(const Simulation& simulation, const Reading& reading) {
  if (reading.way != Reading::Way::InPlace && reading.way != Reading::Way::Background) return nullptr;
  const auto make = [&](const Simulation& shown) {
    return std::make_unique<CsvWriter>("/dev/null", ResultColumns(shown, ResultColumns::Solver::With, reading.columns));
  };
  if (reading.way == Reading::Way::InPlace) return make(simulation);
  return std::make_unique<BackgroundWriter>(simulation, make);
}

Cost cost_of(const scene::SceneDescription& scene, int steps, const Reading& reading) {
  Simulation simulation(scene);
  simulation.step();
  const std::unique_ptr<ResultWriter> writer = make_writer(simulation, reading);
  Simulation mirror = simulation.copy();
  Snapshot snapshot;
  RunSummary summary(simulation);
  const Cost begin{seconds(CLOCK_MONOTONIC), seconds(CLOCK_THREAD_CPUTIME_ID), seconds(CLOCK_PROCESS_CPUTIME_ID)};
  for (int n = 0; n < steps; ++n) {
    const StepResult result = simulation.step();
    if (reading.way == Reading::Way::Mirror) {
      simulation.snapshot(snapshot);
      mirror.restore(snapshot);
    }
    if (reading.way == Reading::Way::Summary) summary.look(simulation);
    if (!writer) continue;
    writer->note_step(simulation, result);
    writer->write_row(simulation);
  }
  if (writer) writer->close();
  return {seconds(CLOCK_MONOTONIC) - begin.wall, seconds(CLOCK_THREAD_CPUTIME_ID) - begin.stepping,
          seconds(CLOCK_PROCESS_CPUTIME_ID) - begin.all};
}

}  // namespace

int main(int argc, char** argv) {
  const scene::ReadResult read = scene::read_scene_file(argc > 1 ? argv[1] : "");
  const int steps = argc > 2 ? std::atoi(argv[2]) : 5000;
  if (!read.scene || steps < 1) {
    std::fprintf(stderr, "%sbench_writing SCENE [STEPS]\n", scene::to_text(read.diagnostics).c_str());
    return 2;
  }
  const double each = 1e6 / steps;
  std::printf("us per step: wall, stepping thread, all threads\n");
  using Way = Reading::Way;
  const Reading readings[] = {{"nothing", Way::Nothing},
                              {"mirror", Way::Mirror},
                              {"summary of the run", Way::Summary},
                              {"time", Way::InPlace, {"time"}},
                              {"positions", Way::InPlace, {"joint/*/position"}},
                              {"joints", Way::InPlace, {"joint/*"}},
                              {"all", Way::InPlace},
                              {"all, by a thread", Way::Background}};
  for (int repetition = 0; repetition < 3; ++repetition)
    for (const Reading& reading : readings) {
      const Cost cost = cost_of(*read.scene, steps, reading);
      std::printf("%-18s %8.2f %8.2f %8.2f\n", reading.name, each * cost.wall, each * cost.stepping, each * cost.all);
    }
  return 0;
}
