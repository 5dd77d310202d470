#include "flexarm/simulation/checkpoint.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "math/number_text.h"
#include "model/state_numbers.h"
#include "simulation/checkpoint_scene.h"
#include "simulation/fingerprint.h"
#include "simulation/inside.h"
#include "simulation/scene_identity.h"
#include "simulation/unfinished_file.h"

namespace flexarm {
namespace {

constexpr const char* kHeader = "flexarm-checkpoint 16";
constexpr const char* kHeaderOfFourSteps = "flexarm-checkpoint 15";    // older: lacks the fifth of the past steps
constexpr const char* kHeaderWithoutFile = "flexarm-checkpoint 14";    // older: lacks the scene's file, too
constexpr const char* kHeaderWithoutValues = "flexarm-checkpoint 13";  // older: lacks the scene's values, too
constexpr std::size_t kShown = 120;                                    // characters of a line in messages

/// The last line of a file whose other lines are `text`.
std::string checksum_line(const std::string& text) {
  Fingerprint fingerprint;
  fingerprint.add(text);
  return "checksum " + fingerprint.text() + "\n";
}

/// What must agree for a state to fit a simulation: as text, one item per line, and as named values.
SceneIdentity identity(const Simulation& simulation) {
  const State& state = initial_state_of(simulation);  // before elements were halved and sliders left their lines
  SceneIdentity out = identity_of(simulation.scene(), scheme_of(simulation));
  const std::pair<const char*, std::size_t> counts[] = {{"nodes", state.nodes.size()},
                                                        {"joints", state.released.size()},
                                                        {"mass_points", state.study.mass_points.size()},
                                                        {"coordinates", state.commands.size()}};
  for (const auto& [name, count] : counts) {
    out.text += fmt::format("{}{} {}", out.text.back() == '\n' ? "" : " ", name, count);
    out.values.push_back({std::string("number of ") + name, std::to_string(count)});
  }
  out.text += "\n";
  return out;
}

// ---------------------------------------------------------------- the scene's file, and its values, by which messages
// say what differs

constexpr const char* kSceneFile = "scene_file ";
constexpr const char* kValues = "values ";

/// Empty if the scene does not come from a file that is still there.
std::string file_line(const scene::SceneDescription& scene) {
  std::error_code error;
  const std::filesystem::path path = std::filesystem::absolute(scene.file, error).lexically_normal();
  if (error || !std::filesystem::is_regular_file(path, error) || path.string().find('\n') != std::string::npos)
    return "";
  return kSceneFile + path.string() + "\n";
}

std::string values_text(const std::vector<SceneValue>& values) {
  std::string text = kValues + std::to_string(values.size()) + "\n";
  for (const SceneValue& one : values) text += one.name + "\t" + one.value + "\n";
  return text;
}

/// Reads the scene's values from a checkpoint. Empty if it does not contain them.
std::multimap<std::string, std::string> read_values(const std::string& text) {
  std::multimap<std::string, std::string> values;
  std::istringstream lines(text.substr(std::min(text.size(), text.rfind(std::string("\n") + kValues))));
  for (std::string line; std::getline(lines, line);)
    if (const std::size_t tab = line.find('\t'); tab != std::string::npos)
      values.emplace(line.substr(0, tab), line.substr(tab + 1));
  return values;
}

std::string shortened(const std::string& text) {
  constexpr std::size_t kMost = 60;
  return text.size() <= kMost ? text : text.substr(0, kMost) + "...";
}

/// Says in words what differs: "parameter 'mass': expected 4, found 5; link 'bob' ...". Empty if nothing does.
std::string differences(const std::vector<SceneValue>& expected, std::multimap<std::string, std::string> found) {
  constexpr std::size_t kMostShown = 3;
  std::vector<std::string> told;
  for (const SceneValue& one : expected) {
    auto there = found.lower_bound(one.name);  // the first of that name
    if (there != found.end() && there->first != one.name) there = found.end();
    const std::string got = there == found.end() ? "none" : "'" + shortened(there->second) + "'";
    if (there == found.end() || there->second != one.value)
      told.push_back(fmt::format("{}: expected '{}', found {}", one.name, shortened(one.value), got));
    if (there != found.end()) found.erase(there);
  }
  for (const auto& [name, value] : found)
    told.push_back(fmt::format("{}: expected none, found '{}'", name, shortened(value)));
  const std::size_t shown = std::min(told.size(), kMostShown);
  std::string text =
      fmt::format("{}", fmt::join(told.begin(), told.begin() + static_cast<std::ptrdiff_t>(shown), "; "));
  if (told.size() > shown) text += fmt::format("; and {} others", told.size() - shown);
  return text;
}

/// Resizes everything that a state has per node.
void resize_nodes(State& state, std::size_t count) {
  if (!state.study.total_rotations.empty()) state.study.total_rotations.resize(count, Vector3::Zero());
  if (!state.study.forces.empty()) state.study.forces.resize(count, Vector6::Zero());
  if (!state.study.momentum_rates.empty())
    state.study.momentum_rates.resize(state.study.momentum_rates.size() - state.nodes.size() + count, Vector3::Zero());
  state.nodes.resize(count);
}

std::string hexadecimal(double value) {
  if (std::isnan(value)) return "nan";
  char text[kLongestNumber];
  return std::string(text, write_number(text, value, NumberFormat::Hexadecimal) - text);
}

[[noreturn]] void fail_reading(const std::string& name, const std::string& what) {
  throw std::runtime_error("checkpoint '" + name + "': " + what);
}

/// Reads a checkpoint line by line. Errors name the file and the line.
class Reader {
 public:
  Reader(const std::string& text, const std::string& name) : name_(name), lines_(text) {
    const std::string header = next();
    const bool is_older =
        header == kHeaderOfFourSteps || header == kHeaderWithoutFile || header == kHeaderWithoutValues;
    if (header != kHeader && !is_older)
      fail_line(header, "'" + std::string(kHeader) + "': another format, or no checkpoint");
    has_values_ = header != kHeaderWithoutValues;
    past_steps_ = is_older ? 4 : IncrementHistory::kLength;
    // Verify the checksum: an unfinished or damaged file would give a wrong state, or seem to belong to another scene.
    const std::size_t end = text.rfind("checksum ");
    if (end == std::string::npos) fail("is damaged: it does not end with its checksum");
    const std::string expected = checksum_line(text.substr(0, end)), found = text.substr(end);
    if (found != expected)
      fail(fmt::format("is damaged: it ends with '{}', its content with '{}'", shown(found), shown(expected)));
  }

