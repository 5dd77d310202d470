#include "recording/replaced_file.h"

#include <stdexcept>

namespace flexarm::recording {
namespace {

template <class Work>
void naming(const std::string& path, const Work& work) {
  try {
    work();
  } catch (const std::runtime_error& error) {
    throw std::runtime_error("'" + path + "' " + error.what());
  }
}

}  // namespace

ReplacedFile::ReplacedFile(const std::string& path) : path_(path) {
  naming(path_, [&] { file_.emplace(path); });
}

void ReplacedFile::fail(const std::string& reason) const {
  throw std::runtime_error("cannot write '" + path_ + "': " + reason);
}

void ReplacedFile::put_in_place() {
  naming(path_, [&] { file_->put_in_place(); });
}

}  // namespace flexarm::recording
