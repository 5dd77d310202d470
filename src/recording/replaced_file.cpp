#include "recording/replaced_file.h"

#include <filesystem>
#include <stdexcept>

namespace flexarm::recording {

namespace fs = std::filesystem;

ReplacedFile::~ReplacedFile() {
  std::error_code ignored;
  fs::remove(unfinished_, ignored);
}

void ReplacedFile::fail(const std::string& reason) const {
  throw std::runtime_error("cannot write '" + path_ + "': " + reason);
}

void ReplacedFile::put_in_place() {
  std::error_code error;
  fs::rename(unfinished_, path_, error);
  if (error) fail(error.message());
}

}  // namespace flexarm::recording
