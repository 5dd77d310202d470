#include <filesystem>

#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/files.h"
#include "cli/installation.h"
#include "cli/linear_table.h"
#include "cli/linearise_options.h"
#include "cli/recording_library.h"
#include "cli/scene_input.h"
#include "flexarm/scene/scene_description.h"
#include "flexarm/simulation/linear_reduction.h"
#include "simulation/step_resolution.h"

namespace flexarm::cli {
namespace {

/// Parts of an eigenvector below this fraction of its largest part are not printed.
constexpr double kVisiblePart = 0.05;
/// Hankel singular values of dropped states below this fraction of the largest one are not printed.
constexpr double kLarge = 1e-6;

struct LineariseArguments {
  SceneInput scene;
  LinearRequest request;
  ResponseOptions responses;
  DerivativeOptions derivatives;
  std::optional<double> time;
  bool is_steady = false, prints_shapes = false;
  Equilibrium wanted = Equilibrium::Stable;
  int count = 20;
  std::optional<int> order;  // of the reduced model; empty: no reduction
  std::string output;
};

std::string kind_of_file(const std::string& path) {
  return std::filesystem::path(path).extension().string();
}

/// Brings the simulation to the state about which it is linearised. Runs the sensitivities along, if there are any.
void go_to_reference(const LineariseArguments& arguments, Simulation& simulation, Sensitivities* sensitivities) {
  if (arguments.time) {
    while (simulation.time() < *arguments.time - 0.5 * simulation.step_size())
      if (const StepResult result = sensitivities ? sensitivities->step() : simulation.step(); !result.converged)
        throw std::runtime_error(
            fmt::format("simulation failed after t = {:.17g} s: {}", simulation.time(), simulation.explain(result)));
    return;
  }
  const StaticResult result = simulation.solve_static(kLoadSteps, arguments.wanted);
  if (result.converged)
    warn_of_instability(simulation, result, arguments.wanted);
  else
    fmt::print(stderr, "flexarm: {}; the model is that of the initial configuration\n",
               lack_of_equilibrium(simulation, result));
}

void print_poles(const LinearModel& model, const LineariseArguments& arguments) {
  fmt::print("{} states, {} inputs, {} outputs\n", model.states.size(), model.inputs.size(), model.outputs.size());
  fmt::print("{:>14} {:>14} {:>14} {:>14}  {}\n", "frequency [Hz]", "damping ratio", "real [1/s]", "imaginary", "most");
  int count = 0;
  for (const Pole& pole : poles(model)) {
    if (count++ == arguments.count) break;
    fmt::print("{:>14.7g} {:>14.4g} {:>14.7g} {:>14.7g}  {}\n", pole.frequency(), pole.damping_ratio(),
               pole.value.real(), pole.value.imag(), model.states[pole.state]);
    for (Eigen::Index i = 0; arguments.prints_shapes && i < model.positions; ++i)
      if (std::abs(pole.mode[i]) > kVisiblePart)
        fmt::print("    {:<32} {:>10.4f} {:>+10.4f}i\n", model.states[i], pole.mode[i].real(), pole.mode[i].imag());
  }
}

void print_reduction(const ReducedModel& reduced, int order) {
  fmt::print("{} states, {} of them for poles that do not decay\n", reduced.model.states.size(), reduced.kept);
  if (static_cast<std::size_t>(order) > reduced.model.states.size())
    fmt::print("the other states are not excited by inputs, or not visible in outputs\n");
  const Eigen::VectorXd& values = reduced.hankel_singular_values;
  const Eigen::Index balanced = static_cast<Eigen::Index>(reduced.model.states.size()) - reduced.kept;
  fmt::print("Hankel singular values:");
  for (Eigen::Index i = 0; i < values.size() && (i <= balanced || values[i] > kLarge * values[0]); ++i) {
    if (i == balanced) fmt::print("; left out:");
    fmt::print(" {:.4g}", values[i]);
  }
  fmt::print("\ngains have an error of at most {:.4g}\n", 2 * values.tail(values.size() - balanced).sum());
}

/// The linear model, with everything that the arguments request.
LinearModel model_of(const Simulation& simulation, const LineariseArguments& arguments) {
  try {
    LinearModel model = linearise(simulation, arguments.request);
    for (const std::string& effect : model.left_out) fmt::print(stderr, "flexarm: warning: left out: {}\n", effect);
    if (const std::string doubt = arguments.time ? doubt_about_instant(simulation, model) : ""; !doubt.empty())
      fmt::print(stderr, "flexarm: warning: {}\n", doubt);
    if (!arguments.order) return model;
    ReducedModel reduced = flexarm::reduced(model, *arguments.order);
    if (!is_standard_output(arguments.output)) print_reduction(reduced, *arguments.order);
    return std::move(reduced.model);
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("flexarm: {}", error.what()));
  }
}

std::string csv_of(const LinearModel& model, const LinearResponses& responses) {
  if (!responses.frequency.frequencies.empty()) return frequency_response_as_csv(model, responses.frequency);
  if (!responses.step.times.empty()) return step_response_as_csv(model, responses.step);
  return linear_model_as_csv(model, responses.derivatives);
}

void write_model(const std::string& path, const std::string& scene, const LinearModel& model,
                 const LinearResponses& responses) {
  if (path.empty()) return;
  const std::string kind = kind_of_file(path);
  if (kind == ".mat") return recording_library().mat(path, scene, model, responses);
  const std::string text = kind == ".csv" ? csv_of(model, responses) : linear_model_as_json(scene, model, responses);
  if (is_standard_output(path))
    fmt::print("{}", text);
  else
    write_file(path, text);
}

void draw_picture(const std::string& picture, const std::string& scene, const LinearModel& model,
                  const LinearResponses& responses) {
  if (picture.empty()) return;
  const std::string data = data_of_picture(picture);
  write_model(data, scene, model, responses);
  if (!draw("plot_bode.py", data, picture))
    throw std::runtime_error("no picture was made, since that needs python3-matplotlib; the data are in '" + data +
                             "'");
}

void check_files(const LineariseArguments& arguments) {
  const auto& [frequencies, step_until, picture] = arguments.responses;
  if (kind_of_file(arguments.output) == ".csv" && !frequencies.empty() && step_until)
    throw InputError(
        "flexarm: --output: a .csv file can have one table only: expected .mat or .json for both responses");
  refuse_overwriting("--output", arguments.output, arguments.scene.path);
  require_writable("--output", arguments.output);
  if (picture.empty()) return;
  for (const std::string& file : {picture, data_of_picture(picture)}) {
    refuse_overwriting("--plot", file, arguments.scene.path);
    require_writable("--plot", file);
  }
}

int linearise_scene(LineariseArguments arguments) {
  check_files(arguments);
  Simulation simulation = load_simulation(arguments.scene);
  const std::unique_ptr<Sensitivities> sensitivities =
      sensitivities_of(simulation, arguments.scene, arguments.derivatives);
  go_to_reference(arguments, simulation, sensitivities.get());
  if (arguments.time) arguments.request.about = LinearisedAbout::Instant;
  if (arguments.is_steady) arguments.request.about = LinearisedAbout::Steady;
  const LinearModel model = model_of(simulation, arguments);
  LinearResponses responses = responses_of(model, arguments.responses);
  if (sensitivities) {
    responses.derivatives = derivatives_of(*sensitivities, model, arguments.derivatives);
    warn_of_events(responses.derivatives);
  }
  write_model(arguments.output, simulation.scene().name, model, responses);
  draw_picture(arguments.responses.picture, simulation.scene().name, model, responses);
  if (is_standard_output(arguments.output)) return kDone;
  print_poles(model, arguments);
  print_derivatives(responses.derivatives, model, arguments.count);
  return kDone;
}

std::string check_file(const std::string& path) {
  const std::string kind = kind_of_file(path);
  if (is_standard_output(path) || kind == ".mat" || kind == ".json" || kind == ".csv") return "";
  return "must end with .mat, .json or .csv, or be - (JSON), got '" + path + "'";
}

}  // namespace

