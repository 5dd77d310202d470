#pragma once
/// Runs loops over packs, and other long kernels, with the widest registers of the processor at hand. Results differ
/// between processors with and without fused multiply-add by round-off.

namespace flexarm::simd {

// What a function template inlines is compiled for the same processor as the template, and nothing else is: no inline
// function that other files share can come out for a processor that they do not run on. GCC only: clang's `flatten`
// inlines one level of calls. Without optimisation nothing is inlined.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && defined(__OPTIMIZE__)
inline constexpr bool has_wide_version = true;
inline bool is_wide() {
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
}
template <class Work>
[[gnu::target("avx2,fma"), gnu::flatten, gnu::noinline]] void run_wide(const Work& work) {
  work();
}
#else
inline constexpr bool has_wide_version = false;
inline bool is_wide() {
  return false;
}
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
  if constexpr (has_wide_version) {
    static const bool wide = is_wide();
    if (wide) return run_wide(work);
  }
  run_baseline(work);
}

}  // namespace flexarm::simd
