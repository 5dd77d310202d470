#include "building/slide_builder.h"

#include <algorithm>

#include "building/elementary_joints.h"
#include "building/model_builder.h"
#include "schemes/slide_scheme.h"

namespace flexarm {
namespace {

/// Poses that differ by less count as equal: relative to the distance from the origin, and in radians.
constexpr double kSamePlace = 1e-9, kSameDirection = 1e-6;

}  // namespace

bool SlideBuilder::continues(int before, int after) const {
  if (before == after) return true;
  const Pose a = mechanism_.pose_of(before), b = mechanism_.pose_of(after);
  const double scale = 1 + a.position.norm();
  return (a.position - b.position).norm() <= kSamePlace * scale &&
         a.orientation.angularDistance(b.orientation) <= kSameDirection;
}

std::vector<int> SlideBuilder::welded_beams(int link) const {
  const auto is_weld = [&](const scene::JointDescription* joint) {
    if (!joint || joint->kind != scene::JointKind::Fixed) return false;
    const LinkFrame &parent = model_.links[plan_.links[joint->parent]],
                    &child = model_.links[plan_.links[joint->child]];
    return parent.beam && child.beam && continues(parent.beam->tip.node, child.frame.node);  // both have nodes already
  };
  std::vector<int> chain = {link};
  while (is_weld(plan_.tree.above[chain.back()])) chain.push_back(plan_.links[plan_.tree.above[chain.back()]->parent]);
  std::reverse(chain.begin(), chain.end());
  for (bool grows = true; grows;) {
    const auto& below = plan_.tree.below[chain.back()];
    const auto weld = std::find_if(below.begin(), below.end(), is_weld);
    grows = weld != below.end();
    if (grows) chain.push_back(plan_.links[(*weld)->child]);
  }
  return chain;
}

int SlideBuilder::slide_line(int link, const scene::SlideDescription& slide) {
  const std::vector<int> chain = welded_beams(link);
  double begin = 0;
  for (const int before : chain) {
    if (before == link) break;
    begin -= plan_.meshes[before]->centreline.length();
  }
  SlideLine line, empty;
  line.smooth = empty.smooth = slide.smooth;
  for (const int beam : chain) {
    const double origin = begin;
    for (const MeshElement& element : plan_.meshes[beam]->mesh.elements) {
      const int base = model_.links[beam].frame.node, front = base + element.nodes.front();
      if (!line.nodes.empty() && !continues(line.nodes.back(), front)) {  // a kink
        if (slide.start <= begin) return add_line(line);
        line = empty;
      }
      if (line.nodes.empty() || line.nodes.back() != front) line.nodes.push_back(front);
      const int first = static_cast<int>(line.nodes.size()) - 1, count = static_cast<int>(element.nodes.size());
      for (int i = 1; i < count; ++i) line.nodes.push_back(base + element.nodes[i]);
      line.pieces.push_back({first, count, begin, origin + element.end});
      begin = origin + element.end;
    }
  }
  return add_line(line);
}

int SlideBuilder::add_line(const SlideLine& line) {
  for (std::size_t i = 0; i < model_.slide_lines.size(); ++i)
    if (model_.slide_lines[i].nodes == line.nodes && model_.slide_lines[i].begin() == line.begin() &&
        model_.slide_lines[i].smooth == line.smooth)
      return static_cast<int>(i);
  model_.slide_lines.push_back(line);
  return static_cast<int>(model_.slide_lines.size()) - 1;
}

Attachment SlideBuilder::add(const scene::JointDescription& joint) {
  const scene::SlideDescription& slide = *joint.slide;
  const std::string where = at(slide.location, "<slide> of joint '" + joint.name + "'");
  const int parent = plan_.links[joint.parent];
  if (!plan_.meshes[parent]) throw ModelError(where + "link '" + joint.parent + "' has no <beam> to slide on");
  if (!joint.origin.position.isZero(0))
    throw ModelError(
        where +
        "give the place on the line by 'start' and the distance from the line by 'offset'; xyz of the joint's "
        "<origin> must be 0 0 0");
  const SlideScheme* scheme = find_slide_scheme(slide.scheme);
  if (!scheme) throw ModelError(where + "unknown slide scheme '" + slide.scheme + "'");
  const LinkMesh& mesh = *plan_.meshes[parent];
  JointMap map;
  map.kind = JointMapKind::Slide;
  map.line = slide_line(parent, slide);
  map.algorithm = scheme->algorithm;
  const SlideLine& line = model_.slide_lines[map.line];
  map.master = line.nodes.front();
  const std::string name = coordinate_names(joint).front();
  Released released;
  released.displacement[0] = plan_.initial_positions.of(name, slide.start);
  for (const double x : {slide.start, released.displacement[0]})
    if (!(x >= line.begin() && x <= line.end()))
      throw ModelError(where + "the arc length must be from " + std::to_string(line.begin()) + " to " +
                       std::to_string(line.end()) + " (the ends of the line or kinks), got " + std::to_string(x));
  const int node = mechanism_.add_map(map, released);
  scene::JointDescription travel = joint;
  travel.limits.reset();
  if (slide.on_end == scene::SlideDescription::End::Stop)
    travel.limits = scene::JointLimits{line.begin(), line.end(), 0, slide.restitution};
  mechanism_.add_coordinates(travel, {name});
  // The joint's frame is fixed to the section. Its given orientation is that in the link, where the slide starts on the
  // undeformed line.
  const Pose section = mesh.centreline.at(slide.start);
  const Pose frame{-mesh.mesh.centroid, section.orientation.conjugate() * joint.origin.orientation};
  return {node, frame * Pose{slide.offset, Quaternion::Identity()}};
}

void SlideBuilder::couple(const scene::JointDescription& joint) {
  const int angle = static_cast<int>(model_.coordinates.size()) - 1;
  Coordinate& travel = model_.coordinates[angle - 1];
  travel.mimicked = angle;
  travel.is_coupled = true;
  travel.mimic = {joint.kind == scene::JointKind::Cam ? 1.0 : joint.ratio, joint.slide->start, joint.profile};
  model_.initial_released[travel.joint].displacement[0] =
      travel.mimic.value(model_.initial_released[model_.coordinates[angle].joint].displacement[0]);
}

}  // namespace flexarm
