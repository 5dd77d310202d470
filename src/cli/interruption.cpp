#include "cli/interruption.h"

#include <csignal>

namespace flexarm::cli {
namespace {

volatile std::sig_atomic_t interrupted = 0;  // the one thing that a signal handler may set

void handle(int) {
  interrupted = 1;
}

}  // namespace

void catch_interruptions() {
  struct sigaction action = {};
  action.sa_handler = handle;
  action.sa_flags = SA_RESETHAND;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool is_interrupted() {
  return interrupted != 0;
}

}  // namespace flexarm::cli
