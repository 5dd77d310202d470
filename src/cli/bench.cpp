#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>

#include <fmt/format.h>

#include "bench/report.h"
#include "bench/scaling.h"
#include "bench/thesis.h"
#include "cli/commands.h"
#include "cli/progress_bar.h"

namespace flexarm::cli {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string output = "docs/reports", scenes;
  bool quick = false;
};

void write_file(const fs::path& path, const std::string& text, std::ios::openmode mode = std::ios::trunc) {
  std::ofstream file(path, std::ios::binary | std::ios::out | mode);
  file << text;
  file.close();
  if (!file) throw std::runtime_error("cannot write '" + path.string() + "'");
}

fs::path program_folder() {
  std::error_code error;
  return fs::read_symlink("/proc/self/exe", error).parent_path();
}

/// The first of these that is there.
std::optional<fs::path> first_of(const std::vector<fs::path>& places) {
  std::error_code error;
  for (const fs::path& place : places)
    if (fs::exists(place, error)) return place;
  return std::nullopt;
}

/// A script that draws; installed next to the program, or in the source tree that it was built from.
std::optional<fs::path> plot_script(const std::string& name) {
  return first_of({program_folder() / name, fs::path(FLEXARM_SOURCE_DIR) / "scripts" / name});
}

/// The thesis's scenes: installed in <prefix>/share/flexarm, the program being in <prefix>/lib/flexarm.
std::optional<fs::path> thesis_scenes() {
  const fs::path prefix = program_folder().parent_path().parent_path();
  return first_of({prefix / "share/flexarm/config/thesis", fs::path(FLEXARM_SOURCE_DIR) / "config/thesis"});
}

std::string quoted(const fs::path& path) {
  std::string out = "'";
  for (const char c : path.string()) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

/// False if this machine cannot draw.
bool draw(const std::string& name, const fs::path& data, const fs::path& picture) {
  const std::optional<fs::path> script = plot_script(name);
  if (!script) return false;
  const std::string command = "/usr/bin/python3 " + quoted(*script) + " " + quoted(data) + " " + quoted(picture);
  return std::system(command.c_str()) == 0;
}

int measure_properties(const Arguments& arguments) {
  const fs::path folder = arguments.output, report_file = folder / "properties.md",
                 data = folder / "properties_dissipation.csv", picture = folder / "properties_dissipation.png";
  fs::create_directories(folder);
  // Minutes later would be a bad time to find out that this fails; what is there stays until then.
  write_file(report_file, "", std::ios::app);
  bench::Report report;
  {
    ProgressBar bar(0, 1, true);
    report = bench::measure_properties(arguments.quick, [&](double part) { bar.show(part, "properties"); });
  }
  write_file(data, bench::decay_to_csv(report));
  const bool is_drawn = draw("plot_properties.py", data, picture);
  if (!is_drawn) fmt::print(stderr, "flexarm: no picture: it needs python3-matplotlib\n");
  write_file(report_file, bench::to_markdown(report, is_drawn ? picture.filename().string() : ""));
  fmt::print("{}\n", report_file.string());
  return kDone;
}

int measure_thesis(const Arguments& arguments) {
  const fs::path folder = arguments.output, report_file = folder / "thesis.md";
  const std::optional<fs::path> scenes =
      arguments.scenes.empty() ? thesis_scenes() : std::optional<fs::path>(arguments.scenes);
  if (!scenes) throw std::runtime_error("the thesis's scenes are not installed; name their folder by --scenes");
  fs::create_directories(folder);
  write_file(report_file, "", std::ios::app);
  bench::ThesisReport report;
  {
    ProgressBar bar(0, 1, true);
    report = bench::measure_thesis(scenes->string(), arguments.quick, [&](double part) { bar.show(part, "thesis"); });
  }
  std::map<std::string, std::string> pictures;
  for (std::size_t e = 0; e < report.examples.size(); ++e) {
    const std::string stem = "thesis_" + report.examples[e].runs.front().scene.substr(0, 4);
    const fs::path data = folder / (stem + ".csv"), picture = folder / (stem + ".png");
    write_file(data, bench::histories_to_csv(report.examples[e], report.outcomes[e]));
    if (draw("plot_thesis.py", data, picture)) pictures[report.examples[e].number] = picture.filename().string();
  }
  if (pictures.empty()) fmt::print(stderr, "flexarm: no pictures: they need python3-matplotlib\n");
  write_file(report_file, bench::to_markdown(report, [&](const std::string& number) { return pictures[number]; }));
  fmt::print("{}\n", report_file.string());
  return kDone;
}

int measure_scaling(const Arguments& arguments) {
  const fs::path folder = arguments.output, report_file = folder / "scaling.md", data = folder / "scaling.csv",
                 picture = folder / "scaling.png";
  fs::create_directories(folder);
  write_file(report_file, "", std::ios::app);
  bench::ScalingReport report;
  {
    ProgressBar bar(0, 1, true);
    report = bench::measure_scaling(arguments.quick, [&](double part) { bar.show(part, "scaling"); });
  }
  write_file(data, bench::scaling_to_csv(report));
  const bool is_drawn = draw("plot_scaling.py", data, picture);
  if (!is_drawn) fmt::print(stderr, "flexarm: no picture: it needs python3-matplotlib\n");
  write_file(report_file, bench::to_markdown(report, is_drawn ? picture.filename().string() : ""));
  fmt::print("{}\n", report_file.string());
  return kDone;
}

}  // namespace

void add_bench(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("bench", "Measures the simulator itself");
  command->require_subcommand(1);
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* properties =
      command->add_subcommand("properties", "Properties of all time integration schemes, as a report");
  properties->add_option("--output", arguments->output, "folder for the report")->capture_default_str();
  properties->add_flag("--quick", arguments->quick, "short runs, to see that all of it works");
  properties->callback([arguments, &status] { status = measure_properties(*arguments); });
  CLI::App* thesis = command->add_subcommand("thesis", "The five examples of Muñoz 2004, chapter 12, as a report");
  thesis->add_option("--output", arguments->output, "folder for the report")->capture_default_str();
  thesis->add_option("--scenes", arguments->scenes, "folder of the scenes (default: those that come with flexarm)");
  thesis->add_flag("--quick", arguments->quick, "short runs, to see that all of it works");
  thesis->callback([arguments, &status] { status = measure_thesis(*arguments); });
  CLI::App* scaling = command->add_subcommand("scaling", "Time and memory over the size of a mechanism, as a report");
  scaling->add_option("--output", arguments->output, "folder for the report")->capture_default_str();
  scaling->add_flag("--quick", arguments->quick, "small mechanisms, to see that all of it works");
  scaling->callback([arguments, &status] { status = measure_scaling(*arguments); });
}

}  // namespace flexarm::cli
