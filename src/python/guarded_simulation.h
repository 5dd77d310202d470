#pragma once
/// A simulation as Python's threads see it.

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

/// Belongs to one thread while that works on it without Python's lock; whoever comes in between is told so. All else,
/// this class's own members included, is changed only by who holds the lock.
class GuardedSimulation {
 public:
  GuardedSimulation(std::shared_ptr<const ReadScene> scene, Simulation simulation)
      : scene_(std::move(scene)), simulation_(std::move(simulation)) {}
  GuardedSimulation(const GuardedSimulation& other, Simulation simulation)
      : scene_(other.scene_),
        family_(other.family_),
        simulation_(std::move(simulation)),
        is_edited_(other.is_edited_) {}

  /// @throws std::runtime_error if another thread works on it.
  Simulation& use() {
    if (is_in_work_)
      throw std::runtime_error(
          "another thread is working on this simulation: each belongs to one thread at a time (copy.copy() makes "
          "another one)");
    return simulation_;
  }

  /// `work(simulation)`, while other threads of Python's run.
  template <class Work>
  auto work(const Work& work) {
    Simulation& simulation = use();
    const InWork in_work(is_in_work_);
    const pybind11::gil_scoped_release unlocked;
    return work(simulation);
  }

  std::shared_ptr<GuardedSimulation> copy() { return std::make_shared<GuardedSimulation>(*this, use().copy()); }

  /// Those that fit the patterns, found once.
  /// @throws std::invalid_argument naming a pattern that no column fits.
  ResultColumns& columns(const std::vector<std::string>& patterns) {
    const auto known = columns_.find(patterns);
    if (known != columns_.end()) return known->second;
    return columns_.emplace(patterns, ResultColumns(use(), ResultColumns::Solver::With, patterns)).first->second;
  }

  /// `edit(simulation)` makes its scene another one; if it throws, nothing has changed.
  template <class Edit>
  void edit(const Edit& edit) {
    edit(use());
    family_ = std::make_shared<const char>();
    columns_.clear();
    is_edited_ = true;
  }

  /// Of which it was made.
  const std::shared_ptr<const ReadScene>& scene() const { return scene_; }
  bool is_edited() const { return is_edited_; }
  /// The same for all that are copies of each other: their snapshots fit.
  const std::shared_ptr<const char>& family() const { return family_; }

 private:
  /// For as long as it lives.
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
