#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "experiments/parameters/study_units.hpp"
#include "results/layout/fields.hpp"
#include "results/layout/layout.hpp"

namespace zerocount::python {

namespace py = pybind11;

/// An array of NumPy that owns the bytes; they are not copied.
py::array array_of(std::vector<std::byte> bytes, hdf5::Element element, std::vector<py::ssize_t> shape);

/// An array of NumPy that owns the numbers; they are not copied.
py::array array_of(std::vector<double> numbers, std::vector<py::ssize_t> shape);

/// What the package knows of a column: {"unit", "meaning", "flags": {value: word}, "type"}, in the words for
/// this kind of axis.
py::dict description_of(const layout::Column& column, parameters::AxisKind axis);

/// {column: array of this shape} of the records.
template <class Record>
py::dict arrays_of(const std::vector<layout::RecordField<Record>>& fields,
                   std::span<const Record* const> records, const std::vector<py::ssize_t>& shape) {
  std::vector<std::vector<std::byte>> columns = layout::columns_of(fields, records);
  py::dict arrays;
  for (std::size_t i = 0; i < fields.size(); ++i)
    arrays[py::str(fields[i].column.name)] = array_of(std::move(columns[i]), fields[i].column.element, shape);
  return arrays;
}

/// {column: description}.
template <class Record>
py::dict descriptions_of(const std::vector<layout::RecordField<Record>>& fields, parameters::AxisKind axis) {
  py::dict descriptions;
  for (const layout::RecordField<Record>& field : fields)
    descriptions[py::str(field.column.name)] = description_of(field.column, axis);
  return descriptions;
}

}  // namespace zerocount::python
