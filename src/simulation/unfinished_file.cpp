#include "simulation/unfinished_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

namespace flexarm {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& why) {
  throw std::runtime_error("cannot be written: " + why);
}
[[noreturn]] void fail_by_errno() {
  fail(std::strerror(errno));
}

/// The file that will be replaced. If `path` is a symbolic link, it is the file that the link points to.
std::string place_of(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) return path;
  if (!fs::is_regular_file(status)) fail("it is not a regular file");  // a file must not replace it
  const fs::path place = fs::canonical(path, error);
  if (error) fail(error.message());
  if (::access(place.c_str(), W_OK) != 0) fail_by_errno();
  return place.string();
}

class Descriptor {
 public:
  Descriptor(const std::string& path, int flags) : number_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  bool write(std::string_view text) const {
    while (!text.empty()) {
      const ssize_t written = ::write(number_, text.data(), text.size());
      if (written < 0 && errno != EINTR) return false;
      if (written > 0) text.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
  }
  bool synchronise() const { return ::fsync(number_) == 0; }
  bool close() {
    const int number = std::exchange(number_, -1);
    return ::close(number) == 0;
  }
  bool is_open() const { return number_ >= 0; }

 private:
  int number_;
};

}  // namespace

UnfinishedFile::UnfinishedFile(const std::string& path) : place_(place_of(path)), temporary_(place_ + ".partial") {}

UnfinishedFile::UnfinishedFile(const std::string& path, std::string_view text) : UnfinishedFile(path) {
  Descriptor file(temporary_, O_WRONLY | O_CREAT | O_TRUNC);
  if (!file.is_open() || !file.write(text) || !file.synchronise() || !file.close()) fail_by_errno();
}

UnfinishedFile::~UnfinishedFile() {
  if (!temporary_.empty()) std::remove(temporary_.c_str());
}

void UnfinishedFile::put_in_place() {
  const Descriptor file(temporary_, O_RDONLY);
  if (!file.is_open() || !file.synchronise()) fail_by_errno();
  if (std::rename(temporary_.c_str(), place_.c_str()) != 0) fail_by_errno();
  temporary_.clear();
  // Synchronise the folder, so that the new name outlives a loss of power, too. Where that is impossible, it is left to
  // the system.
  const fs::path folder = fs::path(place_).parent_path();
  const Descriptor descriptor(folder.empty() ? "." : folder.string(), O_RDONLY | O_DIRECTORY);
  if (descriptor.is_open()) descriptor.synchronise();
}

}  // namespace flexarm
