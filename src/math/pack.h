#pragma once
/// Four numbers of type double that go through the same operations side by side: one SIMD register with AVX, two of
/// SSE2. A scalar for the templates on one (Eigen's too): a kernel written once runs for one element or for four.
///
/// Lanes never mix: what a lane gives does not depend on its place or on its neighbours. Branches become
/// sign_of(), or for_lanes_beyond() where the far branch is rare.

#include <cmath>
#include <type_traits>

#include <Eigen/Core>

namespace flexarm {

class alignas(4 * sizeof(double)) Pack {  // compilers align vectors wider than their registers as they like
 public:
  static constexpr int kLanes = 4;
  using Vector = double __attribute__((vector_size(kLanes * sizeof(double))));
  using Mask = long long __attribute__((vector_size(kLanes * sizeof(long long))));  ///< per lane 0 or -1

  Pack() = default;
  [[gnu::always_inline]] Pack(double value) : values_(Vector{} + value) {}
  [[gnu::always_inline]] Pack(double a, double b, double c, double d) : values_{a, b, c, d} {}
  [[gnu::always_inline]] explicit Pack(const Vector& values) : values_(values) {}
  // Not trivial, which makes calls pass packs by address: by value they would go other ways with AVX than without.
  [[gnu::always_inline]] Pack(const Pack& other) : values_(other.values_) {}
  [[gnu::always_inline]] Pack& operator=(const Pack& other) {
    values_ = other.values_;
    return *this;
  }

  [[gnu::always_inline]] const Vector& values() const { return values_; }
  [[gnu::always_inline]] double operator[](int lane) const { return values_[lane]; }
  [[gnu::always_inline]] void set(int lane, double value) { values_[lane] = value; }

  [[gnu::always_inline]] Pack& operator+=(const Pack& other) {
    values_ += other.values_;
    return *this;
  }
  [[gnu::always_inline]] Pack& operator-=(const Pack& other) {
    values_ -= other.values_;
    return *this;
  }
  [[gnu::always_inline]] Pack& operator*=(const Pack& other) {
    values_ *= other.values_;
    return *this;
  }
  [[gnu::always_inline]] Pack& operator/=(const Pack& other) {
    values_ /= other.values_;
    return *this;
  }
  [[gnu::always_inline]] Pack operator-() const { return Pack(-values_); }
  [[gnu::always_inline]] friend Pack operator+(const Pack& a, const Pack& b) { return Pack(a.values_ + b.values_); }
  [[gnu::always_inline]] friend Pack operator-(const Pack& a, const Pack& b) { return Pack(a.values_ - b.values_); }
  [[gnu::always_inline]] friend Pack operator*(const Pack& a, const Pack& b) { return Pack(a.values_ * b.values_); }
  [[gnu::always_inline]] friend Pack operator/(const Pack& a, const Pack& b) { return Pack(a.values_ / b.values_); }

  [[gnu::always_inline]] friend Pack sqrt(const Pack& a) {
    Pack root;
    for (int lane = 0; lane < kLanes; ++lane) root.values_[lane] = std::sqrt(a.values_[lane]);
    return root;
  }
  [[gnu::always_inline]] friend Pack abs(const Pack& a) { return Pack(a.values_ < 0 ? -a.values_ : a.values_); }

 private:
  Vector values_;
};

template <typename S>
inline constexpr bool is_pack = std::is_same_v<S, Pack>;

/// -1 where the (real part of the) number is negative, else 1.
template <typename S>
[[gnu::always_inline]] inline auto sign_of(const S& x) {
  if constexpr (is_pack<S>) {
    const Pack::Vector one = Pack::Vector{} + 1.0;
    return Pack(x.values() < 0 ? -one : one);
  } else {
    return typename Eigen::NumTraits<S>::Real(std::real(x) < 0 ? -1 : 1);
  }
}

/// Calls far(lane) for the lanes where not x < limit (that holds for NaN, too).
template <class Far>
[[gnu::always_inline]] inline void for_lanes_beyond(const Pack& x, const Pack& limit, const Far& far) {
  const Pack::Mask near = x.values() < limit.values();
  if (__builtin_expect((near[0] & near[1] & near[2] & near[3]) != 0, 1)) return;
  for (int lane = 0; lane < Pack::kLanes; ++lane)
    if (!near[lane]) far(lane);
}

}  // namespace flexarm

namespace Eigen {

template <>
struct NumTraits<flexarm::Pack> : GenericNumTraits<double> {
  using Real = double;
  using NonInteger = flexarm::Pack;
  using Nested = flexarm::Pack;
  using Literal = double;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 0,
    ReadCost = 1,
    AddCost = 1,
    MulCost = 1
  };
};

namespace internal {

// A pack aligns itself; Eigen would ask for 16 bytes, which is less and refused by clang.
template <int Size>
struct compute_default_alignment<flexarm::Pack, Size> {
  enum { value = 0 };
};

}  // namespace internal
}  // namespace Eigen
