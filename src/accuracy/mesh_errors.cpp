#include "accuracy/mesh_errors.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

namespace flexarm {
namespace {

/// Time of an iteration for an element of each order. The unit is that of order 1.
constexpr double kCost[] = {0, 1, 2, 4, 7};
/// Cost of a rigid beam, so that it is not zero.
constexpr double kRigidCost = 0.2;

constexpr int kRichOrder = 4, kFirstRichElements = 2, kMostRichElements = 32;

/// Meshes that are tried, by number of nodes. `order`: of all meshes; empty: any.
std::vector<BeamResolution> ladder(std::optional<int> order) {
  if (!order)
    return {{1, 1}, {1, 2}, {1, 3}, {2, 2}, {2, 3},  {3, 2}, {4, 2},  {3, 3},  {2, 4},  {4, 3},  {6, 2}, {3, 4},
            {4, 4}, {6, 3}, {6, 4}, {8, 3}, {12, 2}, {8, 4}, {12, 3}, {16, 3}, {16, 4}, {32, 3}, {32, 4}};
  std::vector<BeamResolution> meshes;
  for (const int elements : {1, 2, 3, 4, 5, 6, 8, 10, 12, 16, 20, 24, 32, 40, 48, 64, 96, 128})
    meshes.push_back({elements, *order});
  return meshes;
}

int node_count(const BeamResolution& mesh) {
  return mesh.elements.value_or(0) * mesh.order;
}

std::vector<BeamResolution> rich_meshes(const std::vector<BeamResolution>& own, const MeshFreedom& freedom,
                                        int elements) {
  std::vector<BeamResolution> beams = own;
  for (std::size_t b = 0; b < beams.size(); ++b)
    if (freedom.is_free[b]) beams[b] = {elements, kRichOrder};
  return beams;
}

/// Errors of one beam's meshes, compared to the rich run. Ends after two meshes that are good enough.
std::vector<MeshError> measure_beam(TrialRuns& trials, const TrialRun& rich, std::size_t beam, bool may_be_rigid,
                                    const std::optional<int>& order, double wanted) {
  std::vector<BeamResolution> meshes = ladder(order);
  if (may_be_rigid) meshes.insert(meshes.begin(), {0, order.value_or(1)});
  std::vector<MeshError> found;
  int good = 0;
  for (const BeamResolution& mesh : meshes) {
    if (good == 2) break;
    if (!order && node_count(mesh) >= node_count(rich.settings.beams[beam])) continue;
    RunSettings settings = rich.settings;
    settings.beams[beam] = mesh;
    const TrialRun& run = trials.run(settings, 10 * rich.seconds + 1);
    if (!run.is_complete()) continue;
    const MotionDifference error = difference(run.motion, rich.motion);
    good += size(error) <= wanted ? 1 : 0;
    found.push_back({mesh, error, mesh_cost(mesh)});
  }
  const BeamResolution& best = rich.settings.beams[beam];
  if (!order) found.push_back({best, 0 * difference(rich.motion, rich.motion), mesh_cost(best)});
  std::stable_sort(found.begin(), found.end(), [](const MeshError& a, const MeshError& b) { return a.cost < b.cost; });
  return found;
}

/// Only the meshes that are better than all cheaper ones.
std::vector<const MeshError*> worth_their_cost(const std::vector<MeshError>& meshes) {
  std::vector<const MeshError*> kept;
  for (const MeshError& mesh : meshes)
    if (kept.empty() || size(mesh.error) < size(kept.back()->error)) kept.push_back(&mesh);
  return kept;
}

}  // namespace

double mesh_cost(const BeamResolution& mesh) {
  return mesh.elements == 0 ? kRigidCost : mesh.elements.value_or(9) * kCost[mesh.order];
}

double mesh_cost(const std::vector<BeamResolution>& beams) {
  return std::accumulate(beams.begin(), beams.end(), 0.0,
                         [](double sum, const BeamResolution& mesh) { return sum + mesh_cost(mesh); });
}

MeshErrors measure_meshes(TrialRuns& trials, const RunSettings& settings, const MeshFreedom& freedom, double wanted) {
  MeshErrors errors;
  RunSettings rich = settings;
  rich.beams = rich_meshes(settings.beams, freedom, kFirstRichElements);
  errors.is_rich_enough = std::count(freedom.is_free.begin(), freedom.is_free.end(), true) == 0;
  for (int elements = 2 * kFirstRichElements; !errors.is_rich_enough && elements <= kMostRichElements; elements *= 2) {
    RunSettings richer = rich;
    richer.beams = rich_meshes(settings.beams, freedom, elements);
    const TrialRun &coarse = trials.run(rich), &fine = trials.run(richer);
    if (coarse.is_complete() && fine.is_complete()) {
      errors.rest = size(difference(coarse.motion, fine.motion));
      errors.is_rich_enough = errors.rest <= wanted;
    } else if (!fine.is_complete()) {
      errors.shortcoming = fine.failure;
    }
    if (!errors.is_rich_enough) rich = richer;
  }
  if (!errors.is_rich_enough && errors.shortcoming.empty())
    errors.shortcoming =
        fmt::format("{} elements of order {} in each beam are not enough", kMostRichElements, kRichOrder);
  errors.rich = rich;
  const TrialRun& run = trials.run(rich);
  if (!run.is_complete()) {
    errors.shortcoming = run.failure;
    return errors;
  }
  for (std::size_t b = 0; b < rich.beams.size(); ++b) {
    const MotionDifference none = 0 * difference(run.motion, run.motion);
    const std::optional<int> order = freedom.keeps_orders ? std::optional<int>(settings.beams[b].order) : std::nullopt;
    errors.beams.push_back(freedom.is_free[b]
                               ? measure_beam(trials, run, b, freedom.may_be_rigid, order, wanted)
                               : std::vector<MeshError>(1, {rich.beams[b], none, mesh_cost(rich.beams[b])}));
  }
  return errors;
}

std::optional<MotionDifference> MeshErrors::of(const std::vector<BeamResolution>& meshes) const {
  MotionDifference sum;
  for (std::size_t b = 0; b < beams.size(); ++b) {
    const auto found =
        std::find_if(beams[b].begin(), beams[b].end(), [&](const MeshError& error) { return error.mesh == meshes[b]; });
    if (found == beams[b].end()) return std::nullopt;
    sum = b == 0 ? found->error : MotionDifference(sum + found->error);
  }
  return sum;
}

std::vector<MeshChoice> mesh_choices(const MeshErrors& errors) {
  std::vector<std::vector<const MeshError*>> worthy;
  for (const std::vector<MeshError>& beam : errors.beams) worthy.push_back(worth_their_cost(beam));
  std::vector<std::size_t> at(worthy.size(), 0);
  const auto choice = [&] {
    MeshChoice out;
    for (std::size_t b = 0; b < at.size(); ++b) out.beams.push_back(worthy[b][at[b]]->mesh);
    out.error = errors.of(out.beams).value();
    out.cost = mesh_cost(out.beams);
    return out;
  };
  // Errors of different beams are assumed not to cancel, since they would do so for this motion only.
  const auto gain = [&](std::size_t b, std::size_t to) {
    const MeshError &now = *worthy[b][at[b]], &then = *worthy[b][to];
    return (size(now.error) - size(then.error)) / (then.cost - now.cost);
  };
  std::vector<MeshChoice> choices = {choice()};
  while (true) {
    std::size_t beam = at.size(), to = 0;
    for (std::size_t b = 0; b < at.size(); ++b)
      for (std::size_t next = at[b] + 1; next < worthy[b].size(); ++next)
        if (beam == at.size() || gain(b, next) > gain(beam, to)) beam = b, to = next;
    if (beam == at.size()) return choices;
    at[beam] = to;
    choices.push_back(choice());
  }
}

const MeshChoice& cheapest_mesh(const std::vector<MeshChoice>& choices, double wanted) {
  const auto found = std::find_if(choices.begin(), choices.end(),
                                  [&](const MeshChoice& choice) { return size(choice.error) <= wanted; });
  return found != choices.end() ? *found : choices.back();
}

}  // namespace flexarm
