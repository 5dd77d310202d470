#include "cli/recording_library.h"

#include <stdexcept>
#include <string>

#include <dlfcn.h>

namespace flexarm::cli {

const recording::Writers& recording_writers() {
  // It stays loaded: what it made has its code.
  void* const library = dlopen(recording::kLibrary, RTLD_LAZY | RTLD_LOCAL);
  const void* const writers = library ? dlsym(library, recording::kWriters) : nullptr;
  if (!writers) throw std::runtime_error(std::string("cannot write such files: ") + dlerror());
  return *static_cast<const recording::Writers*>(writers);
}

}  // namespace flexarm::cli
