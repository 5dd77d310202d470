#pragma once
/// Options of `flexarm linearise` that ask what a model answers to inputs.

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "flexarm/simulation/linear_response.h"

namespace flexarm::cli {

struct ResponseOptions {
  std::vector<double> frequencies;   ///< [Hz]
  std::optional<double> step_until;  ///< [s]
  std::string picture;               ///< file; empty: none
};

/// `options` must outlive the command.
void add_responses(CLI::App& command, ResponseOptions& options);

/// @throws std::runtime_error where there is no such response.
LinearResponses responses_of(const LinearModel& model, const ResponseOptions& options);

/// Where the numbers go that a picture is drawn of: beside it.
std::string data_of_picture(const std::string& picture);

}  // namespace flexarm::cli
