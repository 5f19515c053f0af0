#pragma once

#include <memory>

#include <pybind11/pybind11.h>

#include "core/plugin/controller_plugin.hpp"

namespace zerocount::python {

/// Registers the types that a control law in Python gets, Setup and Sample.
void register_law_types(pybind11::module_& module);

/// A control law in Python: a callable that is given the Setup of a trial, and returns one that is given each
/// Sample and returns a torque (N m). Trials with it must be run while the lock of the interpreter is held.
std::shared_ptr<const plugin::ControllerPlugin> python_law(pybind11::object law);

}  // namespace zerocount::python
