#include <cstdio>
#include <new>

#include <malloc.h>

#include <fmt/format.h>

#include "building/model_builder.h"
#include "cli/commands.h"
#include "cli/interruption.h"

namespace {

/// Runs the command line; the exit status.
int run(int argc, char** argv) {
  using namespace flexarm::cli;
  CLI::App app("Simulates flexible manipulators.", "flexarm");
  app.require_subcommand(1);
  int status = kDone;
  add_check(app, status);
  add_simulate(app, status);
  add_expand(app, status);
  add_static(app, status);
  add_modes(app, status);
  add_linearise(app, status);
  add_replay(app, status);
  add_tune(app, status);
  add_sweep(app, status);
  add_identify(app, status);
  add_bench(app, status);
  try {
    app.parse(argc, argv);
    return status;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kBadInput;  // 0: --help
  } catch (const InputError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return kBadInput;
  } catch (const Interrupted& error) {
    fmt::print(stderr, "flexarm: {}\n", error.what());
    return kInterrupted + interruption();
  } catch (const flexarm::ModelError& error) {
    fmt::print(stderr, "flexarm: {}\n", error.what());
    return kBadInput;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "flexarm: not enough memory for this scene\n");
    return kFailed;
  } catch (const std::exception& error) {
    fmt::print(stderr, "flexarm: {}\n", error.what());
    return kFailed;
  }
}

/// What a simulation gives back stays with the process, for the next one: the system takes longer to hand out fresh
/// memory than building a large model takes.
void keep_memory() {
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, -1);
}

}  // namespace

int main(int argc, char** argv) {
  keep_memory();
  flexarm::cli::ignore_signals_of_output();
  const int status = run(argc, argv);
  if (std::fflush(stdout) == 0) return status;
  std::perror("flexarm: cannot write the output");
  return flexarm::cli::kFailed;
}
