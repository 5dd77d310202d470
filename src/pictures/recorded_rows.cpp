#include "pictures/recorded_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include "pictures/recorded_arrows.h"
#include "pictures/recorded_columns.h"
#include "pictures/recorded_motion.h"

namespace flexarm::pictures {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// The same rows, with their columns in the order of results. Files may have another one, such as that of the alphabet.
ResultRows in_order(const Simulation& simulation, const ResultRows& rows) {
  const ResultColumns usual(simulation, ResultColumns::Solver::WithEstimate);
  std::map<std::string, std::size_t> ranks;
  for (const ResultColumn& column : usual.columns()) ranks.emplace(column.name, ranks.size());
  const auto rank = [&](std::size_t column) {
    const auto found = ranks.find(rows.columns[column].name);
    return found == ranks.end() ? ranks.size() : found->second;
  };
  std::vector<std::size_t> order(rows.columns.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
  ResultRows out{{}, {}, rows.notes};
  for (const std::size_t column : order) out.columns.push_back(rows.columns[column]);
  out.values.reserve(rows.values.size());
  for (std::size_t row = 0; row < rows.count(); ++row)
    for (const std::size_t column : order) out.values.push_back(rows.values[row * order.size() + column]);
  return out;
}

/// Makes the numbers of instants (see Instant) from rows.
class RowReader {
 public:
  RowReader(const Simulation& simulation, const ResultRows& rows)
      : rows_(rows), columns_(rows), motion_(simulation, columns_), arrows_(simulation, columns_) {
    const auto time = columns_.find("time");
    if (!time) throw std::invalid_argument("expected a column 'time'");
    time_ = *time;
    for (const scene::Probe& probe : simulation.scene().probes)
      probes_.push_back(columns_.find_pose("probe/" + probe.name + "/"));
  }

  /// Reduces beams to the sections that the rows have, and notes what is missing.
  void complete(Picture& picture) {
    for (PictureBeam& beam : picture.beams) {
      sections_.push_back(motion_.sections_of(beam.link));
      const std::string& link = picture.links[beam.link].name;
      if (!sections_.back().empty())
        make_coarse(beam);
      else if (motion_.is_flexible(beam.link))
        picture.notes.push_back(fmt::format(
            "link '{0}' is drawn bent {1}, without colours: the run has no columns beam/{0}/*, which CSV and HDF5 "
            "files have by `--columns '*'`",
            link, motion_.has_frames() ? "as its ends are" : "as at the start"));
    }
    const std::vector<std::string> lacks = arrows_.notes();
    picture.notes.insert(picture.notes.end(), lacks.begin(), lacks.end());
    if (!picture.lines.empty() && !motion_.places_lines())
      picture.notes.push_back("springs and tendons are not drawn: the run does not say where all their points are");
    if (!motion_.has_frames())
      picture.notes.push_back(
          motion_.has_positions()
              ? "the run has no columns frame/*: links are where the positions of joints put them"
              : "no column places a link of this scene (frame/LINK/* or joint/NAME/position), so all links stay where "
                "they are at the start");
  }

  double time(std::size_t row) const { return columns_.value(row, time_); }

  std::vector<double> instant(std::size_t row, const Picture& picture, Arrows& arrows) {
    motion_.show(row, time(row));
    arrows_.find(row, motion_, arrows);
    std::vector<double> values;
    for (std::size_t i = 0; i < picture.links.size(); ++i) append(motion_.link_pose(row, i), values);
    for (std::size_t i = 0; i < picture.beams.size(); ++i) append_beam(row, picture.beams[i], sections_[i], values);
    for (std::size_t i = 0; i < picture.probes.size(); ++i) {
      const Vector3 place =
          probes_[i] ? columns_.pose(row, *probes_[i]).position : motion_.shown().probe_pose(i).position;
      values.insert(values.end(), place.data(), place.data() + 3);
    }
    for (const PictureLine& line : picture.lines) {
      if (motion_.places_lines())
        append_line(motion_.shown(), line, line_points_, values);
      else
        values.insert(values.end(), 3 * line.points, kUnknown);
    }
    for (std::size_t k = 0; k < rows_.columns.size(); ++k) values.push_back(columns_.value(row, k));
    return values;
  }

 private:
  static void append(const Pose& pose, std::vector<double>& values) {
    values.insert(values.end(), pose.position.data(), pose.position.data() + 3);
    for (int i = 0; i < 4; ++i) values.push_back(pose.orientation.coeffs()[i]);
  }

  /// Reduces a beam of the picture to its nodes.
  void make_coarse(PictureBeam& beam) {
    points_.clear();
    motion_.shown().beam_points(beam.link, 0, points_);
    beam.arc_lengths.clear();
    for (const BeamPoint& point : points_) beam.arc_lengths.push_back(point.arc_length);
    beam.sections = motion_.shown().undeformed_sections(beam.link, 0);
    beam.between = 0;
  }

  void append_beam(std::size_t row, const PictureBeam& beam, const std::vector<std::size_t>& sections,
                   std::vector<double>& values) {
    for (const std::size_t column : sections) values.push_back(columns_.value(row, column));
    if (!sections.empty()) return;
    points_.clear();
    motion_.shown().beam_points(beam.link, beam.between, points_);
    for (const BeamPoint& point : points_) {
      append(point.pose, values);
      for (const Vector6& numbers : {point.strain, point.resultant})
        for (int i = 0; i < 6; ++i) values.push_back(motion_.is_flexible(beam.link) ? kUnknown : numbers[i]);
    }
  }

  const ResultRows& rows_;
  RecordedColumns columns_;
  RecordedMotion motion_;
  RecordedArrows arrows_;
  std::size_t time_ = 0;
  std::vector<std::optional<RecordedColumns::PosePlaces>> probes_;
  std::vector<std::vector<std::size_t>> sections_;  ///< columns of each beam; empty: there are none
  std::vector<BeamPoint> points_;                   ///< scratch
  std::vector<Vector3> line_points_;                ///< scratch
};

}  // namespace

EncodedRun record_rows(const Simulation& simulation, const ResultRows& given, const RecordingOptions& options) {
  const ResultRows rows = in_order(simulation, given);
  RowReader reader(simulation, rows);
  Picture picture = picture_of(simulation, rows.columns);
  picture.title = options.title;
  picture.notes.insert(picture.notes.begin(), rows.notes.begin(), rows.notes.end());
  reader.complete(picture);
  Recording recording(std::move(picture), options.rate);
  for (std::size_t row = 0; row < rows.count(); ++row) {
    if (!recording.is_due(reader.time(row)) && row + 1 < rows.count()) continue;
    Arrows arrows;
    std::vector<double> values = reader.instant(row, recording.picture(), arrows);
    recording.keep(reader.time(row), std::move(values), std::move(arrows));
  }
  return recording.encode();
}

}  // namespace flexarm::pictures
