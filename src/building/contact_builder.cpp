#include "building/passes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "building/contact_laws.h"
#include "building/line_contacts.h"
#include "building/model_builder.h"
#include "building/touching_meshes.h"
#include "contact/contact_element.h"

namespace flexarm {
namespace {

/// Depth beyond which a contact gives way no further, relative to sizes.
constexpr double kContactDepth = 0.1;
/// A shape whose half width is smaller than this, relative to the arms of its body, and smaller than that many metres,
/// is a point. It may penetrate by more than its size.
constexpr double kPoint = 1e-4, kLargestPoint = 1e-4;
/// Radius of gyration of a ball, relative to its radius.
constexpr double kTurnedLever = 0.63;
/// Most intervals between the stations along an element.
constexpr int kMostSpans = 8;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// One side of a contact: a link or a ground.
struct Side {
  std::string name;
  const scene::LinkDescription* link = nullptr;  // null: a ground
  double mass = kInfinity;                       // [kg]
  double size = kInfinity;                       // smallest half width of its shapes [m]
  bool is_fixed = false;                         // to the world
  std::vector<ContactSurface> surfaces;          // for each node that has shapes
  std::vector<ContactStations> tubes;            // for each element of a beam
};

/// The shapes of a <collision>; a mesh may have several.
std::vector<ContactShape> shapes_of(const scene::VisualDescription& collision, const Pose& frame,
                                    const scene::LinkDescription& link) {
  const Pose place = frame * collision.origin;
  if (const auto* box = std::get_if<scene::BoxShape>(&collision.shape)) return {{Box{0.5 * box->size}, place}};
  if (const auto* cylinder = std::get_if<scene::CylinderShape>(&collision.shape)) {
    const double half_length = 0.5 * cylinder->length;
    if (cylinder->inner_radius > 0) return {{Tube{cylinder->radius, cylinder->inner_radius, half_length}, place}};
    return {{Cylinder{cylinder->radius, half_length}, place}};
  }
  if (const auto* sphere = std::get_if<scene::SphereShape>(&collision.shape)) return {{Ball{sphere->radius}, place}};
  const auto& mesh = std::get<scene::MeshShape>(collision.shape);
  std::vector<ContactShape> out;
  try {
    for (const auto& hull : hulls_of_mesh(mesh, link.location.file)) out.push_back({Hull{hull}, place});
  } catch (const std::runtime_error& error) {
    throw ModelError(at(link.location, fmt::format("<link> '{}'", link.name)) +
                     fmt::format("its <collision> has the mesh '{}', but {}", mesh.url, error.what()));
  }
  return out;
}

class ContactBuilder {
 public:
  ContactBuilder(const ScenePlan& plan, const Model& model) : plan_(plan), model_(model), scene_(plan.scene) {
    for (const scene::LinkDescription& link : scene_.links) sides_.push_back(side_of(link));
    for (const scene::GroundDescription& ground : scene_.grounds) sides_.push_back(side_of(ground));
    find_neighbours();
  }

  ForceElementList place() {
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      for (const scene::ContactDescription& contact : scene_.contacts)
        if (contact.first == sides_[i].name && contact.second == contact.first) join_itself(contact, sides_[i]);
      for (std::size_t j = i + 1; j < sides_.size(); ++j)
        if (const scene::ContactDescription* contact = contact_of(i, j)) join(*contact, sides_[i], sides_[j]);
    }
    return std::move(placed_);
  }

 private:
  // ---------------------------------------------------------------- sides

  Side side_of(const scene::GroundDescription& ground) const {
    Side side;
    side.name = ground.name;
    side.is_fixed = true;
    ContactShape shape;
    shape.place.position = ground.offset * ground.normal - model_.origin;
    shape.place.orientation = Quaternion::FromTwoVectors(Vector3::UnitZ(), ground.normal);
    side.surfaces.push_back({-1, {shape}});
    return side;
  }

  Side side_of(const scene::LinkDescription& link) const {
    Side side;
    side.name = link.name;
    side.link = &link;
    const int index = plan_.links[link.name];
    if (link.collisions.empty()) {
      if (plan_.meshes[index] && model_.links[index].beam->radius > 0) add_tube(index, side);
      return side;
    }
    side.is_fixed = plan_.links[link.name] == plan_.tree.root;
    bool all_fixed = true;
    for (const scene::VisualDescription& collision : link.collisions) {
      // The mesh files of links that touch nothing need not exist.
      if (std::holds_alternative<scene::MeshShape>(collision.shape) && !is_meant(link.name)) continue;
      const Attachment frame = attachment(plan_, model_, link.name, collision.origin.position);
      all_fixed = all_fixed && frame.node < 0;
      for (const ContactShape& shape : shapes_of(collision, frame.offset, link)) add(shape, frame.node, side);
    }
    if (!std::isfinite(side.size)) side.size = spread_of_points(side);
    side.is_fixed = side.is_fixed || (all_fixed && !side.surfaces.empty());
    if (model_.links[index].beam) side.mass = model_.links[index].beam->mass;
    return side;
  }

