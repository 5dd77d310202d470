#pragma once
/// Features of pybind11 2.6 for older versions (Ubuntu 20.04 has 2.4).

#include <pybind11/pybind11.h>

#if PYBIND11_VERSION_MAJOR == 2 && PYBIND11_VERSION_MINOR < 6

namespace pybind11 {

using module_ = module;

/// A stand-in: before 2.6, the arguments that follow it may also be given by position.
struct kw_only {};

namespace detail {
template <>
struct process_attribute<kw_only> : process_attribute_default<kw_only> {};
}  // namespace detail

}  // namespace pybind11

#endif
