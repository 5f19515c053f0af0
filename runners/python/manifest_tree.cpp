#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include <pybind11/stl.h>

#include "core/text/number_text.hpp"
#include "experiments/manifest_text/overrides.hpp"
#include "experiments/yaml/problems.hpp"
#include "experiments/yaml/yaml_tree.hpp"
#include "runners/python/package.hpp"

namespace zerocount::python {
namespace {

namespace py = pybind11;
using yaml::YamlNode;

/// The number that is all of the text, with or without a sign.
template <class Number>
std::optional<Number> number_in(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  return text::parse_number<Number>(text);
}

py::object scalar_of(const YamlNode& node) {
  if (!node.plain) return py::str(node.text);
  if (node.text == "true" || node.text == "false") return py::bool_(node.text == "true");
  if (const auto whole = number_in<std::int64_t>(node.text)) return py::int_(*whole);
  if (const auto whole = number_in<std::uint64_t>(node.text)) return py::int_(*whole);
  if (const auto real = number_in<double>(node.text)) return py::float_(*real);
  return py::str(node.text);
}

py::object object_of(const YamlNode& node) {
  switch (node.kind) {
    case YamlNode::Kind::null:
      break;
    case YamlNode::Kind::scalar:
      return scalar_of(node);
    case YamlNode::Kind::list: {
      py::list list;
      for (const yaml::YamlPointer& item : node.items) list.append(object_of(*item));
      return list;
    }
    case YamlNode::Kind::map: {
      py::dict map;
      for (const yaml::YamlEntry& entry : node.entries) map[py::str(entry.key)] = object_of(*entry.value);
      return map;
    }
  }
  return py::none();
}

py::object manifest_tree(const std::string& text, const std::string& source,
                         const std::vector<std::string>& overrides) {
  yaml::Problems problems;
  std::deque<std::string> sources;
  yaml::YamlPointer root = yaml::parse_yaml(text, source, false, problems);
  if (root != nullptr) root = manifest_text::apply_overrides(root, overrides, sources, problems);
  problems.raise_if_any();
  return object_of(*root);
}

}  // namespace

void register_manifest_tree(py::module_& module) {
  module.def("manifest_tree", &manifest_tree, py::arg("text"), py::arg("source"), py::arg("overrides"));
}

}  // namespace zerocount::python