  /// How many past steps of the state the text has.
  std::size_t past_steps() const { return past_steps_; }
  std::string next() {
    std::string line;
    std::getline(lines_, line);
    ++number_;
    return line;
  }
  [[noreturn]] void fail(const std::string& what) const { fail_reading(name_, what); }
  [[noreturn]] void fail_line(const std::string& got, const std::string& expected) const {
    fail(fmt::format("line {} is '{}', expected {}", number_, shown(got), expected));
  }

  /// Reads as many lines as `expected` has, and fails if they differ.
  void require_identity(const SceneIdentity& expected) {
    std::istringstream wanted(expected.text);
    for (std::string line; std::getline(wanted, line);) {
      const std::string got = next();
      if (got == line) continue;
      if (const std::string differ = has_values_ ? differences(expected.values, read_values(lines_.str())) : "";
          !differ.empty())
        fail("it belongs to another scene, scheme or step: " + differ);
      fail_line(got, "'" + shown(line) + "': it belongs to another scene, scheme or step");
    }
  }
  /// Reads the scene's file and values, as far as they are there, and the checksum.
  void take_end() {
    std::string line = next();
    if (line.rfind(kSceneFile, 0) == 0) line = next();
    if (has_values_) {
      std::istringstream in(line);
      std::string word;
      std::size_t count = 0;
      if (!(in >> word >> count) || word + " " != kValues) fail_line(line, "the number of the scene's values");
      for (std::size_t i = 0; i < count && lines_; ++i) next();
      line = next();
    }
    if (line.rfind("checksum ", 0) != 0) fail_line(line, "the checksum");
  }
  double number(const char* what) {
    const std::string token = next();
    if (what == kCommand && token == "nan") return std::nan("");
    const std::optional<double> value = parse_hexadecimal(token);
    if (!value) fail_line(token, std::string(what) + " as a finite hexadecimal number");
    return *value;
  }

