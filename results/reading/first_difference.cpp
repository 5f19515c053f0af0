#include "results/reading/first_difference.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <fmt/format.h>

namespace zerocount::reading {
namespace {

/// Elements that are read at a time.
constexpr std::int64_t block_elements = 1 << 20;

std::optional<std::string> differs(const hdf5::Dataset& dataset, const std::string& how) {
  return fmt::format("{}: {}", dataset.path(), how);
}

std::optional<std::string> text_difference(const hdf5::Dataset& one, const hdf5::Dataset& other) {
  const std::vector<std::string> before = one.read_texts();
  const std::vector<std::string> after = other.read_texts();
  const auto place = std::mismatch(before.begin(), before.end(), after.begin(), after.end()).first;
  if (place == before.end() && before.size() == after.size()) return std::nullopt;
  return differs(one, fmt::format("differs from row {} on", place - before.begin()));
}

std::optional<std::string> number_difference(const hdf5::Dataset& one, const hdf5::Dataset& other) {
  const std::vector<hdf5::Size> extent = one.extent();
  if (extent.empty()) return differs(one, "has no rows");
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
    const auto place = std::mismatch(before.begin(), before.end(), after.begin()).first;
    if (place == before.end()) continue;
    const std::int64_t row = first + (place - before.begin()) / static_cast<std::int64_t>(width);
    return differs(one, fmt::format("differs from row {} on", row));
  }
  return std::nullopt;
}

std::optional<std::string> dataset_difference(const hdf5::Dataset& one, const hdf5::Dataset& other) {
  if (one.element() != other.element()) return differs(one, "has elements of another type");
  if (one.extent() != other.extent()) return differs(one, "has another size");
  return one.element() == hdf5::Element::text ? text_difference(one, other) : number_difference(one, other);
}

/// Statistics of the trials: what they are made of is looked at before them.
bool is_derived(const std::string& name) {
  return name == "point" || name == "level" || name == "repeatability";
}

}  // namespace

std::optional<std::string> first_difference(const hdf5::Group& one, const hdf5::Group& other) {
  std::vector<std::string> names = one.children();
  std::stable_partition(names.begin(), names.end(),
                        [](const std::string& name) { return !is_derived(name); });
  for (const std::string& name : names) {
    const std::string path = (one.path() == "/" ? "" : one.path()) + "/" + name;
    if (!other.contains(name)) return path + ": missing in one of the files";
    if (one.is_group(name) != other.is_group(name)) return path + ": a group in one of the files only";
    std::optional<std::string> difference =
        one.is_group(name) ? first_difference(one.open_group(name), other.open_group(name))
                           : dataset_difference(one.open_dataset(name), other.open_dataset(name));
    if (difference) return difference;
  }
  for (const std::string& name : other.children()) {
    if (!one.contains(name))
      return (one.path() == "/" ? "" : one.path()) + "/" + name + ": missing in one of the files";
  }
  return std::nullopt;
}

}  // namespace zerocount::reading
