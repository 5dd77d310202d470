#include "python/signal_clock.h"

#include <pybind11/pybind11.h>

namespace flexarm::python {

bool SignalClock::is_interrupted() {
  const Clock::time_point now = Clock::now();
  if (is_interrupted_ || now < next_) return is_interrupted_;
  next_ = now + kPeriod;
  const pybind11::gil_scoped_acquire locked;
  is_interrupted_ = PyErr_CheckSignals() != 0;
  return is_interrupted_;
}

}  // namespace flexarm::python
