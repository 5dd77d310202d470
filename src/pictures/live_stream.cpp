#include "pictures/live_stream.h"

#include <algorithm>
#include <utility>

#include "pictures/picture_json.h"
#include "pictures/tracks.h"

namespace flexarm::pictures {
namespace {

/// Places for arrows that may come: forces that are applied while the simulation runs, and contacts. More of them need
/// another picture, which ends what the page has of the past.
constexpr std::size_t kPlacesForLoads = 4, kPlacesForContacts = 16;

/// Columns of a live page: all that depend on the state alone.
ResultColumns live_columns(const Simulation& simulation) {
  return ResultColumns(simulation, ResultColumns::Solver::Without);
}

/// Appends arrows, and zeros for the places that are not in use.
void append_arrows(const std::vector<ActingWrench>& arrows, std::size_t places, std::vector<double>& values) {
  for (const ActingWrench& arrow : arrows)
    for (const Vector3& part : {arrow.position, arrow.wrench.force, arrow.wrench.moment})
      values.insert(values.end(), part.data(), part.data() + part.size());
  values.insert(values.end(), 9 * (places - arrows.size()), 0.0);
}

}  // namespace

LiveStream::LiveStream(const Simulation& simulation, const std::string& title)
    : picture_(picture_of(simulation, live_columns(simulation).columns())),
      instant_(picture_, live_columns(simulation)),
      quaternions_(quaternions_of(picture_)) {
  picture_.title = title;
  find_arrows(simulation, arrows_);
  for (std::size_t kind = 0; kind < kArrowKinds; ++kind) places_[kind] = arrows_[kind].size();
  places_[static_cast<std::size_t>(ArrowKind::Load)] += kPlacesForLoads;
  if (!simulation.scene().contacts.empty()) places_[static_cast<std::size_t>(ArrowKind::Contact)] += kPlacesForContacts;
}

std::string LiveStream::picture() const {
  std::string meshes;
  for (const PictureMesh& mesh : picture_.meshes) append_mesh(mesh.surface, meshes);
  std::string json = picture_as_json(picture_, {0, places_, {}, -1, picture_.extent});
  json.insert(json.size() - 1, ", \"mesh_data\": \"" + base64(meshes) + "\"");
  return json;
}

bool LiveStream::make_places() {
  bool has_changed = false;
  for (std::size_t kind = 0; kind < kArrowKinds; ++kind) {
    if (arrows_[kind].size() <= places_[kind]) continue;
    places_[kind] = std::max(arrows_[kind].size(), 2 * places_[kind]);
    has_changed = true;
  }
  return has_changed;
}

LiveMessages LiveStream::next(const Simulation& simulation) {
  find_arrows(simulation, arrows_);
  LiveMessages messages;
  if (make_places()) messages.picture = picture();
  std::swap(values_, last_);
  values_.clear();
  instant_.append(simulation, {}, values_);
  const std::vector<double> columns(values_.end() - static_cast<std::ptrdiff_t>(picture_.columns.size()),
                                    values_.end());
  values_.resize(values_.size() - columns.size());
  for (std::size_t kind = 0; kind < kArrowKinds; ++kind) append_arrows(arrows_[kind], places_[kind], values_);
  values_.insert(values_.end(), columns.begin(), columns.end());
  if (!last_.empty()) keep_signs(quaternions_, last_, values_);
  append_numbers({simulation.time()}, messages.instant);
  append_numbers(values_, messages.instant);
  return messages;
}

}  // namespace flexarm::pictures
