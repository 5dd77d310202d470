#include "cli/command_line.h"

#include <csignal>
#include <cstdio>
#include <initializer_list>
#include <new>

#include <malloc.h>

#include <fmt/format.h>

#include "flexarm/model/model_error.h"

namespace flexarm::cli {
namespace {

int parse_and_run(CLI::App& app, const int& status, int argc, char** argv) {
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
  } catch (const ModelError& error) {
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

int run_command_line(CLI::App& app, const int& status, int argc, char** argv) {
  keep_memory();
  ignore_signals_of_output();
  const int result = parse_and_run(app, status, argc, argv);
  if (std::fflush(stdout) == 0) return result;
  std::perror("flexarm: cannot write the output");
  return kFailed;
}

// ---------------------------------------------------------------- signals

namespace {

volatile std::sig_atomic_t noted = 0;  // the one thing that a signal handler may set

void handle(int signal) {
  if (noted == 0) noted = signal;
}

}  // namespace

void catch_interruptions() {
  struct sigaction action = {};
  action.sa_handler = handle;
  action.sa_flags = SA_RESETHAND;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before = {};
    sigaction(signal, nullptr, &before);
    if (before.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
  }
}

int interruption() {
  return noted;
}

void ignore_signals_of_output() {
  for (const int signal : {SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_IGN);
}

}  // namespace flexarm::cli
