#include "cli/program.h"

namespace flexarm::cli {

// A file of its own, so that the others compile alike wherever the program is built.
std::string program() {
  return FLEXARM_PROGRAM;
}

}  // namespace flexarm::cli
