#pragma once
/// Prints names of schemes with their options in the output of tests.

#include <ostream>
#include <string>

#include <gtest/gtest.h>

#include "bench/variants.h"

namespace flexarm::bench {

inline void PrintTo(const Variant& variant, std::ostream* out) {
  *out << variant.name();
}

/// "m1_total" for "m1, total".
inline std::string test_name(const ::testing::TestParamInfo<Variant>& info) {
  std::string name;
  for (const char c : info.param.name())
    if (c != ',') name += c == ' ' ? '_' : c;
  return name;
}

}  // namespace flexarm::bench
