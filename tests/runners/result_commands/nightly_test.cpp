// The nightly job, run as it is on studies of a few trials.
#include "analysis/pairs/comparison/comparison.hpp"
#include "analysis/pairs/comparison/point_judgements.hpp"
#include "analysis/pairs/comparison/point_trials.hpp"
#include "experiments/manifest/load_study.hpp"
#include "runners/trials/trial_runner.hpp"
#include "tests/runners/program.hpp"

namespace zerocount::testing {
namespace {

class Nightly : public ::testing::Test {
 protected:
  Nightly() {
    folder_.write("small.yaml", small_manifest(30));
    folder_.write("studies.txt",
                  "# name manifest settings\nsmall small.yaml trials=20\n\nother small.yaml seed=7\n");
  }

  /// Runs a script of the nightly job, stores its output in `said_`, and returns its exit code.
  int script(const std::string& name, const std::string& more = "") {
    const std::string command = fmt::format(
        "{}/{} --root {} --program {} --studies {} --baselines {} {} > {} 2>&1", ZEROCOUNT_NIGHTLY, name,
        folder_.path().string(), ZEROCOUNT_PROGRAM, (folder_ / "studies.txt").string(),
        (folder_ / "baselines").string(), more, (folder_ / "said").string());
    const int status = std::system(command.c_str());
    said_ = folder_.read("said");
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  int night() { return script("nightly", "--out " + (folder_ / "out").string()); }

  std::filesystem::path last_night() const {
    std::filesystem::path last;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "out")) {
      if (entry.is_directory()) last = std::max(last, entry.path());
    }
    return last;
  }

