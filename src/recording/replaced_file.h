#pragma once
/// Files of libraries that write by themselves: beside their place until they are whole.

#include <string>

namespace flexarm::recording {

/// A file that is written under another name, and removed again unless it is put in its place.
class ReplacedFile {
 public:
  explicit ReplacedFile(const std::string& path) : path_(path), unfinished_(path + ".unfinished") {}
  ~ReplacedFile();
  ReplacedFile(const ReplacedFile&) = delete;
  ReplacedFile& operator=(const ReplacedFile&) = delete;

  const std::string& unfinished() const { return unfinished_; }
  /// @throws std::runtime_error naming the file, with the reason
  [[noreturn]] void fail(const std::string& reason) const;
  /// In the place of what is there; the file has been closed.
  /// @throws std::runtime_error if that cannot be
  void put_in_place();

 private:
  std::string path_, unfinished_;
};

}  // namespace flexarm::recording
