#pragma once

#include <functional>
#include <memory>
#include <stop_token>

#include <pybind11/pybind11.h>

#include "core/plugin/controller_plugin.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::python {

/// Makes a Failure of the program an exception of the package (zerocount/errors.py), by its exit code.
void register_failures();

/// Does work without the lock of the interpreter (GIL), on a thread of its own, while this one answers
/// signals: a handler that raises, such as that of Ctrl-C, asks the work to stop, and its exception is raised
/// once it has. Exceptions of the work are raised here.
void interruptible(const std::function<void(const std::stop_token&)>& work);

/// Registers manifest_tree(text, source, overrides): a manifest as dicts, lists and values of Python.
void register_manifest_tree(pybind11::module_& module);

/// Registers the types that a control law in Python gets, Setup and Sample.
void register_law_types(pybind11::module_& module);

/// A control law in Python: a callable that is given the Setup of a trial, and returns one that is given each
/// Sample and returns a torque (N m). Trials with it must be run while the lock of the interpreter is held.
std::shared_ptr<const plugin::ControllerPlugin> python_law(pybind11::object law);

/// Adds to Study its random variables, and the outcomes of trials with given values of them.
void register_sampling(pybind11::class_<study::Study, std::shared_ptr<study::Study>>& object);

/// Registers Study: a checked manifest, its trials, and its random variables.
void register_study(pybind11::module_& module);

}  // namespace zerocount::python
