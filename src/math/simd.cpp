#include "math/simd.h"

namespace flexarm::simd {

Version best_version() {
#if defined(__x86_64__)
  if constexpr (has_versions) {
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") ? Version::Wide : Version::Baseline;
  }
#endif
  return Version::Baseline;
}

Version version = best_version();

}  // namespace flexarm::simd
