#pragma once
/// Files that other libraries write: under another name until they are complete.

#include <optional>
#include <string>

#include "simulation/unfinished_file.h"

namespace flexarm::recording {

/// An UnfinishedFile whose errors name it.
class ReplacedFile {
 public:
  /// @throws std::runtime_error naming the file, if nothing can be put there
  explicit ReplacedFile(const std::string& path);

  const std::string& unfinished() const { return file_->temporary(); }
  /// @throws std::runtime_error naming the file, with the reason
  [[noreturn]] void fail(const std::string& reason) const;
  /// In the place of what is there; the file has been closed.
  /// @throws std::runtime_error naming the file, if that cannot be
  void put_in_place();

 private:
  std::string path_;
  std::optional<UnfinishedFile> file_;
};

}  // namespace flexarm::recording
