/// Tests elements="auto": the number of elements is sufficient for the first four bending frequencies.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "building/beam_mesh.h"
#include "reference_plane_scene.h"
#include "simulation/inside.h"

namespace flexarm::test {
namespace {

constexpr double kFrequencyAccuracy = 0.01;

/// Largest relative error of the first four clamped-free and pinned-pinned frequencies.
double largest_frequency_error(int elements, int order) {
  PlaneBeam beam;
  beam.rotary_inertia = beam.shear_compliance = 1e-5;
  double largest = 0;
  for (const EndCondition& root : {kClamped, kPinned}) {
    const EndCondition tip = root.rotates ? kPinned : kFree;
    const std::vector<double> computed = computed_frequencies(beam, root, tip, elements, order, 4);
    const std::vector<double> exact = exact_frequencies(beam, root, tip, 4);
    for (int k = 0; k < 4; ++k) largest = std::max(largest, std::abs(computed[k] / exact[k] - 1));
  }
  return largest;
}

TEST(AutomaticMesh, HasTheFewestElementsForFourFrequenciesWithinOnePercent) {
  for (int order = 1; order <= 4; ++order) {
    const int elements = automatic_element_count(order, 0);
    EXPECT_LT(largest_frequency_error(elements, order), kFrequencyAccuracy) << "order " << order;
    EXPECT_GT(largest_frequency_error(elements - 1, order), kFrequencyAccuracy) << "order " << order;
  }
}

TEST(AutomaticMesh, IsUsedWhereTheSceneGivesNoNumberOfElements) {
  PlaneBeam beam;
  beam.rotary_inertia = beam.shear_compliance = 1e-5;
  for (int order = 1; order <= 4; ++order) {
    SceneBuilder builder = plane_scene(beam, kClamped, kFree, 1, order);
    builder.scene.links.back().beam->elements.reset();
    const int elements = automatic_element_count(order, 0);
    EXPECT_EQ(model_of(Simulation(builder.scene)).links[1].beam->elements.size(), std::size_t(elements));
    EXPECT_EQ(Simulation(builder.scene).degrees_of_freedom(), std::size_t(6 * order * elements));
  }
}

}  // namespace
}  // namespace flexarm::test
