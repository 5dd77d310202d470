#pragma once
/// The time integration scheme of a scene, its options, and the settings of Newton's method.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flexarm {

/// How the rotations of sections are interpolated within a beam element (docs/theory.md). Only Local is for general
/// use, the others are for study.
enum class Interpolation {
  Local,        ///< rotation vectors relative to a frame that moves with the element: invariant under rigid motion
  Total,        ///< rotation vectors from the undeformed state; nodes may turn by less than 2 pi
  Incremental,  ///< rotation vectors from the last step
  Iterative     ///< rotation vectors from the last Newton iterate
};

/// The virtual rotations that the moment residuals are conjugate to.
enum class WeakForm {
  Spin,     ///< spatial spins
  Additive  ///< variations of total rotation vectors; the static tangent is then symmetric
};

/// What to do if the scheme fails in a step, however often the step is halved.
enum class OnFailure {
  Stop,      ///< the step fails
  Dissipate  ///< the scheme edmc2, which has numerical dissipation, does the whole step
};

/// The value with that name, "stop" or "dissipate"; empty for any other name.
std::optional<OnFailure> on_failure_called(std::string_view name);

/// Largest tolerance of Newton's method. With a larger one, any initial guess would count as converged.
constexpr double kLargestTolerance = 1;
/// Longest step [s]. With longer ones the integrals of servos would overflow.
constexpr double kLongestStep = 1e9;

/// The element <integrator>. If an option is empty, the scheme's default applies, in parentheses below. docs/schemes.md
/// says which options each scheme has.
struct IntegratorDescription {
  std::string scheme = "auto";                 ///< one of scheme_names()
  std::optional<Interpolation> interpolation;  ///< (local)
  std::optional<WeakForm> weak_form;           ///< (spin)
  std::optional<double> beta, gamma;           ///< parameters of Newmark's method, > 0 (1/4, 1/2)
  std::optional<double> alpha;                 ///< parameter of the HHT method, in [-1/3, 0] (-0.05)
  double step = 1e-3;                          ///< [s]
  /// Tolerance of the Newton update, relative to the scene's length and to 1 rad; at most kLargestTolerance.
  double tolerance = 1e-8;
  int max_iterations = 20;
  int max_halvings = 14;
  std::optional<double> rho_infinity;  ///< numerical dissipation: spectral radius at infinite frequency (0.8)
  OnFailure on_failure = OnFailure::Stop;
  /// For runs that choose their steps (accuracy/accurate_run.h): allowed error of positions, in (0, 1), relative to the
  /// displacements. A simulation by itself ignores it.
  std::optional<double> accuracy;
  bool may_be_planar = true;  ///< use two-dimensional steps if everything moves in a plane; false: never
};

/// Names of all schemes that a scene can use; "auto" is the first.
const std::vector<std::string_view>& scheme_names();

/// An option that the scheme does not have, or a value that it does not accept.
struct OptionConflict {
  std::string attribute, message;
};
/// Conflicts between the scheme and the options that are set. Empty if there are none.
std::vector<OptionConflict> option_conflicts(const IntegratorDescription& integrator);

/// Returns the description with another scheme, without the options that the new scheme does not have.
IntegratorDescription with_scheme(IntegratorDescription integrator, const std::string& scheme);

}  // namespace flexarm
