#pragma once
/// Writes results of a simulation as a file of comma-separated values.

#include <cstdio>
#include <memory>
#include <string>

#include "flexarm/simulation/result_writer.h"

namespace flexarm {

/// Writes a line with the columns' names, then one row per call. Numbers have 17 significant digits and a decimal point
/// in any locale, so that they can be read back bit for bit.
class CsvWriter : public ResultWriter {
 public:
  /// Creates the file and writes the header. The path "-" means the standard output.
  /// @throws std::runtime_error naming the file and the reason if that fails. The other functions do the same; the rows
  /// written before an error are complete.
  CsvWriter(const std::string& path, ResultColumns columns);

  void write_row(const Simulation& simulation) override;
  /// Closes the file. Some errors are reported only here, such as a full remote file system.
  void close() override;

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  void write_line(std::string& line);

  std::string path_, line_;
  std::unique_ptr<std::FILE, Closer> file_;
  ResultColumns columns_;
  long written_ = 0;  // bytes of complete rows
};

}  // namespace flexarm
