#include "pictures/recorded_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

namespace flexarm::pictures {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
const char* const kPoseNames[] = {"x", "y", "z", "qx", "qy", "qz", "qw"};

/// Makes the numbers of instants (see Instant) from rows.
class RowReader {
 public:
  RowReader(const Simulation& simulation, const ResultRows& rows)
      : rows_(rows), scene_(simulation.scene()), moved_(simulation.copy()) {
    for (std::size_t i = 0; i < rows.columns.size(); ++i) columns_[rows.columns[i].name] = i;
    if (!find("time")) throw std::invalid_argument("expected a column 'time'");
    for (const scene::LinkDescription& link : scene_.links) frames_.push_back(find_all("frame/" + link.name + "/"));
    for (const std::string& name : simulation.coordinate_names())
      positions_.push_back(find("joint/" + name + "/position"));
    for (const scene::Probe& probe : scene_.probes) probes_.push_back(find_all("probe/" + probe.name + "/"));
    const auto is_known = [](const auto& found) { return found.has_value(); };
    has_frames_ = std::any_of(frames_.begin(), frames_.end(), is_known);
    if (!has_frames_ && std::none_of(positions_.begin(), positions_.end(), is_known))
      throw std::invalid_argument(
          "no column places a link of this scene: expected frame/LINK/* or joint/NAME/position");
  }

  /// Replaces the sections of beams by those that the rows have, and notes what is missing.
  void complete(Picture& picture) {
    for (PictureBeam& beam : picture.beams) {
      const std::string& link = picture.links[beam.link].name;
      const std::vector<Pose> nodes = moved_.undeformed_sections(beam.link, 0);
      std::vector<std::size_t>& places = sections_.emplace_back();
      for (std::size_t k = 0; k < nodes.size(); ++k)
        for (const ResultColumn& part : section_columns())
          if (const auto column = find(fmt::format("beam/{}/{}/{}", link, k, part.name))) places.push_back(*column);
      if (places.size() == nodes.size() * section_columns().size()) {
        make_coarse(nodes, beam);
      } else {
        places.clear();
        picture.notes.push_back(
            fmt::format("link '{}' is drawn {}: the run has no columns beam/{}/*, which `--columns '*'` keeps", link,
                        has_frames_ ? "bent as by a force at its end" : "undeformed", link));
      }
    }
    if (has_frames_ && !picture.lines.empty() && !(picture.beams.empty() && are_all_joints_known()))
      picture.notes.push_back("springs and tendons are not drawn: the run does not say where all their points are");
    if (!has_frames_)
      picture.notes.push_back("the run has no columns frame/*: links are where the positions of joints put them");
  }

  double time(std::size_t row) const { return value(row, columns_.at("time")); }

  std::vector<double> instant(std::size_t row, const Picture& picture) {
    const bool has_lines = !picture.lines.empty() && picture.beams.empty() && are_all_joints_known();
    if (!has_frames_ || has_lines) move_joints(row);
    std::vector<double> values;
    for (std::size_t i = 0; i < picture.links.size(); ++i) append(pose_of(row, i), values);
    for (std::size_t i = 0; i < picture.beams.size(); ++i) append_beam(row, picture, i, values);
    for (std::size_t i = 0; i < picture.probes.size(); ++i) {
      const Vector3 place = probes_[i] ? pose(row, *probes_[i]).position : moved_.probe_pose(i).position;
      for (int k = 0; k < 3; ++k) values.push_back(!probes_[i] && has_frames_ ? kUnknown : place[k]);
    }
    for (const PictureLine& line : picture.lines) {
      if (has_lines || !has_frames_)
        append_line(moved_, line, line_points_, values);
      else
        values.insert(values.end(), 3 * line.points, kUnknown);
    }
    for (std::size_t k = 0; k < rows_.columns.size(); ++k) values.push_back(value(row, k));
    return values;
  }

 private:
  using Places = std::array<std::size_t, 7>;

  std::optional<std::size_t> find(const std::string& name) const {
    const auto found = columns_.find(name);
    return found == columns_.end() ? std::nullopt : std::optional(found->second);
  }
  std::optional<Places> find_all(const std::string& prefix) const {
    Places places;
    for (std::size_t k = 0; k < places.size(); ++k) {
      const auto column = find(prefix + kPoseNames[k]);
      if (!column) return std::nullopt;
      places[k] = *column;
    }
    return places;
  }

  double value(std::size_t row, std::size_t column) const { return rows_.values[row * rows_.columns.size() + column]; }
  Pose pose(std::size_t row, const Places& places) const {
    const auto at = [&](std::size_t k) { return value(row, places[k]); };
    return {{at(0), at(1), at(2)}, Quaternion(at(6), at(3), at(4), at(5)).normalized()};
  }
  static void append(const Pose& pose, std::vector<double>& values) {
    values.insert(values.end(), pose.position.data(), pose.position.data() + 3);
    for (int i = 0; i < 4; ++i) values.push_back(pose.orientation.coeffs()[i]);
  }

