#include "bench/child_process.h"

#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <initializer_list>
#include <stdexcept>

namespace flexarm::bench {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kMayLimitMemory = false;  // their shadow memory takes terabytes of addresses
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
constexpr bool kMayLimitMemory = false;
#else
constexpr bool kMayLimitMemory = true;
#endif
#else
constexpr bool kMayLimitMemory = true;
#endif

constexpr int kWallSecondsPerSecond = 10;  // other processes may keep the processor busy

void limit(__rlimit_resource resource, rlim_t soft, rlim_t hard) {
  const rlimit value{soft, hard};
  setrlimit(resource, &value);
}

/// Applies the limits to the calling process.
void apply(const ProcessLimits& limits) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // end with the parent, since nobody would read the results
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_DFL);
  const rlim_t seconds = static_cast<rlim_t>(limits.seconds);
  limit(RLIMIT_CPU, seconds, seconds + 1);
  limit(RLIMIT_CORE, 0, 0);
  if (kMayLimitMemory) limit(RLIMIT_AS, limits.bytes, limits.bytes);
  alarm(static_cast<unsigned>(kWallSecondsPerSecond * limits.seconds));
}

}  // namespace

bool limits_memory() {
  return kMayLimitMemory;
}

ChildEnd run_in_child(const std::function<void()>& work, const ProcessLimits& limits) {
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no process can be made");
  if (child == 0) {
    apply(limits);
    [&]() noexcept { work(); }();
    _exit(0);  // without flushing buffers and closing files that belong to the parent
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) throw std::runtime_error("a process was lost");
    kill(child, SIGKILL);  // a signal asks this process to end
  }
  const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  return {signal, signal == SIGXCPU || signal == SIGKILL || signal == SIGALRM};
}

}  // namespace flexarm::bench
