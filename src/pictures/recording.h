#pragma once
/// Records what a page shows of a run. docs/notes/page.md says what the numbers are.

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "flexarm/simulation/result_columns.h"
#include "pictures/due_times.h"
#include "pictures/picture.h"

namespace flexarm::pictures {

/// A part of a run that a page plays by itself, such as a natural mode.
struct Clip {
  std::string name;
  std::size_t first, count;  ///< instants
};

/// A run as a page contains it.
struct EncodedRun {
  std::string picture;                  ///< JSON
  std::string motion;                   ///< bytes of a zlib stream
  std::vector<std::string> notes = {};  ///< those of the picture
};

/// Appends the points of a line. Those that it has less than at most are repetitions of its last one.
void append_line(const Simulation& simulation, const PictureLine& line, std::vector<Vector3>& scratch,
                 std::vector<double>& values);

/// The numbers of one instant that change with time, without arrows: poses of links, sections of beams, probes, lines,
/// columns.
class Instant {
 public:
  Instant(const Picture& picture, ResultColumns columns) : picture_(picture), columns_(std::move(columns)) {}

  /// Appends the numbers of the present state. `counts`: of steps since the last instant, for columns of the solver.
  void append(const Simulation& simulation, const StepCounts& counts, std::vector<double>& values);

 private:
  const Picture& picture_;
  ResultColumns columns_;
  std::vector<BeamPoint> points_;     ///< scratch
  std::vector<Vector3> line_points_;  ///< scratch
};

/// The kinds of arrows, in the order of the tracks.
enum class ArrowKind { Effort, Load, Reaction, Contact };
constexpr std::size_t kArrowKinds = 4;
using Arrows = std::array<std::vector<ActingWrench>, kArrowKinds>;

constexpr std::array<const char*, kArrowKinds> kArrowNames = {"effort", "load", "reaction", "contact"};

/// Whether a sensor measures the force and moment that a joint transmits.
bool measures_reaction(const scene::Sensor& sensor);
/// What sensors of the kinds wrench and reaction measure now, without their errors. Overwrites `reactions`.
void find_reactions(const Simulation& simulation, std::vector<ActingWrench>& reactions);
/// Forces of contacts on their first bodies. Overwrites `pushes`.
void find_pushes(const Simulation& simulation, std::vector<ActingWrench>& pushes);
/// The arrows of the present state.
void find_arrows(const Simulation& simulation, Arrows& arrows);

/// Places of the quaternions within the numbers of an Instant.
std::vector<std::size_t> quaternions_of(const Picture& picture);
/// Changes signs of quaternions at these places, so that they change continuously from the last instant on.
void keep_signs(const std::vector<std::size_t>& quaternions, const std::vector<double>& last,
                std::vector<double>& values);

/// What a recording keeps.
struct RecordingOptions {
  std::string title;                      ///< of the page
  double rate = 60;                       ///< instants per second of simulated time, at most
  std::vector<std::string> columns = {};  ///< patterns of names; empty: all columns
  bool has_arrows = true;
};

/// Keeps the instants of a run in memory. Of a long run it keeps fewer instants, at equal distances, unless it has
/// clips, or an instant that is kept still.
class Recording {
 public:
  /// @param simulation  in its state at the start; need not outlive this object
  Recording(const Simulation& simulation, const RecordingOptions& options);
  /// For instants that do not come from a simulation. `rate`: see RecordingOptions.
  Recording(Picture picture, double rate);
  Recording(const Recording&) = delete;  // its parts refer to each other
  Recording& operator=(const Recording&) = delete;

  /// Whether the next instant is due at a time, or in the present state.
  bool is_due(double time) const { return due_.is_due(time); }
  bool is_due(const Simulation& simulation) const { return due_.is_due(simulation); }
  /// Keeps the present state. `counts`: of steps since the last instant.
  void keep(const Simulation& simulation, const StepCounts& counts);
  /// Keeps an instant. `values`: see Instant.
  void keep(double time, std::vector<double> values, Arrows arrows = {});
  /// Steps until a time [s], and keeps the instants that are due, and the first and the last one.
  /// @param before_step  called before each step; the run ends if it returns false
  /// @returns the result of the last step
  StepResult run(Simulation& simulation, double until, const std::function<bool(Simulation&)>& before_step);
  /// Time of the last instant [s]; not a number if there is none.
  double last_time() const;

  Picture& picture() { return picture_; }
  std::size_t size() const { return times_.size(); }
  /// Declares the instants from `first` to the last one as a clip.
  void end_clip(const std::string& name, std::size_t first);
  /// Shows the instant beside all others, faintly.
  void keep_still(std::size_t instant) { still_ = static_cast<int>(instant); }

  EncodedRun encode() const;

 private:
  /// Drops every second instant.
  void thin_out();
  std::array<std::size_t, kArrowKinds> most_arrows() const;

  Picture picture_;
  std::optional<Instant> instant_;  ///< empty: instants do not come from a simulation
  bool has_arrows_;
  DueTimes due_;
  std::vector<double> times_;
  std::vector<std::vector<double>> values_;  ///< of Instant, per instant
  std::vector<Arrows> arrows_;               ///< per instant
  std::vector<Clip> clips_;
  int still_ = -1;
};

}  // namespace flexarm::pictures
