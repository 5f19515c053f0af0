#include "tests/results/walk.hpp"

#include "results/layout/table_io.hpp"
#include "results/reading/all_trials_file.hpp"
#include "tests/support/raw_hdf5.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

void read_whole(const hdf5::Dataset& dataset) {
  if (dataset.element() == hdf5::Element::text) {
    dataset.read_texts();
    return;
  }
  const std::vector<hdf5::Size> extent = dataset.extent();
  if (extent.empty() || extent.size() > 3) dataset.fail("it should have one to three dimensions");
  const auto rows = static_cast<std::int64_t>(extent[0]);
  std::int64_t width = 1;
  for (std::size_t inner = 1; inner < extent.size(); ++inner)
    width *= static_cast<std::int64_t>(extent[inner]);
  std::vector<std::byte> bytes(static_cast<std::size_t>(rows * width) * hdf5::size_of(dataset.element()));
  dataset.read(0, rows, bytes.data());
}

std::vector<std::int64_t> numbers_of(const hdf5::File& file, const char* group, const char* dataset) {
  const hdf5::Dataset numbers = file.open_group(group).open_dataset(dataset);
  std::vector<std::int64_t> values(numbers.extent().at(0));
  numbers.read(0, std::ssize(values), values.data());
  return values;
}

}  // namespace

void for_each_dataset(const std::filesystem::path& path,
                      const std::function<void(const hdf5::Dataset&)>& visit) {
  const std::map<std::string, std::string> datasets = stored_datasets(path);
  const hdf5::File file = layout::open_results(path);
  for (const auto& [name, bytes] : datasets) visit(file.open_dataset(name.substr(1)));
}

void read_everything(const std::filesystem::path& path) {
  const reading::AllTrialsFile checked(path, reading::Require::any_part);
  for_each_dataset(path, read_whole);
}

void expect_sound(const std::filesystem::path& path) {
  ASSERT_NO_THROW(read_everything(path));
  const hdf5::File file = layout::open_results(path);
  const layout::FileHeader header = layout::read_header(file);
  std::vector<std::int64_t> rows, points, indices;
  for (std::int64_t row = header.rows.first; row < header.rows.end(); ++row) {
    rows.push_back(row);
    points.push_back(row / header.trials);
    indices.push_back(row % header.trials);
  }
  EXPECT_EQ(numbers_of(file, "trial", "trial"), rows);
  EXPECT_EQ(numbers_of(file, "trial", "point"), points);
  EXPECT_EQ(numbers_of(file, "trial", "index"), indices);
  EXPECT_EQ(numbers_of(file, "outcome", "trial"), rows);
  const std::vector<std::int64_t> jerks = numbers_of(file, "jerk", "trial");
  EXPECT_TRUE(std::is_sorted(jerks.begin(), jerks.end()));
  if (!jerks.empty()) {
    EXPECT_GE(jerks.front(), header.rows.first);
    EXPECT_LT(jerks.back(), header.rows.end());
  }
}

}  // namespace zerocount::testing
