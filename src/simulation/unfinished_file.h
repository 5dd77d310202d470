#pragma once
/// Writes files as a whole: on failure the file of before stays.

#include <string>
#include <string_view>

namespace flexarm {

/// A file beside the place that it is for, which is removed again unless it is put there.
class UnfinishedFile {
 public:
  /// Others write it, at temporary().
  /// @throws std::runtime_error saying why nothing can be put at `path`.
  explicit UnfinishedFile(const std::string& path);
  /// Writes `text` to where it outlives a loss of power.
  /// @throws std::runtime_error saying why that cannot be, or why nothing can be put at `path`.
  UnfinishedFile(const std::string& path, std::string_view text);
  ~UnfinishedFile();
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;

  const std::string& temporary() const { return temporary_; }
  /// In the place of what is at `path`, where it outlives a loss of power; who wrote it has closed it.
  /// @throws std::runtime_error saying why that cannot be.
  void put_in_place();

 private:
  std::string place_, temporary_;  // the one to be replaced, and that beside it; empty: there is none any more
};

}  // namespace flexarm
