/// The path of the repository; see source_path.h.
#include "support/source_path.h"

namespace flexarm::test {

// This is the only file that contains the path of the repository, so that other files compile to the same code in every
// checkout.
std::string source_path(const std::string& path) {
  return FLEXARM_SOURCE_DIR "/" + path;
}

}  // namespace flexarm::test
