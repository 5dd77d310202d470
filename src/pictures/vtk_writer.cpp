#include "pictures/vtk_writer.h"

#include <regex>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace flexarm::pictures {
namespace {

namespace fs = std::filesystem;

/// A list of a long run is long. So it is not written anew for each instant.
constexpr std::chrono::seconds kListedEvery{1};

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error && !fs::is_directory(folder, error)) error = std::make_error_code(std::errc::not_a_directory);
  if (error) throw std::runtime_error("cannot write into the folder '" + folder.string() + "': " + error.message());
}

/// Removes the files that an earlier run wrote for this part.
void remove_instants(const fs::path& folder, const std::string& part) {
  const std::regex ours(part + "_[0-9]{6,}\\.vtp");
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
    if (entry.is_regular_file(error) && std::regex_match(entry.path().filename().string(), ours))
      fs::remove(entry.path(), error);  // if it stays, it is overwritten, or no list names it
}

}  // namespace

VtkWriter::VtkWriter(const std::string& folder, const Simulation& simulation, const Picture& picture, double rate)
    : folder_(folder), simulation_(simulation), due_(rate), run_(folder_ / "run.pvd") {
  make_folder(folder_);
  for (std::unique_ptr<VtkPart>& part : vtk_parts(simulation, picture)) {
    const fs::path list = folder_ / (part->name() + ".pvd");
    series_.push_back({std::move(part), VtkCollection(list)});
  }
  // Empty lists come first, so that at no time they name files of the earlier run that are gone.
  write_lists();
  for (const Series& series : series_) {
    make_folder(folder_ / series.part->name());
    remove_instants(folder_ / series.part->name(), series.part->name());
  }
}

VtkWriter::~VtkWriter() {
  try {
    if (!are_listed_) write_lists();
  } catch (const std::runtime_error&) {  // the error that ended the run is reported
  }
}

void VtkWriter::write_lists() {
  for (const Series& series : series_) series.list.write();
  run_.write();
  are_listed_ = true;
  listed_ = std::chrono::steady_clock::now();
}

void VtkWriter::write_row(const Simulation& simulation) {
  if (!due_.is_due(simulation)) return;
  write_instant(simulation);
  if (count_ == 1 || std::chrono::steady_clock::now() > listed_ + kListedEvery) write_lists();
}

void VtkWriter::write_instant(const Simulation& simulation) {
  const double time = simulation.time();
  std::vector<VtkCollection::Part> files;
  for (const Series& series : series_) {
    const std::string& name = series.part->name();
    files.push_back({name, fmt::format("{0}/{0}_{1:06}.vtp", name, count_)});
    write_vtk_file(folder_ / files.back().file, vtk_text(series.part->show(simulation), time));
  }
  for (std::size_t i = 0; i < series_.size(); ++i) series_[i].list.add(time, {files[i]});
  run_.add(time, files);
  are_listed_ = false;
  ++count_;
  last_time_ = time;
  due_.note(time);
}

void VtkWriter::close() {
  if (last_time_ != simulation_.time()) write_instant(simulation_);
  write_lists();
}

}  // namespace flexarm::pictures
