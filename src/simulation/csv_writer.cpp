#include "flexarm/simulation/csv_writer.h"

#include <cerrno>
#include <cstring>
#include <initializer_list>
#include <stdexcept>

#include <unistd.h>

#include <fmt/format.h>

#include "flexarm/scene/scene_description.h"
#include "simulation/csv_fields.h"

namespace flexarm {
namespace {

using csv::append;

bool is_standard_output(const std::string& path) {
  return path == "-";
}

[[noreturn]] void fail(const std::string& path) {
  const std::string place = is_standard_output(path) ? "the standard output" : "'" + path + "'";
  throw std::runtime_error(fmt::format("cannot write {}: {}", place, std::strerror(errno)));
}

std::FILE* open(const std::string& path) {
  std::FILE* file = is_standard_output(path) ? fdopen(dup(STDOUT_FILENO), "w") : std::fopen(path.c_str(), "w");
  // Rows go out as a whole: a reader, or what is left when the process is killed, has no broken ones.
  if (file) std::setvbuf(file, nullptr, _IONBF, 0);
  return file;
}

// ---------------------------------------------------------------- header

void append_names(std::string& line, const std::string& prefix, std::initializer_list<const char*> names) {
  for (const char* name : names) append(line, prefix + "/" + name);
}

void append_header(std::string& line, const Simulation& simulation, CsvWriter::Columns columns) {
  append(line, std::string("time"));
  for (const std::string& name : simulation.coordinate_names())
    append_names(line, "joint/" + name, {"position", "velocity", "effort"});
  for (const std::string& name : simulation.link_names())
    append_names(line, "frame/" + name, {"x", "y", "z", "qx", "qy", "qz", "qw"});
  for (const scene::Probe& probe : simulation.scene().probes)
    append_names(line, "probe/" + probe.name, {"x", "y", "z", "qx", "qy", "qz", "qw", "vx", "vy", "vz"});
  append_names(line, "energy", {"kinetic", "strain", "potential", "total", "work", "dissipated"});
  append_names(line, "momentum", {"x", "y", "z"});
  append_names(line, "angular_momentum", {"x", "y", "z"});
  if (columns == CsvWriter::Columns::StateAndSolver)
    append_names(line, "solver",
                 {"step", "iterations", "halvings", "deepest_halving", "other_guesses", "dissipated_steps"});
}

// ---------------------------------------------------------------- rows

void append(std::string& line, const Vector3& vector) {
  for (int i = 0; i < 3; ++i) append(line, vector[i]);
}

void append(std::string& line, const Pose& pose) {
  append(line, pose.position);
  for (int i = 0; i < 4; ++i) append(line, pose.orientation.coeffs()[i]);  // x y z w
}

void append_state(std::string& line, const Simulation& simulation) {
  append(line, simulation.time());
  for (std::size_t i = 0; i < simulation.coordinate_names().size(); ++i) {
    append(line, simulation.position(i));
    append(line, simulation.velocity(i));
    append(line, simulation.effort(i));
  }
  for (std::size_t i = 0; i < simulation.link_names().size(); ++i) append(line, simulation.link_pose(i));
  for (std::size_t i = 0; i < simulation.scene().probes.size(); ++i) {
    const ProbeState probe = simulation.probe(i);
    append(line, probe.pose);
    append(line, probe.velocity);
  }
  const Energies energies = simulation.energies();
  for (const double energy :
       {energies.kinetic, energies.strain, energies.potential, energies.total(), energies.work, energies.dissipated})
    append(line, energy);
  append(line, simulation.momentum());
  append(line, simulation.angular_momentum());
}

}  // namespace

CsvWriter::CsvWriter(const std::string& path, const Simulation& simulation, Columns columns)
    : path_(path), file_(open(path)), columns_(columns) {
  if (!file_) fail(path_);
  append_header(line_, simulation, columns_);
  write_line(line_);
}

void CsvWriter::write_row(const Simulation& simulation) {
  append_state(line_, simulation);
  if (columns_ == Columns::StateAndSolver) {
    append(line_, simulation.step_size());
    for (const long count : {counts_.iterations, counts_.halvings, static_cast<long>(counts_.deepest_halving),
                             counts_.other_guesses, counts_.dissipated_steps})
      append(line_, count);
    counts_ = {};
  }
  write_line(line_);
}

void CsvWriter::count(const StepResult& result) {
  counts_.add(result);
}

void CsvWriter::close() {
  if (file_ && std::fclose(file_.release()) != 0) fail(path_);
}

void CsvWriter::write_line(std::string& line) {
  line += '\n';
  if (std::fwrite(line.data(), 1, line.size(), file_.get()) != line.size()) {
    const int reason = errno;
    // The part of a row that still had room; of what is no regular file nothing can be taken back.
    [[maybe_unused]] const int ignored = ftruncate(fileno(file_.get()), written_);
    errno = reason;
    fail(path_);
  }
  written_ += static_cast<long>(line.size());
  line.clear();  // keeps its memory for the next row
}

}  // namespace flexarm
