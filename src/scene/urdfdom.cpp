#include "scene/urdfdom.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <mutex>

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

namespace flexarm::scene {
namespace {

/// Collects console_bridge's error messages during its lifetime.
class MessageCapture : public console_bridge::OutputHandler {
 public:
  MessageCapture() : previous_(console_bridge::getOutputHandler()), level_(console_bridge::getLogLevel()) {
    console_bridge::useOutputHandler(this);
    console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_ERROR);
  }
  ~MessageCapture() override {
    console_bridge::setLogLevel(level_);
    console_bridge::useOutputHandler(previous_);
  }
  MessageCapture(const MessageCapture&) = delete;
  MessageCapture& operator=(const MessageCapture&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR) errors.push_back(text);
  }

  std::vector<std::string> errors;

 private:
  console_bridge::OutputHandler* previous_;
  console_bridge::LogLevel level_;
};

/// Replaces percent signs, since urdfdom passes some parts of the document to its logger as a printf format. This
/// control character cannot occur in the document.
constexpr char kPercent = '\x1a';

struct Parsed {
  /// Has kPercent for each percent sign; null if urdfdom cannot read the document.
  urdf::ModelInterfaceSharedPtr model;
  std::vector<std::string> errors;
};

Parsed parsed(std::string document) {
  static std::mutex mutex;
  const std::lock_guard<std::mutex> lock(mutex);
  MessageCapture capture;
  std::replace(document.begin(), document.end(), '%', kPercent);
  Parsed out;
  try {
    out.model = urdf::parseURDF(document);
    if (!out.model && capture.errors.empty()) capture.errors.push_back("urdfdom cannot read it");
  } catch (const std::exception& error) {
    capture.errors.push_back(error.what());
  }
  for (std::string& error : capture.errors) std::replace(error.begin(), error.end(), kPercent, '%');
  out.errors = std::move(capture.errors);
  return out;
}

Vector3 vector(const urdf::Vector3& v) {
  return {v.x, v.y, v.z};
}

bool is_extent(double length) {
  return std::isfinite(length) && length > 0;
}

/// Converts a shape. Returns nothing if its dimensions are not finite and positive. A sphere that touches may be a
/// point.
std::optional<decltype(VisualDescription::shape)> shape_of(const urdf::Geometry& geometry, bool touches) {
  if (const auto* box = dynamic_cast<const urdf::Box*>(&geometry)) {
    const Vector3 size = vector(box->dim);
    if (size.allFinite() && size.minCoeff() > 0) return BoxShape{size};
  } else if (const auto* cylinder = dynamic_cast<const urdf::Cylinder*>(&geometry)) {
    if (is_extent(cylinder->radius) && is_extent(cylinder->length))
      return CylinderShape{cylinder->radius, cylinder->length};
  } else if (const auto* sphere = dynamic_cast<const urdf::Sphere*>(&geometry)) {
    if (is_extent(sphere->radius) || (touches && sphere->radius == 0)) return SphereShape{sphere->radius};
  } else if (const auto* mesh = dynamic_cast<const urdf::Mesh*>(&geometry)) {
    MeshShape shape{mesh->filename, vector(mesh->scale)};
    std::replace(shape.url.begin(), shape.url.end(), kPercent, '%');
    if (shape.scale.allFinite()) return shape;
  }
  return std::nullopt;
}

/// The material with a <color> that a <visual> has: its own one, or the robot's with that name. Null if there is none.
const tinyxml2::XMLElement* colored_material(const tinyxml2::XMLElement& visual) {
  const tinyxml2::XMLElement* const own = visual.FirstChildElement("material");
  if (!own || own->FirstChildElement("color")) return own;
  const char* const name = own->Attribute("name");
  const tinyxml2::XMLElement* const robot = visual.GetDocument()->RootElement();
  const tinyxml2::XMLElement* named = robot ? robot->FirstChildElement("material") : nullptr;
  for (; named; named = named->NextSiblingElement("material")) {
    const char* const other = named->Attribute("name");
    if (name && other && std::strcmp(name, other) == 0 && named->FirstChildElement("color")) return named;
  }
  return nullptr;
}

}  // namespace

std::vector<std::string> errors_of_urdfdom(std::string document) {
  return parsed(std::move(document)).errors;
}

std::optional<std::string> refusal_of_urdfdom(std::string document) {
  const Parsed robot = parsed(std::move(document));
  return robot.model ? std::nullopt : std::optional(robot.errors.front());
}

std::optional<VisualDescription> shape_of_urdfdom(const tinyxml2::XMLElement& element) {
  const tinyxml2::XMLElement* const material = colored_material(element);
  const bool is_shared = material && material->Parent() != &element;
  const Parsed robot = parsed("<robot name=\"robot\">" + (is_shared ? printed(*material) : "") +
                              "<link name=\"link\">" + printed(element) + "</link></robot>");
  const urdf::LinkConstSharedPtr link = robot.model ? robot.model->getLink("link") : nullptr;
  if (!link || (!link->visual && !link->collision)) return std::nullopt;
  const urdf::GeometrySharedPtr geometry = link->visual ? link->visual->geometry : link->collision->geometry;
  if (!geometry) return std::nullopt;
  const auto shape = shape_of(*geometry, !link->visual);
  const auto& [position, rotation] = link->visual ? link->visual->origin : link->collision->origin;
  const Pose origin{vector(position), Quaternion(rotation.w, rotation.x, rotation.y, rotation.z).normalized()};
  if (!shape || !origin.position.allFinite() || !origin.orientation.coeffs().allFinite()) return std::nullopt;
  VisualDescription description{origin, *shape};
  if (material && link->visual && link->visual->material) {
    const urdf::Color& color = link->visual->material->color;
    description.color = Color{color.r, color.g, color.b, color.a};
  }
  return description;
}

std::string printed(const tinyxml2::XMLElement& element) {
  tinyxml2::XMLPrinter printer(nullptr, true);
  element.Accept(&printer);
  return printer.CStr();
}

}  // namespace flexarm::scene
