#pragma once
/// Writes numbers that change with time in few bytes: the tracks of docs/notes/page.md.

#include <string>
#include <string_view>
#include <vector>

#include "meshes/surface_mesh.h"

namespace flexarm::pictures {

/// Appends numbers of 64 bits, little-endian.
void append_numbers(const std::vector<double>& numbers, std::string& bytes);
/// Appends a track. Numbers that are not finite, or whose amount is above 8.9e307, count as missing.
void append_track(const std::vector<double>& values, std::string& bytes);
void append_mesh(const meshes::SurfaceMesh& mesh, std::string& bytes);

/// Compresses bytes to a zlib stream.
std::string deflated(std::string_view bytes);
std::string base64(std::string_view bytes);

}  // namespace flexarm::pictures
