#include "math/simd.h"

namespace flexarm::simd {

Version best_version() {
#if defined(__x86_64__)
  if constexpr (has_versions) {
    if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return Version::Baseline;
    const bool has_many_registers =
        __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq");
    return has_many_registers ? Version::ManyRegisters : Version::Wide;
  }
#endif
  return Version::Baseline;
}

Version version = best_version();

}  // namespace flexarm::simd
