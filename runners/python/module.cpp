#include <algorithm>
#include <string>
#include <vector>

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "core/trial/outcome.hpp"
#include "results/layout/layout.hpp"
#include "runners/python/package.hpp"

namespace zerocount::python {
namespace {

/// The words of the outcomes, from best to worst.
std::vector<std::string> outcomes_by_severity() {
  std::vector<layout::FlagMeaning> labels = layout::outcome_labels();
  std::ranges::sort(labels, {}, [](const layout::FlagMeaning& label) {
    return trial::severity(static_cast<trial::Outcome>(label.value));
  });
  std::vector<std::string> words;
  words.reserve(labels.size());
  for (const layout::FlagMeaning& label : labels) words.push_back(label.word);
  return words;
}

void fill(pybind11::module_& module) {
  module.doc() = "What the package zerocount runs in this process: the trials of a study.";
  module.attr("__version__") = ZEROCOUNT_VERSION;
  module.attr("severity") = outcomes_by_severity();
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
