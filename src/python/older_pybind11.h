#pragma once
/// What pybind11 has from version 2.6 on, for older ones (Ubuntu 20.04 has 2.4).

#include <pybind11/pybind11.h>

#if PYBIND11_VERSION_MAJOR == 2 && PYBIND11_VERSION_MINOR < 6

namespace pybind11 {

using module_ = module;

/// With the older ones, arguments behind it may be given by their places, too.
struct kw_only {};

namespace detail {
template <>
struct process_attribute<kw_only> : process_attribute_default<kw_only> {};
}  // namespace detail

}  // namespace pybind11

#endif
