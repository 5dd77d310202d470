#include <algorithm>
#include <cstring>
#include <filesystem>
#include <map>

#include <unistd.h>

#include <fmt/format.h>

#include "bench/accuracy.h"
#include "bench/hard.h"
#include "bench/report.h"
#include "bench/scaling.h"
#include "bench/speed.h"
#include "bench/thesis.h"
#include "cli/command_line.h"
#include "cli/files.h"
#include "cli/installation.h"
#include "cli/interruptions.h"
#include "cli/other_programs.h"
#include "cli/progress_bar.h"
#include "flexarm/schemes/integrator_description.h"

namespace flexarm::bench {
namespace {

namespace fs = std::filesystem;

struct BenchArguments {
  std::string output = "docs/reports", scenes;
  std::string only, references;  ///< of the accuracy report
  std::vector<std::string> problems;
  std::vector<std::string> cases, groups;  ///< of the hard cases
  std::vector<int> random_arms;            ///< for the accuracy report: the first one, and their number
  HardOptions hard;
  bool print_only = false;
  bool quick = false;
};

/// The file of a report; makes its folder. Checks at once that it can be written, not after minutes of measurement. An
/// existing file stays until then.
fs::path report_file(const BenchArguments& arguments, const std::string& name) {
  std::error_code error;
  fs::create_directories(arguments.output, error);  // errors are found below
  const fs::path file = fs::path(arguments.output) / (name + ".md");
  cli::require_writable("--output", file.string());
  return file;
}

/// A progress bar, which is called after each run. If a signal has come, it ends the measurements by an exception, so
/// that reports are written completely or not at all.
class Progress {
 public:
  Progress() { cli::catch_interruptions(); }
  void operator()(double part, const std::string& what) {
    bar_.show(part, what);
    if (cli::interruption() == 0) return;
    bar_.clear();
    throw cli::Interrupted(
        fmt::format("interrupted after {:.0f} % of the measurements, nothing is written", 100 * part));
  }

 private:
  cli::ProgressBar bar_{0, 1, true};
};

/// The folder of scenes that the user gave, or flexarm's own.
fs::path scene_folder(const BenchArguments& arguments, const std::string& own) {
  const std::optional<std::string> scenes =
      arguments.scenes.empty() ? cli::own_scenes(own) : std::optional<std::string>(arguments.scenes);
  if (!scenes) throw std::runtime_error("flexarm's scenes are not installed; name their folder by --scenes");
  return *scenes;
}

/// Writes the report NAME.md, its data, and the picture that plot_NAME.py makes from the data. measure(progress) calls
/// progress(completed fraction, what is measured).
template <class Measure, class ToData>
int write_report(const BenchArguments& arguments, const std::string& name, const std::string& data_name,
                 const Measure& measure, const ToData& to_data) {
  const fs::path file = report_file(arguments, name), folder = arguments.output, data = folder / (data_name + ".csv"),
                 picture = folder / (data_name + ".png");
  const auto report = [&] {
    Progress progress;
    return measure([&](double part, const std::string& what) { progress(part, what); });
  }();
  cli::write_file(data.string(), to_data(report));
  const bool is_drawn = cli::draw("plot_" + name + ".py", data.string(), picture.string());
  if (!is_drawn) fmt::print(stderr, "flexarm: no picture: it needs python3-matplotlib\n");
  cli::write_file(file.string(), to_markdown(report, is_drawn ? picture.filename().string() : ""));
  fmt::print("{}\n", file.string());
  return cli::kDone;
}

int report_properties(const BenchArguments& arguments) {
  return write_report(
      arguments, "properties", "properties_dissipation",
      [&](const auto& progress) {
        return measure_properties(arguments.quick, [&](double part) { progress(part, "properties"); });
      },
      decay_to_csv);
}

int report_thesis(const BenchArguments& arguments) {
  const fs::path scenes = scene_folder(arguments, "thesis"), file = report_file(arguments, "thesis"),
                 folder = arguments.output;
  ThesisReport report;
  {
    Progress progress;
    report = measure_thesis(scenes.string(), arguments.quick, [&](double part) { progress(part, "thesis"); });
  }
  std::map<std::string, std::string> pictures;
  for (std::size_t e = 0; e < report.examples.size(); ++e) {
    const std::string stem = "thesis_" + report.examples[e].runs.front().scene.substr(0, 4);
    const fs::path data = folder / (stem + ".csv"), picture = folder / (stem + ".png");
    cli::write_file(data.string(), histories_to_csv(report.examples[e], report.outcomes[e]));
    if (cli::draw("plot_thesis.py", data.string(), picture.string()))
      pictures[report.examples[e].number] = picture.filename().string();
  }
  if (pictures.empty()) fmt::print(stderr, "flexarm: no pictures: they need python3-matplotlib\n");
  cli::write_file(file.string(), to_markdown(report, [&](const std::string& number) { return pictures[number]; }));
  fmt::print("{}\n", file.string());
  return cli::kDone;
}

int report_scaling(const BenchArguments& arguments) {
  return write_report(
      arguments, "scaling", "scaling",
      [&](const auto& progress) {
        return measure_scaling(arguments.quick, [&](double part) { progress(part, "scaling"); });
      },
      scaling_to_csv);
}

std::vector<SpeedProblem> named_problems(const std::vector<std::string>& names) {
  std::vector<SpeedProblem> problems = speed_problems();
  const auto is_unwanted = [&](const SpeedProblem& problem) {
    return !names.empty() && std::find(names.begin(), names.end(), problem.name) == names.end();
  };
  problems.erase(std::remove_if(problems.begin(), problems.end(), is_unwanted), problems.end());
  return problems;
}

int report_speed(const BenchArguments& arguments) {
  const fs::path scenes = scene_folder(arguments, "");
  return write_report(
      arguments, "speed", "speed",
      [&](const auto& progress) {
        return measure_speed(scenes.string(), named_problems(arguments.problems), arguments.quick, progress);
      },
      runs_to_csv);
}

/// The references of the accuracy report: the folder that the user gave, or a temporary one that is filled now.
class References {
 public:
  References(const BenchArguments& arguments, const std::string& only) : folder_(arguments.references) {
    if (!folder_.empty()) return;
    folder_ = (fs::temp_directory_path() / fmt::format("flexarm_references_{}", getpid())).string();
    is_own_ = true;
    if (!cli::run_script("outside_references", {"--output", folder_, "--only", only}))
      throw std::runtime_error("the references could not be made (see above); they need python3-scipy");
  }
  ~References() {
    std::error_code error;
    if (is_own_) fs::remove_all(folder_, error);
  }
  References(const References&) = delete;
  References& operator=(const References&) = delete;

