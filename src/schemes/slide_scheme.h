#pragma once
/// Schemes for the sliding contact of a slider over a step, as data.

#include <array>
#include <string>
#include <string_view>

#include "model/slide_line.h"
#include "schemes/scheme.h"

namespace flexarm {

/// A value of <slide scheme="...">: one of the strategies in the thesis (Muñoz 2004, ch. 12; docs/notes/joints.md 4.4).
/// `sme` is SM-EM for beams of scheme std (4.6).
struct SlideScheme {
  std::string_view name;
  std::string_view owner;  ///< the only conserving scheme that supports it; empty: all do
  SlideAlgorithm algorithm;
};

/// All slide schemes; the first is the default.
constexpr std::array<SlideScheme, 6> kSlideSchemes = {{
    {"sm_em", "", {SlideStep::SmEm, SlideStep::SmEm}},
    {"alg1", "m1", {SlideStep::MidContact, SlideStep::EnterEnd}},
    {"alg2", "m2", {SlideStep::BeginWeights, SlideStep::EnterEnd}},
    {"alg3", "m1", {SlideStep::EndContact, SlideStep::EnterEnd}},
    {"alg4", "m1", {SlideStep::MidContact, SlideStep::EnterMid}},
    {"sme", "std", {SlideStep::SmEm, SlideStep::SmEm}},
}};

/// The slide scheme with that name; null if it is unknown.
const SlideScheme* find_slide_scheme(std::string_view name);

/// Why a slide scheme does not suit an integration scheme; empty if it does. The Newmark family accepts all of them,
/// since it ignores this choice and folds sliders by their exact variation.
std::string slide_scheme_conflict(const SlideScheme& slide, const Scheme& scheme);

}  // namespace flexarm
