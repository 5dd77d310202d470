#pragma once
/// Accepts paths from Python: str, bytes, pathlib.Path. From version 2.7 on, pybind11 can do this itself.

#include <string>

#include <pybind11/pybind11.h>

namespace flexarm::python {

struct PathArgument {
  std::string text;
};

}  // namespace flexarm::python

namespace pybind11::detail {

template <>
struct type_caster<flexarm::python::PathArgument> {
  PYBIND11_TYPE_CASTER(flexarm::python::PathArgument, _("os.PathLike"));

  bool load(handle source, bool) {
    PyObject* bytes = nullptr;
    if (!PyUnicode_FSConverter(source.ptr(), &bytes)) {  // not a path, or a text with a null character
      PyErr_Clear();
      return false;
    }
    value.text = reinterpret_steal<pybind11::bytes>(bytes);
    return true;
  }
};

}  // namespace pybind11::detail
