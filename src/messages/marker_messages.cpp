#include "messages/marker_messages.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <type_traits>
#include <variant>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "flexarm/scene/scene_description.h"
#include "messages/colors.h"
#include "messages/conversions.h"
#include "messages/ground_markers.h"
#include "messages/legend.h"
#include "messages/markers.h"
#include "messages/picture_axes.h"
#include "pictures/recording.h"
#include "pictures/surface_meshes.h"

namespace flexarm::messages {
namespace {

constexpr int kPointsBetweenNodes = 3;  ///< so that bending looks smooth
// Per radius of the scene:
constexpr double kSmallestRadius =
    0.004;  ///< of a tube; a thinner one, such as a rod of 3 mm by 2 m, would be hard to see
constexpr double kTrailWidth = 0.004, kLineWidth = 0.006, kTextHeight = 0.06, kGapOfText = 0.02;
constexpr double kLineSpacing = 1.3;  ///< of rviz, in multiples of the text's height
/// Smaller strains are the round-off of a beam without load.
constexpr double kSmallestStrain = 1e-9;

constexpr std::size_t kTextLines = 3, kMostLines = 5, kLongestLine = 64;
const std_msgs::ColorRGBA kStateColor = make_color(1, 0.8, 0.2);
const std_msgs::ColorRGBA kLineColor = make_color(0.85, 0.8, 0.65);

const ArrowKind kEfforts{"joint efforts", make_color(1, 0.65, 0.1)};
const ArrowKind kWrenches{"applied wrenches", make_color(1, 0.35, 0.8)};
const ArrowKind kReactions{"reactions", make_color(0.6, 0.9, 1)};
const ArrowKind kContacts{"contacts", make_color(0.5, 1, 0.4)};

TriangleMesh mesh_of(const scene::VisualDescription& visual, const std::string& scene_file) {
  return std::visit(
      [&](const auto& shape) -> TriangleMesh {
        using Shape = std::decay_t<decltype(shape)>;
        if constexpr (std::is_same_v<Shape, scene::BoxShape>) return box_mesh(shape);
        if constexpr (std::is_same_v<Shape, scene::CylinderShape>) return cylinder_mesh(shape);
        if constexpr (std::is_same_v<Shape, scene::SphereShape>) return sphere_mesh(shape);
        if constexpr (std::is_same_v<Shape, scene::MeshShape>) return {pictures::surface_of_mesh(shape, scene_file)};
      },
      visual.shape);
}

/// The shapes of a link's <visual>, or a tube of that radius if no shape can be drawn.
std::vector<Skin> skins_of(const scene::LinkDescription& link, const std::string& scene_file,
                           const std::vector<Pose>& sections, double radius, const MarkerMessages::Warn& warn) {
  std::vector<Skin> skins;
  for (const scene::VisualDescription& visual : link.visuals) try {
      TriangleMesh mesh;
      mesh.add(mesh_of(visual, scene_file), visual.origin);
      skins.emplace_back(mesh, sections);
    } catch (const std::runtime_error& error) {
      const auto* file = std::get_if<scene::MeshShape>(&visual.shape);
      warn(
          fmt::format("link '{}': its <visual> '{}' is not drawn: {}", link.name, file ? file->url : "", error.what()));
    }
  if (skins.empty()) skins.push_back(Skin::tube(sections, radius));
  return skins;
}

/// Places text below (side -1) or above (1) the space that the scene can reach, as seen in the picture.
void place_text(std::size_t lines, int side, const pictures::SceneExtent& extent, visualization_msgs::Marker& text) {
  const double away = kOutline + kGapOfText + 0.5 * kLineSpacing * kTextHeight * static_cast<double>(lines);
  text.pose.position = to_point(extent.center + side * away * extent.radius * picture_axes().up);
  text.scale.z = kTextHeight * extent.radius;
}

/// Breaks text into lines as long as the picture is wide, at most kMostLines; drops the rest.
std::vector<std::string> wrapped(const std::string& text) {
  std::istringstream words(text);
  std::vector<std::string> lines(1);
  for (std::string word; words >> word;) {
    std::string& line = lines.back();
    if (line.size() + 1 + word.size() <= kLongestLine || line.empty()) {
      line += (line.empty() ? "" : " ") + word;
    } else if (lines.size() == kMostLines) {
      line += " ...";
      break;
    } else {
      lines.push_back(word);
    }
  }
  return lines;
}

/// Energy - work + dissipated: constant but for the error of the steps [J].
double balance(const Energies& energies) {
  return energies.total() - energies.work + energies.dissipated;
}

}  // namespace

bool* MarkerChoice::find(const std::string& name) {
  bool* const members[] = {&beams, &trails, &efforts, &wrenches, &reactions, &contacts,
                           &lines, &masses, &grounds, &text,     &legend};
  const auto found = std::find(names().begin(), names().end(), name);
  return found == names().end() ? nullptr : members[found - names().begin()];
}

const std::vector<std::string>& MarkerChoice::names() {
  static const std::vector<std::string> names{"beams", "trails", "efforts", "wrenches", "reactions", "contacts",
                                              "lines", "masses", "grounds", "text",     "legend"};
  return names;
}

MarkerMessages::MarkerMessages(const Simulation& simulation, const std::string& root_frame, const MarkerChoice& choice,
                               const Warn& warn)
    : simulation_(simulation),
      root_frame_(root_frame),
      choice_(choice),
      extent_(pictures::scene_extent(simulation)),
      energy_(balance(simulation.energies())),
      cylinders_(simulation),
      bare_links_(simulation, extent_.radius),
      floors_(pictures::floors_of(simulation.scene().grounds, pictures::up_of(simulation.scene().gravity), extent_)),
      trails_(simulation, choice.trail_duration) {
  for (std::size_t link = 0; link < simulation.link_names().size(); ++link) {
    const std::vector<Pose> sections = simulation.undeformed_sections(link, kPointsBetweenNodes);
    if (sections.empty()) continue;
    const double radius = std::max(simulation.beam_radius(link), kSmallestRadius * extent_.radius);
    beams_.push_back(
        {link, skins_of(simulation.scene().links[link], simulation.scene().file, sections, radius, warn), {}, {}});
  }
}

void MarkerMessages::begin_anew() {
  largest_strain_ = 0;
  arrow_scale_ = {};
  trails_.forget();
}

visualization_msgs::MarkerArray MarkerMessages::make(const ros::Time& stamp, std::optional<double> real_time_factor,
                                                     const std::string& state) {
  std_msgs::Header header;
  header.stamp = stamp;
  header.frame_id = root_frame_;
  visualization_msgs::MarkerArray message;
  if (choice_.beams) add_beams(header, message);
  if (choice_.beams) cylinders_.add_to(header, message);
  if (choice_.lines) add_lines(header, message);
  if (choice_.masses) bare_links_.add_to(header, message);
  if (choice_.grounds) add_grounds(header, floors_, message);
  add_all_arrows(header, message);
  if (choice_.trails) {
    trails_.update();
    trails_.add_to(header, kTrailWidth * extent_.radius, message);
  }
  if (choice_.text) add_text(header, real_time_factor, message);
  if (choice_.text && !state.empty()) add_state(header, state, message);
  if (choice_.legend) {
    LegendContent content{std::nullopt, arrow_scale_, {}};
    if (choice_.beams && !beams_.empty()) content.largest_strain = largest_strain_;
    if (choice_.efforts && !efforts_.empty()) content.kinds.push_back(kEfforts);
    if (choice_.wrenches) content.kinds.push_back(kWrenches);
    if (!reactions_.empty()) content.kinds.push_back(kReactions);
    if (choice_.contacts && !simulation_.scene().contacts.empty()) content.kinds.push_back(kContacts);
    add_legend(header, extent_, content, message);
  }
  delete_others(header, message);
  return message;
}

void MarkerMessages::add_beams(const std_msgs::Header& header, visualization_msgs::MarkerArray& message) {
  for (Beam& beam : beams_) {
    const double radius = simulation_.beam_radius(beam.link);
    beam.points.clear();
    simulation_.beam_points(beam.link, kPointsBetweenNodes, beam.points);
    beam.sections.clear();
    for (const BeamPoint& point : beam.points) {
      beam.sections.push_back({point.pose, edge_strain(point, radius)});
      largest_strain_ = std::max(largest_strain_, beam.sections.back().strain);
    }
  }
  const double scale = std::max(largest_strain_, kSmallestStrain);
  for (Beam& beam : beams_) {
    for (Skin::Section& section : beam.sections) section.strain /= scale;
    message.markers.push_back(
        make_marker(header, simulation_.link_names()[beam.link], visualization_msgs::Marker::TRIANGLE_LIST));
    for (Skin& skin : beam.skins) skin.draw(beam.sections, message.markers.back());
  }
}

void MarkerMessages::add_lines(const std_msgs::Header& header, visualization_msgs::MarkerArray& message) {
  for (std::size_t i = 0; i < simulation_.scene().force_elements.size(); ++i) {
    simulation_.line_points(i, line_points_);
    if (line_points_.size() < 2) continue;
    visualization_msgs::Marker line =
        make_marker(header, "lines", visualization_msgs::Marker::LINE_STRIP, static_cast<int>(i));
    line.scale.x = kLineWidth * extent_.radius;
    line.color = kLineColor;
    for (const Vector3& point : line_points_) line.points.push_back(to_point(point));
    message.markers.push_back(line);
  }
}

void MarkerMessages::add_all_arrows(const std_msgs::Header& header, visualization_msgs::MarkerArray& message) {
  if (choice_.efforts) simulation_.effort_wrenches(efforts_);
  if (choice_.wrenches) simulation_.outside_wrenches(wrenches_);
  if (choice_.reactions) pictures::find_reactions(simulation_, reactions_);
  if (choice_.contacts) pictures::find_pushes(simulation_, pushes_);
  for (const auto* shown : {&efforts_, &wrenches_, &reactions_, &pushes_}) arrow_scale_.note(*shown);
  const auto add = [&](const ArrowKind& kind, const std::vector<ActingWrench>& wrenches) {
    add_arrows(header, kind.name, wrenches, arrow_scale_, extent_.radius, kind.color, message);
  };
  add(kEfforts, efforts_);
  add(kWrenches, wrenches_);
  add(kReactions, reactions_);
  add(kContacts, pushes_);
}

void MarkerMessages::add_text(const std_msgs::Header& header, std::optional<double> real_time_factor,
                              visualization_msgs::MarkerArray& message) const {
  const Energies energies = simulation_.energies();
  visualization_msgs::Marker text = make_marker(header, "text", visualization_msgs::Marker::TEXT_VIEW_FACING, 1);
  place_text(kTextLines, -1, extent_, text);
  text.text = fmt::format("t = {:.2f} s", simulation_.time());
  if (real_time_factor) text.text += fmt::format(", {:.2f} x real time", *real_time_factor);
  text.text += fmt::format("\nkinetic {:.3g} J, strain {:.3g} J, potential {:.3g} J", energies.kinetic, energies.strain,
                           energies.potential);
  text.text += fmt::format("\nwork {:.3g} J, dissipated {:.3g} J, error of the steps {:.1g} J", energies.work,
                           energies.dissipated, balance(energies) - energy_);
  message.markers.push_back(text);
}

void MarkerMessages::add_state(const std_msgs::Header& header, const std::string& state,
                               visualization_msgs::MarkerArray& message) const {
  visualization_msgs::Marker text = make_marker(header, "text", visualization_msgs::Marker::TEXT_VIEW_FACING, 2);
  const std::vector<std::string> lines = wrapped(state);
  place_text(lines.size(), 1, extent_, text);
  text.color = kStateColor;
  text.text = fmt::format("{}", fmt::join(lines, "\n"));
  message.markers.push_back(text);
}

void MarkerMessages::delete_others(const std_msgs::Header& header, visualization_msgs::MarkerArray& message) {
  std::set<std::pair<std::string, int>> present;
  for (const visualization_msgs::Marker& marker : message.markers) present.emplace(marker.ns, marker.id);
  for (const auto& [name, id] : shown_) {
    if (present.count({name, id}) > 0) continue;
    visualization_msgs::Marker gone = make_marker(header, name, visualization_msgs::Marker::TRIANGLE_LIST, id);
    gone.action = visualization_msgs::Marker::DELETE;
    message.markers.push_back(gone);
  }
  shown_.merge(present);
}

}  // namespace flexarm::messages
