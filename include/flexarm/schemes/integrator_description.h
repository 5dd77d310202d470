#pragma once
/// The time integration scheme of a scene, its options, and the settings of Newton's method.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flexarm {

/// How section rotations are interpolated inside a beam element (docs/theory.md). All but Local are for study.
enum class Interpolation {
  Local,        ///< rotation vectors relative to a frame that moves with the element: strain-invariant
  Total,        ///< from the undeformed state; nodes turn by less than 2 pi
  Incremental,  ///< from the last step
  Iterative     ///< from the last Newton iterate
};

/// The virtual rotations to which the rows of moments are conjugate.
enum class WeakForm {
  Spin,     ///< spatial spins
  Additive  ///< total rotation vectors: the static tangent is symmetric
};

/// What to do with a step that the scheme cannot do, however often it is halved.
enum class OnFailure {
  Stop,      ///< the step fails
  Dissipate  ///< it is done from its beginning by edmc2, with its own numerical dissipation
};

/// By its name, "stop" or "dissipate"; empty if there is none of that name.
std::optional<OnFailure> on_failure_called(std::string_view name);

/// Largest tolerance of Newton's method; a larger one would accept any guess.
constexpr double kLargestTolerance = 1;
/// Longest step; beyond it the integrals of servos would overflow [s].
constexpr double kLongestStep = 1e9;

///  <integrator>. An empty option stands for the scheme's own value, in parentheses. docs/schemes.md says which scheme
/// takes which option.
struct IntegratorDescription {
  std::string scheme = "auto";                 ///< one of scheme_names()
  std::optional<Interpolation> interpolation;  ///< (local)
  std::optional<WeakForm> weak_form;           ///< (spin)
  std::optional<double> beta, gamma;           ///< of Newmark's rule, > 0 (1/4, 1/2)
  std::optional<double> alpha;                 ///< of Hilber, Hughes and Taylor's, in [-1/3, 0] (-0.05)
  double step = 1e-3;                          ///< [s]
  double tolerance = 1e-8;  ///< on the Newton update, relative to the scene's length and to 1 rad, up to
                            ///< kLargestTolerance
  int max_iterations = 20;
  int max_halvings = 14;
  std::optional<double> rho_infinity;  ///< of numerical dissipation: spectral radius at infinite frequency (0.8)
  OnFailure on_failure = OnFailure::Stop;
  /// For runs that choose their steps (accuracy/accurate_run.h): the error of points, in (0, 1), relative to how far
  /// they move. A simulation by itself does not use it.
  std::optional<double> accuracy;
  bool may_be_planar = true;  ///< where all moves in a plane, steps are taken there; else they are three-dimensional
};

/// Names of the schemes that a scene may ask for, "auto" first.
const std::vector<std::string_view>& scheme_names();

/// An option that the scheme does not have, or whose value it does not take.
struct OptionConflict {
  std::string attribute, message;
};
/// Empty if all options that are set suit the scheme.
std::vector<OptionConflict> option_conflicts(const IntegratorDescription& integrator);

/// The same description with another scheme, without the options that this scheme does not take.
IntegratorDescription with_scheme(IntegratorDescription integrator, const std::string& scheme);

}  // namespace flexarm
