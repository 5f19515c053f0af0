// The pages of docs/manifest describe the language as it is.
#include "core/failure/failure.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "tests/experiments/manifest_texts.hpp"
#include "tests/support/test.hpp"

namespace zerocount {
namespace {

struct Block {
  std::string language;
  std::string text;
};

/// All pages, the first one first.
std::string pages() {
  std::ostringstream text;
  for (const char* name : {"README", "controller-and-command", "random-numbers", "trials", "values"}) {
    std::ifstream file(fmt::format("{}/{}.md", ZEROCOUNT_MANIFEST_PAGES, name));
    EXPECT_TRUE(file) << name;
    text << file.rdbuf();
  }
  return text.str();
}

/// What stands between fences, with the word behind the opening fence.
std::vector<Block> fenced_blocks() {
  std::vector<Block> blocks;
  std::istringstream text(pages());
  bool inside = false;
  for (std::string line; std::getline(text, line);) {
    if (line.rfind("```", 0) != 0) {
      if (inside) blocks.back().text += line + "\n";
      continue;
    }
    if (!inside) blocks.push_back({line.substr(3), ""});
    inside = !inside;
  }
  return blocks;
}

bool starts_with(const std::string& text, std::string_view start) {
  return text.rfind(start, 0) == 0;
}

/// A manifest with the required keys that `part` lacks.
std::string completed(const std::string& part) {
  std::string manifest;
  std::istringstream required(minimal_manifest());
  for (std::string line; std::getline(required, line);) {
    const std::string key = line.substr(0, line.find(':') + 1);
    if (("\n" + part).find("\n" + key) == std::string::npos) manifest += line + "\n";
  }
  return manifest + part;
}

std::size_t index_of_block(const std::vector<Block>& blocks, std::string_view start) {
  const auto found =
      std::find_if(blocks.begin(), blocks.end(), [&](const Block& b) { return starts_with(b.text, start); });
  return static_cast<std::size_t>(found - blocks.begin());
}

/// The study of a manifest in the pages, whose samples are the table in it.
study::Study study_in_pages(const std::string& text) {
  const std::vector<Block> blocks = fenced_blocks();
  const auto table =
      std::find_if(blocks.begin(), blocks.end(), [](const Block& b) { return b.language == "csv"; });
  return manifest::parse_study(text, "m.yaml", {}, sections::known_companions(nullptr, table->text));
}

TEST(ManifestPages, TheirManifestsAreUnderstoodWithoutWarnings) {
  int whole = 0;
  int parts = 0;
  for (const Block& block : fenced_blocks()) {
    if (block.language != "yaml" || starts_with(block.text, "# bad.yaml")) continue;
    const bool is_whole = starts_with(block.text, "zerocount:");
    ++(is_whole ? whole : parts);
    EXPECT_NO_THROW(EXPECT_EQ(study_in_pages(is_whole ? block.text : completed(block.text)).warnings,
                              std::vector<std::string>{}))
        << block.text;
  }
  EXPECT_EQ(whole, 1);
  EXPECT_EQ(parts, 20);
}

TEST(ManifestPages, TheFirstManifestUsesEverySection) {
  const study::Study study = study_of(fenced_blocks().front().text);
  EXPECT_EQ(study::point_count(study), 6);
  EXPECT_EQ(study.moves, 2);
  EXPECT_EQ(study.profiles.size(), 1u);
  EXPECT_EQ(study.retained_trials.size(), 2u);
  EXPECT_EQ(study.observed.size(), 3u);
}

TEST(ManifestPages, ListThePointsOfTheirSweepInOrder) {
  const std::vector<Block> blocks = fenced_blocks();
  const std::size_t sweep = index_of_block(blocks, "sweep:");
  ASSERT_LT(sweep + 1, blocks.size());
  std::string listed;
  for (const std::string& label : study_of(completed(blocks[sweep].text)).points.labels)
    listed += label + "\n";
  EXPECT_EQ(blocks[sweep + 1].text, listed);
}

TEST(ManifestPages, ShowTheErrorsOfTheirBadManifest) {
  const std::vector<Block> blocks = fenced_blocks();
  const std::size_t bad = index_of_block(blocks, "# bad.yaml");
  ASSERT_LT(bad + 1, blocks.size());
  std::string message;
  try {
    manifest::parse_study(blocks[bad].text, "bad.yaml");
  } catch (const Failure& failure) {
    message = failure.what();
  }
  EXPECT_EQ(blocks[bad + 1].text, message + "\n");
}

/// The names of the rows with the Sobol dimensions from `first` on, in their order, as far as there are any.
std::string names_in_order_of_dimension(std::size_t first) {
  std::map<std::size_t, std::string_view> names;
  for (const parameters::Parameter& parameter : parameters::parameter_table()) {
    if (parameters::has_value(parameter)) names[parameter.sobol_dimension] = parameter.name;
  }
  std::string listed;
  for (std::size_t i = first; names.count(i) > 0; ++i)
    listed += fmt::format("{}`{}`", i == first ? "" : ", ", names[i]);
  return listed;
}

TEST(ManifestPages, NameTheSobolDimensionsInOrder) {
  std::string text = pages();
  std::replace(text.begin(), text.end(), '\n', ' ');
  for (const std::size_t first : {std::size_t{0}, parameters::first_sobol_dimension_beyond_moves}) {
    const std::string listed = names_in_order_of_dimension(first);
    EXPECT_TRUE(says(text, listed + ".")) << listed;
  }
}

}  // namespace
}  // namespace zerocount
