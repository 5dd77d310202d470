#include "flexarm/scene/urdf_reader.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include <fmt/format.h>

#include "math/lfs_pointer.h"
#include "scene/force_element_kinds.h"
#include "scene/limits.h"
#include "scene/parameters.h"
#include "scene/readers.h"
#include "scene/scene_checks.h"
#include "scene/standard_reader.h"
#include "scene/strangers.h"
#include "scene/urdfdom.h"
#include "scene/xacro.h"
#include "scene/xacro_program.h"
#include "scene/xml_document.h"

namespace flexarm::scene {
namespace {

/// An element of flexarm, and the element whose child it must be.
struct Place {
  const char* tag;
  const char* parent;
};
constexpr Place kPlaces[] = {{"beam", "link"},       {"release", "joint"},    {"axis2", "joint"},
                             {"slide", "joint"},     {"couple", "joint"},     {"child_origin", "loop_joint"},
                             {"friction", "joint"},  {"simulation", "robot"}, {"loop_joint", "robot"},
                             {"root", "simulation"}, {"drive", "robot"},      {"servo", "robot"},
                             {"hub", "beam"},        {"sensor", "robot"},     {"parameter", "robot"},
                             {"clearance", "joint"}, {"drag", "link"}};

/// Returns kPlaces, and a row for each kind of force element: these are children of <robot>.
std::vector<Place> places_of_all(const std::vector<ForceElementKind>& kinds) {
  std::vector<Place> places(std::begin(kPlaces), std::end(kPlaces));
  for (const ForceElementKind& kind : kinds) places.push_back({kind.tag.c_str(), "robot"});
  return places;
}

/// Records errors for elements of flexarm in a wrong place, where they would be ignored like those of other programs.
void check_places(const XmlElement& element, const std::vector<Place>& places) {
  const std::string tag = element.tag();
  for (const XmlElement& child : element.children()) {
    for (const Place& place : places) {
      const bool is_here = tag == place.parent || (tag == "loop_joint" && std::string_view(place.parent) == "joint");
      if (child.tag() == place.tag && !is_here)
        child.error("<" + child.tag() + "> must be a child of <" + place.parent + ">");
    }
    if (belongs_in_simulation(child)) child.error("<" + child.tag() + "> must be a child of <simulation>");
  }
}

class SceneReader {
 public:
  SceneReader(const ReadOptions& options, Findings& findings) : findings_(findings), kinds_(force_element_kinds()) {
    if (options.more_force_elements)
      kinds_.insert(kinds_.end(), options.more_force_elements->begin(), options.more_force_elements->end());
    places_ = places_of_all(kinds_);
    start_.clamps_all = options.clamp_start;
    start_.is_spawned = options.is_spawned;
    scene_.lock_massless = options.lock_massless;
    scene_.starts_in_equilibrium = options.equilibrium_start;
  }

