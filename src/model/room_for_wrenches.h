#pragma once
/// How much memory is reserved for wrenches that programs apply during a run.

#include <cstddef>

namespace flexarm {

/// Up to so many wrenches act at a time without an allocation on the heap.
constexpr std::size_t kRoomForWrenches = 16;

}  // namespace flexarm
