// Tests tracks whose range is at a limit of numbers, with a reader after docs/notes/page.md.
#include "pictures/tracks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace flexarm::pictures {
namespace {

constexpr double kGap = std::numeric_limits<double>::quiet_NaN();

double number_at(const std::string& bytes, std::size_t place) {
  double number;
  std::memcpy(&number, bytes.data() + place, sizeof number);
  return number;
}

std::vector<double> read_track(const std::string& bytes, std::size_t count) {
  const double least = number_at(bytes, 0), most = number_at(bytes, 8);
  std::vector<double> out(count, least);
  if (bytes.size() == 16) return out;
  EXPECT_EQ(bytes.size(), 16 + 2 * count);
  std::uint16_t step = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto low = static_cast<unsigned char>(bytes[16 + i]),
               high = static_cast<unsigned char>(bytes[16 + count + i]);
    step = static_cast<std::uint16_t>(step + low + 256 * high);
    out[i] = step == 65535 ? kGap : least + (most - least) * (step / 65534.0);
  }
  return out;
}

/// Each value is read as the nearest of 65535 steps, and `kGap` as a gap.
void expect_kept(const std::vector<double>& values, const std::vector<double>& expected) {
  std::string bytes;
  append_track(values, bytes);
  const std::vector<double> got = read_track(bytes, values.size());
  const double range = number_at(bytes, 8) - number_at(bytes, 0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_EQ(std::isnan(got[i]), std::isnan(expected[i])) << i;
    // Half a step, and the round-off of a step of a large range or of the smallest numbers.
    if (!std::isnan(expected[i])) {
      EXPECT_LE(std::abs(got[i] - expected[i]), range * (0.5 + 1e-9) / 65534 + 5e-324) << i;
    }
  }
}

TEST(Tracks, KeepValuesOfAnyRange) {
  for (const double range : {1.0, 1e-9, 1e-200, 1e-303, 1e-305, 1e-310, 5e-324, 1e300}) {
    expect_kept({0, range, 0.25 * range, range}, {0, range, 0.25 * range, range});
    expect_kept({-range, kGap, range}, {-range, kGap, range});
    expect_kept({range, kGap, range}, {range, kGap, range});
  }
}

TEST(Tracks, CountNumbersWhoseRangeIsNoNumberAsMissing) {
  constexpr double kMost = std::numeric_limits<double>::max(), kInfinity = std::numeric_limits<double>::infinity();
  expect_kept({-kMost, 3, kMost, 4}, {kGap, 3, kGap, 4});
  expect_kept({-kInfinity, 3, kInfinity, 4}, {kGap, 3, kGap, 4});
  expect_kept({-0.5 * kMost, 0, 0.5 * kMost}, {-0.5 * kMost, 0, 0.5 * kMost});
}

TEST(Tracks, OfMeshesKeepVerticesOfAnyRange) {
  for (const double size : {1.0, 1e-310, 1.7e308}) {
    meshes::SurfaceMesh mesh;
    mesh.vertices = {{Vector3(-size, 0, 0), Vector3::UnitZ()}, {Vector3(size, 0, 0), Vector3::UnitZ()}};
    std::string bytes;
    append_mesh(mesh, bytes);
    std::uint16_t parts[6];
    ASSERT_EQ(bytes.size(), 48 + sizeof parts);
    std::memcpy(parts, bytes.data() + 48, sizeof parts);
    EXPECT_EQ(parts[0], 0) << size;
    EXPECT_EQ(parts[3], 65535) << size;
  }
}

}  // namespace
}  // namespace flexarm::pictures
