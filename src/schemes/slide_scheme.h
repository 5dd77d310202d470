#pragma once
/// The ways to carry the contact of a slider over a step, as data.

#include <array>
#include <string>
#include <string_view>

#include "model/slide_line.h"
#include "schemes/scheme.h"

namespace flexarm {

/// A value of <slide scheme="...">: one of the thesis's strategies (Muñoz 2004, ch. 12; joints.md 4.4). `sme` is SM-EM
/// on beams of scheme std (4.6).
struct SlideScheme {
  std::string_view name;
  std::string_view owner;  ///< the only conserving scheme that it goes with; empty: all
  SlideAlgorithm algorithm;
};

/// The default first.
constexpr std::array<SlideScheme, 6> kSlideSchemes = {{
    {"sm_em", "", {SlideStep::SmEm, SlideStep::SmEm}},
    {"alg1", "m1", {SlideStep::MidContact, SlideStep::EnterEnd}},
    {"alg2", "m2", {SlideStep::BeginWeights, SlideStep::EnterEnd}},
    {"alg3", "m1", {SlideStep::EndContact, SlideStep::EnterEnd}},
    {"alg4", "m1", {SlideStep::MidContact, SlideStep::EnterMid}},
    {"sme", "std", {SlideStep::SmEm, SlideStep::SmEm}},
}};

/// By name; null if unknown.
const SlideScheme* find_slide_scheme(std::string_view name);

/// Why it does not go with an integration scheme; empty if it does. The Newmark family folds sliders by their exact
/// variation, whatever this says.
std::string slide_scheme_conflict(const SlideScheme& slide, const Scheme& scheme);

}  // namespace flexarm
