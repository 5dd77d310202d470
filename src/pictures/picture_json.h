#pragma once
/// Writes pictures as JSON.

#include <string>

#include "pictures/recording.h"

namespace flexarm::pictures {

/// What a page must know of a run besides its picture.
struct RunShape {
  std::size_t instants;
  std::array<std::size_t, kArrowKinds> arrows;  ///< largest number of each kind
  std::vector<Clip> clips;
  int still;           ///< index of an instant; -1: none
  SceneExtent extent;  ///< of what is shown
};

/// The picture as JSON, see docs/notes/page.md. It has no `<`, so that a page can contain it.
std::string picture_as_json(const Picture& picture, const RunShape& run);

}  // namespace flexarm::pictures