  void add(const ContactShape& shape, int node, Side& side) const {
    const auto on_node = [&](const ContactSurface& each) { return each.node == node; };
    auto surface = std::find_if(side.surfaces.begin(), side.surfaces.end(), on_node);
    if (surface == side.surfaces.end()) surface = side.surfaces.insert(surface, {node, {}});
    surface->shapes.push_back(shape);
    const double size = half_width(shape), lever = std::max(shape.place.position.norm(), longest_arm(node));
    if (size > (node < 0 ? 0 : std::min(kPoint * lever, kLargestPoint))) side.size = std::min(side.size, size);
    if (node >= 0) side.mass = mass_of_body(model_, node);
  }

  /// The largest distance of a body's joints from its node, or of those by which it hangs from the node before [m].
  double longest_arm(int node) const {
    double longest = 0;
    for (const JointMap& joint : model_.joints) {
      if (joint.slave == node) longest = std::max(longest, joint.arm.norm());
      if (joint.master >= 0 && (joint.slave == node || joint.master == node))
        longest = std::max(longest, joint.origin.position.norm());
    }
    return longest;
  }

  /// Half of the distance between the farthest points of a side that has points only; infinite for one point [m].
  static double spread_of_points(const Side& side) {
    double farthest = 0;
    for (const ContactSurface& surface : side.surfaces)
      for (const ContactShape& one : surface.shapes)
        for (const ContactShape& other : surface.shapes)
          farthest = std::max(farthest, (one.place.position - other.place.position).norm());
    return farthest > 0 ? 0.5 * farthest : kInfinity;
  }

  /// Adds a tube of the section's largest radius along the line of the nodes, with stations at equal distances.
  void add_tube(int index, Side& side) const {
    const LinkFrame& link = model_.links[index];
    side.mass = link.beam->mass;
    side.size = link.beam->radius;
    const int order = link.beam->order;
    for (std::size_t k = 0; k < link.beam->elements.size(); ++k) {
      const double begin = k == 0 ? 0.0 : link.beam->element_ends[k - 1], length = link.beam->element_ends[k] - begin;
      ContactStations stations;
      for (const int node : plan_.meshes[index]->mesh.elements[k].nodes)
        stations.nodes.push_back(link.frame.node + node);
      const double radii = std::min(std::ceil(length / link.beam->radius), 1.0 * kMostSpans);
      const int spans = std::max(static_cast<int>(radii), order);
      for (int i = 0; i <= spans; ++i) {
        ContactStation station;
        station.weights = line_weights(order, -1 + 2.0 * i / spans).values;
        station.radius = link.beam->radius;
        station.share = (i == 0 || i == spans ? 0.5 : 1.0) * length / spans / link.beam->length;
        stations.stations.push_back(station);
      }
      side.tubes.push_back(std::move(stations));
    }
  }

  // ---------------------------------------------------------------- pairs

  void find_neighbours() {
    for (const auto* joints : {&scene_.joints, &scene_.loop_joints})
      for (const scene::JointDescription& joint : *joints)
        // Joined links are neighbours, which touch only if a <contact> names both. A floating joint does not make
        // neighbours, since its link moves freely.
        if (joint.kind != scene::JointKind::Floating) add_neighbours(joint);
    for (const scene::ClearanceDescription& clearance : scene_.clearances) add_neighbours(clearance.joint);
  }

  void add_neighbours(const scene::JointDescription& joint) {
    const int parent = body_of(joint.parent), child = body_of(joint.child);
    if (parent >= 0 && child >= 0) neighbours_.insert(std::minmax(parent, child));
    joined_.insert(std::minmax(plan_.links[joint.parent], plan_.links[joint.child]));
  }

  /// The node to which a link is fixed; of a beam, its first node; -1: the world.
  int body_of(const std::string& link) const { return model_.links[plan_.links[link]].frame.node; }

  bool are_neighbours(const Side& first, const Side& second) const {
    if (!first.link || !second.link) return false;
    const int one = body_of(first.name), other = body_of(second.name);
    return one == other || neighbours_.count(std::minmax(one, other)) > 0 ||
           joined_.count(std::minmax(plan_.links[first.name], plan_.links[second.name])) > 0;
  }

