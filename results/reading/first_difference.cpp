#include "results/reading/first_difference.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <vector>

#include <fmt/format.h>

namespace zerocount::reading {
namespace {

/// Number of elements of a dataset that are read and compared at a time.
constexpr std::int64_t block_elements = 1 << 20;

/// Rules for a comparison of two files, and the receiver of its differences.
struct Comparison {
  double tolerance{0.0};  ///< Relative tolerance of real numbers; 0: bits are compared
  bool units{false};      ///< Whether the attribute `units` is compared too
  /// Function that receives each difference; if it returns false, the comparison ends.
  std::function<bool(const DatasetDifference&)> tell;
};

using How = std::optional<std::string>;  ///< Description of a difference; empty if there is none

How text_difference(const hdf5::Dataset& one, const hdf5::Dataset& other) {
  const std::vector<std::string> before = one.read_texts();
  const std::vector<std::string> after = other.read_texts();
  const auto place = std::mismatch(before.begin(), before.end(), after.begin(), after.end()).first;
  if (place == before.end() && before.size() == after.size()) return std::nullopt;
  return fmt::format("differs from row {} on", place - before.begin());
}

bool are_close(double one, double other, double tolerance) {
  if (std::isnan(one) || std::isnan(other)) return std::isnan(one) && std::isnan(other);
  return one == other || std::abs(one - other) <= tolerance * std::max(std::abs(one), std::abs(other));
}

/// Byte index of the first difference: of the first byte that differs or, if a tolerance is given for real
/// numbers, of the first number that differs by more than the tolerance. one.size() if nothing differs.
std::size_t first_mismatch(const std::vector<std::byte>& one, const std::vector<std::byte>& other,
                           bool real_numbers, double tolerance) {
  const auto from =
      static_cast<std::size_t>(std::mismatch(one.begin(), one.end(), other.begin()).first - one.begin());
  if (!real_numbers || tolerance <= 0.0) return from;
  for (std::size_t at = from - from % sizeof(double); at < one.size(); at += sizeof(double)) {
    double here = 0.0;
    double there = 0.0;
    std::memcpy(&here, one.data() + at, sizeof here);
    std::memcpy(&there, other.data() + at, sizeof there);
    if (!are_close(here, there, tolerance)) return at;
  }
  return one.size();
}

How number_difference(const hdf5::Dataset& one, const hdf5::Dataset& other, double tolerance) {
  const std::vector<hdf5::Size> extent = one.extent();
  if (extent.empty()) return "has no rows";
  const bool real_numbers = one.element() == hdf5::Element::float64;
  std::size_t width = hdf5::size_of(one.element());
  for (std::size_t dimension = 1; dimension < extent.size(); ++dimension) width *= extent[dimension];
  const auto rows = static_cast<std::int64_t>(extent[0]);
  const std::int64_t at_once = std::max<std::int64_t>(1, block_elements / static_cast<std::int64_t>(width));
  std::vector<std::byte> before;
  std::vector<std::byte> after;
  for (std::int64_t first = 0; first < rows; first += at_once) {
    const std::int64_t count = std::min(at_once, rows - first);
    before.resize(static_cast<std::size_t>(count) * width);
    after.resize(before.size());
    one.read(first, count, before.data());
    other.read(first, count, after.data());
    const std::size_t place = first_mismatch(before, after, real_numbers, tolerance);
    if (place == before.size()) continue;
    return fmt::format("differs from row {} on", first + static_cast<std::int64_t>(place / width));
  }
  return std::nullopt;
}

How dataset_difference(const hdf5::Dataset& one, const hdf5::Dataset& other, double tolerance) {
  if (one.element() != other.element()) return "has elements of another type";
  if (one.extent() != other.extent()) return "has another size";
  return one.element() == hdf5::Element::text ? text_difference(one, other)
                                              : number_difference(one, other, tolerance);
}

/// Whether the dataset `name` holds statistics that are computed from the trials. They are compared last,
/// after the data from which they are computed.
bool is_derived(const std::string& name) {
  return name == "point" || name == "level" || name == "repeatability";
}

std::string path_in(const hdf5::Group& group, const std::string& name) {
  return (group.path() == "/" ? "" : group.path()) + "/" + name;
}

bool compare_groups(const hdf5::Group& one, const hdf5::Group& other, const Comparison& comparison);

/// Compares the member `name` of group `one` with the member of that name in group `other`.
/// @returns false if the comparison is to end.
bool compare_member(const hdf5::Group& one, const hdf5::Group& other, const std::string& name,
                    const Comparison& comparison) {
  const std::string path = path_in(one, name);
  if (!other.contains(name))
    return comparison.tell({path, "missing in one of the files", DatasetDifference::Kind::in_one_file_only});
  if (one.is_group(name) != other.is_group(name))
    return comparison.tell({path, "a group in one of the files only"});
  if (one.is_group(name)) return compare_groups(one.open_group(name), other.open_group(name), comparison);
  const hdf5::Dataset here = one.open_dataset(name), there = other.open_dataset(name);
  if (comparison.units && here.has_attribute("units") && there.has_attribute("units") &&
      here.text("units") != there.text("units") &&
      !comparison.tell(
          {path, fmt::format("its unit '{}' differs", here.text("units")), DatasetDifference::Kind::unit}))
    return false;
  const How how = dataset_difference(here, there, comparison.tolerance);
  return !how || comparison.tell({path, *how});
}

bool compare_groups(const hdf5::Group& one, const hdf5::Group& other, const Comparison& comparison) {
  std::vector<std::string> names = one.children();
  std::stable_partition(names.begin(), names.end(),
                        [](const std::string& name) { return !is_derived(name); });
  for (const std::string& name : names) {
    if (!compare_member(one, other, name, comparison)) return false;
  }
  for (const std::string& name : other.children()) {
    if (!one.contains(name) && !comparison.tell({path_in(one, name), "missing in one of the files",
                                                 DatasetDifference::Kind::in_one_file_only}))
      return false;
  }
  return true;
}

}  // namespace

std::string text_of(const DatasetDifference& difference) {
  return fmt::format("{}: {}", difference.path, difference.how);
}

std::optional<std::string> first_difference(const hdf5::Group& one, const hdf5::Group& other) {
  std::optional<std::string> first;
  compare_groups(one, other, {0.0, false, [&](const DatasetDifference& difference) {
                                first = text_of(difference);
                                return false;
                              }});
  return first;
}

std::vector<DatasetDifference> differences(const hdf5::Group& one, const hdf5::Group& other,
                                           double tolerance) {
  std::vector<DatasetDifference> all;
  compare_groups(one, other, {tolerance, true, [&](const DatasetDifference& difference) {
                                all.push_back(difference);
                                return true;
                              }});
  return all;
}

}  // namespace zerocount::reading
