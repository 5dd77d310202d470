#include "cli/page_options.h"

#include <filesystem>
#include <set>

#include <fmt/format.h>

#include "cli/exit_status.h"
#include "cli/files.h"
#include "cli/installation.h"
#include "cli/simulation_output.h"
#include "pictures/page.h"

namespace flexarm::cli {

void add_page(Command& command, PageOptions& options) {
  command.heading("A page that shows it in a browser");
  command.flag("--show", options.is_wanted, "writes the page, by default into the working folder");
  command.option("--page", options.path, "HTML file for the page").shown_as("FILE").needs("--show");
  command.flag("--open", options.opens, "opens the page in a browser").needs("--show");
}

std::string page_path(const PageOptions& options, const SceneInput& scene, const std::string& suffix) {
  if (!options.is_wanted) return "";
  const std::string path =
      !options.path.empty() ? options.path : std::filesystem::path(scene.path).stem().string() + suffix + ".html";
  if (!is_page(path)) throw InputError("flexarm: expected the name of a page, NAME.html, got '" + path + "'");
  refuse_overwriting("--page", path, scene.path);
  require_writable("--page", path);
  return path;
}

void present_page(const PageOptions& options, const std::string& path, std::FILE* stream) {
  fmt::print(stream, "{} shows it in a browser\n", path);
  if (options.opens && !open_in_browser(path))
    fmt::print(stderr, "flexarm: no browser can be started by xdg-open: open {} yourself\n", path);
}

void write_page(const PageOptions& options, const std::string& path, const std::vector<pictures::EncodedRun>& runs,
                std::FILE* stream) {
  std::set<std::string> notes;
  for (const pictures::EncodedRun& run : runs)
    for (const std::string& note : run.notes)
      if (notes.insert(note).second) fmt::print(stderr, "flexarm: warning: {}\n", note);
  pictures::write_page(path, runs);
  present_page(options, path, stream);
}

}  // namespace flexarm::cli
