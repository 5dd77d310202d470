#pragma once
/// The colours that stand for amounts, in pages, films and rviz.

#include <array>
#include <cstdint>
#include <string>

namespace flexarm::pictures {

/// Colours, 0xRRGGBB, at equal distances, from the least value to the largest one: viridis, whose order and steps the
/// eye sees, also in grey and with colour blindness. Its dark end is left out, since it would vanish on a dark
/// background. (Nathaniel Smith and Stefan van der Walt, matplotlib, 2015, CC0.)
constexpr std::array<std::uint32_t, 8> kColorsOfAmounts = {0x46327e, 0x3b528b, 0x2c728e, 0x21918c,
                                                           0x28ae80, 0x5ec962, 0xaddc30, 0xfde725};
/// The same for values of both signs; 0 is in the middle.
constexpr std::array<std::uint32_t, 7> kColorsOfSignedValues = {0x1f5fc4, 0x5b8fdf, 0x9ab9e6, 0xbfc3c9,
                                                                0xe9ad8c, 0xdd7550, 0xb93a26};

/// Red, green and blue (0 to 1) of an amount, given as a fraction (0 to 1) of the largest one: linear between the
/// colours of kColorsOfAmounts.
std::array<double, 3> color_of_amount(double part);

/// Both scales as JSON: {"amounts": ["#rrggbb", ...], "signed": [...]}.
std::string color_scales_as_json();

}  // namespace flexarm::pictures
