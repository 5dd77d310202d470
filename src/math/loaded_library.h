#pragma once
/// Libraries of flexarm that are loaded only when needed, since their dependencies take long to load.

#include <stdexcept>
#include <string>

#include <dlfcn.h>

namespace flexarm {

/// The functions that a library in the same folder as this one has under a symbol. The library stays loaded, since
/// objects that it made use its code.
/// @throws std::runtime_error with `cannot` and the reason, if it cannot be loaded
template <class Functions>
const Functions& loaded_functions(const char* library, const char* symbol, const char* cannot) {
  void* const loaded = dlopen(library, RTLD_LAZY | RTLD_LOCAL);
  const void* const functions = loaded ? dlsym(loaded, symbol) : nullptr;
  if (!functions) throw std::runtime_error(std::string(cannot) + ": " + dlerror());
  return *static_cast<const Functions*>(functions);
}

}  // namespace flexarm
