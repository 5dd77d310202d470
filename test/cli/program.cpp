/// The path of the program under test.
#include "cli/program.h"

namespace flexarm::cli {

// In a separate file, so that other files compile to the same code wherever the program is built.
std::string program() {
  return FLEXARM_PROGRAM;
}

}  // namespace flexarm::cli
