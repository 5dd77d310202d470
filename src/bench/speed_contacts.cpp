// Measures rigid bodies in contact, in comparison with MuJoCo, and the cost of contacts that never close.
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "accuracy/processor_time.h"
#include "bench/markdown_table.h"
#include "bench/speed.h"
#include "flexarm/scene/urdf_reader.h"
#include "flexarm/simulation/simulation.h"
#ifdef FLEXARM_HAS_MUJOCO
#include "bench/mujoco_motion.h"
#endif

namespace flexarm::bench {
namespace {

constexpr double kStep = 1e-3;  // of all runs in both programs [s]
constexpr double kSettled = 1;  // time from which creep is measured [s]

/// The same bodies for both programs. Creep is measured for the last body.
struct Touching {
  std::string name;
  std::string urdf, mjcf;
  double until;                // [s]
  std::vector<double> pushes;  // forces on the first coordinates of MuJoCo's model, equal to the scene's efforts [N]
  bool is_driven;              // external forces do work, which MuJoCo does not report
  bool is_far = false;         // no body comes close to another one
};

std::string inertial(double mass, const Vector3& inertia, const Vector3& middle = {0, 0, 0}) {
  return fmt::format(
      "<inertial><origin xyz=\"{} {} {}\"/><mass value=\"{}\"/><inertia ixx=\"{}\" iyy=\"{}\" izz=\"{}\" ixy=\"0\" "
      "ixz=\"0\" iyz=\"0\"/></inertial>",
      middle.x(), middle.y(), middle.z(), mass, inertia.x(), inertia.y(), inertia.z());
}

std::string urdf_of(const std::string& parts, const std::string& more) {
  return "<robot name=\"touching\"><link name=\"world\"/><ground name=\"floor\"/>" + parts +
         fmt::format(
             "<simulation><gravity xyz=\"0 0 -9.81\"/><integrator scheme=\"em\" step=\"{}\"/>{}</simulation></robot>",
             kStep, more);
}
std::string mjcf_of(const std::string& bodies, double friction) {
  return fmt::format(
      "<mujoco><compiler angle=\"radian\"/><option timestep=\"{}\" gravity=\"0 0 -9.81\"><flag "
      "energy=\"enable\"/></option>"
      "<default><geom friction=\"{} 0 0\" condim=\"3\"/></default><worldbody><geom type=\"plane\" size=\"0 0 1\"/>{}"
      "</worldbody></mujoco>",
      kStep, friction, bodies);
}

/// A chain of ten links of 0.2 m, with balls at their middles, that falls obliquely.
Touching chain() {
  constexpr double kMass = 0.5, kInertia = 2e-3;
  const std::string inertia = inertial(kMass, Vector3::Constant(kInertia), {0.1, 0, 0});
  std::string parts = "<contact first=\"*\" second=\"*\" friction=\"0.5\"/>", bodies, ends;
  for (int k = 0; k < 10; ++k) {
    parts += fmt::format(
        "<link name=\"link{0}\">{1}<collision><origin xyz=\"0.1 0 0\"/><geometry><sphere radius=\"0.05\"/></geometry>"
        "</collision></link><joint name=\"joint{0}\" type=\"{2}\"><parent link=\"{3}\"/><child "
        "link=\"link{0}\"/>{4}</joint>",
        k, inertia, "floating", k == 0 ? "world" : fmt::format("link{}", k - 1),
        k == 0 ? "<origin xyz=\"0 0 1.8\" rpy=\"0 0.6 0.1\"/>"
               : "<origin xyz=\"0.2 0 0\"/><release kind=\"spherical\"/>");
    bodies += k == 0 ? "<body pos=\"0 0 1.8\" quat=\"0.954139 -0.014769 0.295152 0.047748\"><freejoint/>"
                     : "<body pos=\"0.2 0 0\"><joint type=\"ball\"/>";
    bodies += fmt::format(
        "<inertial pos=\"0.1 0 0\" mass=\"{0}\" diaginertia=\"{1} {1} {1}\"/><geom type=\"sphere\" size=\"0.05\" "
        "pos=\"0.1 0 "
        "0\"/>",
        kMass, kInertia);
    ends += "</body>";
  }
  return {"chain of ten links falls", urdf_of(parts, ""), mjcf_of(bodies + ends, 0.5), 2, {}, false};
}

Touching stack() {
  std::string parts = "<contact first=\"*\" second=\"*\" friction=\"0.5\"/>", starts, bodies;
  for (int k = 0; k < 5; ++k) {
    const double height = 0.05 + 0.101 * k + 0.001;
    parts += fmt::format(
        "<link name=\"box{0}\">{1}<collision><geometry><box size=\"0.1 0.1 0.1\"/></geometry></collision></link>"
        "<joint name=\"of_box{0}\" type=\"floating\"><parent link=\"world\"/><child link=\"box{0}\"/></joint>",
        k, inertial(1, Vector3::Constant(1.0 / 600)));
    starts += fmt::format("<initial joint=\"of_box{}/z\" position=\"{}\"/>", k, height);
    bodies += fmt::format(
        "<body pos=\"0 0 {}\"><freejoint/><geom type=\"box\" size=\"0.05 0.05 0.05\" mass=\"1\"/></body>", height);
  }
  return {"stack of five boxes", urdf_of(parts, starts), mjcf_of(bodies, 0.5), 3, {}, false};
}

/// Two fingers that press a block with 10 N each, and hold it.
Touching grasp() {
  const std::string finger = inertial(0.2, Vector3::Constant(1e-4));
  std::string parts = "<contact first=\"block\" second=\"*\" friction=\"0.8\"/>", bodies;
  for (const auto& [name, at, axis] : {std::tuple("left", -0.041, 1), std::tuple("right", 0.041, -1)}) {
    parts += fmt::format(
        "<link name=\"{0}\">{1}<collision><geometry><box size=\"0.02 0.04 0.04\"/></geometry></collision></link><joint "
        "name=\"of_{0}\" type=\"prismatic\"><parent link=\"world\"/><child link=\"{0}\"/><origin xyz=\"{2} 0 "
        "0.5\"/><axis "
        "xyz=\"{3} 0 0\"/><limit lower=\"-1\" upper=\"1\" effort=\"100\" velocity=\"10\"/></joint>",
        name, finger, at, axis);
    bodies += fmt::format(
        "<body pos=\"{} 0 0.5\"><joint type=\"slide\" axis=\"{} 0 0\"/><inertial pos=\"0 0 0\" mass=\"0.2\" "
        "diaginertia=\"1e-4 "
        "1e-4 1e-4\"/><geom type=\"box\" size=\"0.01 0.02 0.02\"/></body>",
        at, axis);
  }
  parts += "<link name=\"block\">" + inertial(0.5, Vector3::Constant(3e-4)) +
           "<collision><geometry><box size=\"0.06 0.06 0.06\"/></geometry></collision></link><joint name=\"of_block\" "
           "type=\"floating\"><parent link=\"world\"/><child link=\"block\"/></joint>";
  bodies +=
      "<body pos=\"0 0 0.5\"><freejoint/><inertial pos=\"0 0 0\" mass=\"0.5\" diaginertia=\"3e-4 3e-4 3e-4\"/><geom "
      "type=\"box\" size=\"0.03 0.03 0.03\"/></body>";
  return {"two fingers hold a block",
          urdf_of(parts,
                  "<initial joint=\"of_block/z\" position=\"0.5\"/><effort joint=\"of_left\" history=\"10\"/><effort "
                  "joint=\"of_right\" history=\"10\"/>"),
          mjcf_of(bodies, 0.8),
          3,
          {10, 10},
          true};
}

/// A scene with contacts that never close, or the same scene without contacts, to measure what these contacts cost.
Touching far_scene(const std::string& what, const std::string& parts, const std::string& loads,
                   const std::string& contacts) {
  const char* kind = contacts.empty() ? ", no contact" : ", far contacts";
  return {what + kind, urdf_of(contacts + parts, loads), "", 3, {}, false, true};
}

/// A rigid arm of six links, and five boxes that its hand could touch.
Touching far_boxes(bool with_contact) {
  std::string arm, boxes, contacts, parent = "world";
  const auto shape = [](const std::string& size) {
    return "<collision><geometry><box size=\"" + size + "\"/></geometry></collision>";
  };
  for (int k = 0; k < 6; ++k) {
    const std::string link = fmt::format("link{}", k);
    arm += fmt::format(
        "<link name=\"{0}\">{1}{2}</link><joint name=\"joint{3}\" type=\"continuous\"><parent link=\"{4}\"/>"
        "<child link=\"{0}\"/><origin xyz=\"0.2 0 0\"/><axis xyz=\"{5}\"/></joint>",
        link, inertial(1, Vector3::Constant(0.01), {0.1, 0, 0}), shape("0.2 0.05 0.05"), k, parent,
        k % 2 == 0 ? "0 0 1" : "0 1 0");
    parent = link;
  }
  for (int k = 0; k < 5; ++k) {
    boxes += fmt::format(
        "<link name=\"box{0}\">{1}</link><joint name=\"of_box{0}\" type=\"fixed\"><parent link=\"world\"/><child "
        "link=\"box{0}\"/><origin xyz=\"{2} 5 5\"/></joint>",
        k, shape("0.3 0.3 0.3"), 5 + k);
    if (with_contact) contacts += fmt::format("<contact first=\"link5\" second=\"box{}\"/>", k);
  }
  return far_scene("six links, five boxes", boxes + arm, "", contacts);
}

/// Two cantilevers of 20 elements, one high above the other, that bend in 3D.
Touching far_beams(bool with_contact) {
  std::string beams, loads;
  for (const auto& [name, height] : {std::pair("low", 1), std::pair("high", 4)}) {
    beams += fmt::format(
        "<link name=\"{0}\"><beam elements=\"20\" order=\"2\"><centerline><line to=\"1 0 0\"/></centerline><circle "
        "radius=\"0.01\"/><material young=\"7e10\" poisson=\"0.3\" density=\"2700\"/></beam></link><joint "
        "name=\"of_{0}\" type=\"fixed\"><parent link=\"world\"/><child link=\"{0}\"/><origin xyz=\"0 0 {1}\"/></joint>",
        name, height);
    loads += fmt::format("<load link=\"{}\" at=\"1 0 0\" force=\"0 5 0\"/>", name);
  }
  return far_scene("two beams", beams, loads, with_contact ? "<contact first=\"low\" second=\"high\"/>" : "");
}

ContactRun run_flexarm(const Touching& problem, double until) {
  const scene::ReadResult result = scene::read_scene_text(problem.urdf, problem.name);
  if (!result.scene) throw std::logic_error(to_text(result.diagnostics));
  Simulation simulation(*result.scene);
  ContactRun out{problem.name, "flexarm", 0, 0, 0, 0, 0, true};
  const std::size_t last = result.scene->links.size() - 1;
  const double begin = simulation.energies().total();
  std::vector<ActingContact> contacts;
  double settled = 0;
  while (simulation.time() < until - 0.5 * kStep) {
    const double clock = processor_seconds();
    out.completed = simulation.step().converged;
    out.seconds += processor_seconds() - clock;
    if (!out.completed) return out;
    ++out.steps;
    if (problem.is_far) continue;  // evaluating all points would remove the step's data from the caches
    simulation.contacts(contacts);
    out.most_contacts = std::max(out.most_contacts, static_cast<int>(contacts.size()));
    for (const ActingContact& contact : contacts) out.deepest = std::max(out.deepest, contact.penetration);
    const Energies energies = simulation.energies();
    out.gained = std::max(out.gained, energies.total() - energies.work - begin);
    const double height = simulation.link_pose(last).position.z();
    if (std::abs(simulation.time() - kSettled) < 0.5 * kStep) settled = height;
    out.crept = std::abs(height - settled);
  }
  return out;
}

#ifdef FLEXARM_HAS_MUJOCO

ContactRun run_mujoco(const Touching& problem, double until) {
  const MujocoModel model = mujoco_model_of_text(problem.mjcf);
  const MujocoData data = mujoco_data(model.get());
  std::copy(problem.pushes.begin(), problem.pushes.end(), data->qfrc_applied);
  ContactRun out{problem.name, std::string("MuJoCo ") + mj_versionString(), 0, 0, 0, 0, 0, true};
  mj_forward(model.get(), data.get());
  const double begin = data->energy[0] + data->energy[1];
  double settled = 0;
  for (out.steps = 0; static_cast<double>(out.steps) * kStep < until - 0.5 * kStep;) {
    const double clock = processor_seconds();
    mj_step(model.get(), data.get());
    out.seconds += processor_seconds() - clock;
    ++out.steps;
    int touching = 0;
    for (int k = 0; k < data->ncon; ++k) {
      touching += data->contact[k].dist < 0;
      out.deepest = std::max(out.deepest, -data->contact[k].dist);
    }
    out.most_contacts = std::max(out.most_contacts, touching);
    out.gained = std::max(out.gained, data->energy[0] + data->energy[1] - begin);
    const double height = data->xpos[3 * (model->nbody - 1) + 2];
    if (out.steps == std::lround(kSettled / kStep)) settled = height;
    out.crept = std::abs(height - settled);
  }
  out.completed = !has_warned(data.get());
  return out;
}

#endif

}  // namespace

std::vector<ContactRun> compare_contacts(bool quick) {
  std::vector<ContactRun> runs;
  for (const Touching& problem :
       {chain(), stack(), grasp(), far_boxes(false), far_boxes(true), far_beams(false), far_beams(true)}) {
    const double until = quick ? 0.05 : problem.until;
    runs.push_back(run_flexarm(problem, until));
    runs.back().is_driven = problem.is_driven;
#ifdef FLEXARM_HAS_MUJOCO
    if (problem.is_far) continue;
    runs.push_back(run_mujoco(problem, until));
    runs.back().is_driven = problem.is_driven;
#endif
  }
  return runs;
}

std::string contact_table(const std::vector<ContactRun>& runs) {
  std::string text = head({"scene", "program", "steps", "µs per step", "most points", "deepest [mm]",
                           "energy gained [J]", "the last body creeps [m/s]"});
  for (const ContactRun& r : runs) {
    const double crept = r.crept / (static_cast<double>(r.steps) * kStep - kSettled);
    text += row({r.scene, r.program, fmt::format("{}", r.steps),
                 r.completed ? fmt::format("{:.3g}", 1e6 * r.seconds / static_cast<double>(r.steps)) : "fails",
                 fmt::format("{}", r.most_contacts), fmt::format("{:.3g}", 1e3 * r.deepest),
                 r.is_driven ? "" : fmt::format("{:.1e}", r.gained), crept > 0 ? fmt::format("{:.1e}", crept) : "0"});
  }
  return text;
}

}  // namespace flexarm::bench