  /// Whether the positions of joints place all links.
  bool are_all_joints_known() const {
    for (std::size_t i = 0; i < positions_.size(); ++i)
      if (!positions_[i] || !moved_.is_commandable(i)) return false;
    return true;
  }
  /// Puts the joints where the row has them. Joints that cannot be set stay.
  void move_joints(std::size_t row) {
    std::vector<CoordinateState> states;
    for (std::size_t i = 0; i < positions_.size(); ++i)
      if (positions_[i] && std::isfinite(value(row, *positions_[i])) && moved_.is_commandable(i))
        states.push_back({i, value(row, *positions_[i]), {}});
    try {
      moved_.set_joint_state(states);
    } catch (const std::invalid_argument&) {
      for (const CoordinateState& state : states) try {
          moved_.set_joint_state({state});
        } catch (const std::invalid_argument&) {
        }
    }
  }

  Pose pose_of(std::size_t row, std::size_t link) const {
    return frames_[link] ? pose(row, *frames_[link]) : moved_.link_pose(link);
  }

  /// Reduces a beam of the picture to its nodes.
  void make_coarse(const std::vector<Pose>& nodes, PictureBeam& beam) {
    std::vector<BeamPoint> points;
    moved_.beam_points(beam.link, 0, points);
    beam.arc_lengths.clear();
    for (const BeamPoint& point : points) beam.arc_lengths.push_back(point.arc_length);
    beam.sections = nodes;
    beam.between = 0;
  }

  void append_beam(std::size_t row, const Picture& picture, std::size_t index, std::vector<double>& values) const {
    if (!sections_[index].empty()) {
      for (const std::size_t column : sections_[index]) values.push_back(value(row, column));
      return;
    }
    const PictureBeam& beam = picture.beams[index];
    const Pose frame = pose_of(row, beam.link);
    const Vector3 shift = has_frames_ ? shift_of_end(row, beam) : Vector3::Zero();
    const double length = beam.arc_lengths.back();
    for (std::size_t k = 0; k < beam.sections.size(); ++k) {
      const double part = beam.arc_lengths[k] / length;
      Pose section = beam.sections[k];
      const Vector3 turn =
          (3 * part - 1.5 * part * part) / length * (section.orientation * Vector3::UnitX()).cross(shift);
      section.position += 0.5 * part * part * (3 - part) * shift;  // a cantilever with a force at its end
      if (turn.norm() > 0)
        section.orientation = Quaternion(Eigen::AngleAxisd(turn.norm(), turn.normalized())) * section.orientation;
      append(frame * section, values);
      values.insert(values.end(), 12, kUnknown);
    }
  }

  /// How far the end of a beam is from its undeformed place, in the link's frame, as its child there shows.
  Vector3 shift_of_end(std::size_t row, const PictureBeam& beam) const {
    const Vector3 end = beam.sections.back().position;
    for (const scene::JointDescription& joint : scene_.joints) {
      if (joint.parent != scene_.links[beam.link].name || joint.kind == scene::JointKind::Slide) continue;
      if ((joint.origin.position - end).norm() > 1e-6 * beam.arc_lengths.back() || !keeps_place(joint.kind)) continue;
      const auto is_child = [&](const scene::LinkDescription& link) { return link.name == joint.child; };
      const auto child = std::find_if(scene_.links.begin(), scene_.links.end(), is_child) - scene_.links.begin();
      return pose_of(row, beam.link).inverse() * pose_of(row, static_cast<std::size_t>(child)).position - end;
    }
    return Vector3::Zero();
  }

  /// Whether a joint's child stays at the joint's origin.
  static bool keeps_place(scene::JointKind kind) {
    using scene::JointKind;
    return kind == JointKind::Fixed || kind == JointKind::Revolute || kind == JointKind::Continuous ||
           kind == JointKind::Spherical || kind == JointKind::Universal;
  }

  const ResultRows& rows_;
  const scene::SceneDescription& scene_;
  Simulation moved_;                  ///< by the positions of joints, if the rows have no frames, or for lines
  std::vector<Vector3> line_points_;  ///< scratch
  bool has_frames_ = false;
  std::map<std::string, std::size_t> columns_;
  std::vector<std::optional<Places>> frames_, probes_;  ///< of links, of probes
  std::vector<std::optional<std::size_t>> positions_;   ///< of joint coordinates
  std::vector<std::vector<std::size_t>> sections_;      ///< columns of each beam; empty: there are none
};

}  // namespace

EncodedRun record_rows(const Simulation& simulation, const ResultRows& rows, const RecordingOptions& options) {
  RowReader reader(simulation, rows);
  Picture picture = picture_of(simulation, rows.columns);
  picture.title = options.title;
  picture.notes.insert(picture.notes.begin(), rows.notes.begin(), rows.notes.end());
  reader.complete(picture);
  Recording recording(std::move(picture), options.rate);
  for (std::size_t row = 0; row < rows.count(); ++row)
    if (recording.is_due(reader.time(row)) || row + 1 == rows.count())
      recording.keep(reader.time(row), reader.instant(row, recording.picture()));
  return recording.encode();
}

}  // namespace flexarm::pictures
