#pragma once
/// Results of a simulation as comma-separated values.

#include <cstdio>
#include <memory>
#include <string>

#include "flexarm/simulation/result_writer.h"

namespace flexarm {

/// A file with a line of the columns' names, then a row for each call. Numbers have 17 significant digits, so that they
/// are read back bit for bit, in any locale.
class CsvWriter : public ResultWriter {
 public:
  /// Creates the file and writes the header. The path "-" means the standard output.
  /// @throws std::runtime_error naming the file and the reason if that fails, as the other functions do. The rows
  ///   written before are then whole.
  CsvWriter(const std::string& path, ResultColumns columns);

  void write_row(const Simulation& simulation) override;
  /// A remote file system may notice only here that it is full.
  void close() override;

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  void write_line(std::string& line);

  std::string path_, line_;
  std::unique_ptr<std::FILE, Closer> file_;
  ResultColumns columns_;
  long written_ = 0;  // bytes of whole rows
};

}  // namespace flexarm
