#pragma once
/// Runs loops over packs, and other long kernels, with the widest registers of the processor at hand, and with 32 of
/// them in the place of 16 where it has AVX-512: kernels of beams have more numbers in hand than 16. Registers of eight
/// numbers are not used. Results differ between processors with and without fused multiply-add by round-off.

namespace flexarm::simd {

// What a function template inlines is compiled for the same processor as the template, and nothing else is: no inline
// function that other files share can come out for a processor that they do not run on. GCC only: clang's `flatten`
// inlines one level of calls. Without optimisation nothing is inlined.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && defined(__OPTIMIZE__)
inline constexpr bool has_wide_version = true;
inline bool is_wide() {
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
}
inline bool has_many_registers() {
  return is_wide() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
         __builtin_cpu_supports("avx512dq");
}
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
inline constexpr bool has_wide_version = false;
inline bool is_wide() {
  return false;
}
inline bool has_many_registers() {
  return false;
}
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
  if constexpr (has_wide_version) {
    static const bool many_registers = has_many_registers(), wide = is_wide();
    if (many_registers) return run_with_many_registers(work);
    if (wide) return run_wide(work);
  }
  run_baseline(work);
}

}  // namespace flexarm::simd