  /// Whether any <contact> may apply to this link.
  bool is_meant(const std::string& link) const {
    return std::any_of(scene_.contacts.begin(), scene_.contacts.end(), [&](const scene::ContactPair& pair) {
      return pair.first == link || pair.second == link || pair.first == scene::kAllBodies ||
             pair.second == scene::kAllBodies;
    });
  }

  /// How many of the two sides a pair names; -1: the pair does not apply to them.
  static int named_of(const scene::ContactPair& pair, const Side& first, const Side& second) {
    const auto named = [](const std::string& name, const Side& side) {
      return name == side.name ? 1 : name == scene::kAllBodies ? 0 : -1;
    };
    int best = -1;
    for (const auto& [a, b] : {std::pair(&pair.first, &pair.second), std::pair(&pair.second, &pair.first)})
      if (named(*a, first) >= 0 && named(*b, second) >= 0) best = std::max(best, named(*a, first) + named(*b, second));
    return best;
  }

  /// The <contact> that applies to two sides; null: none. The one that names more sides counts. Of those that name
  /// equally many, a <no_contact> counts before a <contact>, and then the first one in the file.
  const scene::ContactDescription* contact_of(std::size_t i, std::size_t j) const {
    const Side &first = sides_[i], &second = sides_[j];
    const scene::ContactDescription* contact = nullptr;
    int most = are_neighbours(first, second) ? 1 : -1;
    for (const scene::ContactPair& pair : scene_.no_contacts) most = std::max(most, named_of(pair, first, second));
    for (const scene::ContactDescription& each : scene_.contacts)
      if (const int named = named_of(each, first, second); named > most) contact = &each, most = named;
    if (contact && most == 2) require_something_to_touch(*contact, first, second);
    return first.is_fixed && second.is_fixed ? nullptr : contact;
  }

  void require_something_to_touch(const scene::ContactDescription& contact, const Side& first,
                                  const Side& second) const {
    for (const Side* side : {&first, &second})
      if (side->surfaces.empty() && side->tubes.empty())
        throw ModelError(
            at(contact.location, "<contact>") +
            fmt::format("link '{}' has nothing to touch with: expected a <collision> whose shape has an extent, or a "
                        "<beam>",
                        side->name));
    if (first.is_fixed && second.is_fixed)
      throw ModelError(at(contact.location, "<contact>") +
                       fmt::format("'{}' and '{}' never move against each other", first.name, second.name));
  }

  // ---------------------------------------------------------------- laws

  ContactLaw law_of(const scene::ContactDescription& contact, const Side& stations, const Side& shapes,
                    double at_a_time) const {
    const double inverse = 1 / stations.mass + 1 / shapes.mass;
    const scene::SurfaceHints hints = hints_of(stations, shapes);
    LawRequest request{inverse > 0 ? 1 / inverse : mass_of(model_), at_a_time,
                       contact.contact_time.value_or(scene_.contact_time), contact.stiffness};
    // A hint may only make the contact softer: Gazebo accepts stiffnesses that its steps cannot resolve.
    request.softest = hints.stiffness.value_or(kInfinity);
    request.restitution = contact.restitution;
    request.friction = contact.friction.value_or(hints.friction.value_or(0));
    request.grip = contact.grip;
    ContactLaw law = law_of_points(request);
    const double size = std::min(stations.size, shapes.size), turned = std::isfinite(size) ? size : model_.length_scale;
    law.depth = kContactDepth * size;
    law.spinning = contact.spinning;
    law.rolling = contact.rolling;
    law.turn_grip = law.grip * kTurnedLever * kTurnedLever * turned * turned;
    return law;
  }

  /// Combines the hints of both surfaces like Gazebo: the smaller friction, and stiffnesses in series.
  scene::SurfaceHints hints_of(const Side& one, const Side& other) const {
    scene::SurfaceHints out;
    for (const Side* side : {&one, &other}) {
      const auto found = scene_.surfaces.find(side->name);
      if (found == scene_.surfaces.end()) continue;
      const auto& [friction, stiffness] = found->second;
      if (friction) out.friction = std::min(*friction, out.friction.value_or(*friction));
      if (stiffness) out.stiffness = out.stiffness ? 1 / (1 / *stiffness + 1 / *out.stiffness) : *stiffness;
    }
    return out;
  }

  // ---------------------------------------------------------------- elements

  static bool is_ball(const Side& side) {
    const auto all_balls = [](const ContactSurface& each) {
      return std::all_of(each.shapes.begin(), each.shapes.end(),
                         [](const ContactShape& shape) { return std::holds_alternative<Ball>(shape.kind); });
    };
    return !side.surfaces.empty() && std::all_of(side.surfaces.begin(), side.surfaces.end(), all_balls);
  }

