// What parts the study of a file from another: whatever decides which trial is which.
#include "results/layout/recorded_values.hpp"

#include "core/failure/failure.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/manifest_text/overrides.hpp"
#include "experiments/manifests/shipped_manifests.hpp"
#include "experiments/yaml/yaml_tree.hpp"
#include "results/layout/header.hpp"
#include "tests/support/says.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

/// Everything whose order numbers results.
constexpr std::string_view with_every_order =
    "zerocount: 1\nname: ordered\nseed: 1\nrigs: 2\ntrials: 12\n"
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

/// Overrides that write each map of `maps` that the manifest has in another order of its keys; empty where it
/// has none with two keys.
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

TEST(StudyDifferences, NameEveryOrderWhateverElseDiffers) {
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

TEST(StudyDifferences, RefuseShardsAndPartsAsTheyRefuseExtensions) {
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
      EXPECT_NE(std::string_view(foreign.what()).find("of another study: "), std::string_view::npos);
      EXPECT_NE(std::string_view(foreign.what()).find(differences(study, other)), std::string_view::npos)
          << foreign.what();
    }
  }
}

}  // namespace
}  // namespace zerocount::testing
