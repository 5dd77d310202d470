#pragma once
/// A lock-free queue between two threads, for states of a simulation and commands to it.

#include <atomic>
#include <cassert>
#include <cstddef>
#include <stdexcept>
#include <vector>

namespace flexarm {

/// A queue of fixed capacity for one producer thread and one consumer thread: first in, first out, without locks,
/// waiting or allocations. Entries are constructed once and reused, so that they keep their memory. Each thread caches
/// the other thread's count and reads it again only if it must, because each read moves a cache line between the
/// processors.
template <class Entry>
class SpscRing {
 public:
  /// @param capacity  number of entries, > 0
  /// @throws std::invalid_argument if it is 0
  explicit SpscRing(std::size_t capacity) : entries_(capacity) {
    if (capacity == 0) throw std::invalid_argument("capacity: expected a number of entries > 0, got 0");
  }

  // ---- for the producer
  /// Whether at least `count` entries are free.
  bool has_room(std::size_t count = 1) {
    const std::size_t pushed = pushed_.load(kOwn);
    if (entries_.size() - (pushed - seen_popped_) < count) seen_popped_ = popped_.load(kOther);
    return entries_.size() - (pushed - seen_popped_) >= count;
  }
  /// The `index`-th free entry, to be filled before push(). It must be free.
  Entry& free_entry(std::size_t index = 0) {
    assert(has_room(index + 1));
    return at(pushed_.load(kOwn) + index);
  }
  /// Hands the first `count` free entries over to the consumer, all at once.
  void push(std::size_t count = 1) {
    assert(has_room(count));
    pushed_.store(pushed_.load(kOwn) + count, std::memory_order_release);
  }

  // ---- for the consumer
  std::size_t size() {
    seen_pushed_ = pushed_.load(kOther);
    return seen_pushed_ - popped_.load(kOwn);
  }
  bool empty() {
    const std::size_t popped = popped_.load(kOwn);
    if (seen_pushed_ == popped) seen_pushed_ = pushed_.load(kOther);
    return seen_pushed_ == popped;
  }
  /// The oldest entry. The ring must not be empty.
  Entry& front() {
    assert(!empty());
    return at(popped_.load(kOwn));
  }
  void pop() {
    assert(!empty());
    popped_.store(popped_.load(kOwn) + 1, std::memory_order_release);
  }

 private:
  static constexpr std::memory_order kOwn = std::memory_order_relaxed, kOther = std::memory_order_acquire;
  static constexpr std::size_t kCacheLine = 64;

  Entry& at(std::size_t count) { return entries_[count % entries_.size()]; }

  std::vector<Entry> entries_;
  // Only one thread writes each count, and the counts of different threads are on different cache lines. They never
  // wrap.
  alignas(kCacheLine) std::atomic<std::size_t> pushed_{0};
  std::size_t seen_popped_ = 0;
  alignas(kCacheLine) std::atomic<std::size_t> popped_{0};
  std::size_t seen_pushed_ = 0;
};

}  // namespace flexarm
