#include "cli/linearise_options.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include <fmt/format.h>

#include "cli/commands.h"
#include "math/number_text.h"

namespace flexarm::cli {

// ---------------------------------------------------------------- responses

namespace {

/// Number of intervals between the times at which a step response is written.
constexpr int kIntervals = 1000;
constexpr double kMostFrequencies = 1e6;

std::string wrong(const std::string& got) {
  return "expected numbers > 0, or FROM:TO:COUNT with 0 < FROM < TO and COUNT >= 2, got '" + got + "'";
}

/// Reads "FROM:TO:COUNT". @returns what is wrong with it, or ""
std::string read_range(const std::string& text, std::vector<double>& frequencies) {
  const std::string_view view = text;
  const std::size_t first = view.find(':'), second = view.find(':', first + 1);
  if (second == std::string_view::npos) return wrong(text);
  const auto from = parse_number(view.substr(0, first)), count = parse_number(view.substr(second + 1)),
             to = parse_number(view.substr(first + 1, second - first - 1));
  if (!from || !to || !count || !(0 < *from && *from < *to) || *count < 2 || *count > kMostFrequencies ||
      *count != std::floor(*count))
    return wrong(text);
  const double intervals = *count - 1;
  for (int i = 0; i <= intervals; ++i) frequencies.push_back(*from * std::pow(*to / *from, i / intervals));
  return "";
}

std::string read_frequencies(const Words& words, std::vector<double>& frequencies) {
  if (words.size() == 1 && words[0].find(':') != std::string::npos) return read_range(words[0], frequencies);
  for (const std::string& word : words) {
    const std::optional<double> frequency = parse_number(word);
    if (!frequency || *frequency <= 0) return wrong(word);
    frequencies.push_back(*frequency);
  }
  return "";
}

}  // namespace

void add_responses(Command& command, ResponseOptions& options) {
  command.heading("Responses");
  command
      .option_of_words(
          "--frequencies", [&options](const Words& words) { return read_frequencies(words, options.frequencies); },
          "frequencies of a frequency response: FROM:TO:COUNT (logarithmic), or a list [Hz]")
      .shown_as("NUMBER")
      .with_commas();
  command.option("--step-response", options.step_until, "step responses up to this time, one input after the other [s]")
      .check(check_positive);
  command.option("--plot", options.picture, "file for a Bode picture (.png); its data go beside it (.json)")
      .shown_as("FILE")
      .needs("--frequencies");
}

LinearResponses responses_of(const LinearModel& model, const ResponseOptions& options) {
  LinearResponses responses;
  responses.frequency = frequency_response(model, options.frequencies);
  if (options.step_until) responses.step = step_response(model, *options.step_until, kIntervals);
  return responses;
}

std::string data_of_picture(const std::string& picture) {
  return std::filesystem::path(picture).replace_extension(".json").string();
}

// ---------------------------------------------------------------- derivatives of the run to the time of linearisation

namespace {

/// Most warnings of doubtful events that are printed.
constexpr int kMostWarnings = 10;

}  // namespace

void add_derivatives(Command& command, DerivativeOptions& options, const std::string& time) {
  command
      .option("--sensitivities", options.parameters,
              "derivatives of the states and outputs at --time with respect to these parameters of the scene")
      .with_commas()
      .needs(time);
  command
      .flag("--transition", options.by_initial_state,
            "derivatives of the states at --time with respect to those of the start")
      .needs(time);
}

std::unique_ptr<Sensitivities> sensitivities_of(Simulation& simulation, const SceneInput& input,
                                                const DerivativeOptions& options) {
  if (!options.are_wanted()) return nullptr;
  SensitivityRequest request;
  request.parameters = options.parameters;
  request.initial_state = options.by_initial_state;
  request.read = [input](const std::string& parameter, double value) {
    scene::ReadOptions others = input.options;
    others.parameters[parameter] = value;
    return scene::read_scene_file(input.path, others);
  };
  try {
    return std::make_unique<Sensitivities>(simulation, request);
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("flexarm: --sensitivities: {}", error.what()));
  }
}

RunDerivatives derivatives_of(const Sensitivities& sensitivities, const LinearModel& model,
                              const DerivativeOptions& options) {
  if (!sensitivities.lost().empty()) throw std::runtime_error("no sensitivities: " + sensitivities.lost());
  RunDerivatives run;
  run.events = sensitivities.events();
  const Eigen::MatrixXd states = sensitivities.states();
  const Eigen::Index count = static_cast<Eigen::Index>(options.parameters.size());
  run.parameters = options.parameters;
  run.states = states.leftCols(count);
  try {
    if (count > 0) run.outputs = sensitivities.outputs(model.outputs).leftCols(count);
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("flexarm: {}", error.what()));
  }
  run.initial_states.assign(sensitivities.directions().begin() + count, sensitivities.directions().end());
  run.transition = states.rightCols(states.cols() - count);
  return run;
}

void warn_of_events(const RunDerivatives& run) {
  int hidden = 0, shown = 0;
  for (const RunEvent& event : run.events) {
    if (event.doubt.empty()) continue;
    if (++shown > kMostWarnings)
      ++hidden;
    else
      fmt::print(stderr, "flexarm: warning: sensitivities after t = {:.9g} s are doubtful: '{}' {}: {}\n", event.time,
                 event.joint, event.what, event.doubt);
  }
  if (hidden > 0) fmt::print(stderr, "flexarm: warning: and {} more such events\n", hidden);
}

void print_derivatives(const RunDerivatives& run, const LinearModel& model, int count) {
  if (run.parameters.empty()) return;
  fmt::print("derivatives with respect to parameters\n{:<32}", "");
  for (const std::string& name : run.parameters) fmt::print(" {:>14}", name);
  fmt::print("\n");
  const auto print = [](const std::string& name, const Eigen::RowVectorXd& row) {
    fmt::print("{:<32}", name);
    for (Eigen::Index i = 0; i < row.size(); ++i) fmt::print(" {:>14.7g}", row[i]);
    fmt::print("\n");
  };
  for (std::size_t i = 0; i < model.outputs.size(); ++i)
    print(model.outputs[i], run.outputs.row(static_cast<Eigen::Index>(i)));
  const Eigen::Index shown = std::min<Eigen::Index>(run.states.rows(), count);
  for (Eigen::Index i = 0; i < shown; ++i)
    print("state " + model.states[static_cast<std::size_t>(i)], run.states.row(i));
}

}  // namespace flexarm::cli
