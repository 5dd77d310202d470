#pragma once
/// Guards a simulation against simultaneous use by several Python threads.

#include <deque>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/pybind11.h>

#include "flexarm/simulation/result_columns.h"
#include "flexarm/simulation/simulation.h"
#include "python/read_scene.h"

namespace flexarm::python {

/// While a thread works on the simulation without Python's global lock (GIL), other threads that use it get an
/// exception. All other access, also to the members of this class, requires the GIL.
class GuardedSimulation {
 public:
  GuardedSimulation(std::shared_ptr<const ReadScene> scene, Simulation simulation)
      : scene_(std::move(scene)), simulation_(std::move(simulation)) {}
  GuardedSimulation(const GuardedSimulation& other, Simulation simulation)
      : scene_(other.scene_),
        family_(other.family_),
        simulation_(std::move(simulation)),
        is_edited_(other.is_edited_) {}

  /// The simulation. @throws std::runtime_error if another thread works on it
  Simulation& use() {
    if (is_in_work_)
      throw std::runtime_error(
          "another thread is working on this simulation: each belongs to one thread at a time (copy.copy() makes "
          "another one)");
    return simulation_;
  }

  /// Calls `work(simulation)` without the GIL, so that other Python threads can run.
  template <class Work>
  auto work(const Work& work) {
    Simulation& simulation = use();
    const InWork in_work(is_in_work_);
    const pybind11::gil_scoped_release unlocked;
    return work(simulation);
  }

  /// Calls `work()`, which uses all these simulations, without the GIL.
  template <class Work>
  static void work_on_all(const std::vector<std::shared_ptr<GuardedSimulation>>& simulations, const Work& work) {
    for (const auto& simulation : simulations) simulation->use();
    std::deque<InWork> in_work;
    for (const auto& simulation : simulations) in_work.emplace_back(simulation->is_in_work_);
    const pybind11::gil_scoped_release unlocked;
    work();
  }

  std::shared_ptr<GuardedSimulation> copy() { return std::make_shared<GuardedSimulation>(*this, use().copy()); }

  /// The columns that match the patterns; kept for later calls.
  /// @throws std::invalid_argument that names a pattern without any matching column
  ResultColumns& columns(const std::vector<std::string>& patterns) {
    const auto known = columns_.find(patterns);
    if (known != columns_.end()) return known->second;
    return columns_.emplace(patterns, ResultColumns(use(), ResultColumns::Solver::With, patterns)).first->second;
  }

  /// Calls `edit(simulation)`, which changes the scene. If it throws, nothing has changed.
  template <class Edit>
  void edit(const Edit& edit) {
    edit(use());
    family_ = std::make_shared<const char>();
    columns_.clear();
    is_edited_ = true;
  }

  /// The scene from which the simulation was made.
  const std::shared_ptr<const ReadScene>& scene() const { return scene_; }
  bool is_edited() const { return is_edited_; }
  /// A mark that copies of a simulation share. Snapshots can be exchanged between simulations with the same mark.
  const std::shared_ptr<const char>& family() const { return family_; }

 private:
  /// Sets the flag as long as this object lives.
  class InWork {
   public:
    explicit InWork(bool& flag) : flag_(flag) { flag_ = true; }
    ~InWork() { flag_ = false; }
    InWork(const InWork&) = delete;
    InWork& operator=(const InWork&) = delete;

   private:
    bool& flag_;
  };

  std::shared_ptr<const ReadScene> scene_;
  std::shared_ptr<const char> family_ = std::make_shared<const char>();
  Simulation simulation_;
  std::map<std::vector<std::string>, ResultColumns> columns_;
  bool is_in_work_ = false, is_edited_ = false;
};

}  // namespace flexarm::python
