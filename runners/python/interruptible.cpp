#include <chrono>
#include <exception>
#include <future>

#include <pybind11/pybind11.h>

#include "core/failure/failure.hpp"
#include "runners/python/package.hpp"

namespace zerocount::python {

namespace py = pybind11;

void register_failures() {
  py::register_exception_translator(
      [](std::exception_ptr exception) {  // NOLINT(performance-unnecessary-value-param): pybind11's type
        try {
          if (exception) std::rethrow_exception(exception);
        } catch (const Failure& failure) {
          const py::object error = py::module_::import("zerocount.errors")
                                       .attr("error_of")(static_cast<int>(failure.code()), failure.what());
          PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(error.ptr())), error.ptr());
        }
      });
}

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
