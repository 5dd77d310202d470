#pragma once
/// Recognises the small text files that Git has instead of large ones until `git lfs pull` fetches these.

#include <string_view>

namespace flexarm {

constexpr const char* kLfsPointerText = "this is a Git LFS pointer, not the file: 'git lfs pull' fetches it";

/// Whether a file with this beginning is such a pointer.
inline bool is_lfs_pointer(std::string_view beginning) {
  constexpr std::string_view kBeginning = "version https://git-lfs.github.com/spec/";
  return beginning.substr(0, kBeginning.size()) == kBeginning;
}

}  // namespace flexarm
