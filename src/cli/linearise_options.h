#pragma once
/// Options of `flexarm linearise` that ask for more than a model, and what they ask for.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/scene_input.h"
#include "flexarm/simulation/linear_response.h"
#include "flexarm/simulation/sensitivities.h"

namespace flexarm::cli {

// ---------------------------------------------------------------- what the model answers to inputs

struct ResponseOptions {
  std::vector<double> frequencies;   ///< [Hz]
  std::optional<double> step_until;  ///< [s]
  std::string picture;               ///< file; empty: none
};

/// `options` must outlive the command.
void add_responses(Command& command, ResponseOptions& options);

/// @throws std::runtime_error where there is no such response.
LinearResponses responses_of(const LinearModel& model, const ResponseOptions& options);

/// Where the numbers go that a picture is drawn of: beside it.
std::string data_of_picture(const std::string& picture);

// ---------------------------------------------------------------- how the run to its instant changes

struct DerivativeOptions {
  std::vector<std::string> parameters;
  bool by_initial_state = false;
  bool are_wanted() const { return !parameters.empty() || by_initial_state; }
};

/// `time`: an option without which there are none; `options` must outlive the command.
void add_derivatives(Command& command, DerivativeOptions& options, const std::string& time);

/// Of a simulation of that input, at its start.
/// @throws InputError naming what cannot be differentiated.
std::unique_ptr<Sensitivities> sensitivities_of(Simulation& simulation, const SceneInput& input,
                                                const DerivativeOptions& options);

/// Of the states and outputs of a model about now.
/// @throws InputError for outputs that have none; std::runtime_error if they are lost.
RunDerivatives derivatives_of(const Sensitivities& sensitivities, const LinearModel& model,
                              const DerivativeOptions& options);

/// What stops and dry friction did on the way, as far as it makes derivatives doubtful: warnings.
void warn_of_events(const RunDerivatives& run);

/// A row for each output and the first `count` states, a column for each parameter.
void print_derivatives(const RunDerivatives& run, const LinearModel& model, int count);

}  // namespace flexarm::cli
