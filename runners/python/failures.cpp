#include "runners/python/failures.hpp"

#include <exception>

#include <pybind11/pybind11.h>

#include "core/failure/failure.hpp"

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

}  // namespace zerocount::python
