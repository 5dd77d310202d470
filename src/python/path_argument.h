#pragma once
/// Paths as Python gives them: str, bytes, pathlib.Path. pybind11 has this itself from version 2.7 on.

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
    if (!PyUnicode_FSConverter(source.ptr(), &bytes)) {  // what is no path, or has a null character in it
      PyErr_Clear();
      return false;
    }
    value.text = reinterpret_steal<pybind11::bytes>(bytes);
    return true;
  }
};

}  // namespace pybind11::detail
