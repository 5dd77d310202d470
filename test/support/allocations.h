#pragma once
/// How often a program allocates memory, and what it does where there is none. One of its files may include this.

#include <atomic>
#include <cstdlib>

// Interposes the allocator of the whole program, libraries included; it only counts, glibc does the work.
namespace {
std::atomic<bool> g_counting{false};
std::atomic<long> g_allocations{0};
std::atomic<long> g_allowed{-1};  // malloc()'s, before one comes back with nothing; negative: all
[[maybe_unused]] void count() {
  if (g_counting.load(std::memory_order_relaxed)) g_allocations.fetch_add(1, std::memory_order_relaxed);
}
[[maybe_unused]] bool is_refused() {
  return g_allowed.load(std::memory_order_relaxed) >= 0 && g_allowed.fetch_sub(1, std::memory_order_relaxed) == 0;
}
}  // namespace

// Sanitizers have an allocator of their own, without which they see nothing.
#ifndef __has_feature  // clang's way to say what it was told; GCC has macros
#define __has_feature(feature) 0
#endif
#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && \
    !__has_feature(address_sanitizer) && !__has_feature(thread_sanitizer)
#define FLEXARM_COUNTS_ALLOCATIONS 1
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);

void* malloc(std::size_t size) {
  count();
  if (is_refused()) return nullptr;
  return __libc_malloc(size);
}
void* calloc(std::size_t number, std::size_t size) {
  count();
  return __libc_calloc(number, size);
}
void* realloc(void* memory, std::size_t size) {
  count();
  return __libc_realloc(memory, size);
}
void* memalign(std::size_t alignment, std::size_t size) {
  count();
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  return memalign(alignment, size);
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  *memory = memalign(alignment, size);
  return *memory || size == 0 ? 0 : 12;  // ENOMEM
}
}
#else
#define FLEXARM_COUNTS_ALLOCATIONS 0
#endif

namespace flexarm::test {

/// False with sanitizers, and with other C libraries.
constexpr bool kCountsAllocations = FLEXARM_COUNTS_ALLOCATIONS;

/// In all threads.
template <class Function>
long allocations_in(const Function& function) {
  g_allocations = 0;
  g_counting = true;
  function();
  g_counting = false;
  return g_allocations;
}

/// Runs `function`, for which one allocation fails, that after so many. @returns whether it came to that one
template <class Function>
bool without_allocation(long number, const Function& function) {
  struct Limit {
    explicit Limit(long number) { g_allowed = number; }
    ~Limit() { g_allowed = -1; }
  };
  const Limit limit(number);
  function();
  return g_allowed < 0;
}

}  // namespace flexarm::test