  TemporaryFolder folder_;
  std::string said_;
};

TEST_F(Nightly, PassesIfTheBaselinesAreFromTheSameProgram) {
  ASSERT_EQ(script("make-baselines", "--reason 'the first ones'"), 0) << said_;
  EXPECT_TRUE(says(folder_.read("baselines/small.h5.log.yaml"), "the first ones", "[\"trials=20\"]"));
  ASSERT_EQ(night(), 0) << said_;
  EXPECT_TRUE(says(said_, "small: passed: every dataset is equal to the bit"));
  for (const char* name :
       {"small.h5", "small.json", "small.xml", "small.md", "small.txt", "other.xml", "summary.md"}) {
    EXPECT_TRUE(std::filesystem::exists(last_night() / name)) << name;
  }
}

TEST_F(Nightly, FindsTheRegression) {
  ASSERT_EQ(script("make-baselines", "--reason first"), 0) << said_;
  folder_.write("small.yaml", small_manifest(200));
  folder_.write("studies.txt", "small small.yaml\n");
  ASSERT_EQ(script("make-baselines", "--reason 'more trials'"), 0) << said_;
  std::string slower = small_manifest(200);
  slower.replace(slower.find("3.85e-5"), 7, "1.50e-4");
  folder_.write("small.yaml", slower);
  EXPECT_EQ(night(), 1) << said_;
  EXPECT_TRUE(says(read_bytes(last_night() / "summary.md"), "regression"));
}

TEST_F(Nightly, AddsItsResultsToTheHistory) {
  ASSERT_EQ(script("make-baselines", "--reason first"), 0) << said_;
  ASSERT_EQ(night(), 0) << said_;
  EXPECT_TRUE(says(said_, "history: No change is significant."));
  EXPECT_TRUE(says(read_bytes(last_night() / "summary.md"), "## History"));
  const auto runs = [&](const std::string& database) {
    const ProgramResult shown =
        zerocount_program({"history", "show", "--database", database, "--study", "small", "--point", "low",
                           "--measure", "success_rate", "--format", "csv"},
                          folder_.path());
    EXPECT_EQ(shown.code, 0) << shown.err;
    return std::count(shown.out.begin(), shown.out.end(), '\n') - 1;
  };
  EXPECT_EQ(runs("out/history.sqlite"), 2) << "the two studies, of one name and two seeds, are two series";
  const std::string page = read_bytes(last_night() / "small.html");
  EXPECT_TRUE(page.empty() || page.find("Over time") != std::string::npos);
  const std::string index = page.empty() ? "" : read_bytes(last_night() / "index.html");
  EXPECT_TRUE(page.empty() || index.find("href=\"./small.html\"") != std::string::npos);
  folder_.write("studies.txt", "small small.yaml trials=20\n");
  ASSERT_EQ(
      script("nightly", fmt::format("--out {0}/other --history {0}/mine.sqlite", folder_.path().string())), 0)
      << said_;
  EXPECT_EQ(runs("mine.sqlite"), 1);
  ASSERT_EQ(script("nightly", fmt::format("--out {}/none --history none", folder_.path().string())), 0)
      << said_;
  EXPECT_FALSE(says(said_, "history"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "none/history.sqlite"));
}

// With the margins of the repository: every change fails, whichever way it goes.
TEST_F(Nightly, ReportsImprovementsToo) {
  std::string slower = small_manifest(200);
  slower.replace(slower.find("3.85e-5"), 7, "1.50e-4");
  folder_.write("small.yaml", slower);
  folder_.write("studies.txt", "small small.yaml\n");
  ASSERT_EQ(script("make-baselines", "--reason first"), 0) << said_;
  folder_.write("small.yaml", small_manifest(200));
  EXPECT_EQ(night(), 1) << said_;
  EXPECT_TRUE(says(read_bytes(last_night() / "summary.md"), "| better |"));
}

TEST_F(Nightly, NeverPassesWithoutABaselineOrAStudy) {
  EXPECT_EQ(night(), 4) << said_;
  EXPECT_TRUE(says(said_, "there is no baseline"));
  folder_.write("studies.txt", "# none\n");
  EXPECT_EQ(night(), 3) << said_;
  EXPECT_EQ(script("nightly", "--whatever"), 2);
}

TEST_F(Nightly, RunsTheLastStudyOfAListWithoutALineBreakAtItsEnd) {
  folder_.write("studies.txt", "small small.yaml trials=20\nother small.yaml seed=7");
  ASSERT_EQ(script("make-baselines", "--reason first"), 0) << said_;
  EXPECT_EQ(night(), 0) << said_;
  EXPECT_TRUE(says(said_, "other: passed", "2 studies"));
}

TEST_F(Nightly, ContinuesAfterAStudyThatFails) {
  ASSERT_EQ(script("make-baselines", "--reason first"), 0) << said_;
  folder_.write("studies.txt", "small none.yaml\nother small.yaml seed=7\n");
  EXPECT_EQ(night(), 2) << said_;
  EXPECT_TRUE(says(said_, "other: passed"));
}

// Real changes of the machine, run and compared: does the gate see them?
//
// The study has a gain at criterion (6), one beyond it, and one with a proportional part. Of each change 300
// trials a point are enough on equal draws.

constexpr std::int64_t trials = 300;
constexpr const char* manifest = R"(
zerocount: 1
name: gate-power
seed: 1
trials: 300
friction:
  k1: {truncated_normal: {mean: 110, sd: 15, low: 90, high: 130}}
  k2: {truncated_normal: {mean: 750, sd: 110, low: 600, high: 900}}
command: {targets: [{integers: [1, 30]}], hold: 0.5}
initial: {encoder_phase: {uniform: [0, 1]}}
sweep:
  cases:
    a: {controller.ki: 3.85e-5}
    between: {controller.ki: 6.5e-5}
    with-kp: {controller.ki: 9.45e-5, controller.kp: 6.21e-4}
)";

/// [design point] the trials of a run with these settings.
std::vector<comparison::PointTrials> trials_of(const std::vector<std::string>& settings) {
  const study::Study study = manifest::parse_study(manifest, "power.yaml", settings);
  std::vector<comparison::PointTrials> points;
  for (std::int64_t point = 0; point < study::point_count(study); ++point) {
    std::vector<trial::MoveOutcome> outcomes;
    for (const shards::TrialResult& result : trials::TrialRunner(study).run({point * trials, trials}))
      outcomes.push_back(result.outcome.moves.front());
    points.push_back(comparison::gather_trials(outcomes, 1));
  }
  return points;
}

comparison::GateRules every_change_fails() {
  comparison::GateRules rules;
  rules.changed_fails = true;
  return rules;
}

