#include "simulation/failure_text.h"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flexarm {
namespace {

using Failure = StepResult::Failure;
using Reason = StepResult::Reason;

/// The size of what failed, with its unit.
std::string amount_text(const Failure& failure) {
  switch (failure.quantity) {
    case Failure::Quantity::None:
      return "";
    case Failure::Quantity::Force:
      if (!std::isfinite(failure.amount)) return "a force";
      return fmt::format("{:.3g} N not in balance", failure.amount);
    case Failure::Quantity::Moment:
      if (!std::isfinite(failure.amount)) return "a moment";
      return fmt::format("{:.3g} N m not in balance", failure.amount);
    case Failure::Quantity::Rotation:
      return fmt::format("{:.3g} rad in {:.3g} s", failure.amount, failure.step);
    case Failure::Quantity::Bending:
      return fmt::format("{:.3g} rad", failure.amount);
  }
  return "";
}

/// "amount at place"; one or both parts may be missing.
std::string place_and_amount(const Model& model, const Failure& failure) {
  const std::string name = place_name(model, failure.place);
  std::string amount = amount_text(failure);
  if (name.empty()) return amount;
  const Vector3& r = failure.place.position;
  return fmt::format("{}at {} at ({:.4g}, {:.4g}, {:.4g}) m", amount.empty() ? "" : amount + " ", name, r.x(), r.y(),
                     r.z());
}

/// Number of elements that the scene gives the beam, however they are halved now.
int element_count(const BeamLink& beam) {
  return beam.parts.back().element + 1;
}

std::string advice(const Model& model, const StepResult& result) {
  const Failure& failure = result.failure;
  switch (result.reason) {
    case Reason::None:
      return "";
    case Reason::NoConvergence:
      return failure.place.element >= 0
                 ? "a finer mesh of that link, a smaller step, numerical dissipation (rho_infinity)"
                 : "a smaller step, damping of the parts that move there, a <motion> that the mechanism can follow";
    case Reason::SingularTangent:
      return "inertia or stiffness for the parts that move there (an <inertial>, a spring), a start away from dead "
             "points; "
             "see flexarm check";
    case Reason::NotFinite:
      if (failure.place.force_element >= 0)
        return "a finite function of time; for a line: guides outside the rims of its pulleys, and a rest length above "
               "0; for a cylinder: oil in both chambers";
      return "finite loads, efforts and motions: look at their functions of time and at commands";
    case Reason::RotationTooLarge:
      // The failed sub-step turns by `amount`. Suggest the length of one that turns by half a radian.
      return fmt::format(
          "a smaller step (such as {:.1g} s), or less effort, more damping or a <limit> for the part that turns there",
          failure.amount > 0 ? 0.5 * failure.step / failure.amount : failure.step);
    case Reason::OffTheLine:
      return "a smaller step, a longer line, or an end where the slider stops or leaves (on_end)";
    case Reason::DrivenOffTheLine:
      return "a <motion> that stays on the line, or a longer line";
    case Reason::OpenLoop:
      return "a start at which the loop is not at a dead point, and motions within its reach";
    case Reason::DeadPoint:
      return "motions within the loop's reach, other lengths of its links, or a compliant joint";
    case Reason::NeverRests:
      return "a <motion>, a stop or a load that holds the moving parts";
    case Reason::HitTooFast:
    case Reason::EventWithin:
      return "a smaller step, or more halvings (max_halvings)";
    case Reason::OutOfTime:
      return "continuing from here, which takes as much time again, a smaller step, or a longer recovery_wall_time";
    case Reason::BentTooFar:
      return bending_advice(*model.links[failure.place.link].beam);
  }
  return "";
}

/// @throws std::invalid_argument if the model does not have the place
void require_place(const Model& model, const StepResult& result) {
  const StepResult::Place& place = result.failure.place;
  const auto is_below = [](int index, std::size_t count) { return index < static_cast<int>(count); };
  const bool is_here = is_below(place.coordinate, model.coordinates.size()) &&
                       is_below(place.loop, model.closures.size()) && is_below(place.link, model.links.size()) &&
                       is_below(place.force_element, model.force_elements.size());
  const bool needs_element = place.element >= 0 || result.reason == StepResult::Reason::BentTooFar;
  if (!is_here || (needs_element && (place.link < 0 || !model.links[place.link].beam)))
    throw std::invalid_argument("result: its place is not in this scene; call explain() of the simulation that failed");
}

}  // namespace

std::string bending_advice(const BeamLink& beam) {
  return fmt::format("a finer mesh of that link: {} elements or more{}", 2 * element_count(beam),
                     beam.order == 2 && !beam.refines ? ", or refine=\"true\" of its <beam>" : "");
}

std::string place_name(const Model& model, const StepResult::Place& place) {
  if (place.coordinate >= 0) return fmt::format("joint coordinate '{}'", model.coordinates[place.coordinate].name);
  if (place.loop >= 0) return fmt::format("loop joint '{}'", model.closures[place.loop].name);
  if (place.force_element >= 0) {
    const ForceElement& element = *model.force_elements[place.force_element];
    const std::vector<std::string> links = element.links();
    if (!element.name().empty()) return fmt::format("<{}> '{}'", element.kind(), element.name());
    return fmt::format("a <{}>{}", element.kind(), links.empty() ? "" : fmt::format(" of {}", fmt::join(links, ", ")));
  }
  if (place.link < 0) return "";
  const LinkFrame& link = model.links[place.link];
  if (place.element < 0) return fmt::format("link '{}'", link.name);
  return fmt::format("element {} of {} of link '{}'", place.element + 1, element_count(*link.beam), link.name);
}

std::string growth_text(const Model& model, const ExplicitLimit& limit) {
  return fmt::format("{} of joint coordinate '{}' needs steps below {:.2g} s", limit.cause,
                     model.coordinates[limit.coordinate].name, limit.step);
}

std::string failure_text(const Model& model, const StepSettings& settings, const StepResult& result,
                         const ExplicitLimit& limit) {
  if (result.reason == Reason::None) return "";
  require_place(model, result);
  const Failure& failure = result.failure;
  std::string text = to_string(result.reason);
  const bool is_too_long = limit.step < settings.step;
  if (is_too_long)
    text = fmt::format("the step is too long for an explicit scheme, so that the motion grows ({}): {}", text,
                       growth_text(model, limit));
  if (failure.cause != result.reason && failure.cause != Reason::None)
    text += fmt::format(" ({})", to_string(failure.cause));
  const std::string place = place_and_amount(model, failure);
  if (!place.empty()) text += ": " + place;
  text += fmt::format(
      ". Tried from t = {:.6g} s: steps down to {:.3g} s ({} halvings, step {:.3g} s), {} guesses, {} iterations",
      failure.time, failure.step, result.halvings, settings.step, failure.guesses, result.iterations);
  if (failure.tried_dissipation) text += ", then edmc2 (on_failure)";
  return text + ". What usually helps: " +
         (is_too_long ? "such a step, or an implicit scheme, such as em" : advice(model, result));
}

}  // namespace flexarm
