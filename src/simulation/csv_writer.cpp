#include "flexarm/simulation/csv_writer.h"

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

#include <unistd.h>

#include <fmt/format.h>

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
  // Unbuffered, so that each row is written as a whole: readers see no partial rows, and a killed process leaves none.
  // The exception is a kill during a write across two memory pages, which Linux may end between them.
  if (file) std::setvbuf(file, nullptr, _IONBF, 0);
  return file;
}

}  // namespace

CsvWriter::CsvWriter(const std::string& path, ResultColumns columns)
    : path_(path), file_(open(path)), columns_(std::move(columns)) {
  if (!file_) fail(path_);
  for (const ResultColumn& column : columns_.columns()) append(line_, column.name);
  write_line(line_);
}

void CsvWriter::write_row(const Simulation& simulation) {
  for (const double value : columns_.row(simulation, take_counts())) append(line_, value);
  write_line(line_);
}

void CsvWriter::close() {
  if (file_ && std::fclose(file_.release()) != 0) fail(path_);
}

void CsvWriter::write_line(std::string& line) {
  line += '\n';
  if (std::fwrite(line.data(), 1, line.size(), file_.get()) != line.size()) {
    const int reason = errno;
    // Remove the part of the row for which there was still room. If this is not a regular file, nothing can be removed.
    [[maybe_unused]] const int ignored = ftruncate(fileno(file_.get()), written_);
    errno = reason;
    fail(path_);
  }
  written_ += static_cast<long>(line.size());
  line.clear();  // keeps its memory for the next row
}

}  // namespace flexarm
