// Each stage of a tuning by itself, from values to values.
#include "runners/tuning/stages.hpp"

#include "analysis/trials/summary/chosen_point.hpp"
#include "analysis/trials/summary/study_statistics.hpp"
#include "experiments/manifest/load_study.hpp"
#include "runners/tuning/extras.hpp"
#include "tests/runners/design_commands/tune_fixture.hpp"
#include "tests/support/draws.hpp"
#include "tests/support/each_seed.hpp"

namespace zerocount::tuning {
namespace {

using testing::TemporaryFolder;

study::Study axis_study(const std::vector<std::string>& overrides = {}) {
  return manifest::parse_study(std::string(testing::axis) + "goal: {band: 1, within: 0.05, moves: 0.95}\n" +
                                   std::string(testing::two_gains),
                               "axis.yaml", overrides);
}

/// The search space of a study, and a search in it.
struct Searching {
  explicit Searching(std::int64_t trials, const std::vector<std::string>& overrides = {})
      : study(axis_study(overrides)),
        space(space_of(study, {.trials = trials}, trials::Effort().limited_to(trials, {}), {})),
        plan(plan_search(study, space.budget, space.effort, space.speed)),
        search(study, space.free(), plan.size, journal, space.effort) {}

  study::Study study;
  TuningJournal journal{{}, {}, false};
  Space space;
  SearchPlan plan;
  StudySearch search;
};

TEST(TuningStages, SearchTakesItsFractionOfTheBudgetAndRanksItsFinalists) {
  Searching of(4000);
  int generations = 0;
  const Searched found =
      search_values(of.space, of.search, of.plan, [&](const SearchProgress&) { ++generations; });
  ASSERT_FALSE(found.result.finalists.empty());
  EXPECT_EQ(found.result.generations, generations);
  EXPECT_LE(found.result.trials, 2000);
  EXPECT_EQ(of.space.effort.spent_trials(), found.result.trials);
  EXPECT_EQ(of.space.measured_speed > 0.0, of.search.simulated() >= 1000);
  EXPECT_GE(found.examined, std::ssize(found.result.tried));
  const Aim aim = aim_of(of.study);
  for (std::size_t i = 1; i < found.result.estimates.size(); ++i)
    EXPECT_FALSE(is_better(aim, found.result.estimates[i], found.result.estimates[i - 1])) << i;
}

/// The proof that these values of the free parameters meet the goal, as the only finalist of the search.
std::optional<Proven> proof_of_values(Searching& of, const Values& values,
                                      const std::filesystem::path& path) {
  SearchResult found;
  found.finalists.push_back(
      {{}, values, results_of(of.search.candidate(values), of.search.machines(), 200, nullptr, {})});
  found.estimates.push_back(estimate_of(aim_of(of.study), found.finalists[0].machines, 200));
  status::StatusLine line(true);
  return prove_values(of.space, of.search, found, {path, 1}, line);
}

TEST(TuningStages, ProofEqualsTheVerdictOfItsFile) {
  Searching of(20000);
  const Values values{3.85e-5, 0.0};
  const TemporaryFolder folder;
  const std::optional<Proven> proven = proof_of_values(of, values, folder.path() / "proof.h5");
  ASSERT_TRUE(proven);
  const reading::AllTrialsFile file(folder.path() / "proof.h5");
  const trials::Replicates machines = trials::replicates_of(file.study(), 0);
  const Judged alone = judged(file.study(), machines, results_in(file, file.study(), machines));
  EXPECT_EQ(proven->proof.verdict.status, alone.verdict.status);
  EXPECT_EQ(proven->proof.verdict.moves.low, alone.verdict.moves.low);
  EXPECT_EQ(proven->proof.criterion, alone.criterion);
  EXPECT_EQ(values_in_manifest(file.study(), of.space.free()), values);
  EXPECT_NE(file.study().seed, of.study.seed);
}

/// Random values of the free parameters, and a goal near the proportion of moves that meet it at these
/// values.
struct RandomProofs {
  static constexpr unsigned seeds = 3;

  explicit RandomProofs(unsigned seed) : draws(seed) {}

