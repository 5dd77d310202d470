/// libFuzzer's way in: any bytes as a scene.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "fuzz/try_scene.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const flexarm::fuzz::Trial trial = flexarm::fuzz::try_scene({reinterpret_cast<const char*>(data), size}, "fuzz.urdf");
  if (trial.wrong.empty()) return 0;
  std::fprintf(stderr, "%s\n", trial.wrong.c_str());
  std::abort();
}