  SceneDescription read(const XmlElement& unnamed, std::vector<ParameterDescription> parameters) {
    scene_.parameters = std::move(parameters);
    scene_.file = findings_.file();
    scene_.name = unnamed.text("name").value_or("");
    const XmlElement robot = unnamed.with_name(scene_.name);
    check_places(robot, places_);
    robot.expect_at_most_one({"simulation"});
    for (const XmlElement& child : robot.children()) read_child(child);
    warn_of_strangers(robot, kinds_);
    warn_of_misspelt_words(robot);
    warn_of_gazebo_loops(robot, scene_);
    check_size(robot, "links", scene_.links.size(), kMostLinks);
    check_size(robot, "joints", scene_.joints.size(), kMostJoints);
    check_size(robot, "loop joints", scene_.loop_joints.size(), kMostJoints);
    check_size(robot, "cylinders", cylinders_.size(), kMostJoints);
    check_size(robot, "springs", scene_.springs.size(), kMostJoints);
    check_size(robot, "drives", scene_.drives.size(), kMostJoints);
    check_size(robot, "servos", scene_.servos.size(), kMostJoints);
    settle_gears(transmissions_, scene_.drives, findings_);
    check_size(robot, "sensors", scene_.sensors.size(), kMostSensors);
    check_size(robot, "elements between points of links", scene_.force_elements.size(), kMostForceElements);
    check_size(robot, "grounds", scene_.grounds.size(), kMostContacts);
    check_size(robot, "<contact>", scene_.contacts.size(), kMostContacts);
    check_size(robot, "<no_contact>", scene_.no_contacts.size(), kMostContacts);
    if (scene_.links.empty()) robot.error("at least one <link> is expected");
    add_cylinders(cylinders_, scene_, unreadable_, findings_);
    check_size(robot, "winches", winches_.size(), kMostJoints);
    check_tree(scene_, findings_);
    settle_root(scene_, start_, findings_);
    add_winches(winches_, scene_, findings_);  // on the world, even if the root link of the file moves
    add_pumps(cylinders_, scene_, findings_);
    connect_tendon_sensors(scene_, findings_);
    settle_inertias(scene_, findings_);
    warn_of_units(scene_, findings_);
    settle_positions(scene_, start_, unreadable_, findings_);
    check_references(scene_, unreadable_, findings_);
    check_contacts(scene_, findings_);
    if (!scene_.contacts.empty() || start_.is_spawned) warn_of_untouchable_shapes(robot);
    add_disabled_pairs(disabled_, scene_);
    if (findings_.error_count() == 0) hold_followers_of_fixed_joints(scene_);
    return std::move(scene_);
  }

 private:
  void read_child(const XmlElement& child) {
    const std::size_t errors = findings_.error_count();
    const std::string tag = child.tag();
    if (tag == "link" && scene_.links.size() <= kMostLinks) {
      scene_.links.push_back(read_whole_link(child));
      if (findings_.error_count() > errors) unreadable_.insert(scene_.links.back().name);
    } else if (tag == "joint" && scene_.joints.size() <= kMostJoints) {
      scene_.joints.push_back(read_joint(child));
      const std::string name = scene_.joints.back().name;
      check_places(child.with_name(name), places_);
      if (read_play(child, scene_.joints.back())) free_play(scene_.joints.back());
      if (findings_.error_count() > errors) unreadable_.insert(name);
    } else if (tag == "material") {
      judge_material(child);
    } else if (tag == "loop_joint" && scene_.loop_joints.size() <= kMostJoints) {
      scene_.loop_joints.push_back(read_loop_joint(child));
      const std::string name = scene_.loop_joints.back().name;
      check_places(child.with_name(name), places_);
      if (read_play(child, scene_.loop_joints.back())) {
        scene_.clearances.back().closes_loop = true;
        scene_.loop_joints.pop_back();
      }
      if (findings_.error_count() > errors) unreadable_.insert(name);
    } else if (tag == "cylinder" && cylinders_.size() <= kMostJoints) {
      read_whole_cylinder(child);
    } else if (tag == "winch" && winches_.size() <= kMostJoints) {
      winches_.push_back(read_winch(child));
      const std::string name = winches_.back().travel.name;
      read_actuators(child.with_name(name));
      if (findings_.error_count() > errors) unreadable_.insert(name);
    } else if (const ForceElementKind* kind = kind_of(child)) {
      if (scene_.force_elements.size() <= kMostForceElements) scene_.force_elements.push_back(kind->read(child));
    } else if (tag == "ground" && scene_.grounds.size() <= kMostContacts) {
      scene_.grounds.push_back(read_ground(child));
    } else if (is_contact(child) && scene_.contacts.size() <= kMostContacts) {
      scene_.contacts.push_back(read_contact(child));
    } else if (tag == "no_contact" && child.has("srdf")) {
      const std::vector<ContactPair> pairs = read_srdf(child);
      disabled_.insert(disabled_.end(), pairs.begin(), pairs.end());
    } else if (tag == "gazebo") {
      read_surface(child, scene_);
    } else if (tag == "no_contact" && scene_.no_contacts.size() <= kMostContacts) {
      scene_.no_contacts.push_back(read_no_contact(child));
    } else if (tag == "spring" && scene_.springs.size() <= kMostJoints) {
      scene_.springs.push_back(read_spring(child));
    } else if (tag == "drive" && scene_.drives.size() <= kMostJoints) {
      scene_.drives.push_back(read_drive(child));
    } else if (tag == "servo" && scene_.servos.size() <= kMostJoints) {
      scene_.servos.push_back(read_servo(child));
    } else if (tag == "transmission" && transmissions_.size() <= kMostJoints) {
      if (const std::optional<Transmission> transmission = read_transmission(child))
        transmissions_.push_back(*transmission);
    } else if (tag == "simulation") {
      read_simulation(child, scene_, start_);
    } else if (tag == "sensor" && !child.child("parent") && scene_.sensors.size() <= kMostSensors) {
      scene_.sensors.push_back(read_sensor(child));  // a <sensor> with a <parent> is URDF's own
    }
  }

