#include "pictures/color_scale.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace flexarm::pictures {
namespace {

/// Red (0), green (1) or blue (2) of a colour, from 0 to 1.
double channel(std::uint32_t color, std::size_t which) {
  return static_cast<double>(color >> (16 - 8 * which) & 0xff) / 255;
}

template <class Colors>
std::string json_colors(const Colors& colors) {
  std::string out;
  for (const std::uint32_t color : colors) out += fmt::format("{}\"#{:06x}\"", out.empty() ? "" : ", ", color);
  return "[" + out + "]";
}

}  // namespace

std::array<double, 3> color_of_amount(double part) {
  constexpr std::size_t kLast = kColorsOfAmounts.size() - 1;
  const double along = std::isfinite(part) ? std::clamp(part, 0.0, 1.0) * kLast : 0;
  const auto first = std::min(static_cast<std::size_t>(along), kLast - 1);
  const double rest = along - static_cast<double>(first);
  std::array<double, 3> color{};
  for (std::size_t c = 0; c < color.size(); ++c) {
    const double here = channel(kColorsOfAmounts[first], c);
    color[c] = here + rest * (channel(kColorsOfAmounts[first + 1], c) - here);
  }
  return color;
}

std::string color_scales_as_json() {
  return "{\"amounts\": " + json_colors(kColorsOfAmounts) + ", \"signed\": " + json_colors(kColorsOfSignedValues) + "}";
}

}  // namespace flexarm::pictures
