#include "simulation/background_writer.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <utility>

#include "model/state_numbers.h"
#include "simulation/inside.h"

namespace flexarm {
namespace {

/// How long a thread sleeps before it looks at the ring again. Waking the writing thread for every row would cost the
/// simulating thread more than handing over the row.
constexpr std::chrono::microseconds kPause{200};
/// Capacity of the rings: as many states as kMostBytes holds, but at least kFewest and at most kMost.
constexpr std::size_t kMostBytes = 1 << 22;
constexpr std::size_t kFewest = 16, kMost = 1024;

std::size_t entries_for(const State& state) {
  std::size_t numbers = 0;
  for_each_number(state, [&](const char*, double) { ++numbers; });
  return std::clamp(kMostBytes / (numbers * sizeof(double)), kFewest, kMost);
}

/// While an object of this class exists, its thread and the threads that it starts get no signals: the main thread
/// handles them.
class SignalsBlocked {
 public:
  SignalsBlocked() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~SignalsBlocked() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsBlocked(const SignalsBlocked&) = delete;
  SignalsBlocked& operator=(const SignalsBlocked&) = delete;

 private:
  sigset_t before_;
};

}  // namespace

BackgroundWriter::BackgroundWriter(const Simulation& simulation, const MakeWriter& make_writer)
    : mirror_(simulation.copy()),
      writer_(make_writer(mirror_)),
      ring_(entries_for(state_of(simulation))),
      returned_(entries_for(state_of(simulation))) {
  const SignalsBlocked blocked;
  thread_ = std::thread([this] { write_entries(); });
}

BackgroundWriter::~BackgroundWriter() {
  finish();
}

void BackgroundWriter::write_row(const Simulation& simulation) {
  Entry& entry = step_waits_ ? ring_.free_entry() : next_entry();
  entry.is_row = true;
  set_state(entry, simulation);
  ring_.push();
  step_waits_ = false;
}

void BackgroundWriter::note_step(const Simulation& simulation, const StepResult& result) {
  push_step();
  Entry& entry = next_entry();
  entry.is_step = true;
  entry.result = result;
  step_waits_ = true;
  if (!looks_at_steps()) return;  // the step shares an entry with the row after it, which costs less
  set_state(entry, simulation);
  push_step();
}

void BackgroundWriter::push_step() {
  if (step_waits_) ring_.push();
  step_waits_ = false;
}

void BackgroundWriter::close() {
  finish();
  throw_error();
  writer_->close();
}

BackgroundWriter::Entry& BackgroundWriter::next_entry() {
  throw_error();
  while (!ring_.has_room()) {
    std::this_thread::sleep_for(kPause);
    throw_error();
  }
  Entry& entry = ring_.free_entry();
  entry.is_step = entry.is_row = entry.has_state = false;
  return entry;
}

void BackgroundWriter::set_state(Entry& entry, const Simulation& simulation) {
  entry.has_state = true;
  entry.state = snapshot_of(simulation);
  entry.step_size = simulation.step_size();
  entry.step_of_constants = step_of_constants(simulation);
}

/// Reuses the memory that came back last, which is still in the processor's cache. Cycling through all entries of the
/// ring would take three times as long.
Snapshot BackgroundWriter::snapshot_of(const Simulation& simulation) {
  for (; !returned_.empty(); returned_.pop()) free_.push_back(std::move(returned_.front()));
  Snapshot snapshot;
  if (!free_.empty()) {
    snapshot = std::move(free_.back());
    free_.pop_back();
  }
  simulation.snapshot(snapshot);
  return snapshot;
}

void BackgroundWriter::throw_error() {
  if (has_failed_.load(std::memory_order_acquire)) std::rethrow_exception(error_);
}

void BackgroundWriter::finish() {
  push_step();
  is_over_.store(true, std::memory_order_release);
  if (thread_.joinable()) thread_.join();
}

void BackgroundWriter::write_entries() {
  try {
    for (bool was_over = false; !was_over;) {
      was_over = is_over_.load(std::memory_order_acquire);
      if (ring_.empty() && !was_over) std::this_thread::sleep_for(kPause);
      for (; !ring_.empty(); ring_.pop()) write(ring_.front());
    }
  } catch (...) {
    error_ = std::current_exception();
    has_failed_.store(true, std::memory_order_release);
  }
}

void BackgroundWriter::write(Entry& entry) {
  if (entry.has_state) {
    if (mirror_.step_size() != entry.step_size) set_step(mirror_, entry.step_size, {});
    set_step_of_constants(mirror_, entry.step_of_constants);
    mirror_.restore(entry.state);
    returned_.free_entry() = std::move(entry.state);
    returned_.push();
  }
  if (entry.is_step) writer_->note_step(mirror_, entry.result);
  if (entry.is_row) writer_->write_row(mirror_);
}

}  // namespace flexarm