  void read_whole_cylinder(const XmlElement& unnamed) {
    const std::size_t errors = findings_.error_count();
    cylinders_.push_back(read_cylinder(unnamed));
    const CylinderDescription& read = cylinders_.back().cylinder;
    const XmlElement cylinder = unnamed.with_name(read.name);
    read_actuators(cylinder);
    if (const std::optional<XmlElement> hydraulics = cylinder.child("hydraulics"))
      if (const std::optional<XmlElement> its = hydraulics->child("pump")) read_actuators(its->with_name(read.pump));
    if (findings_.error_count() > errors) unreadable_.insert({read.name, read.pump});
  }

  /// Reads what acts on the coordinate of a cylinder, a winch or a pump.
  void read_actuators(const XmlElement& element) {
    for (const XmlElement& child : element.children()) {
      if (child.tag() == "spring") scene_.springs.push_back(read_spring(child));
      if (child.tag() == "drive") scene_.drives.push_back(read_drive(child));
      if (child.tag() == "servo") scene_.servos.push_back(read_servo(child));
    }
  }

  /// Reads the <clearance> of a joint. Returns false if it has none.
  bool read_play(const XmlElement& unnamed, const JointDescription& description) {
    const XmlElement joint = unnamed.with_name(description.name);
    const std::optional<XmlElement> clearance = joint.child("clearance");
    if (clearance) scene_.clearances.push_back(read_clearance(*clearance, joint, description));
    return clearance.has_value();
  }

  /// Returns the kind of force element that the child is; null if it is none.
  const ForceElementKind* kind_of(const XmlElement& child) const {
    const auto kind = std::find_if(kinds_.begin(), kinds_.end(), [&](const ForceElementKind& each) {
      return each.tag == child.tag() && (each.attribute.empty() || child.has(each.attribute.c_str()));
    });
    return kind == kinds_.end() ? nullptr : &*kind;
  }

  LinkDescription read_whole_link(const XmlElement& unnamed) {
    LinkDescription description = read_link(unnamed);
    const XmlElement link = unnamed.with_name(description.name);
    check_places(link, places_);
    if (const std::optional<XmlElement> beam = link.child("beam")) {
      description.beam = read_beam(*beam, description.name);
      if (const std::optional<XmlElement> inertial = link.child("inertial"))
        inertial->warning("is ignored, since the mass of a flexible link comes from its <beam>");
      if (!description.beam) return description;
    }
    if (const std::optional<XmlElement> drag = link.child("drag")) description.drag = read_drag(*drag, description);
    return description;
  }

  void check_size(const XmlElement& robot, const char* what, std::size_t count, std::size_t most) const {
    if (count > most) robot.error(fmt::format("a scene has at most {} {}", most, what));
  }

