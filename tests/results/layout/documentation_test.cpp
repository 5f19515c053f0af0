#include "tests/results/samples.hpp"
#include "tests/results/walk.hpp"
#include "tests/support/raw_hdf5.hpp"
#include "tests/support/says.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

using Rows = std::vector<std::vector<std::string>>;

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" `");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" `") - first + 1);
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream text(line.substr(1));
  for (std::string cell; std::getline(text, cell, '|');) cells.push_back(trimmed(cell));
  return cells;
}

/// The cells of the tables in datasets.md whose head begins with `head`. Where a table has no column of
/// dimensions, they are those in the brackets of its heading.
Rows documented(const std::string& head) {
  std::istringstream text(read_bytes(ZEROCOUNT_FORMAT_DOCUMENTATION));
  Rows rows;
  bool inside = false;
  bool has_dimensions = false;
  std::string heading;
  for (std::string line; std::getline(text, line);) {
    if (line.starts_with("#")) heading = line;
    if (line.starts_with(fmt::format("| {} |", head))) {
      inside = true;
      has_dimensions = head != "path" || cells_of(line)[2] == "dimensions";
    } else if (!line.starts_with("|")) {
      inside = false;
    } else if (inside && !line.starts_with("| ---")) {
      rows.push_back(cells_of(line));
      if (has_dimensions) continue;
      const std::size_t bracket = heading.find('[') + 1;
      rows.back().insert(rows.back().begin() + 2, heading.substr(bracket, heading.find(']') - bracket));
    }
  }
  return rows;
}

/// Whether core/trial/measures.md defines the measure with this path.
bool is_defined_elsewhere(const std::string& path) {
  static const std::string definitions = read_bytes(ZEROCOUNT_MEASURE_DEFINITIONS);
  return definitions.find(fmt::format("`{}`", path.substr(path.rfind('/') + 1))) != std::string::npos;
}

/// True where `path` is `described`, in which the step `<word>` stands for any name.
bool fits(const std::string& path, const std::string& described) {
  std::istringstream path_steps(path);
  std::istringstream described_steps(described);
  std::string step;
  std::string expected;
  while (std::getline(described_steps, expected, '/')) {
    if (!std::getline(path_steps, step, '/')) return false;
    if (!expected.starts_with('<') && step != expected) return false;
  }
  return !std::getline(path_steps, step, '/');
}

std::string type_name(hdf5::Element element) {
  const std::map<hdf5::Element, std::string> names{
      {hdf5::Element::float64, "float64"}, {hdf5::Element::int64, "int64"}, {hdf5::Element::int32, "int32"},
      {hdf5::Element::int8, "int8"},       {hdf5::Element::flag, "uint8"},  {hdf5::Element::text, "string"}};
  return names.at(element);
}

std::ptrdiff_t dimensions_of(const std::vector<std::string>& row) {
  return row[2].empty() ? 0 : 1 + std::count(row[2].begin(), row[2].end(), ',');
}

/// The row for a dataset: the one with its path, or else the first whose pattern fits its path and role, and
/// whose dimensions are as many.
std::optional<std::size_t> find_row(const Rows& rows, const hdf5::Dataset& dataset) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i][0] == dataset.path()) return i;
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!fits(dataset.path(), rows[i][0])) continue;
    if (dimensions_of(rows[i]) != std::ssize(dataset.extent())) continue;
    if (dataset.has_attribute("role") &&
        rows[i][0].find(fmt::format("<{}>", dataset.text("role"))) == std::string::npos) {
      continue;
    }
    return i;
  }
  return std::nullopt;
}

TEST(Documentation, DescribesEveryDatasetOfAFileAndNoOther) {
  const TemporaryFolder directory;
  const TemporaryFolder directory_with_rigs;
  const TemporaryFolder directory_with_companions;
  const TemporaryFolder directory_with_worlds;
  study::Study with_companions = sample_study();
  with_companions.features.own_controller = true;
  with_companions.plugin = std::make_shared<const plugin::ControllerPlugin>(
      plugin::ControllerPlugin{{"own", "1", "0123", {{"gain", "1", "a gain", 1.0, 0.0, 2.0}}}});
  with_companions.samples = study::JointSamples{
      .file = "posterior.csv", .text = "friction.k1\n110\n", .parameters = {"friction.k1"}, .rows = 1};
  const Rows rows = documented("path");
  ASSERT_GT(rows.size(), 40U);
  std::set<std::size_t> used;
  const auto look_up = [&](const hdf5::Dataset& dataset) {
    const std::optional<std::size_t> found = find_row(rows, dataset);
    ASSERT_TRUE(found) << dataset.path() << " is not described";
    used.insert(*found);
    const std::vector<std::string>& row = rows[*found];
    EXPECT_TRUE(says(row[1], type_name(dataset.element()))) << dataset.path();
    EXPECT_EQ(std::ssize(dataset.extent()), dimensions_of(row)) << dataset.path();
    EXPECT_TRUE(row[3] == "own" || row[3] == dataset.text("units")) << dataset.path();
    if (row[4].empty()) {
      EXPECT_TRUE(is_defined_elsewhere(dataset.path())) << dataset.path();
    } else if (row[0].find('<') == std::string::npos) {
      EXPECT_TRUE(row[4].starts_with(dataset.text("long_name")))
          << dataset.path() << ": " << dataset.text("long_name");
    }
    if (dataset.has_attribute("flag_values") && dataset.element() == hdf5::Element::int8) {
      std::istringstream words(dataset.text("flag_meanings"));
      for (std::string word; words >> word;) EXPECT_TRUE(says(row[4], word)) << dataset.path();
    }
  };
  for_each_dataset(write_sample_file(directory.path(), sample_study()), look_up);
  for_each_dataset(write_sample_file(directory_with_rigs.path(), sample_study_with_rigs()), look_up);
  for_each_dataset(write_sample_file(directory_with_companions.path(), with_companions), look_up);
  study::Study in_worlds = sample_study_in_worlds();
  in_worlds.conditions = in_worlds.condition_names = {"empty", "loaded"};
  in_worlds.ages.at = {0.0, 1.0};
  in_worlds.rigs = 10;
  in_worlds.features.position_error = true;
  in_worlds.features.tolerances = {{1.0e-6}, 1};
  for_each_dataset(write_file_in_worlds(directory_with_worlds.path(), in_worlds), look_up);
  for (std::size_t i = 0; i < rows.size(); ++i)
    EXPECT_TRUE(used.contains(i)) << rows[i][0] << " is in no file";
}

TEST(Documentation, DescribesEveryAttributeOfTheRootAndNoOther) {
  const TemporaryFolder directory;
  const std::filesystem::path file = write_sample_file(directory.path(), sample_study());
  std::set<std::string> described;
  for (const std::vector<std::string>& row : documented("attribute")) described.insert(row[0]);
  EXPECT_EQ(described, attribute_names(file));
}

}  // namespace
}  // namespace zerocount::testing
