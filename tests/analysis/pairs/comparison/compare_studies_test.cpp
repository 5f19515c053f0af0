// Two results files: what they have in common, which points belong together, and what comes of it.
#include "analysis/pairs/comparison/comparison.hpp"
#include "core/hash/sha256.hpp"
#include "tests/analysis/study_files.hpp"
#include "tests/support/checksum.hpp"
#include "tests/support/merged_file.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zerocount::testing {
namespace {

constexpr std::int64_t trials = 120;

/// A study with two design points. Its manifest ends with the further lines `more`.
study::Study study_of(const std::string& more = "", std::uint64_t seed = 1, std::int64_t count = trials) {
  study::Study study = plain_study(2, count, 1);
  study.seed = seed;
  study.manifest.text = "zerocount: 1\nname: plain\nseed: " + std::to_string(seed) + "\n" + more;
  study.manifest.sha256 = hash::sha256_hex(study.manifest.text);
  study.study_sha256 = study.manifest.sha256;
  study.columns.inputs = {{"friction.k1", "N m/rad", "stiffness"}};
  return study;
}

/// A made-up trial whose move arrives after `samples` samples. It ends at zero counts if `success` is true.
TrialRecord trial_of(bool success, int samples) {
  trial::MoveOutcome move;
  move.outcome = success ? trial::Outcome::zero_count : trial::Outcome::one_count;
  move.arrived = move.stable = true;
  move.arrival = samples;
  move.arrival_time = samples * 0.0005;
  return {{{move}}, {}};
}

std::vector<TrialRecord> good_trials(std::int64_t count = trials) {
  std::vector<TrialRecord> all;
  for (std::int64_t row = 0; row < 2 * count; ++row)
    all.push_back(trial_of(row % 10 != 0, 40 + int(row * 7 % 23)));
  return all;
}

class ComparedStudies : public ::testing::Test {
 protected:
  reading::AllTrialsFile write(const std::string& name, const study::Study& study,
                               const std::vector<TrialRecord>& records) {
    write_study_file(folder_ / name, study, records);
    return reading::AllTrialsFile(folder_ / name);
  }

  std::string fault(const reading::AllTrialsFile& one, const reading::AllTrialsFile& other) {
    return refusal_by([&] { comparison::compare_studies(one, other); }, ExitCode::bad_data);
  }

