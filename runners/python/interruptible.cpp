#include "runners/python/interruptible.hpp"

#include <chrono>
#include <future>

#include <pybind11/pybind11.h>

namespace zerocount::python {

namespace py = pybind11;

void interruptible(const std::function<void(const std::stop_token&)>& work) {
  constexpr std::chrono::milliseconds between_signals{50};
  std::stop_source stop;
  const py::gil_scoped_release released;
  std::future<void> done = std::async(std::launch::async, work, stop.get_token());
  while (done.wait_for(between_signals) != std::future_status::ready) {
    const py::gil_scoped_acquire acquired;
    if (PyErr_CheckSignals() == 0) continue;
    const py::error_already_set raised;
    stop.request_stop();
    {
      const py::gil_scoped_release released_again;
      done.wait();
    }
    throw raised;
  }
  done.get();
}

}  // namespace zerocount::python
