#pragma once
/// Types for tests that run for every number of nodes that an element may have.

#include <type_traits>

#include <gtest/gtest.h>

namespace flexarm::test {

/// A number of nodes as a type, for typed tests.
template <int N>
using NodeCount = std::integral_constant<int, N>;
using NodeCounts = ::testing::Types<NodeCount<2>, NodeCount<3>, NodeCount<4>, NodeCount<5>>;

}  // namespace flexarm::test
