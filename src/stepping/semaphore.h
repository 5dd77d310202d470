#pragma once
/// What one thread waits for and another gives.

#include <semaphore.h>

#include <chrono>
#include <ctime>

namespace flexarm::node {

/// Who gives never waits.
class Semaphore {
 public:
  Semaphore() { sem_init(&semaphore_, 0, 0); }
  ~Semaphore() { sem_destroy(&semaphore_); }
  Semaphore(const Semaphore&) = delete;
  Semaphore& operator=(const Semaphore&) = delete;

  void give() { sem_post(&semaphore_); }
  void take() {
    while (sem_wait(&semaphore_) != 0) {
    }  // a signal's handler has run
  }
  /// Waits until then at most.
  void take_until(std::chrono::steady_clock::time_point time) {
    const auto since_boot = std::chrono::duration_cast<std::chrono::nanoseconds>(time.time_since_epoch()).count();
    constexpr long kSecond = 1000000000;
    const timespec until{since_boot / kSecond, since_boot % kSecond};
    sem_clockwait(&semaphore_, CLOCK_MONOTONIC, &until);
  }

 private:
  sem_t semaphore_;
};

}  // namespace flexarm::node
