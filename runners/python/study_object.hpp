#pragma once

#include <pybind11/pybind11.h>

namespace zerocount::python {

/// Registers Study: a checked manifest, its trials, and its random variables.
void register_study(pybind11::module_& module);

}  // namespace zerocount::python
