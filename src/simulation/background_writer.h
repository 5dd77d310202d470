#pragma once
/// Writes results in a separate thread while the simulation goes on.

#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "flexarm/simulation/result_writer.h"
#include "flexarm/simulation/spsc_ring.h"

namespace flexarm {

/// Hands all rows to another writer, in the same order, from copies of the states. A simulation that is ahead of the
/// writer by more than some rows waits for it. If the writer fails, the next call throws its error.
class BackgroundWriter : public ResultWriter {
 public:
  /// Makes the writer, for the mirror that it will read, a simulation that never steps.
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
    bool is_step = false, is_row = false;  // or a step and the row after it
    StepResult result;                     // of the step
    bool has_state = false;
    Snapshot state;
  };

  Entry& next_entry();
  /// A step that waits for its row.
  void push_step();
  Snapshot snapshot_of(const Simulation& simulation);
  void throw_error();
  void finish();
  void write_entries();
  void write(Entry& entry);

  Simulation mirror_;  // never steps: what the writer looks at
  std::unique_ptr<ResultWriter> writer_;
  SpscRing<Entry> ring_;
  SpscRing<Snapshot> returned_;  // memory, by the thread that writes
  std::vector<Snapshot> free_;   // memory, what came back last at the end
  bool step_waits_ = false;      // in the next free entry
  std::atomic<bool> is_over_{false}, has_failed_{false};
  std::exception_ptr error_;  // once it has failed
  std::thread thread_;
};

}  // namespace flexarm
