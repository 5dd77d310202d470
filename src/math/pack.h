#pragma once
/// A pack of four numbers of type double (lanes) for SIMD: one register with AVX, two with SSE2. A pack can be the
/// scalar type of templates, including Eigen's, so that a kernel that is written once runs for one element or for four.
///
/// Lanes never mix: the result in a lane does not depend on its position or on the other lanes. Code for packs cannot
/// branch on values. It uses sign_of(), or for_lanes_beyond() for a rare branch.

#include <cmath>
#include <type_traits>

#include <Eigen/Core>

namespace flexarm {

// The alignment is explicit, since compilers choose different ones for vectors wider than registers.
class alignas(4 * sizeof(double)) Pack {
 public:
  static constexpr int kLanes = 4;
  using Vector = double __attribute__((vector_size(kLanes * sizeof(double))));
  using Mask = long long __attribute__((vector_size(kLanes * sizeof(long long))));  ///< per lane 0 or -1

  Pack() = default;
  [[gnu::always_inline]] Pack(double value) : values_(Vector{} + value) {}
  [[gnu::always_inline]] Pack(double a, double b, double c, double d) : values_{a, b, c, d} {}
  [[gnu::always_inline]] explicit Pack(const Vector& values) : values_(values) {}
  // A non-trivial copy makes calls pass packs by address. The calling convention by value depends on AVX.
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

/// Returns -1 if the (real part of the) number is negative, else 1; for each lane of a pack.
template <typename S>
[[gnu::always_inline]] inline auto sign_of(const S& x) {
  if constexpr (is_pack<S>) {
    const Pack::Vector one = Pack::Vector{} + 1.0;
    return Pack(x.values() < 0 ? -one : one);
  } else {
    return typename Eigen::NumTraits<S>::Real(std::real(x) < 0 ? -1 : 1);
  }
}

/// Calls far(lane) for the lanes in which x < limit is false, which includes NaN.
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

// Pack has an alignment of its own. Eigen would request 16 bytes, which is less, and an error in clang.
template <int Size>
struct compute_default_alignment<flexarm::Pack, Size> {
  enum { value = 0 };
};

}  // namespace internal
}  // namespace Eigen