void add_linearise(CommandLine& line) {
  const auto arguments = std::make_shared<LineariseArguments>();
  Command& command = line.command("linearise", "Linear model (A, B, C, D) about the equilibrium, with its poles");
  add_scene(command, arguments->scene);
  command.heading("Reference motion");
  add_equilibrium(command, arguments->wanted);
  command
      .option("--time", arguments->time,
              "about the motion of a simulation at this time, instead of the equilibrium [s]")
      .check(check_non_negative);
  command.flag("--steady", arguments->is_steady, "about a steady motion with the velocities of <motion>s at t = 0")
      .excludes("--time");
  command.heading("The model");
  command
      .option("--inputs", arguments->request.inputs,
              "effort:JOINT, motion:JOINT (acceleration), wrench:POINT:fx; all efforts by default")
      .with_commas();
  command
      .option("--outputs", arguments->request.outputs,
              "position:, velocity: or acceleration: with JOINT, POINT or POINT:x; effort:JOINT of a <motion>; "
              "strain:SENSOR, section_force:SENSOR; positions of all joints and probes by default")
      .with_commas();
  command
      .option("--reduce", arguments->order,
              "reduces the model to this number of states, by balanced truncation of the decaying part")
      .check(whole_number_between(0, 100000))
      .excludes("--sensitivities")
      .excludes("--transition");
  add_derivatives(command, arguments->derivatives, "--time");
  command.heading("Output");
  command.option("--count", arguments->count, "number of poles to print")
      .shows_default()
      .check(whole_number_between(0, 100000));
  command.flag("--shapes", arguments->prints_shapes, "prints the mode of each pole");
  command
      .option("-o,--output", arguments->output,
              "file: .mat (MATLAB), .json or .csv (the matrices, or a response); -: JSON to standard output")
      .shown_as("FILE")
      .check(check_file);
  add_responses(command, arguments->responses);
  command.runs([arguments] { return linearise_scene(*arguments); });
}

}  // namespace flexarm::cli
