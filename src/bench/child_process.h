#pragma once
/// Work in a separate process: if it crashes, the caller goes on.

#include <sys/mman.h>

#include <cstddef>
#include <functional>
#include <new>
#include <type_traits>

namespace flexarm::bench {

/// A value in memory that a child process shares with its parent: what the child had written before it ended is there.
template <class Value>
class Shared {
  static_assert(std::is_trivially_copyable_v<Value>);

 public:
  /// @throws std::bad_alloc if there is no memory.
  Shared() : memory_(mmap(nullptr, sizeof(Value), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)) {
    if (memory_ == MAP_FAILED) throw std::bad_alloc();
    new (memory_) Value;
  }
  ~Shared() { munmap(memory_, sizeof(Value)); }
  Shared(const Shared&) = delete;
  Shared& operator=(const Shared&) = delete;
  Value& operator*() { return *static_cast<Value*>(memory_); }
  Value* operator->() { return static_cast<Value*>(memory_); }

 private:
  void* memory_;
};

struct ProcessLimits {
  int seconds = 10;                          ///< of the processor; ten times as much by the clock on the wall
  std::size_t bytes = std::size_t{2} << 30;  ///< of address space; not with the address or thread sanitizer
};

/// Whether memory can be limited in this program.
bool limits_memory();

/// How a child ended.
struct ChildEnd {
  int signal = 0;                ///< that ended it; 0: it ended by itself
  bool ran_out_of_time = false;  ///< one of the limits' signals
};

/// Calls work() in a copy of this process, which has one thread only, and waits. An exception that escapes ends the
/// child with SIGABRT.
/// @throws std::runtime_error if there is no process to be had.
ChildEnd run_in_child(const std::function<void()>& work, const ProcessLimits& limits);

}  // namespace flexarm::bench
