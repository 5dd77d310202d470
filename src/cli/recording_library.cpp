#include "cli/recording_library.h"

#include "math/loaded_library.h"

namespace flexarm::cli {

const recording::Library& recording_library() {
  return loaded_functions<recording::Library>(recording::kLibrary, recording::kSymbol,
                                              "cannot read or write such files");
}

}  // namespace flexarm::cli