  void join(const scene::ContactDescription& contact, const Side& first, const Side& second) {
    if (!first.tubes.empty() && !second.tubes.empty()) return join_lines_of(contact, first, second);
    if (!second.tubes.empty() && touch_line(contact, first, second)) return;
    if (!first.tubes.empty() && touch_line(contact, second, first)) return;
    // Corners need not be tested against balls: the middle of a ball is nearer to a face or an edge than to them. Of
    // two balls, one is tested against the other.
    if (!is_ball(second) || first.surfaces.empty() || is_ball(first)) join_stations(contact, first, second);
    if (!is_ball(first) || second.surfaces.empty()) join_stations(contact, second, first);
  }

  /// Names and order of a pair. Indices are set for links only, not for grounds.
  LinkPair links_of(const scene::ContactDescription& contact, const Side& first, const Side& second) const {
    LinkPair out{0, 0, {first.name, second.name}, !are_in_order(contact, first, second)};
    if (out.is_reversed) std::reverse(out.names.begin(), out.names.end());
    if (first.link) out.first = plan_.links[first.name];
    if (second.link) out.second = plan_.links[second.name];
    return out;
  }

  void join_lines_of(const scene::ContactDescription& contact, const Side& first, const Side& second) {
    require_no_turn_grip(contact);
    join_lines(model_, plan_, links_of(contact, first, second), law_of(contact, first, second, 1), placed_);
  }

  void join_itself(const scene::ContactDescription& contact, const Side& side) {
    if (side.tubes.empty())
      throw ModelError(at(contact.location, "<contact>") +
                       fmt::format("link '{}' cannot touch itself: expected a <beam> with elements and without "
                                   "<collision>",
                                   side.name));
    join_lines_of(contact, side, side);
  }

  /// Adds contacts of a body's points with the line of a beam. Returns true if the beam's stations need not be tested
  /// against the body.
  bool touch_line(const scene::ContactDescription& contact, const Side& body, const Side& tube) {
    if (!body.link) return false;  // a ground has no points
    const BeamLink& beam = *model_.links[plan_.links[tube.name]].beam;
    const bool is_small_ball = is_ball(body) && touches_line(body.size, beam);
    if (!is_small_ball && (is_ball(body) || !has_room_for_corners(beam, kMostSpans))) return false;
    require_no_turn_grip(contact);
    const double at_a_time = is_small_ball ? 1.0 : 2.0;  // an edge enters and leaves the tube
    std::vector<ContactStations> points = stations_of(body, tube.size, false);
    std::transform(points.begin(), points.end(), points.begin(), without_segments);
    join_with_line(model_, plan_, links_of(contact, body, tube), points, law_of(contact, body, tube, at_a_time),
                   placed_);
    return is_small_ball;
  }

  /// Stations of each node or element. `spacing`: largest distance of points on edges, the size of the other side.
  /// `on_flat`: for the flat shapes of the other side, see contact_points().
  static std::vector<ContactStations> stations_of(const Side& side, double spacing, bool on_flat) {
    std::vector<ContactStations> out = side.tubes;
    for (const ContactSurface& surface : side.surfaces) {
      ContactStations body{{surface.node}, {}, 0};
      for (const ContactShape& shape : surface.shapes) {
        const std::vector<ContactPoint> points = contact_points(shape, spacing, on_flat);
        const int at_a_time = points_at_a_time(shape, points);
        body.at_a_time += at_a_time;
        for (const ContactPoint& point : points) {
          ContactStation station;
          station.arm = point.arm;
          station.radius = point.radius;
          station.outwards = point.outwards;
          // One of two bodies' segments touches alone where these cross.
          station.share = point.half > 0 ? 0.5 * at_a_time : point.share;
          station.rim = point.rim;
          station.half = point.half;
          station.curvature = point.curvature;
          station.axis = point.axis;
          body.stations.push_back(station);
        }
      }
      if (!body.stations.empty()) out.push_back(std::move(body));
    }
    return out;
  }

  /// Whether the sides are in the order in which the <contact> names them or, if it does not name both, in the scene's
  /// order.
  bool are_in_order(const scene::ContactDescription& contact, const Side& first, const Side& second) const {
    if (contact.first == first.name && contact.second == second.name) return true;
    return &first < &second && !(contact.first == second.name && contact.second == first.name);
  }

