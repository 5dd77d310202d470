#include "pictures/page.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <vector>

#include <dlfcn.h>
#include <fmt/format.h>

#include "math/json_text.h"
#include "pictures/color_scale.h"
#include "pictures/tracks.h"
#include "simulation/unfinished_file.h"

namespace flexarm::pictures {
namespace {

namespace fs = std::filesystem;

/// The folder of this library.
fs::path library_folder() {
  Dl_info info;
  if (dladdr(reinterpret_cast<const void*>(&page_of), &info) == 0 || !info.dli_fname) return {};
  std::error_code ignored;
  return fs::weakly_canonical(info.dli_fname, ignored).parent_path();
}

/// Folders of the player's files and of three.js: beside this library if flexarm is installed by pip, in the share
/// folder if it is installed otherwise, else in the source tree and in the system.
std::vector<fs::path> player_folders() {
  const fs::path here = library_folder(), three(FLEXARM_THREE_DIR);
  return {here / "player", here.parent_path() / "share/flexarm/player",
          fs::path(FLEXARM_SOURCE_DIR) / "src/pictures/player", three, three / "examples/js/controls"};
}

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file) throw std::runtime_error("cannot read " + path.string());
  return text;
}

std::string player_file(const std::string& name) {
  std::error_code ignored;
  for (const fs::path& folder : player_folders())
    if (fs::is_regular_file(folder / name, ignored)) return text_of(folder / name);
  throw std::runtime_error(fmt::format("a part of pages, {}, is not installed{}", name,
                                       name == "player.html" ? "" : ": three.js is in the package libjs-three"));
}

/// Replaces each `<TAG ... ATTRIBUTE="FILE">END` by the contents of FILE within `<ELEMENT>...</ELEMENT>`.
void put_files_in(std::string& page, const std::string& begin, const std::string& end, const std::string& element) {
  std::size_t at = 0;
  while ((at = page.find(begin, at)) != std::string::npos) {
    const std::size_t name = at + begin.size(), quote = page.find('"', name), stop = page.find(end, quote);
    if (stop == std::string::npos) throw std::runtime_error("player.html is damaged");
    const std::string text = fmt::format("<{0}>\n{1}</{0}>", element, player_file(page.substr(name, quote - name)));
    page.replace(at, stop + end.size() - at, text);
    at += text.size();
  }
}

std::string elements_of(const std::vector<EncodedRun>& runs) {
  std::string out;
  for (const EncodedRun& run : runs)
    out += "<script type=\"application/json\" class=\"flexarm-picture\">" + run.picture + "</script>\n" +
           "<script type=\"text/plain\" class=\"flexarm-motion\">" + base64(run.motion) + "</script>\n";
  return out;
}

/// What all runs of a page share.
std::string settings_of(FirstTime first_time) {
  return fmt::format("<script type=\"application/json\" class=\"flexarm-settings\">{}</script>\n",
                     "{\"colors\": " + color_scales_as_json() +
                         ", \"first_time\": " + (first_time ? json_number(*first_time) : "null") + "}");
}

/// The player, with elements in the place of the runs.
std::string page_with(const std::string& elements) {
  const std::string place = "<!-- runs -->";
  std::string page = player_file("player.html");
  put_files_in(page, "<link rel=\"stylesheet\" href=\"", ">", "style");
  put_files_in(page, "<script src=\"", "></script>", "script");
  const std::size_t at = page.find(place);
  if (at == std::string::npos) throw std::runtime_error("player.html has no place for runs");
  page.replace(at, place.size(), elements);
  return page;
}

}  // namespace

std::string page_of(const std::vector<EncodedRun>& runs, FirstTime first_time) {
  return page_with(settings_of(first_time) + elements_of(runs));
}

std::string live_page() {
  return page_with(settings_of({}) +
                   "<script type=\"application/json\" class=\"flexarm-live\">{\"stream\": \"/stream\"}</script>\n");
}

void write_page(const std::string& path, const std::vector<EncodedRun>& runs, FirstTime first_time) {
  with_subject("'" + path + "'", [&] { UnfinishedFile(path, page_of(runs, first_time)).put_in_place(); });
}

// ---------------------------------------------------------------- writer

PageWriter::PageWriter(const std::string& path, const Simulation& simulation, const RecordingOptions& options,
                       FirstTime first_time)
    : path_(path), simulation_(simulation), recording_(simulation, options), first_time_(first_time) {
  // So that errors show before the run, but an older page stays until this one is complete.
  with_subject("'" + path + "'", [&] {
    page_of({});
    const UnfinishedFile place(path, "");
  });
}

void PageWriter::write_row(const Simulation& simulation) {
  if (recording_.is_due(simulation)) recording_.keep(simulation, take_counts());
}

void PageWriter::close() {
  if (recording_.last_time() != simulation_.time()) recording_.keep(simulation_, take_counts());
  write_page(path_, {recording_.encode()}, first_time_);
}

}  // namespace flexarm::pictures
