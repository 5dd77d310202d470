#include "cli/response_options.h"

#include <cmath>
#include <filesystem>

#include "cli/scene_input.h"
#include "math/parse_number.h"

namespace flexarm::cli {
namespace {

/// Parts of the time that a step response is written at the ends of.
constexpr int kIntervals = 1000;
constexpr double kMostFrequencies = 1e6;

CLI::ValidationError wrong(const std::string& got) {
  return CLI::ValidationError(
      "--frequencies", "expected numbers > 0, or FROM:TO:COUNT with 0 < FROM < TO and COUNT >= 2, got '" + got + "'");
}

/// "FROM:TO:COUNT"
std::vector<double> range(const std::string& text) {
  const std::string_view view = text;
  const std::size_t first = view.find(':'), second = view.find(':', first + 1);
  if (second == std::string_view::npos) throw wrong(text);
  const auto from = parse_number(view.substr(0, first)), count = parse_number(view.substr(second + 1)),
             to = parse_number(view.substr(first + 1, second - first - 1));
  if (!from || !to || !count || !(0 < *from && *from < *to) || *count < 2 || *count > kMostFrequencies ||
      *count != std::floor(*count))
    throw wrong(text);
  std::vector<double> frequencies;
  const double intervals = *count - 1;
  for (int i = 0; i <= intervals; ++i) frequencies.push_back(*from * std::pow(*to / *from, i / intervals));
  return frequencies;
}

std::vector<double> read_frequencies(const std::vector<std::string>& words) {
  if (words.size() == 1 && words[0].find(':') != std::string::npos) return range(words[0]);
  std::vector<double> frequencies;
  for (const std::string& word : words) {
    const std::optional<double> frequency = parse_number(word);
    if (!frequency || *frequency <= 0) throw wrong(word);
    frequencies.push_back(*frequency);
  }
  return frequencies;
}

}  // namespace

void add_responses(CLI::App& command, ResponseOptions& options) {
  CLI::Option* frequencies =
      command
          .add_option_function<std::vector<std::string>>(
              "--frequencies",
              [&options](const std::vector<std::string>& words) { options.frequencies = read_frequencies(words); },
              "of a frequency response: FROM:TO:COUNT (logarithmic), or a list [Hz]")
          ->delimiter(',');
  command
      .add_option_function<double>(
          "--step-response", [&options](double until) { options.step_until = until; },
          "until this time after an input went from 0 to 1, each by itself [s]")
      ->check(check_positive);
  command.add_option("--plot", options.picture, "file for a Bode picture (.png); its data go beside it (.json)")
      ->needs(frequencies);
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

}  // namespace flexarm::cli
