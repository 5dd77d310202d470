#include "pictures/tracks.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <stdexcept>

#include <zlib.h>

namespace flexarm::pictures {
namespace {

/// Steps of the scale of a track; the number after the last one stands for a missing value.
constexpr int kSteps = 65534;
constexpr std::uint16_t kMissing = 65535;

template <class Number>
void append_bits(Number number, std::string& bytes) {
  for (std::size_t i = 0; i < sizeof number; ++i) bytes += static_cast<char>(number >> (8 * i) & 0xff);
}

/// Whether a track may contain a value: its range must be a number, too.
bool is_shown(double value) {
  return std::abs(value) <= 0.5 * std::numeric_limits<double>::max();
}

void append_number(double number, std::string& bytes) {
  std::uint64_t bits;
  std::memcpy(&bits, &number, sizeof bits);
  append_bits(bits, bytes);
}

}  // namespace

void append_numbers(const std::vector<double>& numbers, std::string& bytes) {
  for (const double number : numbers) append_number(number, bytes);
}

void append_track(const std::vector<double>& values, std::string& bytes) {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  bool has_gaps = false;
  for (const double value : values) {
    if (!is_shown(value))
      has_gaps = true;
    else
      least = std::min(least, value), most = std::max(most, value);
  }
  if (least > most) least = most = std::numeric_limits<double>::quiet_NaN();
  // A constant with gaps needs a scale, too.
  if (has_gaps && least == most) most = least + std::max(1e-9, 1e-9 * std::abs(least));
  append_number(least, bytes);
  append_number(most, bytes);
  if (!(most > least)) return;
  std::string high;
  std::uint16_t last = 0;
  const double range = most - least;  // may be so small that its reciprocal is not finite
  for (const double value : values) {
    const std::uint16_t step =
        is_shown(value) ? static_cast<std::uint16_t>(std::round(kSteps * ((value - least) / range))) : kMissing;
    const auto difference = static_cast<std::uint16_t>(step - last);
    bytes += static_cast<char>(difference & 0xff);
    high += static_cast<char>(difference >> 8);
    last = step;
  }
  bytes += high;
}

void append_mesh(const meshes::SurfaceMesh& mesh, std::string& bytes) {
  Vector3 least = Vector3::Constant(std::numeric_limits<double>::infinity()), most = -least;
  for (const auto& vertex : mesh.vertices) {
    least = least.cwiseMin(vertex.position);
    most = most.cwiseMax(vertex.position);
  }
  for (const Vector3& corner : {least, most})
    for (int i = 0; i < 3; ++i) append_number(corner[i], bytes);
  for (const auto& vertex : mesh.vertices)
    for (int i = 0; i < 3; ++i) {
      const double half = 0.5 * most[i] - 0.5 * least[i];  // the whole may not be finite
      const double part = half > 0 ? (0.5 * vertex.position[i] - 0.5 * least[i]) / half : 0;
      append_bits(static_cast<std::uint16_t>(std::round(65535 * part)), bytes);
    }
  for (const auto& triangle : mesh.triangles)
    for (const int vertex : triangle) append_bits(static_cast<std::uint32_t>(vertex), bytes);
}

std::string deflated(std::string_view bytes) {
  uLongf size = compressBound(bytes.size());
  std::string out(size, '\0');
  const int status = compress2(reinterpret_cast<Bytef*>(out.data()), &size,
                               reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), Z_DEFAULT_COMPRESSION);
  if (status != Z_OK) throw std::runtime_error("a run of this size cannot be compressed");
  out.resize(size);
  return out;
}

std::string base64(std::string_view bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) out += i + k <= bytes.size() ? kDigits[group >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

}  // namespace flexarm::pictures
