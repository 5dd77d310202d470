#include "pictures/picture_json.h"

#include <map>
#include <type_traits>

#include "math/json_text.h"
#include "pictures/floors.h"

namespace flexarm::pictures {
namespace {

/// JSON of a list; `text` makes that of an element.
template <class List, class Text>
std::string json_list(const List& list, const Text& text) {
  std::string out;
  for (const auto& element : list) out += (out.empty() ? "" : ", ") + text(element);
  return "[" + out + "]";
}

/// Puts an object together from its members.
class JsonObject {
 public:
  JsonObject& add(const char* name, const std::string& value) {
    append_member(text_, name, value);
    return *this;
  }
  JsonObject& add_text(const char* name, const std::string& text) { return add(name, json_string(text)); }
  template <class Number>
  JsonObject& add_number(const char* name, Number number) {
    return add(name, json_number(static_cast<double>(number)));
  }
  std::string done() const { return "{" + text_ + "}"; }

 private:
  std::string text_;
};

std::string json_number_list(const std::vector<double>& numbers) {
  return json_list(numbers, json_number);
}

std::string json_pose(const Pose& pose) {
  const Vector3& p = pose.position;
  const Quaternion& q = pose.orientation;
  return json_number_list({p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()});
}

std::string json_shape(const PictureShape& shape) {
  JsonObject out;
  std::visit(
      [&](const auto& given) {
        using Shape = std::decay_t<decltype(given)>;
        if constexpr (std::is_same_v<Shape, scene::BoxShape>)
          out.add_text("kind", "box").add("size", json_array(given.size));
        if constexpr (std::is_same_v<Shape, scene::SphereShape>)
          out.add_text("kind", "sphere").add_number("radius", given.radius);
        if constexpr (std::is_same_v<Shape, scene::CylinderShape>)
          out.add_text("kind", "cylinder").add_number("radius", given.radius).add_number("length", given.length);
        if constexpr (std::is_same_v<Shape, std::size_t>) out.add_text("kind", "mesh").add_number("mesh", given);
      },
      shape.shape);
  const auto& color = shape.color;
  return out.add("pose", json_pose(shape.pose))
      .add("color", color ? json_number_list({color->begin(), color->end()}) : "null")
      .done();
}

std::string json_mass(const MassBall& mass, double scene_radius) {
  return JsonObject().add("at", json_array(mass.at)).add_number("radius", shown_radius(mass, scene_radius)).done();
}

std::string json_link(const PictureLink& link, double scene_radius) {
  return JsonObject()
      .add_text("name", link.name)
      .add_number("parent", link.parent)
      .add_number("beam", link.beam)
      .add("stick", json_list(link.stick, [](const Vector3& point) { return json_array(point); }))
      .add("shapes", json_list(link.shapes, json_shape))
      .add("mass", link.mass ? json_mass(*link.mass, scene_radius) : "null")
      .done();
}

std::string json_beam(const PictureBeam& beam) {
  return JsonObject()
      .add_number("link", beam.link)
      .add("arc_lengths", json_number_list(beam.arc_lengths))
      .add("sections", json_list(beam.sections, json_pose))
      .add_number("radius", beam.radius)
      .add_number("tube", beam.tube)
      .done();
}

std::string json_joint(const PictureJoint& joint) {
  return JsonObject()
      .add_text("name", joint.name)
      .add_number("link", joint.link)
      .add_text("kind", joint.kind)
      .add("axis", joint.axis ? json_array(*joint.axis) : "null")
      .add("columns", json_number_list({joint.columns.begin(), joint.columns.end()}))
      .done();
}

std::string json_mesh(const PictureMesh& mesh) {
  return JsonObject()
      .add_text("name", mesh.name)
      .add_number("vertices", mesh.surface.vertices.size())
      .add_number("triangles", mesh.surface.triangles.size())
      .done();
}

std::string json_arrows(const std::array<std::size_t, kArrowKinds>& counts) {
  std::string out;
  for (std::size_t kind = 0; kind < kArrowKinds; ++kind)
    out += (kind > 0 ? ", " : "") +
           JsonObject().add_text("kind", kArrowNames[kind]).add_number("count", counts[kind]).done();
  return "[" + out + "]";
}

std::string json_floor(const Floor& floor) {
  return JsonObject()
      .add("pose", json_pose(floor.pose))
      .add("size", json_number_list({floor.length, floor.width}))
      .add_number("cell", floor.cell)
      .add("ground", floor.is_ground ? "true" : "false")
      .done();
}

void add_scenery(const Picture& picture, const SceneExtent& extent, JsonObject& out) {
  out.add_text("name", picture.name)
      .add_text("title", picture.title)
      .add("notes", json_list(picture.notes, json_string))
      .add("extent", JsonObject()
                         .add("center", json_array(extent.center))
                         .add_number("radius", extent.radius)
                         .add("half", json_array(extent.half))
                         .done())
      .add("gravity", json_array(picture.gravity))
      .add("floors", json_list(floors_of(picture.grounds, up_of(picture.gravity), extent), json_floor));
}

void add_parts(const Picture& picture, double scene_radius, JsonObject& out) {
  std::map<std::string, std::size_t> links;
  for (std::size_t i = 0; i < picture.links.size(); ++i) links[picture.links[i].name] = i;
  out.add("links", json_list(picture.links, [&](const PictureLink& link) { return json_link(link, scene_radius); }))
      .add("meshes", json_list(picture.meshes, json_mesh))
      .add("beams", json_list(picture.beams, json_beam))
      .add("joints", json_list(picture.joints, json_joint))
      .add("probes",
           json_list(picture.probes,
                     [&](const scene::Probe& probe) {
                       return JsonObject().add_text("name", probe.name).add_number("link", links.at(probe.link)).done();
                     }))
      .add("lines", json_list(picture.lines,
                              [](const PictureLine& line) {
                                return JsonObject()
                                    .add_text("kind", line.kind)
                                    .add_text("name", line.name)
                                    .add_number("points", line.points)
                                    .done();
                              }))
      .add("columns", json_list(picture.columns, [](const ResultColumn& column) {
             return JsonObject().add_text("name", column.name).add_text("unit", column.unit).done();
           }));
}

void add_run(const RunShape& run, JsonObject& out) {
  out.add("arrows", json_arrows(run.arrows))
      .add_number("frames", run.instants)
      .add("clips", json_list(run.clips,
                              [](const Clip& clip) {
                                return JsonObject()
                                    .add_text("name", clip.name)
                                    .add_number("first", clip.first)
                                    .add_number("count", clip.count)
                                    .done();
                              }))
      .add("still", run.still >= 0 ? json_number(run.still) : "null");
}

/// JSON without `<`, which can occur only within texts.
std::string without_tags(const std::string& json) {
  std::string out;
  out.reserve(json.size());
  for (const char c : json) c == '<' ? out += "\\u003c" : out += c;
  return out;
}

}  // namespace

std::string picture_as_json(const Picture& picture, const RunShape& run) {
  JsonObject out;
  add_scenery(picture, run.extent, out);
  add_parts(picture, run.extent.radius, out);
  add_run(run, out);
  return without_tags(out.done());
}

}  // namespace flexarm::pictures
