#include "runners/python/arrays.hpp"

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <utility>

namespace zerocount::python {
namespace {

py::dtype type_of(hdf5::Element element) {
  switch (element) {
    case hdf5::Element::float64:
      return py::dtype::of<double>();
    case hdf5::Element::int64:
      return py::dtype::of<std::int64_t>();
    case hdf5::Element::int32:
      return py::dtype::of<std::int32_t>();
    case hdf5::Element::int8:
      return py::dtype::of<std::int8_t>();
    case hdf5::Element::flag:
      return py::dtype::of<bool>();
    case hdf5::Element::text:
      break;
  }
  throw std::logic_error("texts are no numbers");
}

/// The owner of what an array shows.
template <class Number>
py::array array_owning(std::vector<Number> numbers, const py::dtype& type, std::vector<py::ssize_t> shape) {
  auto owner = std::make_unique<std::vector<Number>>(std::move(numbers));
  const void* data = owner->data();
  const py::capsule capsule(owner.get(), [](void* p) { delete static_cast<std::vector<Number>*>(p); });
  static_cast<void>(owner.release());
  return py::array(type, std::move(shape), data, capsule);
}

}  // namespace

py::array array_of(std::vector<std::byte> bytes, hdf5::Element element, std::vector<py::ssize_t> shape) {
  return array_owning(std::move(bytes), type_of(element), std::move(shape));
}

py::array array_of(std::vector<double> numbers, std::vector<py::ssize_t> shape) {
  return array_owning(std::move(numbers), py::dtype::of<double>(), std::move(shape));
}

py::dict description_of(const layout::Column& column, parameters::AxisKind axis) {
  py::dict flags;
  if (column.element != hdf5::Element::flag) {
    for (const layout::FlagMeaning& flag : column.flags) flags[py::int_(flag.value)] = flag.word;
  }
  py::dict description;
  description["unit"] = parameters::unit_on(axis, column.unit);
  description["meaning"] = parameters::text_on(axis, column.long_name);
  description["flags"] = flags;
  description["type"] = type_of(column.element);
  return description;
}

}  // namespace zerocount::python
