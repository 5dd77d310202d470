#pragma once
/// Counts memory allocations of a program, and lets allocations fail. Only one file of a program may include this
/// header.

#include <atomic>
#include <cstdlib>

// Replaces the allocator of the whole program, including libraries. It only counts; glibc allocates the memory.
namespace {
std::atomic<bool> g_counting{false};
std::atomic<long> g_allocations{0};
std::atomic<long> g_allowed{-1};  // calls of malloc() before one fails; negative: none fails
[[maybe_unused]] void count() {
  if (g_counting.load(std::memory_order_relaxed)) g_allocations.fetch_add(1, std::memory_order_relaxed);
}
[[maybe_unused]] bool is_refused() {
  return g_allowed.load(std::memory_order_relaxed) >= 0 && g_allowed.fetch_sub(1, std::memory_order_relaxed) == 0;
}
}  // namespace

// Sanitizers have an allocator of their own, which must not be replaced.
#ifndef __has_feature  // defined by clang alone; GCC defines macros
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

/// False with sanitizers, and with other C libraries than glibc.
constexpr bool kCountsAllocations = FLEXARM_COUNTS_ALLOCATIONS;

/// Returns the number of allocations in all threads while `function` runs.
template <class Function>
long allocations_in(const Function& function) {
  g_allocations = 0;
  g_counting = true;
  function();
  g_counting = false;
  return g_allocations;
}

/// Runs `function`, and lets the allocation after `number` allocations fail. @returns whether that one was reached
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