  Findings& findings_;
  std::vector<ForceElementKind> kinds_;
  std::vector<Place> places_;
  std::vector<ReadCylinder> cylinders_;
  std::vector<ReadWinch> winches_;
  SceneDescription scene_;
  StartRequest start_;
  std::vector<Transmission> transmissions_;
  std::vector<ContactPair> disabled_;  // pairs whose collisions SRDF files disable
  std::set<std::string> unreadable_;   // names of links and joints with errors; nothing else about these is reliable
};

/// Returns the document's text without its <parameter>s.
std::string text_without_parameters(tinyxml2::XMLDocument& document) {
  tinyxml2::XMLElement& root = *document.RootElement();
  while (tinyxml2::XMLElement* parameter = root.FirstChildElement("parameter")) root.DeleteChild(parameter);
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

/// @param urdf  output, see ReadResult::urdf
std::optional<SceneDescription> read_scene(const std::string& text, const ReadOptions& options, Findings& findings,
                                           std::string& urdf) {
  if (text.size() > kLargestFile) {
    findings.error(0, "", fmt::format("may have {} bytes", kLargestFile), fmt::format("'{}'", text.size()));
    return std::nullopt;
  }
  if (is_lfs_pointer(text)) {
    findings.error(1, "", kLfsPointerText, quoted(text.substr(0, text.find('\n'))));
    return std::nullopt;
  }
  tinyxml2::XMLDocument document;
  if (!parse_xml(text, document, findings)) return std::nullopt;
  tinyxml2::XMLElement* root = document.RootElement();
  if (!root || std::string_view(root->Name()) != "robot") {
    findings.error(root ? root->GetLineNum() : 1, "", "the outermost element must be <robot>",
                   root ? quoted(root->Name()) : "");
    return std::nullopt;
  }
  const XmlElement robot(*root, "<robot>", "robot", findings);
  if (refuse_xacro(robot)) return std::nullopt;
  std::vector<ParameterDescription> parameters = expand_parameters(*root, options.parameters, findings);
  if (findings.error_count() > 0) return std::nullopt;
  SceneDescription scene = SceneReader(options, findings).read(robot, std::move(parameters));
  if (findings.error_count() > 0) return std::nullopt;

  // urdfdom has judged the parts one by one. Other programs give it the whole file, so let it judge that, too.
  const std::optional<std::string> refusal = refusal_of_urdfdom(printed(*root));
  if (refusal) robot.warning("programs that use urdfdom refuse this file", quoted(*refusal));
  urdf = text.find("${") == std::string::npos ? text : text_without_parameters(document);
  return scene;
}

/// Reads a file, but stops soon after the size that a scene may have. If the file cannot be read, records an error and
/// returns nothing.
std::optional<std::string> read_bytes(const std::string& path, Findings& findings) {
  std::ifstream file(path, std::ios::binary);
  std::string text;
  char part[1 << 14];
  while (file && text.size() <= kLargestFile && file.read(part, sizeof part).gcount() > 0)
    text.append(part, static_cast<std::size_t>(file.gcount()));
  if (file || file.eof()) return text;
  findings.error(0, "", fmt::format("cannot be read: {}", std::strerror(errno)));
  return std::nullopt;
}

}  // namespace

ReadResult read_scene_text(const std::string& text, const std::string& name, const ReadOptions& options) {
  Findings findings(name);
  ReadResult result;
  result.scene = read_scene(text, options, findings, result.urdf);
  result.diagnostics = findings.take();
  return result;
}

ReadResult read_scene_file(const std::string& path, const ReadOptions& options) {
  Findings findings(path);
  ReadResult result;
  std::optional<std::string> text = read_bytes(path, findings);
  const bool is_expanded = text && expand_by_xacro(path, options.xacro_arguments, *text, findings);
  if (text && findings.error_count() == 0) result.scene = read_scene(*text, options, findings, result.urdf);
  if (is_expanded && !result.scene)
    findings.warning(0, "", "line numbers in errors refer to the output of xacro, which 'xacro FILE.xacro' prints");
  result.diagnostics = findings.take();
  return result;
}

}  // namespace flexarm::scene
