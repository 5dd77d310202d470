#include "recording/replaced_file.h"

#include <stdexcept>

namespace flexarm::recording {
ReplacedFile::ReplacedFile(const std::string& path) : path_(path) {
  with_subject("'" + path_ + "'", [&] { file_.emplace(path); });
}

void ReplacedFile::fail(const std::string& reason) const {
  throw std::runtime_error("cannot write '" + path_ + "': " + reason);
}

void ReplacedFile::put_in_place() {
  with_subject("'" + path_ + "'", [&] { file_->put_in_place(); });
}

}  // namespace flexarm::recording
