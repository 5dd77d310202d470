#pragma once
/// Writes files as a whole: if that fails, the file that was there before stays.

#include <stdexcept>
#include <string>
#include <string_view>

namespace flexarm {

/// Calls `work`. @throws std::runtime_error with `subject`, a space, and the text of the one that `work` throws
template <class Work>
void with_subject(const std::string& subject, const Work& work) {
  try {
    work();
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(subject + " " + error.what());
  }
}

/// A temporary file beside its final place. It is removed unless it is put in place.
class UnfinishedFile {
 public:
  /// For a file that another writer writes, at temporary().
  /// @throws std::runtime_error that says why no file can be put at `path`.
  explicit UnfinishedFile(const std::string& path);
  /// Writes `text` to the temporary file, so that it outlives a loss of power.
  /// @throws std::runtime_error that says why this fails, or why no file can be put at `path`.
  UnfinishedFile(const std::string& path, std::string_view text);
  ~UnfinishedFile();
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;

  const std::string& temporary() const { return temporary_; }
  /// Replaces the file at `path` by the temporary one, so that it outlives a loss of power. Its writer must have closed
  /// it.
  /// @throws std::runtime_error that says why this fails.
  void put_in_place();

 private:
  std::string place_, temporary_;  // final place; the file beside it, empty if there is none
};

}  // namespace flexarm
