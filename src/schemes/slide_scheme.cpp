#include "schemes/slide_scheme.h"

#include <algorithm>

#include <fmt/format.h>

namespace flexarm {

const SlideScheme* find_slide_scheme(std::string_view name) {
  const auto found = std::find_if(kSlideSchemes.begin(), kSlideSchemes.end(),
                                  [&](const SlideScheme& slide) { return slide.name == name; });
  return found == kSlideSchemes.end() ? nullptr : &*found;
}

std::string slide_scheme_conflict(const SlideScheme& slide, const Scheme& scheme) {
  if (slide.owner.empty() || slide.owner == scheme.name || !scheme.is_incremental()) return "";
  return fmt::format("slide scheme '{}' belongs to integrator scheme '{}', not to '{}'", slide.name, slide.owner,
                     scheme.name);
}

}  // namespace flexarm
