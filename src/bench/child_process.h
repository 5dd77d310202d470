#pragma once
/// Runs work in a separate process, so that the caller survives a crash.

#include <sys/mman.h>

#include <cstddef>
#include <functional>
#include <new>
#include <type_traits>

namespace flexarm::bench {

/// A value in memory shared by a child process and its parent. The parent can read what the child wrote before its end.
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
  int seconds = 10;                          ///< processor time; the limit of wall time is ten times as long
  std::size_t bytes = std::size_t{2} << 30;  ///< address space; no limit with the address or thread sanitizer
};

/// Whether memory can be limited in this build.
bool limits_memory();

/// How a child ended.
struct ChildEnd {
  int signal = 0;                ///< signal that ended the child; 0: it ended by itself
  bool ran_out_of_time = false;  ///< whether that was the signal of a time limit
};

/// Calls work() in a copy of this process, which has only one thread, and waits for it. An exception that leaves work()
/// ends the child with SIGABRT.
/// @throws std::runtime_error if no process can be created
ChildEnd run_in_child(const std::function<void()>& work, const ProcessLimits& limits);

}  // namespace flexarm::bench
