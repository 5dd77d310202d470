#pragma once
/// Writes results in a separate thread while the simulation goes on stepping.

#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "flexarm/simulation/result_writer.h"
#include "flexarm/simulation/spsc_ring.h"

namespace flexarm {

/// Passes all rows on to another writer, in the same order, from copies of the states. If the simulation is ahead of
/// the writer by more rows than the buffer holds, it waits. If the writer fails, the next call throws its error.
class BackgroundWriter : public ResultWriter {
 public:
  /// Makes the other writer. `shown` is the simulation that it will read: a copy that never steps.
  using MakeWriter = std::function<std::unique_ptr<ResultWriter>(const Simulation& shown)>;

  BackgroundWriter(const Simulation& simulation, const MakeWriter& make_writer);
  /// Returns when all rows that were handed over are written.
  ~BackgroundWriter() override;

  void write_row(const Simulation& simulation) override;
  void note_step(const Simulation& simulation, const StepResult& result) override;
  bool looks_at_steps() const override { return writer_->looks_at_steps(); }
  void close() override;

 private:
  struct Entry {
    bool is_step = false, is_row = false;  // a step, a row, or a step and the row after it
    StepResult result;                     // of the step
    bool has_state = false;
    Snapshot state;
    double step_size = 0, step_of_constants = 0;  // with a state: of the simulation, which may change them [s]
  };

  Entry& next_entry();
  /// Hands over the step that waits for its row, if there is one.
  void push_step();
  void set_state(Entry& entry, const Simulation& simulation);
  Snapshot snapshot_of(const Simulation& simulation);
  void throw_error();
  void finish();
  void write_entries();
  void write(Entry& entry);

  Simulation mirror_;  // a copy that never steps; the writer reads it
  std::unique_ptr<ResultWriter> writer_;
  SpscRing<Entry> ring_;
  SpscRing<Snapshot> returned_;  // memory that the writing thread gives back
  std::vector<Snapshot> free_;   // memory to reuse, the most recently returned last
  bool step_waits_ = false;      // whether the next free entry already has a step
  std::atomic<bool> is_over_{false}, has_failed_{false};
  std::exception_ptr error_;  // set once has_failed_ is true
  std::thread thread_;
};

}  // namespace flexarm
