#pragma once
/// Libraries of flexarm that are loaded only when needed, since their dependencies take long to load.

#include <stdexcept>
#include <string>

#include <dlfcn.h>

namespace flexarm {

/// The functions that a library beside this one has under a symbol. It stays loaded: what it made has its code.
/// @throws std::runtime_error saying `cannot` and why, if it cannot be loaded
template <class Functions>
const Functions& loaded_functions(const char* library, const char* symbol, const char* cannot) {
  void* const loaded = dlopen(library, RTLD_LAZY | RTLD_LOCAL);
  const void* const functions = loaded ? dlsym(loaded, symbol) : nullptr;
  if (!functions) throw std::runtime_error(std::string(cannot) + ": " + dlerror());
  return *static_cast<const Functions*>(functions);
}

}  // namespace flexarm
