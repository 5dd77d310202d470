#pragma once
/// Converts results of the façade to numpy arrays.

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include <pybind11/numpy.h>

#include "flexarm/model/results.h"

namespace flexarm::python {

using Array = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;

constexpr std::size_t kPose = 7;  ///< numbers of a pose: x y z, qx qy qz qw

inline double* put(const Vector3& vector, double* place) {
  return std::copy_n(vector.data(), 3, place);
}
inline double* put(const Pose& pose, double* place) {
  return std::copy_n(pose.orientation.coeffs().data(), 4, put(pose.position, place));
}
inline double* put(const Wrench& wrench, double* place) {
  return put(wrench.moment, put(wrench.force, place));
}

/// An array of `count` numbers `value(index)`.
template <class Value>
pybind11::array_t<double> numbers(std::size_t count, const Value& value) {
  pybind11::array_t<double> array(static_cast<pybind11::ssize_t>(count));
  for (std::size_t i = 0; i < count; ++i) array.mutable_data()[i] = value(i);
  return array;
}

/// An array of `count` rows; `fill(index, place)` writes each row to `place`.
template <class Fill>
pybind11::array_t<double> rows(std::size_t count, std::size_t columns, const Fill& fill) {
  pybind11::array_t<double> array({count, columns});
  double* place = array.mutable_data();
  for (std::size_t i = 0; i < count; ++i, place += columns) fill(i, place);
  return array;
}

/// The shape as Python prints it: "(3, 2)".
inline std::string shape_text(const pybind11::array& array) {
  return pybind11::str(array.attr("shape"));
}

}  // namespace flexarm::python
