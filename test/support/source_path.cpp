#include "support/source_path.h"

namespace flexarm::test {

// The one file that knows where the repository lies: all others compile alike in every checkout.
std::string source_path(const std::string& path) {
  return FLEXARM_SOURCE_DIR "/" + path;
}

}  // namespace flexarm::test
