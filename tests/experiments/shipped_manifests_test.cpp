#include "experiments/parameters/parameter_table.hpp"
#include "experiments/study/study_trial.hpp"
#include "tests/experiments/manifest_texts.hpp"

namespace zerocount {
namespace {

study::Study shipped(const std::string& name) {
  return manifest::load_study(std::filesystem::path(ZEROCOUNT_MANIFESTS) / (name + ".yaml"));
}

/// The folder with the manifests that the benchmarks time. They are beside the shipped manifests, not among
/// them, because nobody would start from them.
std::filesystem::path benchmark_folder() {
  return std::filesystem::path(ZEROCOUNT_MANIFESTS).parent_path();
}

study::Study benchmark_study(const std::string& name) {
  return manifest::load_study(benchmark_folder() / (name + ".yaml"));
}

void expect_understood(const std::filesystem::path& manifest) {
  const study::Study study = manifest::load_study(manifest);
  EXPECT_EQ(study.name, manifest.stem().string());
  EXPECT_TRUE(study.warnings.empty()) << manifest;
  EXPECT_FALSE(study.description.empty()) << manifest;
  EXPECT_EQ(study.manifest.text.rfind("# ", 0), 0u) << manifest << " is explained in its own comments";
}

TEST(ShippedManifests, AreReadWithoutWarningsAndNamedLikeTheirFiles) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(ZEROCOUNT_MANIFESTS)) {
    if (entry.path().extension() != ".yaml") continue;
    expect_understood(entry.path());
    ++count;
  }
  EXPECT_GE(count, 6);
}

TEST(ShippedManifests, BenchmarkManifestsAreReadWithoutWarnings) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(benchmark_folder())) {
    if (entry.path().extension() != ".yaml") continue;
    expect_understood(entry.path());
    names.insert(entry.path().stem().string());
  }
  EXPECT_EQ(names,
            (std::set<std::string>{"bench-creep", "bench-marginal", "bench-million", "bench-transient"}));
}

// Zero counts depend on them, so no study that one starts from leaves them out without a word.
TEST(ShippedManifests, StateNoiseDelayAndAmplifier) {
  using Unstated = std::vector<std::string_view>;
  for (const auto& entry : std::filesystem::directory_iterator(ZEROCOUNT_MANIFESTS)) {
    if (entry.path().extension() != ".yaml") continue;
    EXPECT_EQ(unstated_premises(manifest::load_study(entry.path())), Unstated{}) << entry.path();
  }
  EXPECT_EQ(unstated_premises(study_of(minimal_manifest())),
            (Unstated{"no encoder noise", "no delay", "ideal amplifier"}));
}

TEST(ShippedManifests, Figure7HasTheTenTargetsAnd300Samples) {
  const study::Study study = shipped("paper-fig7");
  ASSERT_EQ(study::point_count(study), 10);
  for (std::int64_t point = 0; point < 10; ++point) {
    const trial::TrialParameters p = study::study_trial(study, point, 0).parameters;
    EXPECT_EQ(p.command.targets, std::vector<std::int64_t>{point + 1});
    EXPECT_EQ(p.command.hold * p.controller.sample_rate, 300);
    EXPECT_EQ(p.controller.ki, 3.85e-5);
  }
}

TEST(ShippedManifests, Figure8HasThirtyCountsAnd15000Samples) {
  const study::Study study = shipped("paper-fig8");
  const trial::TrialParameters p = study::study_trial(study, 0, 0).parameters;
  EXPECT_EQ(p.command.targets, std::vector<std::int64_t>{30});
  EXPECT_EQ(p.command.hold * p.controller.sample_rate, 15000);
  EXPECT_FALSE(study.retained_trials.empty());
}

TEST(ShippedManifests, PaperGainsHasTheGainsAndObservationsOfThePaper) {
  const study::Study study = shipped("paper-gains");
  EXPECT_EQ(study.trials, 10000);
  EXPECT_EQ(study.machines, 10000);
  const std::vector<std::pair<double, double>> gains{
      {3.85e-5, 0}, {9.45e-5, 0}, {9.45e-5, 6.21e-4}, {2.08e-4, 0}};
  ASSERT_EQ(study.points.labels.size(), gains.size() + 1);
  for (std::size_t point = 0; point < gains.size(); ++point) {
    const trial::TrialParameters p =
        study::study_trial(study, static_cast<std::int64_t>(point), 0).parameters;
    EXPECT_EQ(std::pair(p.controller.ki, p.controller.kp), gains[point]);
  }
  EXPECT_GT(study::study_trial(study, 4, 0).parameters.controller.ki, 3.01e-4);
  for (const std::string& label : study.points.labels) EXPECT_EQ(study.observed.count(label), 1u) << label;
}

