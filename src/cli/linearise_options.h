#pragma once
/// Options of `flexarm linearise` for results beyond the model: responses and derivatives.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/scene_input.h"
#include "flexarm/simulation/linear_response.h"
#include "flexarm/simulation/sensitivities.h"

namespace flexarm::cli {

// ---------------------------------------------------------------- responses

struct ResponseOptions {
  std::vector<double> frequencies;   ///< [Hz]
  std::optional<double> step_until;  ///< [s]
  std::string picture;               ///< file of a plot; empty: none
};

/// Declares the options. `options` must outlive the command.
void add_responses(Command& command, ResponseOptions& options);

/// @throws std::runtime_error if a response cannot be computed
LinearResponses responses_of(const LinearModel& model, const ResponseOptions& options);

/// The file beside a picture that contains the plotted numbers.
std::string data_of_picture(const std::string& picture);

// ---------------------------------------------------------------- derivatives of the run to the time of linearisation

struct DerivativeOptions {
  std::vector<std::string> parameters;
  bool by_initial_state = false;
  bool are_wanted() const { return !parameters.empty() || by_initial_state; }
};

/// Declares the options. `time`: the option that they require. `options` must outlive the command.
void add_derivatives(Command& command, DerivativeOptions& options, const std::string& time);

/// Sensitivities of a simulation of `input`, which must be at its start; null if none are requested.
/// @throws InputError that names what cannot be differentiated
std::unique_ptr<Sensitivities> sensitivities_of(Simulation& simulation, const SceneInput& input,
                                                const DerivativeOptions& options);

/// The present derivatives of the model's states and outputs.
/// @throws InputError if an output has no derivatives; std::runtime_error if the sensitivities were lost during the run
RunDerivatives derivatives_of(const Sensitivities& sensitivities, const LinearModel& model,
                              const DerivativeOptions& options);

/// Warns of events at stops and of dry friction during the run that make the derivatives doubtful.
void warn_of_events(const RunDerivatives& run);

/// Prints a row for each output and for each of the first `count` states, with a column for each parameter.
void print_derivatives(const RunDerivatives& run, const LinearModel& model, int count);

}  // namespace flexarm::cli