  const std::string& folder() const { return folder_; }

 private:
  std::string folder_;
  bool is_own_ = false;
};

/// A reference for quick runs, which show that references can be read.
constexpr const char* kQuickReference = "jump at sqrt(0.1)";

int report_accuracy(const BenchArguments& arguments) {
  const std::string scenes = scene_folder(arguments, "").string();
  AccuracyScope scope{arguments.quick, {}, arguments.only};
  if (!arguments.random_arms.empty()) {
    scope.random_arms = {arguments.random_arms[0], arguments.random_arms[1]};
    if (scope.random_arms->second < 1) throw std::runtime_error("--random-arms: expected at least one arm, got '0'");
  }
  std::vector<AccuracyCase> cases;
  if (scope.random_arms) {
    cases = accuracy_cases(scenes, "", scope);
  } else {
    const References references(arguments, scope.quick ? kQuickReference : scope.only);
    cases = accuracy_cases(scenes, references.folder(), scope);
  }
  if (cases.empty())
    throw std::runtime_error(fmt::format("--only: there is no scene with '{}' in its name", scope.only));
  return write_report(
      arguments, "accuracy", "accuracy",
      [&](const auto& progress) {
        const AccuracyReport report = measure_accuracy(cases, scope, progress);
        fmt::print("{}", accuracy_summary(report));
        return report;
      },
      accuracy_to_csv);
}

bool is_in(const std::vector<std::string>& names, const std::string& name) {
  return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
}

/// Whether the name contains one of the parts, or there are no parts.
bool is_meant(const std::vector<std::string>& parts, const std::string& name) {
  return parts.empty() || std::any_of(parts.begin(), parts.end(),
                                      [&](const std::string& part) { return name.find(part) != std::string::npos; });
}

std::vector<HardCase> chosen_cases(const BenchArguments& arguments) {
  std::vector<HardCase> chosen;
  for (HardCase& hard : hard_cases())
    if (is_in(arguments.groups, hard.group) && is_meant(arguments.cases, hard.name)) chosen.push_back(std::move(hard));
  if (chosen.empty()) throw std::runtime_error("there is no such case");
  return chosen;
}

/// Prints each case as a scene file that runs like the case, apart from the end time.
int print_scenes(const std::vector<HardCase>& cases) {
  for (const HardCase& hard : cases) {
    std::string text = hard.scene;
    text.insert(text.find("<simulation>") + std::strlen("<simulation>"),
                fmt::format("\n<integrator step=\"{}\"/>", hard.step));
    fmt::print("<!-- {}: {}; {} -->\n{}", hard.group, hard.name,
               hard.load_steps > 0 ? fmt::format("static, {} steps of the load", hard.load_steps)
                                   : fmt::format("until {} s", hard.until),
               text);
  }
  return cli::kDone;
}

int report_hard(BenchArguments arguments) {
  const std::vector<HardCase> cases = chosen_cases(arguments);
  if (arguments.print_only) return print_scenes(cases);
  arguments.hard.quick = arguments.quick;
  return write_report(
      arguments, "hard", "hard", [&](const auto& progress) { return measure_hard(cases, arguments.hard, progress); },
      hard_to_csv);
}

std::vector<std::string> group_names() {
  std::vector<std::string> names;
  for (const HardCase& hard : hard_cases())
    if (!std::count(names.begin(), names.end(), hard.group)) names.push_back(hard.group);
  return names;
}

std::vector<std::string> problem_names() {
  std::vector<std::string> names;
  for (const SpeedProblem& problem : speed_problems()) names.push_back(problem.name);
  return names;
}

std::vector<std::string> scheme_choice() {
  return {scheme_names().begin(), scheme_names().end()};
}

// ---------------------------------------------------------------- commands

void add_output(cli::Command& command, BenchArguments& arguments) {
  command.option("--output", arguments.output, "folder for the report").shown_as("FOLDER").shows_default();
}

void add_scenes(cli::Command& command, BenchArguments& arguments, const std::string& own) {
  command.option("--scenes", arguments.scenes, "folder of the scenes (default: " + own + ")").shown_as("FOLDER");
}

void add_properties(cli::CommandLine& line, BenchArguments& arguments) {
  cli::Command& command = line.command("properties", "Properties of all time integration schemes, as a report");
  add_output(command, arguments);
  command.flag("--quick", arguments.quick, "short runs, as a test of the command");
  command.runs([&arguments] { return report_properties(arguments); });
}

void add_thesis(cli::CommandLine& line, BenchArguments& arguments) {
  cli::Command& command = line.command("thesis", "The five examples of Muñoz 2004, chapter 12, as a report");
  add_output(command, arguments);
  add_scenes(command, arguments, "those that come with flexarm");
  command.flag("--quick", arguments.quick, "short runs, as a test of the command");
  command.runs([&arguments] { return report_thesis(arguments); });
}

void add_speed(cli::CommandLine& line, BenchArguments& arguments) {
  cli::Command& command = line.command("speed", "Speed against error of known problems, as a report");
  command.option("--problem", arguments.problems, "only this one; may be given more than once (default: all)")
      .choices(problem_names());
  add_output(command, arguments);
  add_scenes(command, arguments, "config, which comes with flexarm");
  command.flag("--quick", arguments.quick, "a few short runs, as a test of the command");
  command.runs([&arguments] { return report_speed(arguments); });
}

void add_accuracy(cli::CommandLine& line, BenchArguments& arguments) {
  cli::Command& command = line.command("accuracy", "True errors relative to requested ones, and costs, as a report");
  add_output(command, arguments);
  add_scenes(command, arguments, "config, which comes with flexarm");
  command.option("--only", arguments.only, "only scenes with this text in \"GROUP: NAME\"");
  command
      .option("--references", arguments.references,
              "folder that scripts/outside_references has written (default: one is made, used and removed)")
      .shown_as("FOLDER");
  command
      .option("--random-arms", arguments.random_arms,
              "only these: number of the first one, and how many (the report has 0 to 19)")
      .takes(2)
      .shown_as("FIRST COUNT")
      .check(cli::whole_number_between(0, 1000000));
  command.flag("--quick", arguments.quick, "three short scenes, as a test of the command");
  command.runs([&arguments] { return report_accuracy(arguments); });
}

void add_hard(cli::CommandLine& line, BenchArguments& arguments) {
  cli::Command& command = line.command("hard", "Scenes at which a simulator may break, as a report");
  command.option("--case", arguments.cases, "only cases with this text in their names; may be given more than once");
  command.option("--group", arguments.groups, "only this one; may be given more than once (default: all)")
      .choices(group_names());
  command
      .option("--scheme", arguments.hard.schemes, "may be given more than once; the others are compared with the first")
      .shows_default()
      .choices(scheme_choice());
  command.option("--seconds", arguments.hard.limits.seconds, "limit of processor time for each run [s]")
      .shows_default()
      .check(cli::check_positive);
  add_output(command, arguments);
  command.flag("--print", arguments.print_only, "print the scenes, run nothing");
  command.flag("--quick", arguments.quick, "five steps of each, as a test of the command");
  command.runs([&arguments] { return report_hard(arguments); });
}

void add_scaling(cli::CommandLine& line, BenchArguments& arguments) {
  cli::Command& command = line.command("scaling", "Time and memory over the size of a mechanism, as a report");
  add_output(command, arguments);
  command.flag("--quick", arguments.quick, "small mechanisms, as a test of the command");
  command.runs([&arguments] { return report_scaling(arguments); });
}

void add_validation(cli::CommandLine& line) {
  line.program("validation", "flexarm beside published measurements", cli::CommandLine::Kind::Other,
               [](const cli::Words& words) -> int { cli::become_python("bench validation", "validation.py", words); });
}

}  // namespace
}  // namespace flexarm::bench

/// The program that `flexarm bench` becomes, with the same arguments. In messages and help it uses that command's name.
int main(int argc, char** argv) {
  using namespace flexarm::bench;
  flexarm::cli::CommandLine line("flexarm bench", "Measures the simulator itself");
  BenchArguments arguments;
  add_properties(line, arguments);
  add_thesis(line, arguments);
  add_speed(line, arguments);
  add_accuracy(line, arguments);
  add_hard(line, arguments);
  add_scaling(line, arguments);
  add_validation(line);
  return line.run(argc, argv);
}
