#include "cli/recording_library.h"

#include <stdexcept>
#include <string>

#include <dlfcn.h>

namespace flexarm::cli {

const recording::Library& recording_library() {
  // It stays loaded: what it made has its code.
  void* const library = dlopen(recording::kLibrary, RTLD_LAZY | RTLD_LOCAL);
  const void* const functions = library ? dlsym(library, recording::kSymbol) : nullptr;
  if (!functions) throw std::runtime_error(std::string("cannot use such files: ") + dlerror());
  return *static_cast<const recording::Library*>(functions);
}

}  // namespace flexarm::cli
