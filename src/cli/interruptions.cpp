#include "cli/interruptions.h"

#include <csignal>
#include <initializer_list>

namespace flexarm::cli {
namespace {

volatile std::sig_atomic_t noted = 0;  // the only type that a signal handler may write

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
