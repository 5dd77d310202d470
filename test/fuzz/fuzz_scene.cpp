/// Entry point of libFuzzer: tries any bytes as the text of a scene.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "fuzz/try_scene.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

constexpr std::size_t kLongestValue = 256;
constexpr flexarm::fuzz::Limits kLimits{300, 3};

/// Changes the value of the next attribute after `place` in the text. A well-formed text stays well-formed.
void change_value(std::string& text, std::size_t place) {
  const std::size_t attribute = text.find("=\"", place);
  if (attribute == std::string::npos) return;
  const std::size_t begin = attribute + 2, end = text.find('"', begin);
  if (end == std::string::npos || end - begin > kLongestValue) return;
  std::string value = text.substr(begin, end - begin);
  const std::size_t old_size = value.size();
  value.resize(kLongestValue);
  value.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(value.data()), old_size, kLongestValue));
  const auto breaks = [](unsigned char c) { return c < ' ' || c > '~' || std::strchr("\"<&", c) != nullptr; };
  std::replace_if(value.begin(), value.end(), breaks, '0');
  text.replace(begin, end - begin, value);
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned int seed) {
  if (seed % 4 == 0 || size == 0) return LLVMFuzzerMutate(data, size, max_size);
  std::string text(reinterpret_cast<const char*>(data), size);
  change_value(text, seed / 4 % size);
  const std::size_t changed = std::min(text.size(), max_size);
  std::memcpy(data, text.data(), changed);
  return changed;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const flexarm::fuzz::Trial trial =
      flexarm::fuzz::try_scene({reinterpret_cast<const char*>(data), size}, "fuzz.urdf", kLimits);
  if (trial.wrong.empty()) return 0;
  std::fprintf(stderr, "fuzz_scene: %s\n", trial.wrong.c_str());
  std::abort();
}