  testing::Draws draws;
  Values values{std::exp(draws.uniform(std::log(1.0e-5), std::log(2.0e-4))), draws.uniform(0.0, 1.0e-3)};
  std::string goal{fmt::format("goal.moves={}", draws.uniform(0.6, 0.99))};
  std::int64_t budget{draws.integer(3000, 8000)};
};

// What a proof shows is shown by its file, with the part of the error probability that its attempt has.
TEST_EACH_SEED(RandomProofs, VerdictEqualsThatOfTheResultsFile) {
  Searching of(budget, {goal});
  const TemporaryFolder folder;
  const std::optional<Proven> proven = proof_of_values(of, values, folder.path() / "proof.h5");
  ASSERT_TRUE(proven);
  const summary::StudySummary summary = summary::summarise_file(folder.path() / "proof.h5");
  const summary::JudgedPoint judged = summary::judge_point(summary, summary::choose_point(summary));
  const goal::Verdict& of_proof = proven->proof.verdict;
  EXPECT_EQ(of_proof.status, judged.verdict.status);
  EXPECT_EQ(of_proof.moves.low, judged.verdict.moves.low);
  EXPECT_EQ(of_proof.moves.high, judged.verdict.moves.high);
  EXPECT_EQ(proven->proof.needs.has_value(), judged.needs.has_value());
  const double alpha = 0.05 / static_cast<double>(correction_of(proven->proof.attempts));
  const measures::MoveCounts counts = summary.points[0].goals[0].sum();
  EXPECT_NEAR(of_proof.moves.low, statistics::clustered_at_least(measures::clusters_of(counts), 1.0 - alpha),
              1e-9);
}

TEST(TuningStages, AMissedGoalIsUnreachableOnlyTogetherWithTheSearch) {
  bool keeps_margins = true;
  const auto status_of = [&](const Landscape& landscape, bool approaching, bool all_tried) {
    Proof proof{axis_study(), {}};
    proof.verdict.status = keeps_margins ? goal::Status::missed : goal::Status::met;
    proof.keeps_margins = keeps_margins;
    proof.all_tried = all_tried;
    Searched searched{.landscape = landscape};
    searched.result.approaching = approaching;
    return tuning::status_of(proof, searched);
  };
  const Landscape leads{.points = 100, .telling = 50, .varies = true};
  const Landscape flat{.points = 100, .telling = 0, .varies = true};
  for (const bool keeps : {true, false}) {  // values that do not keep a margin are no answer either
    keeps_margins = keeps;
    EXPECT_EQ(status_of(leads, false, true), goal::Status::missed);
    EXPECT_EQ(status_of(leads, true, true), goal::Status::undecided);
    EXPECT_EQ(status_of(leads, false, false), goal::Status::undecided);
    EXPECT_EQ(status_of(flat, false, true), goal::Status::undecided);
  }
}

/// A made-up optional part of the answer of `tune` that needs `trials` trials. If these are more than 4000,
/// it also runs when only a tenth of them is affordable.
template <std::int64_t trials, bool applies = true>
Extra made_up(std::string_view name) {
  return {.name = name,
          .cost =
              [](const TunedAxis&) {
                return ExtraCost{
                    .applies = applies, .trials = trials, .usual_part = trials > 4000 ? 0.1 : 1.0};
              },
          .run =
              [](TunedAxis& axis) {
                axis.effort.spend(trials);
                return std::any(trials);
              }};
}

// One that takes too much leaves room for later ones; one that runs out of trials is left out too.
TEST(TuningStages, ExtrasAreMadeInTheirOrderOrNamed) {
  Searching of(3000);
  const Values values{3.85e-5, 0.0};
  const Proof proof{of.study, {}};
  Extras made;
  SearchResult searched;
  TunedAxis axis{of.space, of.search, of.journal, values, proof, true, made, searched};
  const std::vector<Extra> all{made_up<3001>("dear"), made_up<1000>("first"), made_up<1, false>("other"),
                               made_up<5000>("runs out"), made_up<2000>("last")};
  std::vector<const Extra*> wanted;
  for (const Extra& one : all) wanted.push_back(&one);
  status::StatusLine line(true);
  std::string ready;
  make_extras(wanted, axis, true, line, [&](const Extra& one) { ready += fmt::format("{}, ", one.name); });
  EXPECT_EQ(ready, "dear, first, runs out, last, ");
  EXPECT_EQ(made.left_out, (std::vector<LeftOut>{{"dear", "dear"}, {"runs out", "runs out"}}));
  ASSERT_EQ(made.found.size(), 2U);
  EXPECT_EQ(std::any_cast<std::int64_t>(made.found[1]), 2000);
  EXPECT_EQ(of.space.effort.spent_trials(), 3000);
}

}  // namespace
}  // namespace zerocount::tuning
