#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "bench/report.h"
#include "cli/commands.h"
#include "cli/progress_bar.h"

namespace flexarm::cli {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string output = "docs/reports";
  bool quick = false;
};

void write_file(const fs::path& path, const std::string& text, std::ios::openmode mode = std::ios::trunc) {
  std::ofstream file(path, std::ios::binary | std::ios::out | mode);
  file << text;
  file.close();
  if (!file) throw std::runtime_error("cannot write '" + path.string() + "'");
}

/// The script that draws; installed next to the program, or in the source tree that it was built from.
std::optional<fs::path> plot_script() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  for (const fs::path& folder : {program.parent_path(), fs::path(FLEXARM_SCRIPTS_DIR)})
    if (const fs::path script = folder / "plot_properties.py"; fs::exists(script, error)) return script;
  return std::nullopt;
}

std::string quoted(const fs::path& path) {
  std::string out = "'";
  for (const char c : path.string()) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

/// False if this machine cannot draw.
bool draw(const fs::path& data, const fs::path& picture) {
  const std::optional<fs::path> script = plot_script();
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
  const bool is_drawn = draw(data, picture);
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
}

}  // namespace flexarm::cli
