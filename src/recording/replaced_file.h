#pragma once
/// A file that another library writes under a temporary name, until it is complete.

#include <optional>
#include <string>

#include "simulation/unfinished_file.h"

namespace flexarm::recording {

/// As UnfinishedFile, with the name of the file in all errors.
class ReplacedFile {
 public:
  /// @throws std::runtime_error naming the file if no file can be written there
  explicit ReplacedFile(const std::string& path);

  const std::string& unfinished() const { return file_->temporary(); }
  /// @throws std::runtime_error naming the file, with the reason
  [[noreturn]] void fail(const std::string& reason) const;
  /// Replaces an older file by the new one, which must be closed.
  /// @throws std::runtime_error naming the file if that fails
  void put_in_place();

 private:
  std::string path_;
  std::optional<UnfinishedFile> file_;
};

}  // namespace flexarm::recording
