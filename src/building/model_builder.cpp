#include "building/model_builder.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "building/cylinder_places.h"
#include "building/elementary_joints.h"
#include "building/passes.h"
#include "building/rigid_lines.h"

namespace flexarm {
namespace {

/// A model, and its coordinates whose accelerations would not be determined.
struct BuiltModel {
  Model model;
  std::vector<int> massless;   ///< they move nothing that has inertia
  std::vector<int> dependent;  ///< they move nothing at the start but what others move as well
};

std::vector<HalvedElement> halved_elements(const scene::SceneDescription& scene) {
  std::vector<HalvedElement> halved;
  for (std::size_t link = 0; link < scene.links.size(); ++link)
    if (scene.links[link].beam)
      for (const scene::HalvedPart& part : scene.links[link].beam->halved)
        halved.push_back({static_cast<int>(link), part.element, part.part});
  std::sort(halved.begin(), halved.end());
  return halved;
}

BuiltModel build(const scene::SceneDescription& scene) {
  const ScenePlan plan(scene);
  PlacedTree placed = place_tree(plan);
  MassiveTree massive = add_inertia(plan, std::move(placed));
  TreeAtStart at_start = follow_mimics(plan, std::move(massive));
  ClosedMechanism closed = close_loops(plan, std::move(at_start));
  DrivenMechanism driven = connect_drives(plan, std::move(closed));
  SolvableMechanism solvable = choose_constraints(plan, std::move(driven));

  std::vector<Vector6> velocity = initial_velocity(plan, solvable);
  PlacedLoads placed_loads = place_loads(plan, solvable.model);
  Model model = std::move(solvable.model);
  model.halved = halved_elements(scene);
  model.initial_velocity = std::move(velocity);
  model.loads = std::move(placed_loads.loads);
  model.histories = std::move(placed_loads.histories);
  model.probes = place_probes(plan, model);
  place_sensors(plan, solvable, model);
  model.gravity = scene.gravity;
  set_stop_depths(model);
  std::vector<int> massless = finish_mass_properties(solvable.node_parents, model);
  describe_held_joints(plan, solvable, model);
  set_damping_ratios(scene, solvable.node_parents, model);
  std::vector<int> dependent = coordinates_without_own_inertia(solvable.node_parents, model);
  model.node_parents = std::move(solvable.node_parents);
  model.force_elements = place_force_elements(plan, model);
  for (auto& clearance : place_clearances(plan, model)) model.force_elements.push_back(std::move(clearance));
  for (auto& drag : place_drags(plan, model)) model.force_elements.push_back(std::move(drag));
  for (auto& contact : place_contacts(plan, model)) model.force_elements.push_back(std::move(contact));
  model.touching_pairs = touching_pairs(model.force_elements);
  connect_contact_sensors(scene, model);
  return {std::move(model), std::move(massless), std::move(dependent)};
}

bool is_determined(const BuiltModel& built) {
  return built.massless.empty() && built.dependent.empty();
}

bool has_winches(const scene::SceneDescription& scene) {
  return std::any_of(scene.force_elements.begin(), scene.force_elements.end(), [](const auto& element) {
    const std::vector<scene::LinkPoint> points = element->points();
    return std::any_of(points.begin(), points.end(), [](const auto& point) { return point.attribute == scene::kReel; });
  });
}

[[noreturn]] void refuse_massless(const scene::SceneDescription& scene, const BuiltModel& built) {
  std::map<std::string, const scene::JointDescription*> joints;  // by coordinate
  for (const auto* list : {&scene.joints, &scene.loop_joints})
    for (const scene::JointDescription& joint : *list)
      for (const std::string& name : coordinate_names(joint)) joints.emplace(name, &joint);
  std::string text;
  const auto list = [&](const std::vector<int>& coordinates, const std::string& what) {
    for (const int index : coordinates) {
      const std::string& name = built.model.coordinates[index].name;
      text += at(joints.at(name)->location, "<joint>");
      text += fmt::format("joint coordinate '{}' moves nothing {}\n", name, what);
    }
  };
  list(built.massless, "that has inertia");
  list(built.dependent,
       "at the start that the joints beyond it do not move, too: axes are in line, or massless links follow "
       "each other");
  const std::string start = built.dependent.empty() ? "" : "start elsewhere by <initial>, ";
  throw ModelError(
      text + scene.file + ": give the links beyond these joints an <inertial> or a <beam>, " + start +
      "or hold those with one coordinate, and frames without any inertia, where they are by massless=\"lock\" of "
      "<simulation> (--massless lock)" +
      (has_winches(scene) ? "; a winch or a pump gets its inertia by <drive rotor_inertia>" : ""));
}

/// Makes joints fixed, where they start, that rotate freely, and none of whose coordinates moves any inertia: no motion
/// could prescribe a free rotation. `massless`: names of such coordinates. Returns the names of all coordinates of
/// these joints.
std::set<std::string> fix_massless_frames(const Model& model, const std::set<std::string>& massless,
                                          scene::SceneDescription& scene) {
  const InitialPositions positions(scene);
  std::set<std::string> fixed;
  for (scene::JointDescription& joint : scene.joints) {
    if ((joint.kind != scene::JointKind::Floating && joint.kind != scene::JointKind::Spherical) || joint.is_hidden)
      continue;
    const std::vector<std::string> names = coordinate_names(joint);
    if (!std::all_of(names.begin(), names.end(), [&](const auto& name) { return massless.count(name) > 0; })) continue;
    const auto first = std::find_if(model.coordinates.begin(), model.coordinates.end(),
                                    [&](const Coordinate& coordinate) { return coordinate.name == names.front(); });
    Pose start{Vector3::Zero(), model.initial_released[first->joint].rotation};
    if (joint.kind == scene::JointKind::Floating)
      start.position = {positions.of(names[0]), positions.of(names[1]), positions.of(names[2])};
    joint.origin = joint.origin * start;
    joint.kind = scene::JointKind::Fixed;
    fixed.insert(names.begin(), names.end());
  }
  return fixed;
}

/// The scene with constant motions of these coordinates, or with fixed joints, instead of anything else that it says
/// about them.
scene::SceneDescription with_locked(scene::SceneDescription scene, const BuiltModel& built) {
  std::set<std::string> massless;
  for (const int index : built.massless) massless.insert(built.model.coordinates[index].name);
  std::set<std::string> locked = fix_massless_frames(built.model, massless, scene);
  std::vector<int> undetermined = built.massless;
  undetermined.insert(undetermined.end(), built.dependent.begin(), built.dependent.end());
  for (const int index : undetermined) {
    const Coordinate& coordinate = built.model.coordinates[index];
    // No motion can prescribe a component of a free rotation.
    if (coordinate.is_angle || locked.count(coordinate.name) > 0) continue;
    locked.insert(coordinate.name);
    const Released& start = built.model.initial_released[coordinate.joint];
    // A function of time instead of a number, so that the joint does not become a HeldJoint: there is nothing to merge
    // with another body.
    const std::string place = fmt::format("0:{}", start.displacement[coordinate.component]);
    scene.motions.push_back({coordinate.name, TimeFunction::parse(place), {scene.file}});
  }
  const auto drop = [&](auto& entries) {
    entries.erase(std::remove_if(entries.begin(), entries.end(),
                                 [&](const auto& entry) { return locked.count(entry.coordinate) > 0; }),
                  entries.end());
  };
  drop(scene.initial_joints);
  drop(scene.efforts);
  drop(scene.springs);
  drop(scene.drives);
  drop(scene.servos);
  return scene;
}

}  // namespace

Model build_model(const scene::SceneDescription& original, std::vector<std::optional<RigidLine>>* rigid_lines) {
  if (!original.cylinders.empty()) return build_model(place_cylinders(original).scene, rigid_lines);
  RigidLines elastic(original);
  if (rigid_lines) *rigid_lines = std::move(elastic.lines);
  const scene::SceneDescription& scene = elastic.scene;
  BuiltModel built = build(scene);
  if (scene.lock_massless && !is_determined(built)) built = build(with_locked(scene, built));
  if (!is_determined(built)) refuse_massless(scene, built);
  return std::move(built.model);
}

}  // namespace flexarm
