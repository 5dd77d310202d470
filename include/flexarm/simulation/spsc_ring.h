#pragma once
/// A queue between two threads, for states of a simulation and commands to it.

#include <atomic>
#include <cassert>
#include <cstddef>
#include <stdexcept>
#include <vector>

namespace flexarm {

/// A queue with a fixed number of entries, which one thread fills and one other thread empties: in order, without
/// locks, waiting or allocations. Entries live as long as the ring, and keep their memory from one use to the next. A
/// thread reads the other's count only if it must, since each time the memory has to move between their processors.
template <class Entry>
class SpscRing {
 public:
  /// @param capacity  entries that it can hold; > 0
  /// @throws std::invalid_argument if it is 0
  explicit SpscRing(std::size_t capacity) : entries_(capacity) {
    if (capacity == 0) throw std::invalid_argument("capacity: expected a number of entries > 0, got 0");
  }

  // ---- for the thread that fills it
  /// Whether that many entries are free.
  bool has_room(std::size_t count = 1) {
    const std::size_t pushed = pushed_.load(kOwn);
    if (entries_.size() - (pushed - seen_popped_) < count) seen_popped_ = popped_.load(kOther);
    return entries_.size() - (pushed - seen_popped_) >= count;
  }
  /// The `index`-th entry after those that were pushed, to be filled. There must be room for it.
  Entry& free_entry(std::size_t index = 0) {
    assert(has_room(index + 1));
    return at(pushed_.load(kOwn) + index);
  }
  /// Hands over the first `count` free entries, all at once.
  void push(std::size_t count = 1) {
    assert(has_room(count));
    pushed_.store(pushed_.load(kOwn) + count, std::memory_order_release);
  }

  // ---- for the thread that empties it
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
  // Each is written by one of the threads, beside nothing of the other's. They count for ever.
  alignas(kCacheLine) std::atomic<std::size_t> pushed_{0};
  std::size_t seen_popped_ = 0;
  alignas(kCacheLine) std::atomic<std::size_t> popped_{0};
  std::size_t seen_pushed_ = 0;
};

}  // namespace flexarm