// Samples, gain and targets of the work that benchmarks time.
TEST(ShippedManifests, BenchmarksHaveTheStatedSamplesGainAndTargets) {
  struct Work {
    std::string name;
    std::int64_t samples;
    double ki;
    std::int64_t lowest_target;
    std::int64_t highest_target;
  };
  const std::vector<Work> works{{"bench-transient", 300, 3.85e-5, 1, 10},
                                {"bench-creep", 15000, 3.85e-5, 30, 30},
                                {"bench-marginal", 1500, 9.45e-5, 1, 30},
                                {"bench-million", 300, 3.85e-5, 1, 10}};
  for (const Work& work : works) {
    const study::Study study = benchmark_study(work.name);
    ASSERT_EQ(study::point_count(study), 1) << work.name;
    std::set<std::int64_t> targets;
    for (std::int64_t index = 0; index < 500; ++index) {
      const trial::TrialParameters p = study::study_trial(study, 0, index).parameters;
      EXPECT_EQ(trial::samples_of_trial(p), work.samples) << work.name;
      EXPECT_EQ(p.controller.ki, work.ki) << work.name;
      EXPECT_EQ(p.command.targets.size(), 1u) << work.name;
      targets.insert(p.command.targets.begin(), p.command.targets.end());
    }
    EXPECT_EQ(*targets.begin(), work.lowest_target) << work.name;
    EXPECT_EQ(*targets.rbegin(), work.highest_target) << work.name;
    EXPECT_EQ(static_cast<std::int64_t>(targets.size()), work.highest_target - work.lowest_target + 1);
  }
  EXPECT_EQ(benchmark_study("bench-million").trials, 1000000);
}

// What friction may be is not known of any trial, and no two are alike.
TEST(ShippedManifests, BenchmarksDrawAllFrictionParameters) {
  for (const std::string name : {"bench-transient", "bench-creep", "bench-marginal", "bench-million"}) {
    std::set<std::string> random;
    for (const study::InputColumn& column : benchmark_study(name).columns.inputs) random.insert(column.name);
    for (const std::string parameter : {"friction.k1", "friction.k2", "friction.beta", "friction.alpha",
                                        "friction.lambda", "initial.encoder_phase"}) {
      EXPECT_EQ(random.count(parameter), 1u) << name << ": " << parameter;
    }
  }
}

// A million of the very trials that bench-transient has.
TEST(ShippedManifests, BenchMillionHasTheTrialsOfBenchTransient) {
  const study::Study few = benchmark_study("bench-transient");
  const study::Study million = benchmark_study("bench-million");
  for (const std::int64_t index : {0, 1, 99999})
    EXPECT_EQ(study::study_trial(few, 0, index).inputs, study::study_trial(million, 0, index).inputs);
}

TEST(ShippedManifests, TheStabilityMapIsAGrid) {
  const study::Study study = shipped("stability-map");
  ASSERT_EQ(study.points.axes.size(), 2u);
  EXPECT_EQ(study.points.axes[0].name, "controller.kp");
  EXPECT_EQ(study.points.axes[1].name, "controller.ki");
}

// The pages of docs/manifest describe the language as it is.

struct Block {
  std::string language;
  std::string text;
};

/// The text of all documentation pages, the first one first.
std::string pages() {
  std::ostringstream text;
  for (const char* name : {"README", "controller-and-command", "random-numbers", "trials", "values"}) {
    std::ifstream file(fmt::format("{}/{}.md", ZEROCOUNT_MANIFEST_PAGES, name));
    EXPECT_TRUE(file) << name;
    text << file.rdbuf();
  }
  return text.str();
}

/// The fenced code blocks of the documentation pages, each with the word after the opening fence.
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

/// The manifest `part` from the documentation, with the required keys that it lacks.
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

/// The study of a manifest in the documentation pages, whose joint samples are the table there.
study::Study study_in_pages(const std::string& text) {
  const std::vector<Block> blocks = fenced_blocks();
  const auto table =
      std::find_if(blocks.begin(), blocks.end(), [](const Block& b) { return b.language == "csv"; });
  return manifest::parse_study(text, "m.yaml", {}, sections::known_external_inputs(nullptr, table->text));
}

TEST(ManifestPages, ManifestsInPagesAreReadWithoutWarnings) {
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
  EXPECT_EQ(parts, 19);
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

TEST(ManifestPages, ShowTheErrorsThatTheirBadManifestGives) {
  const std::vector<Block> blocks = fenced_blocks();
  const std::size_t bad = index_of_block(blocks, "# bad.yaml");
  ASSERT_LT(bad + 1, blocks.size());
  EXPECT_EQ(blocks[bad + 1].text,
            refusal_by([&] { manifest::parse_study(blocks[bad].text, "bad.yaml"); }) + "\n");
}

/// The source lines of the table rows with the Sobol dimensions from `first` on, in the order of the
/// dimensions, up to the first dimension without a row.
std::string lines_in_order_of_dimension(std::size_t first) {
  std::map<std::size_t, std::string_view> names;
  for (const parameters::Parameter& parameter : parameters::parameter_table()) {
    if (parameters::has_value(parameter)) names[parameter.sobol_dimension] = parameter.name;
  }
  std::string listed;
  for (std::size_t i = first; names.count(i) > 0; ++i) listed += fmt::format("\n{} {}", i, names[i]);
  return listed;
}

TEST(ManifestPages, NameTheSobolDimensionsInOrder) {
  std::ifstream file(ZEROCOUNT_MANIFEST_PAGES "/sobol-dimensions.txt");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  for (const std::size_t first : {std::size_t{0}, parameters::first_sobol_dimension_beyond_moves}) {
    const std::string listed = lines_in_order_of_dimension(first);
    EXPECT_TRUE(says(text, listed + "\n")) << listed;
  }
}

}  // namespace
}  // namespace zerocount
