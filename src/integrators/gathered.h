#pragma once
/// Gathers values of several nodes or elements into packs.

#include "math/pack.h"
#include "math/so3.h"
#include "model/joint.h"

namespace flexarm {

/// Gathers one number per lane: get(lane).
template <class Get>
[[gnu::always_inline]] inline Pack gathered(const Get& get) {
  static_assert(Pack::kLanes == 4);
  return {get(0), get(1), get(2), get(3)};
}
/// Gathers one vector per lane; get(lane) returns a const reference to a vector of `Size` numbers.
template <int Size = 3, class Get>
[[gnu::always_inline]] inline Eigen::Matrix<Pack, Size, 1> gathered_vector(const Get& get) {
  Eigen::Matrix<Pack, Size, 1> out;
  for (int c = 0; c < Size; ++c) out[c] = gathered([&](int lane) { return get(lane)[c]; });
  return out;
}
/// Gathers one quaternion per lane; get(lane) returns a const Quaternion&.
template <class Get>
[[gnu::always_inline]] inline QuaternionT<Pack> gathered_quaternion(const Get& get) {
  QuaternionT<Pack> out;
  for (int c = 0; c < 4; ++c) out.coeffs()[c] = gathered([&](int lane) { return get(lane).coeffs()[c]; });
  return out;
}

}  // namespace flexarm
