#include "core/failure/failure.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/manifest_text/manifest_text.hpp"
#include "experiments/manifests/shipped_manifests.hpp"
#include "experiments/yaml/yaml_tree.hpp"
#include "results/layout/header.hpp"
#include "results/layout/recorded_values.hpp"
#include "tests/results/samples.hpp"
#include "tests/results/walk.hpp"
#include "tests/support/raw_hdf5.hpp"
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

/// The cells of the tables in datasets.md whose table head begins with `head`.
Rows documented(const std::string& head) {
  std::istringstream text(read_bytes(ZEROCOUNT_FORMAT_DOCUMENTATION));
  Rows rows;
  bool inside = false;
  for (std::string line; std::getline(text, line);) {
    if (line.starts_with(fmt::format("| {} |", head))) {
      inside = true;
    } else if (!line.starts_with("|")) {
      inside = false;
    } else if (inside && !line.starts_with("| ---")) {
      rows.push_back(cells_of(line));
    }
  }
  return rows;
}

/// Paths of the groups, and of the datasets of the root group, that the documentation's table of groups
/// lists.
std::set<std::string> documented_groups() {
  std::set<std::string> groups;
  for (const std::vector<std::string>& row : documented("group")) {
    std::istringstream names(row[0]);
    for (std::string name; std::getline(names, name, ',');) groups.insert(trimmed(name));
  }
  return groups;
}

/// Whether core/trial/measures.md defines the measure with this path.
bool is_defined_elsewhere(const std::string& path) {
  static const std::string definitions = read_bytes(ZEROCOUNT_MEASURE_DEFINITIONS);
  return definitions.find(fmt::format("`{}`", path.substr(path.rfind('/') + 1))) != std::string::npos;
}

std::string type_name(hdf5::Element element) {
  const std::map<hdf5::Element, std::string> names{
      {hdf5::Element::float64, "float64"}, {hdf5::Element::int64, "int64"}, {hdf5::Element::int32, "int32"},
      {hdf5::Element::int8, "int8"},       {hdf5::Element::flag, "uint8"},  {hdf5::Element::text, "string"}};
  return names.at(element);
}

TEST(Documentation, DescribesExactlyTheGroupsAndMeasuresOfAFile) {
  const TemporaryFolder directory;
  const TemporaryFolder directory_with_machines;
  const TemporaryFolder directory_with_external_inputs;
  const TemporaryFolder directory_with_worlds;
  study::Study with_external_inputs = sample_study();
  with_external_inputs.features.own_controller = true;
  with_external_inputs.plugin = std::make_shared<const plugin::ControllerPlugin>(
      plugin::ControllerPlugin{{"own", "1", "0123", {{"gain", "1", "a gain", 1.0, 0.0, 2.0}}}});
  with_external_inputs.samples = study::JointSamples{
      .file = "posterior.csv", .text = "friction.k1\n110\n", .parameters = {"friction.k1"}, .rows = 1};
  std::map<std::string, std::vector<std::string>> measures;
  for (const std::vector<std::string>& row : documented("path")) measures.emplace(row[0], row);
  ASSERT_GT(measures.size(), 40U);
  std::set<std::string> found_groups;
  std::set<std::string> found_measures;
  const auto look_up = [&](const hdf5::Dataset& dataset) {
    const std::string& path = dataset.path();
    EXPECT_NE(dataset.text("units"), "") << path;
    EXPECT_NE(dataset.text("long_name"), "") << path;
    found_groups.insert(path.substr(0, path.find('/', 1)));
    if (!path.starts_with("/outcome/")) return;
    found_measures.insert(path);
    ASSERT_TRUE(measures.contains(path)) << path << " is not described";
    const std::vector<std::string>& row = measures.at(path);
    EXPECT_EQ(row[1], type_name(dataset.element())) << path;
    EXPECT_EQ(row[2], dataset.text("units")) << path;
    if (row[3].empty()) {
      EXPECT_TRUE(is_defined_elsewhere(path)) << path;
    } else {
      EXPECT_TRUE(row[3].starts_with(dataset.text("long_name"))) << path << ": " << dataset.text("long_name");
    }
    if (dataset.has_attribute("flag_values") && dataset.element() == hdf5::Element::int8) {
      std::istringstream words(dataset.text("flag_meanings"));
      for (std::string word; words >> word;) EXPECT_TRUE(says(row[3], word)) << path;
    }
  };
  for_each_dataset(write_sample_file(directory.path(), sample_study()), look_up);
  for_each_dataset(write_sample_file(directory_with_machines.path(), sample_study_with_machines()), look_up);
  for_each_dataset(write_sample_file(directory_with_external_inputs.path(), with_external_inputs), look_up);
  study::Study in_worlds = sample_study_in_worlds();
  in_worlds.settings.conditions = {"empty", "loaded"};
  in_worlds.settings.ages.at = {0.0, 1.0};
  in_worlds.machines = 10;
  in_worlds.features.position_error = true;
  in_worlds.features.tolerances = {{1.0e-6}, 1};
  for_each_dataset(write_file_in_worlds(directory_with_worlds.path(), in_worlds), look_up);
  for (const auto& [path, row] : measures)
    EXPECT_TRUE(found_measures.contains(path)) << path << " is in no file";
  EXPECT_EQ(found_groups, documented_groups());
}

