#include "integrators/unknown_scales.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>

#include "joints/kinematics.h"
#include "math/pack.h"
#include "math/simd.h"

namespace flexarm {
namespace {

/// Collects the largest absolute value of numbers; NaN if one of them is NaN.
class Largest {
 public:
  [[gnu::always_inline]] void take(const Pack& values) {
    const Pack size = abs(values);
    is_broken_ |= values.values() != values.values();
    largest_ = Pack(largest_.values() > size.values() ? largest_.values() : size.values());
  }
  double value() const {
    double out = 0;
    for (int lane = 0; lane < Pack::kLanes; ++lane) {
      if (is_broken_[lane]) return std::numeric_limits<double>::quiet_NaN();
      out = std::max(out, largest_[lane]);
    }
    return out;
  }

 private:
  Pack largest_ = 0.0;
  Pack::Mask is_broken_{};
};

/// Calls take(next) for each four of `size` entries; next(array) loads these entries of an array, zero beyond its end.
template <class Take>
[[gnu::always_inline]] inline void by_fours(std::size_t size, const Take& take) {
  const std::size_t whole = size / Pack::kLanes * Pack::kLanes;
  const auto entries = [](const double* from, std::size_t bytes) {
    Pack::Vector out{};
    std::memcpy(&out, from, bytes);
    return Pack(out);
  };
  for (std::size_t i = 0; i < whole; i += Pack::kLanes)
    take([&](const double* array) { return entries(array + i, sizeof(Pack)); });
  if (whole < size) take([&](const double* array) { return entries(array + whole, (size - whole) * sizeof(double)); });
}

double largest_product(const Eigen::VectorXd& a, const Eigen::ArrayXd& b) {
  Largest largest;
  simd::run([&] { by_fours(a.size(), [&](const auto& next) { largest.take(next(a.data()) * next(b.data())); }); });
  return largest.value();
}

}  // namespace

UnknownScales::UnknownScales(const Model& model, const DegreesOfFreedom& dof)
    : length_(model.length_scale),
      scales_(Eigen::ArrayXd::Zero(dof.unknowns)),
      rotations_(Eigen::ArrayXd::Zero(dof.unknowns)) {
  const auto add = [&](int equation, bool is_rotation) {
    if (equation < 0) return;
    scales_[equation] = is_rotation ? 1.0 : 1 / length_;
    rotations_[equation] = is_rotation ? 1.0 : 0.0;
  };
  for (int i = 0; i < dof.node_count; ++i)
    for (int k = 0; k < 6; ++k) add(dof.equation[dof.first[i] + k], k >= 3);
  for (const Coordinate& coordinate : model.coordinates)
    add(dof.equation[dof.scalar_of(coordinate)], is_rotation(model, coordinate));
  mass_ = mass_of(model);
  for_each_multiplier(model, dof, [&](int closure, int constraint, int equation) {
    const bool is_gap = model.closures[closure].constraints[constraint].kind == ClosureConstraint::Kind::Gap;
    multipliers_.push_back({equation, is_gap ? 1.0 : length_});
  });
}

double UnknownScales::norm(const Eigen::VectorXd& increment, double step) const {
  assert(increment.size() == scales_.size());
  constexpr double infinity = std::numeric_limits<double>::infinity();
  double norm = largest_product(increment, scales_);
  if (!std::isfinite(norm)) return infinity;
  if (step == 0 || mass_ == 0) return norm;
  const double way = step * step / (mass_ * length_);
  for (const Multiplier& multiplier : multipliers_) {
    const double size = std::abs(way / multiplier.arm * increment[multiplier.equation]);
    norm = std::max(norm, std::isfinite(size) ? size : infinity);
  }
  return norm;
}

double UnknownScales::largest_moment(const Eigen::VectorXd& residual) const {
  assert(residual.size() == scales_.size());
  double largest = 0;
  for (Eigen::Index i = 0; i < residual.size(); ++i) {
    const double size = scales_[i] > 0 ? std::abs(residual[i]) / scales_[i] : 0;
    if (size > largest || std::isnan(size)) largest = size;  // no number compares larger than NaN, so NaN stays
  }
  return largest;
}

double UnknownScales::largest_rotation(const Eigen::VectorXd& increment) const {
  assert(increment.size() == rotations_.size());
  return largest_product(increment, rotations_);
}

void UnknownScales::choose_order(IncrementHistory& history) const {
  if (history.count < 2 || scales_.size() == 0) return;
  constexpr int kLowest = IncrementHistory::kNoMotion, kOrders = IncrementHistory::kHighestOrder + 1 - kLowest;
  static_assert(IncrementHistory::kHighestOrder == 2);
  std::array<IncrementHistory::Weights, kOrders> weights;
  for (int i = 0; i < kOrders; ++i) weights[i] = history.weights(kLowest + i, 1, history.steps[0]);
  std::array<Largest, kOrders> errors;
  simd::run([&] {
    by_fours(scales_.size(), [&](const auto& next) {
      const auto made = [&](int i) { return next(history.increments[i].data()); };
      const Pack made_0 = made(0), made_1 = made(1), made_2 = made(2), made_3 = made(3), scale = next(scales_.data());
      for (int i = 0; i < kOrders; ++i) {
        const auto& [unused, w_1, w_2, w_3] = weights[i];
        errors[i].take((made_0 - (w_1 * made_1 + w_2 * made_2 + w_3 * made_3)) * scale);
      }
    });
  });
  double smallest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kOrders; ++i) {
    if (weights[i][1] == 0 && kLowest + i > IncrementHistory::kNoMotion) continue;
    if (const double error = errors[i].value(); error < smallest) smallest = error, history.order = kLowest + i;
  }
}

}  // namespace flexarm
