#pragma once
/// Runs loops over packs, and other long kernels, with AVX2 and fused multiply-add where the processor at hand has
/// them. Results differ between processors with and without by round-off. The 32 registers of AVX-512 are not used:
/// whole runs of four scenes took 0.98 to 1.05 of their time without them (docs/architecture.md).

namespace flexarm::simd {

/// For which processors a kernel is compiled: all, and those with AVX2 and fused multiply-add.
enum class Version { Baseline, Wide };

/// The last of them that the processor at hand can run.
Version best_version();
/// The one that runs: the best, or before it for tests. No other thread may run kernels while it is set.
extern Version version;

// What a function template inlines is compiled for the same processor as the template, and nothing else is: no inline
// function that other files share can come out for a processor that they do not run on. GCC only: clang's `flatten`
// inlines one level of calls. Without optimisation nothing is inlined.
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

/// Calls work(), a function object that may be compiled twice.
template <class Work>
void run(const Work& work) {
  if constexpr (has_versions) {
    if (version == Version::Wide) return run_wide(work);
  }
  run_baseline(work);
}

}  // namespace flexarm::simd