TEST(Documentation, DescribesExactlyTheAttributesOfTheRoot) {
  const TemporaryFolder directory;
  const std::filesystem::path file = write_sample_file(directory.path(), sample_study());
  std::set<std::string> described;
  for (const std::vector<std::string>& row : documented("attribute")) described.insert(row[0]);
  EXPECT_EQ(described, attribute_names(file));
}

// What parts the study of a file from another: whatever decides which trial is which.

/// A manifest that has every map whose order of keys numbers results.
constexpr std::string_view with_every_order =
    "zerocount: 1\nname: ordered\nseed: 1\nmachines: 2\ntrials: 12\n"
    "plant: {inertia: 8.0e-4}\ncontroller: {ki: 1.0e-5}\ncommand: {targets: [7, 0], hold: 0.3}\n"
    "conditions: {empty: {}, loaded: {plant.inertia: 9.0e-4}, heavy: {plant.inertia: 1.0e-3}}\n"
    "goals: {first: {band: 1, within: 0.1, moves: 0.9, on: [0]}, second: {band: 0, within: 0.1, moves: 0.9},"
    " third: {band: 2, within: 0.2, moves: 0.9}}\n"
    "tune: {free: {controller.ki: [1.0e-6, 1.0e-4], controller.kp: [0, 1.0e-3]}}\n"
    "sweep:\n  cases: {a: {friction.alpha: 1}, b: {friction.alpha: 2}, c: {friction.alpha: 3}}\n"
    "  grid: {friction.k1: [90, 110], friction.k2: [600, 700], dac.bits: [14, 16]}\n";

constexpr std::array<std::string_view, 5> ordered{"sweep.grid", "sweep.cases", "conditions", "goals",
                                                  "tune.free"};

study::Study study_of(const std::string& text, const std::vector<std::string>& overrides) {
  return manifest::parse_study(text, "m.yaml", overrides);
}

/// Overrides that write each map of `maps` in the manifest with its keys in another order. Empty if no such
/// map has two keys.
std::vector<std::string> shuffled(const std::string& text, const std::vector<std::string_view>& maps,
                                  std::mt19937& random) {
  yaml::Problems problems;
  const yaml::YamlPointer root = yaml::parse_yaml(text, "m.yaml", false, problems);
  std::vector<std::string> overrides;
  for (const std::string_view path : maps) {
    const yaml::YamlNode* const node = manifest_text::node_at(*root, path);
    if (node == nullptr || node->entries.size() < 2) continue;
    yaml::YamlNode other = *node;
    const auto same_order = [&] {
      return std::ranges::equal(other.entries, node->entries, {}, &yaml::YamlEntry::key,
                                &yaml::YamlEntry::key);
    };
    while (same_order()) std::ranges::shuffle(other.entries, random);
    overrides.push_back(fmt::format("{}={}", path, yaml::flow_text(other)));
  }
  return overrides;
}

layout::FileHeader header_of(const study::Study& study) {
  return layout::make_header(study, layout::FileKind::study, layout::all_rows(study), {});
}

std::string differences(const study::Study& there, const study::Study& here) {
  return manifest_text::differences_text(layout::study_differences("out.h5", header_of(there), here));
}

std::vector<std::string> manifests() {
  std::vector<std::string> all{std::string(with_every_order)};
  for (const text::EmbeddedFile& one : manifests::shipped_manifests()) all.emplace_back(one.bytes);
  return all;
}

TEST(StudyDifferences, NameADifferentOrderBesideOtherDifferences) {
  std::mt19937 random(81);
  int tried = 0;
  for (const std::string& text : manifests()) {
    const study::Study study = study_of(text, {});
    SCOPED_TRACE(study.name);
    const std::string more = fmt::format("trials={}", 2 * study.trials);
    EXPECT_EQ(differences(study, study_of(text, {})), "");
    EXPECT_EQ(differences(study, study_of(text, {more})),
              fmt::format("trials is {} there and {} here", study.trials, 2 * study.trials));
    for (const std::string_view map : ordered) {
      std::vector<std::string> overrides = shuffled(text, {map}, random);
      // Of observations at points, the order of the grid is a part of the names.
      if (overrides.empty() || (map == "sweep.grid" && !study.observed.empty())) continue;
      ++tried;
      for (const bool extended : {false, true}) {
        if (extended) overrides.push_back(more);
        const std::string found = differences(study, study_of(text, overrides));
        EXPECT_TRUE(says(found, fmt::format("{}, order of keys is ", map)));
        EXPECT_EQ(found.find("trials is ") != std::string::npos, extended) << found;
      }
    }
  }
  EXPECT_GE(tried, 5 + 20);
}

TEST(StudyDifferences, AreGivenForShardsPartsAndExtensionsAlike) {
  std::mt19937 random(82);
  const std::string text(with_every_order);
  const study::Study study = study_of(text, {});
  const layout::FileHeader header = layout::make_header(
      study, layout::FileKind::shard, layout::all_rows(study), layout::current_provenance());
  layout::require_same_study("shard.h5", header, study);
  for (const std::string_view map : ordered) {
    const study::Study other = study_of(text, shuffled(text, {map}, random));
    try {
      layout::require_same_study("shard.h5", header, other);
      ADD_FAILURE() << map;
    } catch (const layout::ForeignFile& foreign) {
      EXPECT_TRUE(says(std::string_view(foreign.what()), "is from another study: "));
      EXPECT_TRUE(says(std::string_view(foreign.what()), differences(study, other))) << foreign.what();
    }
  }
}

}  // namespace
}  // namespace zerocount::testing
