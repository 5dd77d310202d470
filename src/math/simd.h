#pragma once
/// Runs loops over packs, and other long kernels, with the widest registers of the processor at hand, and with 32 of
/// them in the place of 16 where it has AVX-512: kernels of beams have more numbers in hand than 16. Registers of eight
/// numbers are not used. Results differ between processors with and without fused multiply-add by round-off.

namespace flexarm::simd {

/// For which processors a kernel is compiled: all, those with AVX2 and fused multiply-add, and those with AVX-512.
enum class Version { Baseline, Wide, ManyRegisters };

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
template <class Work>
[[gnu::target("avx2,fma,avx512f,avx512vl,avx512dq,prefer-vector-width=256"), gnu::flatten, gnu::noinline]] void
run_with_many_registers(const Work& work) {
  work();
}
#else
inline constexpr bool has_versions = false;
template <class Work>
void run_wide(const Work& work) {
  work();
}
template <class Work>
void run_with_many_registers(const Work& work) {
  work();
}
#endif

template <class Work>
[[gnu::noinline]] void run_baseline(const Work& work) {
  work();
}

/// Calls work(), a function object that may be compiled three times.
template <class Work>
void run(const Work& work) {
  if constexpr (has_versions) {
    if (version == Version::ManyRegisters) return run_with_many_registers(work);
    if (version == Version::Wide) return run_wide(work);
  }
  run_baseline(work);
}

}  // namespace flexarm::simd
