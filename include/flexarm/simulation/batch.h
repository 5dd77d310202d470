#pragma once
/// Many simulations that are stepped together, by several threads.

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "flexarm/simulation/simulation.h"

namespace flexarm {

/// Simulations that are stepped together, such as arms with different starts, efforts or parameters. Each has the same
/// bits as if it were stepped alone. Only one thread at a time may use a batch.
class Batch {
 public:
  /// `threads`: that work at the same time, the calling one among them; 0: one for each processor.
  /// @throws std::invalid_argument if there is no simulation, one of them is null or is there twice, or `threads` < 0
  explicit Batch(std::vector<std::shared_ptr<Simulation>> simulations, int threads = 0);
  /// Copies of a simulation, in its state. @throws the same
  Batch(const Simulation& simulation, std::size_t count, int threads = 0);
  ~Batch();
  Batch(Batch&&) noexcept;
  Batch& operator=(Batch&&) noexcept;

  std::size_t size() const;
  int threads() const;
  /// @throws std::out_of_range if there is no such simulation
  Simulation& operator[](std::size_t index);

  /// Makes a step in each simulation. `results`: output, per simulation.
  void step(std::vector<StepResult>& results);
  /// Calls `work(index)` for each simulation, in any order and several at a time, and waits for all. It may use only
  /// that simulation. If calls throw, the exception of the lowest index is thrown in the end.
  void for_each(const std::function<void(std::size_t)>& work);

 private:
  struct Workers;
  std::vector<std::shared_ptr<Simulation>> simulations_;
  std::unique_ptr<Workers> workers_;
};

}  // namespace flexarm
