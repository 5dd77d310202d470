#include <algorithm>
#include <iterator>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/flexible_dead_point.h"
#include "building/section.h"
#include "cli/commands.h"
#include "cli/mode_table.h"
#include "cli/round_off.h"
#include "cli/scene_input.h"
#include "flexarm/simulation/driven_ends.h"
#include "integrators/step_plane.h"
#include "scene/flexible_link.h"
#include "scene/joint_kinds.h"
#include "schemes/scheme.h"
#include "simulation/inside.h"

namespace flexarm::cli {
namespace {

constexpr int kModes = 6;

/// Joints of the tree and those that close loops.
std::vector<scene::JointDescription> shown_joints(const scene::SceneDescription& scene) {
  std::vector<scene::JointDescription> shown;
  for (const auto* joints : {&scene.joints, &scene.loop_joints})
    std::copy_if(joints->begin(), joints->end(), std::back_inserter(shown),
                 [](const scene::JointDescription& joint) { return !joint.is_hidden; });
  return shown;
}

void print_size(const Simulation& simulation) {
  const scene::SceneDescription& scene = simulation.scene();
  fmt::print("scene '{}': {} links, {} joints, {} nodes, {} degrees of freedom\n", scene.name, scene.links.size(),
             shown_joints(scene).size(), simulation.node_count(), simulation.degrees_of_freedom());
  fmt::print("scheme {}, step {} s, gravity {} {} {} m/s^2\n", simulation.scheme(), simulation.step_size(),
             scene.gravity.x(), scene.gravity.y(), scene.gravity.z());
}

/// "at least 0 and at most 300"; empty if the parameter has no limits.
std::string limits_text(const scene::ParameterDescription& parameter) {
  const std::string least = parameter.min ? fmt::format("at least {:.6g}", *parameter.min) : "",
                    most = parameter.max ? fmt::format("at most {:.6g}", *parameter.max) : "";
  return least + (parameter.min && parameter.max ? " and " : "") + most;
}

void print_parameters(const Simulation& simulation) {
  const std::vector<scene::ParameterDescription>& parameters = simulation.scene().parameters;
  if (parameters.empty()) return;
  fmt::print("\n{:<24} {:>12}  limits\n", "parameter", "value");
  for (const scene::ParameterDescription& parameter : parameters)
    fmt::print("{:<24} {:>12.6g}  {}\n", parameter.name, parameter.value, limits_text(parameter));
}

void print_plane(const Simulation& simulation) {
  const PlaneSearch search = find_step_plane(model_of(simulation), scheme_of(simulation));
  if (!search.plane) return fmt::print("steps are three-dimensional: {}\n", search.reason);
  const Vector3& normal = search.plane->normal;
  fmt::print("steps are taken in the plane with the normal");
  for (int i = 0; i < 3; ++i) fmt::print(" {:.6g}", without_round_off(normal[i], 1));
  fmt::print("\n");
}

/// Figures of a link with a beam.
struct Line {
  double length, mass;
  std::string elements;
};

Line line_of(const Simulation& simulation, std::size_t link) {
  if (const auto& rigid = rigid_lines_of(simulation)[link]) return {rigid->arc_lengths.back(), rigid->mass, "rigid"};
  const BeamLink& beam = *model_of(simulation).links[link].beam;
  return {beam.length, beam.mass, fmt::format("{} x {}", beam.elements.size(), beam.order)};
}

void print_links(const Simulation& simulation) {
  fmt::print("\n{:<24} {:<10} {:>12}\n", "link", "kind", "mass [kg]");
  const scene::SceneDescription& scene = simulation.scene();
  for (std::size_t i = 0; i < scene.links.size(); ++i) {
    const scene::LinkDescription& link = scene.links[i];
    const bool is_root = link.name == scene.root_link;
    double mass = link.inertial ? link.inertial->mass : 0.0;
    if (link.beam) {
      mass = line_of(simulation, i).mass;
      for (const scene::HubDescription& hub : link.beam->hubs) mass += hub.mass;
    }
    fmt::print("{:<24} {:<10} {:>12.6g}\n", link.name,
               is_flexible(link) ? "flexible"
               : is_root         ? "clamped"
                                 : "rigid",
               mass);
  }
}

void print_joints(const Simulation& simulation) {
  const scene::SceneDescription& scene = simulation.scene();
  const std::vector<scene::JointDescription> shown = shown_joints(scene);
  if (shown.empty()) return;
  fmt::print("\n{:<24} {:<12} {:<20} {:<20} {}\n", "joint", "kind", "parent", "child", "coordinates");
  for (scene::JointDescription joint : shown) {
    std::string kind = scene::traits_of(joint.kind).name;
    // A cylinder is a row with the links that it connects.
    for (const scene::JointDescription& hinge : scene.joints)
      if (hinge.is_hidden && hinge.child == joint.parent) joint.parent = hinge.parent, kind = "cylinder";
    for (const scene::JointDescription& pin : scene.loop_joints)
      if (pin.is_hidden && pin.parent == joint.child) joint.child = pin.child;
    // A winch is a row with its tendon, a pump one with its cylinder.
    for (const auto& element : simulation.scene().force_elements)
      for (const scene::LinkPoint& point : element->points())
        if (point.attribute == scene::kReel && point.link == joint.child)
          kind = std::string_view(element->kind()) == "tendon" ? "winch" : "pump",
          joint.parent = fmt::format("{} {}", element->kind(), element->name), joint.child = "-";
    fmt::print("{:<24} {:<12} {:<20} {:<20} {}\n", joint.name, kind, joint.parent, joint.child,
               scene::coordinate_suffixes(joint).size());
  }
}

void print_force_elements(const Simulation& simulation) {
  const scene::ForceElementDescriptions& described = simulation.scene().force_elements;
  const ForceElementList& elements = model_of(simulation).force_elements;
  if (!described.empty()) fmt::print("\n{:<24} {:<12} {:<40} {}\n", "between points", "kind", "links", "law");
  for (std::size_t i = 0; i < described.size(); ++i) {
    std::vector<std::string> links;
    for (const scene::LinkPoint& point : described[i]->points())
      if (links.empty() || links.back() != point.link) links.push_back(point.link);
    fmt::print("{:<24} {:<12} {:<40} {}\n", elements[i]->name().empty() ? "-" : elements[i]->name(),
               elements[i]->kind(), fmt::format("{}", fmt::join(links, ", ")), elements[i]->description());
  }
}

/// "200", or "100 ... 200".
std::string range_text(double least, double most) {
  return least == most ? fmt::format("{:.4g}", least) : fmt::format("{:.4g} ... {:.4g}", least, most);
}

/// The number of contact points of a pair, and the law with which they touch.
std::string law_text(const ForceElementList& elements, const TouchingPair& pair) {
  double least = std::numeric_limits<double>::infinity(), most = 0;
  TouchLaw all;
  for (const auto& [index, memory] : pair.elements) {
    const std::size_t points = all.points;
    all = elements[index]->touch_law();
    all.points += points;
    least = std::min(least, all.stiffness);
    most = std::max(most, all.stiffness);
  }
  std::string out =
      fmt::format("{} points, {} N/m each, restitution {}, friction {:g}", all.points, range_text(least, most),
                  range_text(all.restitution, all.restitution_of_fast_hits), all.friction);
  if (all.spinning > 0) out += fmt::format(", spinning {:g} m", all.spinning);
  if (all.rolling > 0) out += fmt::format(", rolling {:g} m", all.rolling);
  return out;
}

/// Whether a pair touches at present, and how deep.
std::string touch_text(const Simulation& simulation, std::size_t pair) {
  constexpr double kRoundOff = 1e-9;  // m
  std::vector<double> values;
  put_out_touch(simulation, pair, values);
  const double count = values[3], gap = values[4];
  if (count > 0 && gap < -kRoundOff) return fmt::format("{:g} points inside, {:.3g} m deep", count, -gap);
  return gap <= kRoundOff ? "touches" : fmt::format("{:.3g} m apart", gap);
}

void print_contacts(const Simulation& simulation) {
  const Model& model = model_of(simulation);
  const std::vector<TouchingPair>& pairs = model.touching_pairs;
  if (!pairs.empty()) fmt::print("\n{:<12} {:<40} {:<30} {}\n", "touching", "links", "at the start", "law");
  for (std::size_t i = 0; i < pairs.size(); ++i)
    fmt::print("{:<12} {:<40} {:<30} {}\n", model.force_elements[pairs[i].elements[0].index]->kind(),
               pairs[i].first + ", " + pairs[i].second, touch_text(simulation, i),
               law_text(model.force_elements, pairs[i]));
}

/// Prints the beams: lengths in m, stiffnesses in N and N m^2, mass in kg.
void print_beams(const Simulation& simulation) {
  bool is_first = true;
  const std::vector<scene::LinkDescription>& links = simulation.scene().links;
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (!links[i].beam) continue;
    if (is_first)
      fmt::print("\n{:<24} {:>9} {:>11} {:>11} {:>11} {:>11} {:>11} {:>11} {:>10} {:>9}\n", "beam", "length", "EA",
                 "GA y", "GA z", "GJ", "EI y", "EI z", "mass", "elements");
    is_first = false;
    const Line line = line_of(simulation, i);
    const SectionLine section(links[i].beam->section);
    fmt::print("{:<24} {:>9.5g}", links[i].name, line.length);
    const auto print_stiffness = [&](double arc_length) {
      const Vector6 stiffness = section.at(arc_length).stiffness.diagonal();
      for (int k = 0; k < 6; ++k) fmt::print(" {:>11.5g}", stiffness[k]);
    };
    print_stiffness(0);
    fmt::print(" {:>10.5g} {:>9}\n", line.mass, line.elements);
    if (section.is_uniform()) continue;
    fmt::print("{:<24} {:>9}", "  at its end", "");
    print_stiffness(line.length);
    fmt::print("\n");
  }
  if (!is_first) fmt::print("(m, N, N m^2, kg; number of elements x order)\n");
}

/// Prints the Maxwell elements of the beams, and their stiffness at once: before they relax, relative to that at rest.
void print_relaxation(const Simulation& simulation) {
  bool is_first = true;
  for (const scene::LinkDescription& link : simulation.scene().links) {
    if (!link.beam || link.beam->maxwell.empty()) continue;
    if (is_first) fmt::print("\n{:<24} {:>9}   {}\n", "relaxing beam", "at once", "moduli and relaxation times");
    is_first = false;
    double at_once = 1;
    for (const scene::MaxwellElement& branch : link.beam->maxwell) at_once += branch.modulus_ratio;
    fmt::print("{:<24} {:>9.5g}  ", link.name, at_once);
    for (const auto& [ratio, time] : link.beam->maxwell) fmt::print(" {:.5g} ({:.5g} s)", ratio, time);
    fmt::print("\n");
  }
  if (!is_first) fmt::print("(relative to the stiffness at rest)\n");
}

/// The loop joint whose loop contains a link. The scene must have loop joints.
std::string loop_joint_of(const scene::SceneDescription& scene, const std::string& link) {
  const auto hangs_on = [&](std::string child) {  // whether `link` is on the chain from `child` to the root
    while (child != link && child != scene.root_link)
      child = std::find_if(scene.joints.begin(), scene.joints.end(), [&](const scene::JointDescription& joint) {
                return joint.child == child;
              })->parent;
    return child == link;
  };
  const auto found =
      std::find_if(scene.loop_joints.begin(), scene.loop_joints.end(), [&](const scene::JointDescription& loop) {
        return hangs_on(loop.parent) != hangs_on(loop.child) || loop.parent == link || loop.child == link;
      });
  return (found == scene.loop_joints.end() ? scene.loop_joints.front() : *found).name;
}

void print_dead_point(const Simulation& simulation) {
  if (simulation.scene().loop_joints.empty()) return;
  const std::string link = link_at_dead_point(model_of(simulation), state_of(simulation));
  if (link.empty()) return;
  fmt::print(
      "\nat a dead point: the loop that joint '{}' closes can move without force to first order, but strains link '{}' "
      "to second order; small disturbances decide how it moves on: start it a little away from there, by <initial>\n",
      loop_joint_of(simulation.scene(), link), link);
}

void print_growth(const std::vector<Mode>& modes) {
  for (const Mode& mode : modes)
    if (mode.rate > 0)
      fmt::print("not stable: {} at {:.6g} Hz, grows by {:.6g} 1/s\n", kind_of(mode), mode.frequency, mode.rate);
}

void print_driven_ends(const Simulation& simulation) {
  const std::vector<DrivenEnd> ends = driven_ends(simulation);
  if (ends.empty()) return;
  fmt::print("\n{:<24} {:>14} {:>14} {:>14}\n", "driven at a beam's end", "within a step", "in all", "shakes beyond");
  constexpr std::size_t kMostShown = 12;
  for (std::size_t i = 0; i < std::min(ends.size(), kMostShown); ++i)
    fmt::print("{:<24} {:>14.3g} {:>14.3g} {:>14.3g}\n", ends[i].coordinate, ends[i].within_step, ends[i].whole,
               ends[i].shakes_beyond);
  if (ends.size() > kMostShown) fmt::print("and {} more\n", ends.size() - kMostShown);
  fmt::print(
      "(Inertia that resists the drive [kg m^2]: within one step, while the beam bends, and in total. A controller\n"
      " outside flexarm that acts once a step makes the joint shake if it damps by more than the last column\n"
      " [N m s/rad], or by less if the beam has little <damping>. A <hub> of the beam, or rotor_inertia of a\n"
      " <drive>, allows more.)\n");
}

void print_frequencies(Simulation& simulation) {
  if (simulation.degrees_of_freedom() == 0) return;
  if (!are_modes_quick(simulation)) {
    fmt::print(
        "\nnatural frequencies are not computed, since they would take long here; flexarm modes computes them\n");
    return;
  }
  auto [modes, is_equilibrium] = modes_about_equilibrium(simulation, kModes);
  // Free motions and slow decays come first, and say nothing about the beams. There may be as many as coordinates; few
  // are found faster. A body has six free motions; if there are more and nothing else, the joints are free, too.
  const auto oscillates = [](const Mode& mode) { return mode.frequency > 0 && mode.rate <= 0; };
  const auto is_free = [](const Mode& mode) { return mode.is_free(); };
  const int most = kModes + 2 * static_cast<int>(simulation.coordinate_names().size());
  for (int count = kModes; count < most && std::count_if(modes.begin(), modes.end(), oscillates) < kModes;) {
    const bool are_joints_free = count > 6 && std::all_of(modes.begin(), modes.end(), is_free);
    count = are_joints_free ? most : std::min(2 * count, most);
    modes = simulation.natural_modes(count);
  }
  fmt::print("\n");
  print_where(simulation, is_equilibrium);
  std::vector<Mode> oscillating;
  std::copy_if(modes.begin(), modes.end(), std::back_inserter(oscillating), oscillates);
  std::sort(oscillating.begin(), oscillating.end(),
            [](const Mode& a, const Mode& b) { return a.frequency < b.frequency; });
  oscillating.resize(std::min<std::size_t>(oscillating.size(), kModes));
  const auto free = std::count_if(modes.begin(), modes.end(), is_free);
  fmt::print("first natural frequencies there [Hz]:");
  for (const Mode& mode : oscillating) fmt::print(" {:.6g}", mode.frequency);
  if (oscillating.empty()) fmt::print(" none");
  if (free > 0) fmt::print(" (and {})", free == 1 ? "1 free motion" : fmt::format("{} free motions", free));
  fmt::print("\n");
  if (std::any_of(oscillating.begin(), oscillating.end(), [](const Mode& mode) { return mode.rate != 0; })) {
    fmt::print("their damping ratios:");
    for (const Mode& mode : oscillating) fmt::print(" {:.4g}", mode.damping_ratio());
    fmt::print("\n");
  }
  print_growth(modes);
  warn_of_long_step(simulation, oscillating);
}

}  // namespace

void add_check(CommandLine& line) {
  const auto scene = std::make_shared<SceneInput>();
  Command& command = line.command("check", "Reads a scene, builds its model and describes it");
  add_scene(command, *scene);
  command.runs([scene] {
    Simulation simulation = load_simulation(*scene);
    print_size(simulation);
    print_plane(simulation);
    print_parameters(simulation);
    print_links(simulation);
    print_joints(simulation);
    print_beams(simulation);
    print_relaxation(simulation);
    print_force_elements(simulation);
    print_contacts(simulation);
    print_driven_ends(simulation);
    if (const std::string warning = warning_of_shaking_servos(simulation); !warning.empty())
      fmt::print(stderr, "flexarm: warning: {}\n", warning);
    warn_of_growth(simulation);
    print_dead_point(simulation);
    try {
      print_frequencies(simulation);
    } catch (const std::runtime_error& error) {
      fmt::print("\nfirst natural frequencies [Hz]: none ({})\n", error.what());
    }
    return kDone;
  });
}

}  // namespace flexarm::cli
