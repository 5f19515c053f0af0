#pragma once

#include <pybind11/pybind11.h>

namespace zerocount::python {

/// Registers manifest_tree(text, source, overrides): a manifest as dicts, lists and values of Python.
void register_manifest_tree(pybind11::module_& module);

}  // namespace zerocount::python
