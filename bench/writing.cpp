/// What results cost the thread that steps: a scene with a row of all columns after each step, written by that thread
/// itself and by one of its own, beside no rows at all.
///   bench_writing SCENE [STEPS]

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>

#include "flexarm/scene/urdf_reader.h"
#include "flexarm/simulation/csv_writer.h"
#include "simulation/background_writer.h"

namespace {

using namespace flexarm;

double seconds(clockid_t clock) {
  timespec time;
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

enum class Rows { None, InPlace, Background };

struct Cost {
  double wall, stepping, all;  // of the clock on the wall, of the thread that steps, of all threads [s]
};

Cost cost_of(const scene::SceneDescription& scene, int steps, Rows rows) {
  Simulation simulation(scene);
  simulation.step();
  std::unique_ptr<ResultWriter> writer;
  if (rows != Rows::None)
    writer = std::make_unique<CsvWriter>("/dev/null", ResultColumns(simulation, ResultColumns::Solver::With));
  if (rows == Rows::Background) writer = std::make_unique<BackgroundWriter>(std::move(writer), simulation);
  const Cost begin{seconds(CLOCK_MONOTONIC), seconds(CLOCK_THREAD_CPUTIME_ID), seconds(CLOCK_PROCESS_CPUTIME_ID)};
  for (int n = 0; n < steps; ++n) {
    const StepResult result = simulation.step();
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
  for (int repetition = 0; repetition < 3; ++repetition)
    for (const auto& [name, rows] :
         {std::pair("no rows", Rows::None), {"in place", Rows::InPlace}, {"background", Rows::Background}}) {
      const Cost cost = cost_of(*read.scene, steps, rows);
      std::printf("%-12s %8.2f %8.2f %8.2f\n", name, each * cost.wall, each * cost.stepping, each * cost.all);
    }
  return 0;
}
