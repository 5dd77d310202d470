// Shows changes of results in any bit: prints a line for each scene and each scheme that accepts it, with a hash of the
// state after some steps and of the equilibrium. A refactoring must leave every line unchanged.
//
//   bench_result_bits SCENE... > before.txt
//
// Outputs are comparable only if they come from the same compiler and the same processor.
#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <unistd.h>

#include "flexarm/scene/urdf_reader.h"
#include "flexarm/schemes/integrator_description.h"
#include "flexarm/simulation/checkpoint.h"
#include "flexarm/simulation/simulation.h"

namespace {

constexpr int kSteps = 300;
constexpr int kLoadSteps = 4;

/// Returns the FNV-1a hash of a checkpoint, which contains the complete state.
std::uint64_t state_hash(const flexarm::Simulation& simulation, const std::string& file) {
  flexarm::write_checkpoint(simulation, file);
  std::ifstream stream(file, std::ios::binary);
  std::uint64_t hash = 14695981039346656037u;
  for (std::istreambuf_iterator<char> c(stream), end; c != end; ++c) {
    hash ^= static_cast<unsigned char>(*c);
    hash *= 1099511628211u;
  }
  return hash;
}

/// Runs a scene with a scheme and prints its line. Failed steps are halved; a final failure is also a result.
void report(const flexarm::scene::SceneDescription& scene, const std::string& path, const std::string& scheme,
            const std::string& file) {
  flexarm::SimulationOptions options;
  options.scheme = scheme;
  try {
    flexarm::Simulation simulation(scene, options);
    int iterations = 0, done = 0;
    while (done < kSteps) {
      const flexarm::StepResult result = simulation.step();
      iterations += result.iterations;
      if (!result.converged) break;
      ++done;
    }
    const std::uint64_t moved = state_hash(simulation, file);
    double published = 0;
    for (std::size_t k = 0; k < simulation.coordinate_names().size(); ++k)
      published += simulation.velocity(k) + simulation.effort(k);
    flexarm::Simulation loaded(scene, options);
    const bool stands = loaded.solve_static(kLoadSteps).converged;
    std::printf("%s %s: %d steps %d iterations %016" PRIx64 " published %a static %d %016" PRIx64 "\n", path.c_str(),
                scheme.c_str(), done, iterations, moved, published, stands, state_hash(loaded, file));
  } catch (const std::exception& refusal) {  // not every scheme takes every scene
    std::printf("%s %s: %s\n", path.c_str(), scheme.c_str(), refusal.what());
  }
}

}  // namespace

int main(int count, char** arguments) {
  const std::string file =
      (std::filesystem::temp_directory_path() / ("flexarm_bits_" + std::to_string(getpid()))).string();
  for (int i = 1; i < count; ++i) {
    const flexarm::scene::ReadResult read = flexarm::scene::read_scene_file(arguments[i]);
    if (!read.scene) {
      std::fprintf(stderr, "%s", to_text(read.diagnostics).c_str());
      return 2;
    }
    for (const std::string_view scheme : flexarm::scheme_names())
      report(*read.scene, arguments[i], std::string(scheme), file);
  }
  std::filesystem::remove(file);
}
