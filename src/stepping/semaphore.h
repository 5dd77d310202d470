#pragma once
/// A semaphore for two threads, based on POSIX semaphores.

#include <semaphore.h>

#include <chrono>
#include <cstdint>
#include <ctime>

namespace flexarm::node {

/// give() never waits.
class Semaphore {
 public:
  Semaphore() { sem_init(&semaphore_, 0, 0); }
  ~Semaphore() { sem_destroy(&semaphore_); }
  Semaphore(const Semaphore&) = delete;
  Semaphore& operator=(const Semaphore&) = delete;

  void give() { sem_post(&semaphore_); }
  void take() {
    while (sem_wait(&semaphore_) != 0) {
    }  // sem_wait() was interrupted by a signal
  }
  /// Waits until `time` at most.
  void take_until(std::chrono::steady_clock::time_point time) {
    const auto since_boot = std::chrono::duration_cast<std::chrono::nanoseconds>(time.time_since_epoch()).count();
    constexpr std::int64_t kSecond = 1000000000;
    timespec until{};
    until.tv_sec = static_cast<std::time_t>(since_boot / kSecond);
    until.tv_nsec = static_cast<long>(since_boot % kSecond);
    sem_clockwait(&semaphore_, CLOCK_MONOTONIC, &until);
  }

 private:
  sem_t semaphore_;
};

}  // namespace flexarm::node
