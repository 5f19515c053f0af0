#include <pybind11/pybind11.h>

#include "runners/python/failures.hpp"
#include "runners/python/manifest_tree.hpp"
#include "runners/python/python_law.hpp"
#include "runners/python/study_object.hpp"

namespace zerocount::python {
namespace {

void fill(pybind11::module_& module) {
  module.doc() = "What the package zerocount runs in this process: the trials of a study.";
  module.attr("__version__") = ZEROCOUNT_VERSION;
  register_failures();
  register_law_types(module);
  register_study(module);
  register_manifest_tree(module);
}

}  // namespace
}  // namespace zerocount::python

PYBIND11_MODULE(_zerocount, module) {
  zerocount::python::fill(module);
}