  TemporaryFolder folder_;
};

TEST_F(ComparedStudies, EqualDataPass) {
  const comparison::StudyComparison result = comparison::compare_studies(
      write("a.h5", study_of(), good_trials()), write("b.h5", study_of(), good_trials()));
  EXPECT_EQ(result.layer, comparison::ComparisonLayer::bits);
  EXPECT_TRUE(result.equal_to_the_bit);
  EXPECT_EQ(result.verdict, comparison::GateVerdict::passed);
  EXPECT_TRUE(result.manifest_differences.empty());
  ASSERT_EQ(result.points.size(), 2u);
  EXPECT_EQ(result.points[0].judgements[0].test, "equal to the bit");
}

/// Trials as good_trials(), except that every `step`-th move ends off target. In every second of these moves
/// the error is still falling.
std::vector<TrialRecord> trials_with_undecided_moves(std::size_t step) {
  std::vector<TrialRecord> all = good_trials();
  for (std::size_t row = 0; row < all.size(); row += step) {
    trial::MoveOutcome& move = all[row].outcome.moves[0];
    move = trial::MoveOutcome{};
    move.outcome = trial::Outcome::off_target;
    move.midway_error = row % (2 * step) == 0 ? 9 : 5;
    move.final_error = 5;
  }
  return all;
}

// Whether stability has changed is not known of moves that are neither stable nor shown unstable.
TEST_F(ComparedStudies, UndecidedMovesOfBothFilesAreCounted) {
  const reading::AllTrialsFile none = write("none.h5", study_of(), good_trials());
  const reading::AllTrialsFile some = write("some.h5", study_of("", 2), trials_with_undecided_moves(6));
  const reading::AllTrialsFile many = write("many.h5", study_of("", 3), trials_with_undecided_moves(3));
  const comparison::StudyComparison result = comparison::compare_studies(some, many);
  for (const comparison::PointComparison& point : result.points) {
    EXPECT_EQ(point.baseline_undecided.moves, trials);
    EXPECT_EQ(point.baseline_undecided.off_target, 20);
    EXPECT_EQ(point.baseline_undecided.still_falling, 10);
    EXPECT_EQ(point.current_undecided.off_target, 40);
    EXPECT_EQ(point.current_undecided.still_falling, 20);
  }
  const auto notes_of = [](const comparison::StudyComparison& comparison) {
    return fmt::format("{}", fmt::join(comparison.notes, "\n"));
  };
  EXPECT_TRUE(notes_of(result).starts_with("undecided in the baseline: 40 of 240 moves"));
  EXPECT_TRUE(says(notes_of(result), "undecided in the file: 80 of 240 moves"));
  EXPECT_TRUE(says(notes_of(comparison::compare_studies(none, some)),
                   "undecided in the baseline: none of 240 moves\n"));
  EXPECT_TRUE(
      says(notes_of(comparison::compare_studies(some, none)), "undecided in the file: none of 240 moves\n"));
  EXPECT_FALSE(says(notes_of(comparison::compare_studies(none, none)), "undecided"));
}

TEST_F(ComparedStudies, OneBitIsFoundAndNamed) {
  std::vector<TrialRecord> changed = good_trials();
  changed[17].outcome.moves[0].creep = 1e-300;
  const comparison::StudyComparison result = comparison::compare_studies(
      write("a.h5", study_of(), good_trials()), write("b.h5", study_of(), changed));
  EXPECT_EQ(result.first_difference, "/outcome/creep: differs from row 17 on");
  EXPECT_FALSE(result.equal_to_the_bit);
  // By a clean build this is a regression by itself; one with uncommitted changes may be another.
  if (result.layer == comparison::ComparisonLayer::bits) {
    EXPECT_EQ(result.verdict, comparison::GateVerdict::regression);
  } else {
    EXPECT_EQ(result.layer, comparison::ComparisonLayer::paired);
    EXPECT_EQ(result.points[0].pairs, trials);
  }
}

/// Changes the provenance stored in a results file: written by a build of this commit, without uncommitted
/// changes.
void give_commit(const std::filesystem::path& path, const std::string& commit) {
  const std::string command = fmt::format(
      "{} -c 'import h5py, sys; h5py.File(sys.argv[1], \"r+\").attrs.modify(\"git_commit\", sys.argv[2])' {} "
      "{}",
      ZEROCOUNT_PYTHON, path.string(), commit);
  ASSERT_EQ(std::system(command.c_str()), 0);
  append_checksum(path);
}

TEST_F(ComparedStudies, OneBuildMustMakeOneResult) {
  std::vector<TrialRecord> changed = good_trials();
  changed[17].outcome.moves[0].creep = 1e-300;
  write("a.h5", study_of(), good_trials());
  write("b.h5", study_of(), changed);
  give_commit(folder_ / "a.h5", "c0ffee");
  give_commit(folder_ / "b.h5", "c0ffee");
  const comparison::StudyComparison result = comparison::compare_files(folder_ / "a.h5", folder_ / "b.h5");
  EXPECT_EQ(result.layer, comparison::ComparisonLayer::bits);
  EXPECT_EQ(result.verdict, comparison::GateVerdict::regression);
  EXPECT_EQ(result.first_difference, "/outcome/creep: differs from row 17 on");

  give_commit(folder_ / "b.h5", "decade");  // another build may
  EXPECT_EQ(comparison::compare_files(folder_ / "a.h5", folder_ / "b.h5").layer,
            comparison::ComparisonLayer::paired);
}

TEST_F(ComparedStudies, AnotherManifestOnTheSameDrawsIsComparedTrialByTrial) {
  std::vector<TrialRecord> worse = good_trials();
  for (std::int64_t row = 0; row < trials; row += 3)
    worse[static_cast<std::size_t>(row)] = trial_of(false, 60);
  const comparison::StudyComparison result =
      comparison::compare_studies(write("a.h5", study_of("controller: {ki: 1.0e-5}\n"), good_trials()),
                                  write("b.h5", study_of("controller: {ki: 2.0e-5}\n"), worse));
  EXPECT_EQ(result.layer, comparison::ComparisonLayer::paired);
  ASSERT_EQ(result.manifest_differences.size(), 1u);
  EXPECT_EQ(result.manifest_differences[0].key, "controller.ki");
  EXPECT_EQ(result.manifest_differences[0].baseline, "1.0e-5");
  EXPECT_EQ(result.manifest_differences[0].current, "2.0e-5");
  EXPECT_EQ(result.points[0].verdict, comparison::GateVerdict::regression);
  EXPECT_EQ(result.points[0].judgements[0].verdict, comparison::GateVerdict::regression);
  EXPECT_NE(result.points[1].verdict, comparison::GateVerdict::regression);
  EXPECT_EQ(result.verdict, comparison::GateVerdict::regression);
}

TEST_F(ComparedStudies, AnotherSeedIsAnotherSample) {
  const comparison::StudyComparison result = comparison::compare_studies(
      write("a.h5", study_of(), good_trials()), write("b.h5", study_of("", 2), good_trials()));
  EXPECT_EQ(result.layer, comparison::ComparisonLayer::two_samples);
  EXPECT_EQ(result.points[0].pairs, 0);
  EXPECT_EQ(result.points[0].judgements[0].test, "Fisher, exact");
  EXPECT_EQ(result.verdict, comparison::GateVerdict::inconclusive);  // 120 trials do not show 2 %
}

TEST_F(ComparedStudies, OnlyCommonTrialsOfTheSameDrawsAreCompared) {
  const comparison::StudyComparison result =
      comparison::compare_studies(write("a.h5", study_of("x: 1\n"), good_trials()),
                                  write("b.h5", study_of("x: 2\n", 1, 200), good_trials(200)));
  EXPECT_EQ(result.layer, comparison::ComparisonLayer::paired);
  EXPECT_EQ(result.points[0].pairs, trials);
  ASSERT_EQ(result.notes.size(), 1u);
  EXPECT_TRUE(says(result.notes[0], "have no partner"));
}

TEST_F(ComparedStudies, PointsMissingFromOneFileAreReported) {
  study::Study other = study_of("x: 1\n");
  other.points.labels[1] = "point 7";
  EXPECT_EQ(fault(write("a.h5", study_of(), good_trials()), write("b.h5", other, good_trials())),
            "the files cannot be compared: not the same design points; only " + (folder_ / "a.h5").string() +
                " has 'point 1'; only " + (folder_ / "b.h5").string() + " has 'point 7'");
}

TEST_F(ComparedStudies, PointsWithEqualLabelsButOtherAxisValuesAreRefused) {
  study::Study other = study_of("x: 1\n");
  other.points.axes[0].numbers[1] = 9.0;
  const std::string what =
      fault(write("a.h5", study_of(), good_trials()), write("b.h5", other, good_trials()));
  EXPECT_TRUE(says(what, "the axis controller.ki is 2e-05 there and 9 here"));
}

TEST_F(ComparedStudies, ACaseMayBeGivenAnotherGain) {
  study::Study before = study_of();
  before.points.axes.insert(
      before.points.axes.begin(),
      study::SweepAxis{"case", "", "name", study::SweepAxis::Kind::text, {}, before.points.labels});
  study::Study after = before;
  after.points.axes[1].numbers[1] = 9.0;
  after.study_sha256 = std::string(64, '0');
  const auto a = write("a.h5", before, good_trials());
  EXPECT_EQ(comparison::compare_studies(a, write("b.h5", after, good_trials())).layer,
            comparison::ComparisonLayer::paired);
}

TEST_F(ComparedStudies, TorqueLevelsAreNotComparedWithTargets) {
  const std::string what = fault(write("a.h5", study_of("command: {torque: {levels: [1]}}\n"), good_trials()),
                                 write("b.h5", study_of("command: {targets: [1]}\n"), good_trials()));
  EXPECT_TRUE(says(what, "one has targets, the other torque levels"));
}

TEST_F(ComparedStudies, TrialsThatAreNotIndependentAreNotTested) {
  const std::string what = fault(write("a.h5", study_of("design: saltelli\nx: 1\n"), good_trials()),
                                 write("b.h5", study_of("design: saltelli\nx: 2\n"), good_trials()));
  EXPECT_TRUE(says(what, "a.h5: cannot be compared: the trials of `design: saltelli` are not independent"));
}

TEST_F(ComparedStudies, AComparisonThatMeasuresNothingIsInconclusive) {
  std::vector<TrialRecord> open;
  for (std::int64_t row = 0; row < 2 * trials; ++row) {
    TrialRecord record = trial_of(true, 10);
    record.outcome.moves[0].outcome = trial::Outcome::open_loop;
    open.push_back(record);
  }
  const comparison::StudyComparison result = comparison::compare_studies(
      write("a.h5", study_of("x: 1\n"), open), write("b.h5", study_of("x: 2\n"), open));
  EXPECT_EQ(result.verdict, comparison::GateVerdict::inconclusive);
  EXPECT_EQ(result.tests, 0);
  EXPECT_EQ(result.points[0].verdict, comparison::GateVerdict::not_measured);
}

/// The first `count` trials of each of two points.
std::vector<TrialRecord> first_of(const std::vector<TrialRecord>& all, std::int64_t count) {
  std::vector<TrialRecord> some(all.begin(), all.begin() + count);
  some.insert(some.end(), all.begin() + trials, all.begin() + trials + count);
  return some;
}

TEST_F(ComparedStudies, MaxTrialsLimitsTheTrialsThatAreJudged) {
  std::vector<TrialRecord> worse = good_trials();
  for (std::size_t row = 0; row < worse.size(); ++row)
    worse[row] = trial_of(row % 7 != 0, 45 + int(row % 31));
  const auto baseline = write("a.h5", study_of(), good_trials());
  const auto current = write("b.h5", study_of("", 2), worse);
  for (const std::int64_t count : {25, 60, 119}) {
    comparison::GateRules rules;
    rules.max_trials = count;
    const auto some = comparison::compare_studies(baseline, current, rules);
    const auto alone =
        comparison::compare_studies(write("c.h5", study_of("", 1, count), first_of(good_trials(), count)),
                                    write("d.h5", study_of("", 2, count), first_of(worse, count)));
    for (std::size_t point = 0; point < 2; ++point) {
      EXPECT_EQ(some.points[point].baseline_trials, count);
      ASSERT_EQ(some.points[point].judgements.size(), alone.points[point].judgements.size());
      for (std::size_t i = 0; i < some.points[point].judgements.size(); ++i) {
        EXPECT_EQ(some.points[point].judgements[i].baseline, alone.points[point].judgements[i].baseline);
        EXPECT_EQ(some.points[point].judgements[i].effect, alone.points[point].judgements[i].effect);
      }
    }
    ASSERT_FALSE(some.notes.empty());
    EXPECT_EQ(some.notes[0], fmt::format("of the 120 trials of each point in {}, the first {} are judged; "
                                         "more: --max-trials",
                                         (folder_ / "a.h5").string(), count));
  }
}

TEST_F(ComparedStudies, AnOpenComparisonNamesTheMaxTrialsThatWouldDecide) {
  std::vector<TrialRecord> other = good_trials();
  for (std::size_t row = 0; row < other.size(); ++row)
    other[row] = trial_of(row % 9 != 0, 40 + int(row * 5 % 23));
  comparison::GateRules rules;
  rules.max_trials = 100;
  const auto result = comparison::compare_studies(write("a.h5", study_of(), good_trials()),
                                                  write("b.h5", study_of("", 2), other), rules);
  ASSERT_TRUE(result.trials_to_decide.has_value());
  EXPECT_EQ(result.notes.back(),
            fmt::format("more than {} trials of each point are judged only with --max-trials (here {:.0f})",
                        100, *result.trials_to_decide));
}

TEST_F(ComparedStudies, ADriftingBaselineDoesNotCarryARequirementAway) {
  comparison::GateRules rules;
  rules.requirements = {{.text = "success_rate ≥ 0.995",
                         .quantity = comparison::find_requirable("success_rate").value(),
                         .limit = {text::Relation::at_least, 0.995}}};
  const auto a = write("a.h5", study_of(), good_trials());
  const comparison::StudyComparison result = comparison::compare_studies(a, a, rules);
  EXPECT_TRUE(result.equal_to_the_bit);
  EXPECT_EQ(result.verdict, comparison::GateVerdict::regression);  // 90 % in both
  EXPECT_EQ(result.points[0].judgements.back().verdict, comparison::GateVerdict::regression);
}

TEST(Draws, KeepTheirOrderUnderAnotherDistribution) {
  const TemporaryFolder folder;
  const auto write = [&](const std::string& name, const std::function<double(std::int64_t)>& k1,
                         const std::string& more = "") {
    const study::Study study = study_of("distribution: " + name + "\n" + more);
    std::vector<shards::TrialResult> results(2 * trials);
    for (std::int64_t row = 0; row < 2 * trials; ++row)
      results[static_cast<std::size_t>(row)] = {row, {k1(row)}, trial_of(true, 10).outcome, {}, {}};
    shards::write_shard(folder / (name + ".shard"), study, {0, std::ssize(results)}, results);
    const std::vector<shards::ShardInfo> shards{{folder / (name + ".shard"), {0, 2 * trials}}};
    testing::merge_shards(shards, study, folder / name, {0, 2 * trials}, {});
    return reading::AllTrialsFile(folder / name);
  };
  const auto draw = [](std::int64_t row) { return static_cast<double>((row * 37 + 11) % 101); };
  const reading::AllTrialsFile before = write("a.h5", draw);
  const reading::AllTrialsFile scaled = write("b.h5", [&](std::int64_t row) { return 0.95 * draw(row); });
  const reading::AllTrialsFile other = write("c.h5", [&](std::int64_t row) { return draw(row + 1); });
  const comparison::StudyComparison same = comparison::compare_studies(before, scaled);
  EXPECT_EQ(same.layer, comparison::ComparisonLayer::paired);
  EXPECT_EQ(same.changed_inputs, std::vector<std::string>{"friction.k1"});
  const comparison::StudyComparison different = comparison::compare_studies(before, other);
  EXPECT_EQ(different.layer, comparison::ComparisonLayer::two_samples);
  EXPECT_TRUE(different.layer_reason.ends_with("; trial i has other values of friction.k1"));
  const comparison::StudyComparison of_designs =
      comparison::compare_studies(before, write("d.h5", draw, "design: sobol\n"));
  EXPECT_TRUE(of_designs.layer_reason.ends_with("; the manifests differ in design"));
}

}  // namespace
}  // namespace zerocount::testing
