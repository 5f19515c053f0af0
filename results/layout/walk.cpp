#include "results/layout/walk.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "results/layout/table_io.hpp"

namespace zerocount {
namespace {

void read_whole(const hdf5::Dataset& dataset) {
  if (dataset.element() == Element::text) {
    dataset.read_texts();
    return;
  }
  const std::vector<hsize_t> extent = dataset.extent();
  if (extent.empty() || extent.size() > 2) dataset.fail("it should have one or two dimensions");
  const auto rows = static_cast<std::int64_t>(extent[0]);
  const std::int64_t width = extent.size() > 1 ? static_cast<std::int64_t>(extent[1]) : 1;
  const std::int64_t block = chunk_rows(std::max<std::int64_t>(1, width));
  std::vector<std::byte> bytes(static_cast<std::size_t>(std::min(block, rows) * width) *
                               size_of(dataset.element()));
  for (std::int64_t first = 0; first < rows; first += block) {
    dataset.read(first, std::min(block, rows - first), bytes.data());
  }
}

}  // namespace

void for_each_dataset(const hdf5::Group& group, const std::function<void(const hdf5::Dataset&)>& visit) {
  for (const std::string& name : group.children()) {
    if (group.is_group(name)) {
      for_each_dataset(group.open_group(name), visit);
    } else {
      visit(group.open_dataset(name));
    }
  }
}

void read_everything(const hdf5::Group& group) {
  for_each_dataset(group, read_whole);
}

}  // namespace zerocount
