#pragma once
/// How results name the scene that they belong to, so that they can be shown without it being named again.

#include <string>

namespace flexarm::recording {

struct SceneOrigin {
  std::string path;     ///< of the scene's file, absolute
  std::string options;  ///< with which `flexarm` has read it, as a shell's words: "--set=mass=4 --start=clamp"
};

}  // namespace flexarm::recording