comparison::GateVerdict verdict_on(const std::vector<std::string>& change, const std::string& seed,
                                   const comparison::GateRules& rules) {
  const std::string seeded = "seed=" + seed;
  std::vector<std::string> settings = change;
  settings.push_back(seeded);
  const std::vector<comparison::PointTrials> before = trials_of({seeded});
  const std::vector<comparison::PointTrials> after = trials_of(settings);
  std::vector<comparison::PointComparison> points(before.size());
  for (std::size_t point = 0; point < points.size(); ++point) {
    points[point].baseline_trials = points[point].current_trials = trials;
    points[point].judgements = comparison::compare_measures(rules, "", {before[point], after[point], true});
  }
  comparison::decide(comparison::judgements_of(points), rules);
  std::vector<comparison::GateVerdict> verdicts;
  for (const comparison::PointComparison& point : points) {
    for (const comparison::Judgement& measure : point.judgements) verdicts.push_back(measure.verdict);
  }
  return comparison::worst_of(verdicts);
}

void expect_seen(const std::vector<std::string>& change, const comparison::GateRules& rules = {}) {
  for (const char* seed : {"1", "2"})
    EXPECT_TRUE(comparison::fails(verdict_on(change, seed, rules))) << change.front() << ", seed " << seed;
}

TEST(GatePower, FindsALowerStiffness) {  // k1 less by 10 %
  expect_seen({"friction.k1={truncated_normal: {mean: 99, sd: 13.5, low: 81, high: 117}}"});
}

TEST(GatePower, FindsASpringThatSoftensSooner) {  // β more by 20 %
  expect_seen({"friction.beta=1.2e+5"});
}

TEST(GatePower, FindsAHigherGain) {  // ki more by 10 %
  expect_seen({"sweep.cases.a.controller.ki=4.235e-5", "sweep.cases.between.controller.ki=7.15e-5",
               "sweep.cases.with-kp.controller.ki=1.0395e-4"});
}

// A coarser converter makes fewer jerks and more zero counts here: that is no regression, and is seen where a
// change either way is asked for.
TEST(GatePower, FindsACoarserConverterAsAChange) {
  expect_seen({"dac.resolution=9.6e-4"}, every_change_fails());
}

/// `count` of the trials, selected at random: the entries of the random order `lot` from index `first` on.
comparison::PointTrials some_of(const comparison::PointTrials& all, const std::vector<std::size_t>& lot,
                                std::size_t first, std::size_t count) {
  comparison::PointTrials some;
  some.trials = static_cast<std::int64_t>(count);
  some.moves = 1;
  for (std::size_t i = first; i < first + count; ++i) {
    some.values["success_rate"].push_back(all.values.at("success_rate")[lot[i]]);
    some.values["arrival_rate"].push_back(all.values.at("arrival_rate")[lot[i]]);
    some.values["stable_rate"].push_back(all.values.at("stable_rate")[lot[i]]);
    some.values["arrival_time"].push_back(all.values.at("arrival_time")[lot[i]]);
    some.values["jerk_count"].push_back(all.values.at("jerk_count")[lot[i]]);
  }
  return some;
}

// Two lots from the trials of one study, 500 times: whatever differs is chance.
TEST(GatePower, RaisesNoMoreFalseAlarmsThanStatedOnRealTrials) {
  const std::vector<comparison::PointTrials> all = trials_of({"seed=9"});
  std::vector<std::size_t> lot(trials);
  std::iota(lot.begin(), lot.end(), std::size_t{0});
  std::mt19937_64 random(19);
  comparison::GateRules rules;
  for (const comparison::GateMeasure& measure : comparison::gate_measures())
    rules.margins[std::string(measure.name)] = {};  // none accepted
  constexpr int comparisons = 500;
  int alarms = 0;
  for (int i = 0; i < comparisons; ++i) {
    std::shuffle(lot.begin(), lot.end(), random);
    std::vector<comparison::PointComparison> points(all.size());
    for (std::size_t point = 0; point < points.size(); ++point) {
      points[point].judgements = comparison::compare_measures(
          rules, "",
          {some_of(all[point], lot, 0, trials / 2), some_of(all[point], lot, trials / 2, trials / 2), false});
    }
    comparison::decide(comparison::judgements_of(points), rules);
    alarms += std::any_of(points.begin(), points.end(), [](const comparison::PointComparison& point) {
      return std::any_of(point.judgements.begin(), point.judgements.end(),
                         [](const comparison::Judgement& one) {
                           return one.verdict == comparison::GateVerdict::regression;
                         });
    });
  }
  RecordProperty("alarms", alarms);
  EXPECT_LE(alarms, comparisons * 0.05);
}

}  // namespace
}  // namespace zerocount::testing
