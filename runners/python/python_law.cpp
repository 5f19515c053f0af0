#include <string>
#include <utility>

#include "runners/python/package.hpp"

namespace zerocount::python {
namespace {

namespace py = pybind11;

constexpr std::int64_t samples_between_signals = 1024;

std::string type_name(const py::handle& object) {
  return py::str(py::type::handle_of(object).attr("__name__"));
}

/// The torque that a law returned.
double torque_of(const py::object& value) {
  const double torque = PyFloat_AsDouble(value.ptr());
  if (torque != -1.0 || PyErr_Occurred() == nullptr) return torque;
  if (PyErr_ExceptionMatches(PyExc_TypeError) == 0) throw py::error_already_set();
  PyErr_Clear();
  throw py::type_error("the control law returned " + type_name(value) +
                       " at a sample; expected a torque, a number");
}

/// A law in one trial.
class RunningLaw {
 public:
  explicit RunningLaw(py::object step) : step_(std::move(step)) {}

  double operator()(const zerocount_sample& sample) {
    if (++samples_ % samples_between_signals == 0 && PyErr_CheckSignals() != 0) throw py::error_already_set();
    return torque_of(step_(sample));
  }

 private:
  py::object step_;
  std::int64_t samples_{0};
};

}  // namespace

void register_law_types(py::module_& module) {
  py::class_<zerocount_setup>(module, "Setup", "What is the same at all samples of a trial.")
      .def_readonly("sample_time", &zerocount_setup::sample_time)
      .def_readonly("resolution", &zerocount_setup::resolution)
      .def_readonly("torque_resolution", &zerocount_setup::torque_resolution)
      .def_readonly("lowest_torque", &zerocount_setup::lowest_torque)
      .def_readonly("highest_torque", &zerocount_setup::highest_torque)
      .def_readonly("initial_integral", &zerocount_setup::initial_integral);
  py::class_<zerocount_sample>(module, "Sample", "A sampling instant.")
      .def_readonly("k", &zerocount_sample::k)
      .def_readonly("time", &zerocount_sample::time)
      .def_readonly("error", &zerocount_sample::error)
      .def_readonly("count", &zerocount_sample::count)
      .def_readonly("reference", &zerocount_sample::reference)
      .def_readonly("torque", &zerocount_sample::torque)
      .def_readonly("velocity", &zerocount_sample::velocity)
      .def_readonly("acceleration", &zerocount_sample::acceleration)
      .def_property_readonly("new_target",
                             [](const zerocount_sample& sample) { return sample.new_target != 0; });
}

std::shared_ptr<const plugin::ControllerPlugin> python_law(py::object law) {
  plugin::ControllerPlugin plugin{.description = {"a function of Python", "1", "", {}}};
  plugin.start = [law = std::move(law)](const zerocount_setup& setup) -> plugin::StepFunction {
    py::object step = law(setup);
    if (PyCallable_Check(step.ptr()) == 0) {
      throw py::type_error("the controller returned " + type_name(step) +
                           " for the setup of the trial; expected a function of a sample");
    }
    return RunningLaw(std::move(step));
  };
  return std::make_shared<const plugin::ControllerPlugin>(std::move(plugin));
}

}  // namespace zerocount::python