 private:
  /// The text's first line, shortened.
  static std::string shown(const std::string& line) { return line.substr(0, std::min(line.find('\n'), kShown)); }

  std::string name_;
  bool has_values_ = false;
  std::size_t past_steps_ = IncrementHistory::kLength;
  std::istringstream lines_;
  int number_ = 0;
};

constexpr const char* kHalved = "halved ";  // the elements that are halved, by link, element and part

/// Nodes and links on which wrenches act. Empty if there are no wrenches.
std::string wrenches_text(const std::vector<NodalLoad>& wrenches) {
  if (wrenches.empty()) return "";
  std::string text = fmt::format(" wrenches {}", wrenches.size());
  for (const NodalLoad& wrench : wrenches) text += fmt::format(" {} {:d}", wrench.node, wrench.follows);
  text += " on";
  for (const NodalLoad& wrench : wrenches) text += fmt::format(" {}", wrench.link);
  return text;
}

/// Written only if elements are halved.
std::string halved_line(const State& state) {
  if (state.halved.empty()) return "";
  std::string text = fmt::format("{}{}", kHalved, state.halved.size());
  for (const HalvedElement& one : state.halved) text += fmt::format(" {} {} {}", one.link, one.element, one.part);
  return text + "\n";
}

std::string counts_line(const State& state) {
  return fmt::format("steps {} level {} good {} increments {} of {} order {} drives {} reactions {} left {} {}{}\n",
                     state.steps, state.halving_level, state.good_steps, state.history.increments[0].size(),
                     state.history.count, state.history.order, state.drives.count, state.study.reactions.size(),
                     state.left_lines.size(), fmt::join(state.left_lines, " "), wrenches_text(state.wrenches)) +
         // Written only for scenes with sensors, so that older files of scenes without sensors can still be read.
         (state.samples.empty() ? "" : fmt::format("transmitted {}\n", state.transmitted.count));
}

std::vector<HalvedElement> read_halved(Reader& reader, const std::string& line) {
  std::istringstream in(line);
  std::string word;
  std::size_t count = 0;
  in >> word >> count;
  std::vector<HalvedElement> halved(in && count <= line.size() ? count : 0);
  for (HalvedElement& one : halved) in >> one.link >> one.element >> one.part;
  if (!in || halved.empty()) reader.fail_line(line, "the elements that are halved");
  return halved;
}

/// Reads the whole numbers from `line`, and resizes the state's lists accordingly.
void read_counts(Reader& reader, const std::string& line, State& state) {
  std::istringstream in(line);
  std::string word;
  IncrementHistory& history = state.history;
  std::size_t increments = 0, reactions = 0, left = 0;
  in >> word >> state.steps >> word >> state.halving_level >> word >> state.good_steps >> word >> increments >> word >>
      history.count >> word >> history.order >> word >> state.drives.count >> word >> reactions >> word >> left;
  const auto require = [&](bool ok) {
    if (!ok)
      reader.fail_line(line,
                       "the numbers of steps, increments, reactions, joints that have left their lines, wrenches");
  };
  require(in && left <= state.released.size());
  resize_nodes(state, state.nodes.size() - state.left_lines.size() + left);
  state.left_lines.resize(left);
  for (int& joint : state.left_lines) in >> joint;
  require(in && increments <= 6 * state.nodes.size() + 6 * state.released.size() && reactions <= state.nodes.size());
  state.study.reactions.assign(reactions, Vector6::Zero());
  for (std::vector<double>& made : history.increments) made.assign(increments, 0.0);
  std::size_t wrenches = 0;
  if (in >> word) require(in >> wrenches && wrenches <= line.size());  // each takes some of the line's characters
  state.wrenches.assign(wrenches, {});
  for (NodalLoad& wrench : state.wrenches) require(static_cast<bool>(in >> wrench.node >> wrench.follows));
  if (in >> word)  // older files do not have the links
    for (NodalLoad& wrench : state.wrenches) require(word == "on" && in >> wrench.link);
  if (state.samples.empty()) return;
  const std::string transmitted = reader.next();
  std::istringstream numbers(transmitted);
  if (!(numbers >> word >> state.transmitted.count)) reader.fail_line(transmitted, "the number of forces of joints");
}

}  // namespace

std::string checkpoint_text(const Simulation& simulation) {
  const SceneIdentity scene = identity(simulation);
  const State& state = state_of(simulation);
  std::string text = fmt::format("{}\n{}{}{}", kHeader, scene.text, halved_line(state), counts_line(state));
  for_each_number(state, [&](const char*, double value) { text += hexadecimal(value) + "\n"; });
  text += file_line(simulation.scene()) + values_text(scene.values);
  return text + checksum_line(text);
}

void write_checkpoint(const Simulation& simulation, const std::string& path) {
  with_subject("checkpoint '" + path + "'", [&] { UnfinishedFile(path, checkpoint_text(simulation)).put_in_place(); });
}

void try_checkpoint(const Simulation& simulation, const std::string& path) {
  with_subject("checkpoint '" + path + "'", [&] { UnfinishedFile(path, checkpoint_text(simulation)); });
}

namespace {

std::string text_of_checkpoint(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in || std::filesystem::is_directory(path)) fail_reading(path, "cannot be opened");
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

void read_checkpoint(Simulation& simulation, const std::string& path) {
  read_checkpoint_text(simulation, text_of_checkpoint(path), path);
}

void read_checkpoint_text(Simulation& simulation, const std::string& text, const std::string& name) {
  Reader reader(text, name);
  reader.require_identity(identity(simulation));
  const Snapshot before = simulation.snapshot();
  try {
    std::string line = reader.next();
    std::vector<HalvedElement> halved;
    if (line.rfind(kHalved, 0) == 0) {
      halved = read_halved(reader, line);
      line = reader.next();
    }
    if (halved != state_of(simulation).halved) take_mesh(simulation, halved);
    State state = state_of(simulation);
    read_counts(reader, line, state);
    for_each_number(
        state, [&](const char* what, double& value) { value = reader.number(what); }, reader.past_steps());
    reader.take_end();
    restore(simulation, state);
    const Energies energies = simulation.energies();
    if (!std::isfinite(energies.total() + energies.work + energies.dissipated))
      throw std::invalid_argument("not a state of this scene: its energies are not finite");
  } catch (const std::invalid_argument& error) {
    simulation.restore(before);
    reader.fail(error.what());
  } catch (...) {
    simulation.restore(before);
    throw;
  }
}

bool is_checkpoint(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::string line;
  return std::getline(in, line) && line.rfind("flexarm-checkpoint ", 0) == 0;
}

CheckpointScene scene_of_checkpoint(const std::string& path) {
  const std::string text = text_of_checkpoint(path);
  const Reader reader(text, path);  // refuses what is no saved state
  CheckpointScene scene;
  std::istringstream lines(text);
  for (std::string line; scene.file.empty() && std::getline(lines, line);)
    if (line.rfind(kSceneFile, 0) == 0) scene.file = line.substr(std::strlen(kSceneFile));
  const std::string before = "parameter '";
  for (const auto& [name, value] : read_values(text)) {
    const std::optional<double> number = parse_number(value);
    if (name.rfind(before, 0) == 0 && number)
      scene.parameters[name.substr(before.size(), name.size() - before.size() - 1)] = *number;
  }
  return scene;
}

}  // namespace flexarm
