#pragma once
/// Options of commands that can show their results in a browser.

#include <cstdio>
#include <string>
#include <vector>

#include "cli/scene_input.h"
#include "pictures/recording.h"

namespace flexarm::cli {

struct PageOptions {
  bool is_wanted = false, opens = false;
  std::string path;
};

/// Declares --show, --page and --open. `options` must outlive the command.
void add_page(Command& command, PageOptions& options);

/// The file for the page, by default `suffix` behind the scene's name in the working folder; empty if none is wanted.
/// @throws InputError if it cannot be written, or is not called NAME.html
std::string page_path(const PageOptions& options, const SceneInput& scene, const std::string& suffix);

/// Says where the page is, and opens it in a browser if that is wanted.
void present_page(const PageOptions& options, const std::string& path, std::FILE* stream);

/// Writes a page with these runs, prints their notes as warnings, and presents it.
/// @throws std::runtime_error naming the file and the reason if it cannot be written
void write_page(const PageOptions& options, const std::string& path, const std::vector<pictures::EncodedRun>& runs,
                std::FILE* stream);

}  // namespace flexarm::cli
