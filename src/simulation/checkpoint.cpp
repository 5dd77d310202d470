#include "flexarm/simulation/checkpoint.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>

#include "math/number_text.h"
#include "model/state_numbers.h"
#include "simulation/fingerprint.h"
#include "simulation/inside.h"
#include "simulation/scene_identity.h"
#include "simulation/unfinished_file.h"

namespace flexarm {
namespace {

constexpr const char* kHeader = "flexarm-checkpoint 13";
constexpr std::size_t kShown = 120;  // characters of a line in messages

/// The last line of a file whose other lines are `text`.
std::string checksum_line(const std::string& text) {
  Fingerprint fingerprint;
  fingerprint.add(text);
  return "checksum " + fingerprint.text() + "\n";
}

/// What must agree for a state to fit a simulation, one thing per line.
std::string identity(const Simulation& simulation) {
  const State& state = state_of(simulation);
  return scene_identity(simulation.scene(), scheme_of(simulation)) +
         fmt::format("nodes {} joints {} mass_points {} coordinates {}\n", state.nodes.size() - state.left_lines.size(),
                     state.released.size(), state.mass_points.size(), state.commands.size());
}

/// What is kept per node, for another number of nodes.
void resize_nodes(State& state, std::size_t count) {
  if (!state.total_rotations.empty()) state.total_rotations.resize(count, Vector3::Zero());
  if (!state.forces.empty()) state.forces.resize(count, Vector6::Zero());
  if (!state.momentum_rates.empty())
    state.momentum_rates.resize(state.momentum_rates.size() - state.nodes.size() + count, Vector3::Zero());
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

/// A checkpoint's lines, one after the other; errors name the file and the line.
class Reader {
 public:
  Reader(const std::string& text, const std::string& name) : name_(name), lines_(text) {
    if (const std::string header = next(); header != kHeader)
      fail_line(header, "'" + std::string(kHeader) + "': another format, or no checkpoint");
    // An unfinished or damaged file would give a wrong state, or one that is another scene's.
    const std::size_t end = text.rfind("checksum ");
    if (end == std::string::npos) fail("is damaged: it does not end with its checksum");
    const std::string expected = checksum_line(text.substr(0, end)), found = text.substr(end);
    if (found != expected)
      fail(fmt::format("is damaged: it ends with '{}', its content with '{}'", shown(found), shown(expected)));
  }

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

  /// Takes the lines of `expected`.
  void require_identity(const std::string& expected) {
    std::istringstream wanted(expected);
    for (std::string line; std::getline(wanted, line);)
      if (const std::string got = next(); got != line)
        fail_line(got, "'" + shown(line) + "': it belongs to another scene, scheme or step");
  }
  double number(const char* what) {
    const std::string token = next();
    if (what == kCommand && token == "nan") return std::nan("");
    const std::optional<double> value = parse_hexadecimal(token);
    if (!value) fail_line(token, std::string(what) + " as a finite hexadecimal number");
    return *value;
  }

 private:
  /// Without the line's end, shortened.
  static std::string shown(const std::string& line) { return line.substr(0, std::min(line.find('\n'), kShown)); }

  std::string name_;
  std::istringstream lines_;
  int number_ = 0;
};

/// Where they act; empty if there are none.
std::string wrenches_text(const std::vector<NodalLoad>& wrenches) {
  if (wrenches.empty()) return "";
  std::string text = fmt::format(" wrenches {}", wrenches.size());
  for (const NodalLoad& wrench : wrenches) text += fmt::format(" {} {:d}", wrench.node, wrench.follows);
  text += " on";
  for (const NodalLoad& wrench : wrenches) text += fmt::format(" {}", wrench.link);
  return text;
}

std::string counts_line(const State& state) {
  return fmt::format("steps {} level {} good {} increments {} of {} order {} drives {} reactions {} left {} {}{}\n",
                     state.steps, state.halving_level, state.good_steps, state.history.increments[0].size(),
                     state.history.count, state.history.order, state.drives.count, state.reactions.size(),
                     state.left_lines.size(), fmt::join(state.left_lines, " "), wrenches_text(state.wrenches)) +
         // Where there are some only: what was kept before can still be read.
         (state.samples.empty() ? "" : fmt::format("transmitted {}\n", state.transmitted.count));
}

/// The whole numbers, and room for the others.
void read_counts(Reader& reader, State& state) {
  const std::string line = reader.next();
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
  state.reactions.assign(reactions, Vector6::Zero());
  for (std::vector<double>& made : history.increments) made.assign(increments, 0.0);
  std::size_t wrenches = 0;
  if (in >> word) require(in >> wrenches && wrenches <= line.size());  // each takes some of its characters
  state.wrenches.assign(wrenches, {});
  for (NodalLoad& wrench : state.wrenches) require(static_cast<bool>(in >> wrench.node >> wrench.follows));
  if (in >> word)  // what was kept before does not say it
    for (NodalLoad& wrench : state.wrenches) require(word == "on" && in >> wrench.link);
  if (state.samples.empty()) return;
  const std::string transmitted = reader.next();
  std::istringstream numbers(transmitted);
  if (!(numbers >> word >> state.transmitted.count)) reader.fail_line(transmitted, "the number of forces of joints");
}

/// Errors of `write` name the file.
template <class Write>
void naming(const std::string& path, const Write& write) {
  try {
    write();
  } catch (const std::runtime_error& error) {
    throw std::runtime_error("checkpoint '" + path + "' " + error.what());
  }
}

}  // namespace

std::string checkpoint_text(const Simulation& simulation) {
  std::string text = fmt::format("{}\n{}{}", kHeader, identity(simulation), counts_line(state_of(simulation)));
  for_each_number(state_of(simulation), [&](const char*, double value) { text += hexadecimal(value) + "\n"; });
  return text + checksum_line(text);
}

void write_checkpoint(const Simulation& simulation, const std::string& path) {
  naming(path, [&] { UnfinishedFile(path, checkpoint_text(simulation)).put_in_place(); });
}

void try_checkpoint(const Simulation& simulation, const std::string& path) {
  naming(path, [&] { UnfinishedFile(path, checkpoint_text(simulation)); });
}

void read_checkpoint(Simulation& simulation, const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in || std::filesystem::is_directory(path)) fail_reading(path, "cannot be opened");
  read_checkpoint_text(simulation, {std::istreambuf_iterator<char>(in), {}}, path);
}

void read_checkpoint_text(Simulation& simulation, const std::string& text, const std::string& name) {
  Reader reader(text, name);
  reader.require_identity(identity(simulation));
  State state = state_of(simulation);
  read_counts(reader, state);
  for_each_number(state, [&](const char* what, double& value) { value = reader.number(what); });
  if (const std::string line = reader.next(); line.rfind("checksum ", 0) != 0) reader.fail_line(line, "the checksum");
  const Snapshot before = simulation.snapshot();
  try {
    restore(simulation, state);
  } catch (const std::invalid_argument& error) {
    reader.fail(error.what());
  }
  const Energies energies = simulation.energies();
  if (std::isfinite(energies.total() + energies.work + energies.dissipated)) return;
  simulation.restore(before);
  reader.fail("not a state of this scene: its energies are not finite");
}

}  // namespace flexarm
