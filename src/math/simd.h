#pragma once
/// Runs loops over packs, and other long kernels, with AVX2 and fused multiply-add if the processor has them. Results
/// on processors with and without these differ by round-off. The 32 registers of AVX-512 are not used: with them, whole
/// runs of four scenes took 0.98 to 1.05 of the time without them (docs/architecture.md).

namespace flexarm::simd {

/// The versions of a compiled kernel: for all processors, and for those with AVX2 and fused multiply-add.
enum class Version { Baseline, Wide };

/// Returns the best version that the processor can run.
Version best_version();
/// The version in use: the best one, unless a test sets another. While it is set, no other thread may run kernels.
extern Version version;

// run_wide() inlines everything that it calls, and only this inlined code is compiled for AVX2. So no inline function
// that other files share is compiled for a processor on which these could not run. This works only with GCC, since
// clang's `flatten` inlines only one level of calls, and only with optimisation, since nothing is inlined without.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && defined(__OPTIMIZE__)
inline constexpr bool has_versions = true;
template <class Work>
[[gnu::target("avx2,fma"), gnu::flatten, gnu::noinline]] void run_wide(const Work& work) {
  work();
}
#else
inline constexpr bool has_versions = false;
template <class Work>
void run_wide(const Work& work) {
  work();
}
#endif

template <class Work>
[[gnu::noinline]] void run_baseline(const Work& work) {
  work();
}

/// Calls work() in the version in use. `work` is a function object, which is compiled once for each version.
template <class Work>
void run(const Work& work) {
  if constexpr (has_versions) {
    if (version == Version::Wide) return run_wide(work);
  }
  run_baseline(work);
}

}  // namespace flexarm::simd