  void require_no_turn_grip(const scene::ContactDescription& contact) const {
    if ((contact.spinning > 0 || contact.rolling > 0) && contact.first != scene::kAllBodies &&
        contact.second != scene::kAllBodies)
      throw ModelError(
          at(contact.location, "<contact>") +
          "spinning and rolling are for contacts of bodies' shapes: expected neither for beams, which are touched "
          "along their lines");
  }

  static ContactStations without_segments(ContactStations stations) {
    auto& all = stations.stations;
    all.erase(std::remove_if(all.begin(), all.end(), [](const ContactStation& each) { return each.half > 0; }),
              all.end());
    return stations;
  }

  /// Leaves out segments where only half-spaces are touched, since rims and corners are nearer, and where a tube is,
  /// which
  /// is not convex.
  static ContactStations for_shapes(const ContactStations& stations, const ContactSurface& surface) {
    const auto is_plane = [](const ContactShape& shape) { return std::holds_alternative<HalfSpace>(shape.kind); };
    const auto is_tube = [](const ContactShape& shape) { return std::holds_alternative<Tube>(shape.kind); };
    const std::vector<ContactShape>& shapes = surface.shapes;
    const bool needs_none =
        std::all_of(shapes.begin(), shapes.end(), is_plane) || std::any_of(shapes.begin(), shapes.end(), is_tube);
    return needs_none ? without_segments(stations) : stations;
  }

  static bool has_rims(const Side& side) {
    const auto is_rim = [](const ContactShape& shape) {
      return std::holds_alternative<Cylinder>(shape.kind) || std::holds_alternative<Tube>(shape.kind);
    };
    return std::any_of(side.surfaces.begin(), side.surfaces.end(), [&](const ContactSurface& each) {
      return std::any_of(each.shapes.begin(), each.shapes.end(), is_rim);
    });
  }

  void join_stations(const scene::ContactDescription& contact, const Side& first, const Side& second) {
    if (!has_rims(first)) return join_stations(contact, first, second, second.surfaces, false);
    // Rims touch flat shapes only. Other shapes are touched by points on the rims.
    for (const bool on_flat : {true, false}) {
      std::vector<ContactSurface> surfaces;
      for (const ContactSurface& surface : second.surfaces) {
        ContactSurface part{surface.node, {}};
        std::copy_if(surface.shapes.begin(), surface.shapes.end(), std::back_inserter(part.shapes),
                     [&](const ContactShape& shape) { return is_flat(shape) == on_flat; });
        if (!part.shapes.empty()) surfaces.push_back(std::move(part));
      }
      join_stations(contact, first, second, surfaces, on_flat);
    }
  }

  void join_stations(const scene::ContactDescription& contact, const Side& first, const Side& second,
                     const std::vector<ContactSurface>& surfaces, bool on_flat) {
    for (const ContactStations& all : stations_of(first, second.size, on_flat))
      for (const ContactSurface& surface : surfaces) {
        const ContactStations stations = for_shapes(all, surface);
        const auto& nodes = stations.nodes;
        if (std::find(nodes.begin(), nodes.end(), surface.node) != nodes.end()) continue;
        // Each station of a tube has its share of the whole (ContactStation::share), so there is no further division.
        const bool is_whole = is_ball(first) || !first.tubes.empty();
        const double at_a_time = is_whole ? 1.0 : stations.at_a_time;
        ContactLaw law = law_of(contact, first, second, at_a_time);
        allow_start(law, deepest_start(model_, stations, surface));
        LinkPair links = links_of(contact, first, second);
        placed_.push_back(
            std::make_shared<ContactElement>(std::move(links.names), stations, surface, law, links.is_reversed));
      }
  }

  const ScenePlan& plan_;
  const Model& model_;
  const scene::SceneDescription& scene_;
  std::vector<Side> sides_;
  std::set<std::pair<int, int>> neighbours_, joined_;  // bodies, by nodes; links, by indices
  ForceElementList placed_;
};

}  // namespace

ForceElementList place_contacts(const ScenePlan& plan, const Model& model) {
  if (plan.scene.contacts.empty()) return {};
  return ContactBuilder(plan, model).place();
}

std::vector<TouchingPair> touching_pairs(const ForceElementList& elements) {
  std::vector<TouchingPair> pairs;
  std::map<std::vector<std::string>, std::size_t> places;
  std::size_t memory = 0;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const std::vector<std::string> links = elements[i]->links();
    if (links.size() == 2) {
      const auto [place, is_new] = places.emplace(links, pairs.size());
      if (is_new) pairs.push_back({links[0], links[1], {}});
      pairs[place->second].elements.push_back({i, memory});
    }
    memory += static_cast<std::size_t>(elements[i]->memory_size());
  }
  return pairs;
}

}  // namespace flexarm
