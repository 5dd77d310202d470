#include "cli/simulation_output.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/files.h"
#include "cli/installation.h"
#include "cli/recording_library.h"
#include "flexarm/scene/scene_description.h"
#include "flexarm/simulation/csv_writer.h"
#include "pictures/page.h"
#include "simulation/background_writer.h"

namespace flexarm::cli {
namespace {

bool ends_with(const std::string& text, std::string_view end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

recording::SceneOrigin origin_of(const SceneInput& scene) {
  std::string options;
  for (const std::string& word : option_words(scene)) options += (options.empty() ? "" : " ") + as_shell_word(word);
  return {std::filesystem::absolute(scene.path).lexically_normal().string(), options};
}

/// The file name's extension determines the kind of file.
std::unique_ptr<ResultWriter> make_writer(const SimulateArguments& arguments, const Simulation& simulation) {
  const std::string& path = arguments.output;
  if (is_bag(path)) return recording_library().bag(path, simulation, origin_of(arguments.scene));
  if (is_page(path))
    return std::make_unique<pictures::PageWriter>(
        path, simulation, pictures::RecordingOptions{simulation.scene().name, arguments.page_rate},
        arguments.page_time);
  using Solver = ResultColumns::Solver;
  ResultColumns columns(simulation, arguments.estimates_error ? Solver::WithEstimate : Solver::With, arguments.columns);
  if (ends_with(path, ".h5"))
    return recording_library().hdf5(path, simulation, std::move(columns), origin_of(arguments.scene));
  return std::make_unique<CsvWriter>(path, std::move(columns));
}

std::vector<std::unique_ptr<ResultWriter>> make_writers(const SimulateArguments& arguments,
                                                        const Simulation& simulation) {
  std::vector<std::unique_ptr<ResultWriter>> writers;
  if (!arguments.output.empty()) writers.push_back(make_writer(arguments, simulation));
  if (!arguments.vtk.empty())
    writers.push_back(
        std::make_unique<pictures::VtkWriter>(arguments.vtk, simulation, *arguments.picture, arguments.vtk_rate));
  return writers;
}

/// Writes rows to all outputs, and updates the summary for each of them.
class SummarisedWriter : public ResultWriter {
 public:
  SummarisedWriter(std::vector<std::unique_ptr<ResultWriter>> writers, RunSummary& summary)
      : writers_(std::move(writers)), summary_(summary) {}

  void write_row(const Simulation& simulation) override {
    for (const auto& writer : writers_) writer->write_row(simulation);
    summary_.look(simulation);
  }
  void note_step(const Simulation& simulation, const StepResult& result) override {
    for (const auto& writer : writers_) writer->note_step(simulation, result);
  }
  bool looks_at_steps() const override {
    return std::any_of(writers_.begin(), writers_.end(), [](const auto& writer) { return writer->looks_at_steps(); });
  }
  void close() override {
    for (const auto& writer : writers_) writer->close();
  }

 private:
  std::vector<std::unique_ptr<ResultWriter>> writers_;
  RunSummary& summary_;
};

}  // namespace

std::FILE* report_stream(const SimulateArguments& arguments) {
  return is_standard_output(arguments.output) ? stderr : stdout;
}

bool has_output(const SimulateArguments& arguments) {
  return !arguments.output.empty() || !arguments.vtk.empty();
}

bool is_bag(const std::string& path) {
  return ends_with(path, ".bag");
}

bool is_page(const std::string& path) {
  return ends_with(path, ".html");
}

void warn_of_unknown_ending(const std::string& path) {
  const std::string ending = std::filesystem::path(path).extension().string();
  for (const char* known : {"", ".csv", ".txt", ".h5", ".bag", ".html"})
    if (ending == known) return;
  fmt::print(
      stderr,
      "flexarm: warning: --output: '{}' gets CSV, as its ending '{}' stands for nothing else: there are .csv, .h5 "
      "(HDF5), .bag (ROS bag) and .html (page)\n",
      path, ending);
}

std::unique_ptr<ResultWriter> open_output(const SimulateArguments& arguments, const Simulation& simulation,
                                          RunSummary& summary) {
  if (!has_output(arguments)) return nullptr;
  try {
    return std::make_unique<BackgroundWriter>(simulation, [&](const Simulation& shown) {
      return std::make_unique<SummarisedWriter>(make_writers(arguments, shown), summary);
    });
  } catch (const std::invalid_argument& error) {
    throw InputError("flexarm: --columns: " + std::string(error.what()));
  } catch (const std::runtime_error& error) {
    throw InputError("flexarm: " + std::string(error.what()));
  }
}

}  // namespace flexarm::cli
