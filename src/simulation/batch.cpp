#include "flexarm/simulation/batch.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <unordered_set>
#include <utility>

#include <sched.h>

namespace flexarm {
namespace {

/// Each thread takes the work in so many shares, so that none waits long for the others.
constexpr std::size_t kShares = 8;

int processors() {
  cpu_set_t allowed;
  if (sched_getaffinity(0, sizeof allowed, &allowed) == 0) return std::max(CPU_COUNT(&allowed), 1);
  return static_cast<int>(std::max(std::thread::hardware_concurrency(), 1U));
}

std::vector<std::shared_ptr<Simulation>> copies_of(const Simulation& simulation, std::size_t count) {
  std::vector<std::shared_ptr<Simulation>> copies;
  for (std::size_t i = 0; i < count; ++i) copies.push_back(std::make_shared<Simulation>(simulation.copy()));
  return copies;
}

}  // namespace

/// Threads that wait for work.
struct Batch::Workers {
  explicit Workers(int threads) {
    for (int i = 1; i < threads; ++i) others.emplace_back([this] { serve(); });
  }
  ~Workers() {
    {
      const std::lock_guard<std::mutex> lock(mutex);
      ends = true;
    }
    has_work.notify_all();
    for (std::thread& thread : others) thread.join();
  }

  void run(std::size_t size, const std::function<void(std::size_t)>& given) {
    {
      const std::lock_guard<std::mutex> lock(mutex);
      work = &given;
      count = size;
      share = std::max<std::size_t>(1, size / (kShares * (others.size() + 1)));
      next = 0;
      failed = size;
      failure = nullptr;
      busy = others.size();
      ++round;
    }
    has_work.notify_all();
    take_shares();
    std::unique_lock<std::mutex> lock(mutex);
    is_done.wait(lock, [this] { return busy == 0; });
    if (failure) std::rethrow_exception(failure);
  }

  void serve() {
    std::size_t served = 0;
    for (;;) {
      std::unique_lock<std::mutex> lock(mutex);
      has_work.wait(lock, [&] { return ends || round != served; });
      if (ends) return;
      served = round;
      lock.unlock();
      take_shares();
      lock.lock();
      if (--busy == 0) is_done.notify_one();
    }
  }

  void take_shares() {
    for (;;) {
      const std::size_t first = next.fetch_add(share);
      for (std::size_t i = first; i < std::min(first + share, count); ++i) call(i);
      if (first + share >= count) return;
    }
  }

  void call(std::size_t index) {
    try {
      (*work)(index);
    } catch (...) {
      const std::lock_guard<std::mutex> lock(mutex);
      if (index < failed) failed = index, failure = std::current_exception();
    }
  }

  std::vector<std::thread> others;
  std::mutex mutex;
  std::condition_variable has_work, is_done;
  std::size_t round = 0;  // of work
  std::size_t busy = 0;   // other threads that have not ended this round
  bool ends = false;
  const std::function<void(std::size_t)>* work = nullptr;
  std::size_t count = 0, share = 1;
  std::atomic<std::size_t> next{0};
  std::size_t failed = 0;  // lowest index that threw
  std::exception_ptr failure;
};

Batch::Batch(std::vector<std::shared_ptr<Simulation>> simulations, int threads) : simulations_(std::move(simulations)) {
  if (simulations_.empty()) throw std::invalid_argument("a batch: expected at least one simulation");
  if (threads < 0) throw std::invalid_argument("threads: expected a number >= 0, got " + std::to_string(threads));
  std::unordered_set<const Simulation*> known{nullptr};
  for (std::size_t i = 0; i < simulations_.size(); ++i)
    if (!known.insert(simulations_[i].get()).second)
      throw std::invalid_argument("a batch: simulation " + std::to_string(i) +
                                  (simulations_[i] ? " is there twice" : " is null"));
  const auto most = static_cast<int>(std::min<std::size_t>(simulations_.size(), 1024));
  workers_ = std::make_unique<Workers>(std::min(threads == 0 ? processors() : threads, most));
}

Batch::Batch(const Simulation& simulation, std::size_t count, int threads)
    : Batch(copies_of(simulation, count), threads) {}

Batch::~Batch() = default;
Batch::Batch(Batch&&) noexcept = default;
Batch& Batch::operator=(Batch&&) noexcept = default;

std::size_t Batch::size() const {
  return simulations_.size();
}

int Batch::threads() const {
  return static_cast<int>(workers_->others.size()) + 1;
}

Simulation& Batch::operator[](std::size_t index) {
  return *simulations_.at(index);
}

void Batch::step(std::vector<StepResult>& results) {
  results.resize(size());
  for_each([&](std::size_t i) { results[i] = simulations_[i]->step(); });
}

void Batch::for_each(const std::function<void(std::size_t)>& work) {
  workers_->run(size(), work);
}

}  // namespace flexarm
