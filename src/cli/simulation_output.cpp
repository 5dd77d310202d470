#include "cli/simulation_output.h"

#include <stdexcept>
#include <string_view>
#include <utility>

#include "cli/commands.h"
#include "cli/files.h"
#include "cli/recording_library.h"
#include "flexarm/simulation/csv_writer.h"
#include "simulation/background_writer.h"

namespace flexarm::cli {
namespace {

bool ends_with(const std::string& text, std::string_view end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// The kind of file is what its name ends with.
std::unique_ptr<ResultWriter> make_writer(const SimulateArguments& arguments, const Simulation& simulation) {
  const std::string& path = arguments.output;
  if (is_bag(path)) return recording_library().bag(path, simulation);
  using Solver = ResultColumns::Solver;
  ResultColumns columns(simulation, arguments.estimates_error ? Solver::WithEstimate : Solver::With, arguments.columns);
  if (ends_with(path, ".h5")) return recording_library().hdf5(path, simulation, std::move(columns));
  return std::make_unique<CsvWriter>(path, std::move(columns));
}

/// Writes rows, at each of which the summary looks, too.
class SummarisedWriter : public ResultWriter {
 public:
  SummarisedWriter(std::unique_ptr<ResultWriter> writer, RunSummary& summary)
      : writer_(std::move(writer)), summary_(summary) {}

  void write_row(const Simulation& simulation) override {
    writer_->write_row(simulation);
    summary_.look(simulation);
  }
  void note_step(const Simulation& simulation, const StepResult& result) override {
    writer_->note_step(simulation, result);
  }
  bool looks_at_steps() const override { return writer_->looks_at_steps(); }
  void close() override { writer_->close(); }

 private:
  std::unique_ptr<ResultWriter> writer_;
  RunSummary& summary_;
};

}  // namespace

std::FILE* report_stream(const SimulateArguments& arguments) {
  return is_standard_output(arguments.output) ? stderr : stdout;
}

bool is_bag(const std::string& path) {
  return ends_with(path, ".bag");
}

std::unique_ptr<ResultWriter> open_output(const SimulateArguments& arguments, const Simulation& simulation,
                                          RunSummary& summary) {
  if (arguments.output.empty()) return nullptr;
  try {
    return std::make_unique<BackgroundWriter>(simulation, [&](const Simulation& shown) {
      return std::make_unique<SummarisedWriter>(make_writer(arguments, shown), summary);
    });
  } catch (const std::invalid_argument& error) {
    throw InputError("flexarm: --columns: " + std::string(error.what()));
  } catch (const std::runtime_error& error) {
    throw InputError("flexarm: " + std::string(error.what()));
  }
}

}  // namespace flexarm::cli
