#include "bench/thesis.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>

#include "flexarm/scene/urdf_reader.h"
#include "flexarm/schemes/integrator_description.h"
#include "simulation/inside.h"

namespace flexarm::bench {
namespace {

constexpr int kHistoryRows = 300;

scene::SceneDescription scene_of(const std::string& folder, const ThesisRun& run) {
  const std::string path = folder + "/" + run.scene + ".urdf";
  scene::ReadResult read = scene::read_scene_file(path);
  if (!read.scene)
    throw std::runtime_error(read.diagnostics.empty() ? "cannot read '" + path + "'" : read.diagnostics[0].text());
  scene::SceneDescription scene = *read.scene;
  scene.integrator = with_scheme(scene.integrator, run.scheme);
  scene.integrator.step = run.step;
  for (scene::LinkDescription& link : scene.links) {
    if (!link.beam) continue;
    for (const MeshChange& change : run.mesh)
      if (change.link == link.name) link.beam->elements = change.elements;
    scene::DirectSection& s = std::get<scene::DirectSection>(link.beam->section);
    for (double* stiffness : {&s.ea, &s.ga2, &s.ga3, &s.gj, &s.ei2, &s.ei3}) *stiffness *= run.stiffness;
  }
  for (scene::JointDescription& joint : scene.joints) {
    if (!joint.slide) continue;
    if (!run.contact.empty()) joint.slide->scheme = run.contact;
    joint.slide->smooth = run.smooth;
  }
  return scene;
}

/// Number of borders between elements between two arc lengths.
int borders_between(const Model& model, double from, double to) {
  int count = 0;
  for (const SlideLine& line : model.slide_lines)
    for (std::size_t i = 1; i < line.pieces.size(); ++i) {
      const double border = line.pieces[i].begin;
      count += (from - border) * (to - border) < 0 || (to == border && from != border);
    }
  return count;
}

/// Measures quantities during a run.
class Observer {
 public:
  Observer(const ThesisExample& example, const Simulation& simulation, int stride)
      : example_(example), simulation_(simulation), stride_(stride) {
    const Energies e = simulation.energies();
    start_ = e.total() - e.work + e.dissipated;
    potential_ = e.potential;
    angular_momentum_ = simulation.angular_momentum();
    observe(0);
  }

  void observe(long step) {
    const Energies e = simulation_.energies();
    const Vector3 l = simulation_.angular_momentum();
    const double defect = std::abs(e.total() - e.work + e.dissipated - start_);
    const double turned = (l - angular_momentum_).norm();
    energy_ = std::max({energy_, e.kinetic + e.strain, std::abs(e.potential - potential_)});
    momentum_ = std::max(momentum_, l.norm());
    energy_defect_ = std::max(energy_defect_, defect);
    momentum_defect_ = std::max(momentum_defect_, turned);
    if (step % stride_ != 0) return;
    std::vector<double> row = {simulation_.time(), defect, turned};
    for (const double value : example_.observe(simulation_)) row.push_back(value);
    rows_.push_back(std::move(row));
  }

  void finish(ThesisOutcome& out) {
    const auto relative = [](double defect, double scale) { return scale > 0 ? defect / scale : 0.0; };
    out.energy_defect = relative(energy_defect_, energy_);
    out.angular_momentum_defect = relative(momentum_defect_, momentum_);
    for (std::vector<double>& row : rows_) {
      row[1] = relative(row[1], energy_);
      row[2] = relative(row[2], momentum_);
    }
    out.history = std::move(rows_);
  }

 private:
  const ThesisExample& example_;
  const Simulation& simulation_;
  int stride_;
  double start_ = 0, potential_ = 0, energy_ = 0, momentum_ = 0, energy_defect_ = 0, momentum_defect_ = 0;
  Vector3 angular_momentum_;
  std::vector<std::vector<double>> rows_;
};

}  // namespace

ThesisOutcome run_thesis(const std::string& scene_folder, const ThesisExample& example, const ThesisRun& run,
                         bool quick) {
  ThesisOutcome out;
  const auto start = std::chrono::steady_clock::now();
  Simulation simulation(scene_of(scene_folder, run));
  const long steps = quick ? 10 : std::lround(example.until / run.step);
  Observer observer(example, simulation, static_cast<int>(std::max(1L, steps / kHistoryRows)));
  long sub_steps = 0, iterations = 0;
  double travel = example.travel(simulation);
  for (long n = 1; n <= steps; ++n) {
    const double before = simulation.time();
    const StepResult result = simulation.step();
    out.halvings += result.halvings;
    iterations += result.iterations;
    sub_steps += 1 + result.halvings;
    const double now = example.travel(simulation), moved = now - travel;
    const auto time_at = [&](double place) { return before + (simulation.time() - before) * (place - travel) / moved; };
    for (int k = borders_between(model_of(simulation), travel, now); k > 0; --k)
      out.crossings.push_back(simulation.time());
    const bool arrives = example.ends_at_zero && travel > 0 && now <= 0;
    if (arrives) out.arrival = time_at(0);
    travel = now;
    observer.observe(n);
    if (arrives) break;
    if (!result.converged) {
      out.failure = Failure{simulation.time(), result.reason};
      break;
    }
  }
  out.end = simulation.time();
  out.iterations = sub_steps > 0 ? static_cast<double>(iterations) / static_cast<double>(sub_steps) : 0;
  observer.finish(out);
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return out;
}

ThesisReport measure_thesis(const std::string& scene_folder, bool quick, const std::function<void(double)>& progress) {
  ThesisReport report;
  report.examples = thesis_examples();
  // The cost of a run is roughly proportional to its number of steps and elements.
  const auto cost = [](const ThesisExample& example, const ThesisRun& run) { return example.cost / run.step; };
  double whole = 0, done = 0;
  for (const ThesisExample& example : report.examples)
    for (const ThesisRun& run : example.runs) whole += cost(example, run);
  for (const ThesisExample& example : report.examples) {
    report.outcomes.emplace_back();
    for (const ThesisRun& run : example.runs) {
      report.outcomes.back().push_back(run_thesis(scene_folder, example, run, quick));
      progress((done += cost(example, run)) / whole);
    }
  }
  return report;
}

std::string histories_to_csv(const ThesisExample& example, const std::vector<ThesisOutcome>& outcomes) {
  const bool has_momentum = example.conserves_angular_momentum;
  std::string text = "run,step,time,energy_defect";
  if (has_momentum) text += ",angular_momentum_defect";
  for (const std::string& name : example.observables) text += "," + name;
  text += "\n";
  for (std::size_t i = 0; i < outcomes.size(); ++i)
    for (const std::vector<double>& row : outcomes[i].history) {
      text += fmt::format("\"{}\",{:g}", example.runs[i].label, example.runs[i].step);
      for (std::size_t k = 0; k < row.size(); ++k)
        if (k != 2 || has_momentum) text += fmt::format(",{:.6g}", row[k]);
      text += "\n";
    }
  return text;
}

}  // namespace flexarm::bench
