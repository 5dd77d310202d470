#pragma once
/// Memory for wrenches that come and go.

#include <cstddef>

namespace flexarm {

/// So many may begin or end between two steps without an allocation.
constexpr std::size_t kRoomForWrenches = 16;

}  // namespace flexarm
