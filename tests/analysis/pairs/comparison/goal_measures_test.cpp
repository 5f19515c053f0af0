// Studies with a goal are compared by it: how often that is wrong, and that it sees what there is.
#include "analysis/pairs/comparison/comparison.hpp"
#include "analysis/pairs/comparison/point_judgements.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

using comparison::ChangeVerdict;
using comparison::Judgement;
using comparison::PointTrials;

/// Distribution of the settling times of a made-up study, and its numbers of machines, trials and moves.
struct Machines {
  std::int64_t machines{0};  ///< number of machines; 0: every trial has its own
  std::int64_t trials{200};
  std::int64_t moves{1};
  double median{0.02};      ///< median of the settling times, s
  double of_machines{0.2};  ///< standard deviation of the logarithms of the machines' median settling times
  double never{0.0};        ///< probability that a move does not settle
  double shift{0.0};        ///< time by which every move settles later, s
};

/// The trials of a made-up study whose random numbers come from the seed `draws`. If `again` is above 0, some
/// trials get other random numbers, from the seed `again`.
PointTrials settled_trials(const Machines& machines, unsigned draws, unsigned again = 0) {
  constexpr double sample = 1e-4;
  constexpr double redrawn = 0.3;
  std::mt19937_64 of_draws(draws);
  std::mt19937_64 of_change(again);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  std::vector<double> of_machines;
  for (std::int64_t machine = 0; machine < std::max(machines.machines, machines.trials); ++machine)
    of_machines.push_back(std::exp(machines.of_machines * normal(of_draws)));
  std::vector<trial::MoveOutcome> outcomes;
  for (std::int64_t i = 0; i < machines.trials; ++i) {
    const double machine =
        of_machines[static_cast<std::size_t>(machines.machines > 0 ? i % machines.machines : i)];
    for (std::int64_t move = 0; move < machines.moves; ++move) {
      double z = normal(of_draws);
      double u = uniform(of_draws);
      const double z_again = normal(of_change);
      const double u_again = uniform(of_change);
      if (again > 0 && uniform(of_change) < redrawn) {
        z = z_again;
        u = u_again;
      }
      trial::MoveOutcome outcome;
      const double time = machines.median * machine * std::exp(0.1 * z) + machines.shift;
      if (u >= machines.never) outcome.bands[0].settling_time = sample * std::round(time / sample);
      outcomes.push_back(outcome);
    }
  }
  comparison::AlsoRead also;
  also.machines = machines.machines;
  const std::optional<double> asked = machines.machines > 0 ? std::optional(0.9) : std::nullopt;
  also.judged = {{{.band = 0, .within = 0.03, .moves = 0.9, .machines = asked},
                  {.settling = measures::Settling::in_band, .within = 0.03},
                  machines.machines}};
  return comparison::gather_trials(outcomes, machines.moves, also);
}

std::vector<Judgement> compare_settled(const PointTrials& before, const PointTrials& after, bool paired,
                                       const comparison::GateRules& rules = {}) {
  std::vector<comparison::PointComparison> points(1);
  points[0].judgements = comparison::compare_measures(rules, "", {before, after, paired});
  comparison::decide(comparison::judgements_of(points), rules);
  return points[0].judgements;
}

/// A kind of made-up study: whether its trials are independent, have several moves, or share machines, and
/// whether the compared studies are paired (use the same random numbers).
struct Layer {
  Machines machines;
  bool paired;
};
std::vector<Layer> layers() {
  std::vector<Layer> all;
  for (const bool paired : {false, true}) {
    all.push_back({{.trials = 200}, paired});
    all.push_back({{.trials = 100, .moves = 3}, paired});
    all.push_back({{.machines = 60, .trials = 240, .moves = 2, .never = 0.02}, paired});
  }
  return all;
}

std::vector<std::string> measure_names(const std::vector<Judgement>& measures) {
  std::vector<std::string> names;
  for (const Judgement& measure : measures) names.push_back(measure.measure);
  return names;
}

TEST(GoalMeasures, ReplaceTheOtherMeasuresUnlessTheRulesNameThem) {
  using Names = std::vector<std::string>;
  const PointTrials of_moves = settled_trials({}, 1);
  const PointTrials of_machines = settled_trials({.machines = 50}, 1);
  const auto names = [](const comparison::GateRules& rules, const PointTrials& trials) {
    return measure_names(comparison::compare_measures(rules, "a", {trials, trials, true}));
  };
  EXPECT_EQ(names({}, of_moves), (Names{"goal_rate", "goal_settling_time"}));
  EXPECT_EQ(names({}, of_machines), (Names{"goal_rate", "goal_machines", "goal_settling_time"}));
  comparison::GateRules rules;
  rules.points["b"].margins["jerk_count"] = {};  // a margin that had no effect would be ignored
  EXPECT_EQ(names(rules, of_moves), (Names{"goal_rate", "goal_settling_time", "jerk_count"}));
  rules.measures = {"stable_rate", "goal_machines"};
  EXPECT_EQ(names(rules, of_machines), (Names{"goal_machines", "stable_rate"}));
  PointTrials without = of_moves;
  without.judged.clear();
  EXPECT_EQ(names({}, without).front(), "success_rate");
}

TEST(GoalMeasures, RaiseFalseAlarmsNoMoreOftenThanStated) {
  constexpr int comparisons = 120;
  constexpr double rate = 0.2;
  comparison::GateRules rules;
  rules.false_discovery_rate = rate;
  for (const comparison::GateMeasure& measure : comparison::goal_measures())
    rules.margins[std::string(measure.name)] = {};
  for (const auto& [machines, paired] : layers()) {
    int alarms = 0;
    int improvements = 0;
    int small = 0;  // p at most the rate, of the times alone, without adjustment
    for (unsigned seed = 1; seed <= comparisons; ++seed) {
      const auto measures = compare_settled(
          settled_trials(machines, seed),
          paired ? settled_trials(machines, seed, seed) : settled_trials(machines, 1000 + seed), paired,
          rules);
      const auto any = [&](ChangeVerdict change) {
        return std::ranges::any_of(measures, [&](const auto& one) { return one.change == change; });
      };
      alarms += any(ChangeVerdict::worse);
      improvements += any(ChangeVerdict::better);
      small += measures.back().p <= rate;
    }
    const std::string which = std::to_string(machines.moves) + (paired ? " moves, paired" : " moves");
    EXPECT_LE(alarms, comparisons * rate) << which;
    EXPECT_LE(improvements, comparisons * rate) << which;
    EXPECT_LE(small, comparisons * rate + 3.0 * std::sqrt(comparisons * rate * (1.0 - rate))) << which;
    EXPECT_GT(small, 0) << which;  // the level is used, not only kept
  }
}

TEST(GoalMeasures, BoundTheDifferenceOfTheTimesAsOftenAsStated) {
  constexpr int comparisons = 150;
  constexpr double shift = 2e-3;
  for (const auto& [machines, paired] : layers()) {
    int too_low = 0;
    int too_high = 0;
    Machines later = machines;
    later.shift = shift;
    for (unsigned seed = 1; seed <= comparisons; ++seed) {
      const Judgement time =
          compare_settled(settled_trials(machines, seed),
                          paired ? settled_trials(later, seed, seed) : settled_trials(later, 1000 + seed),
                          paired)
              .back();
      EXPECT_LE(time.bounds.low, time.effect + 1e-4);
      EXPECT_GE(time.bounds.high, time.effect - 1e-4);
      too_low += time.bounds.high < shift;
      too_high += time.bounds.low > shift;
    }
    const double allowed = 0.05 * comparisons + 3.0 * std::sqrt(0.05 * 0.95 * comparisons);
    EXPECT_LE(too_low, allowed) << machines.moves << paired;
    EXPECT_LE(too_high, allowed) << machines.moves << paired;
  }
}

TEST(GoalMeasures, FindARealWorsening) {
  for (const auto& [machines, paired] : layers()) {
    Machines many = machines;
    many.trials *= 3;
    many.machines *= 3;
    Machines worse = many;
    worse.median *= 1.4;  // of the times; more of them come too late
    for (unsigned seed = 1; seed <= 10; ++seed) {
      const auto found = compare_settled(
          settled_trials(many, seed),
          paired ? settled_trials(worse, seed, seed) : settled_trials(worse, 1000 + seed), paired);
      EXPECT_EQ(found.front().change, ChangeVerdict::worse) << machines.moves << paired << seed;
      EXPECT_EQ(found.back().change, ChangeVerdict::worse) << machines.moves << paired << seed;
    }
  }
}

TEST(GoalMeasures, AMoveThatNeverSettlesIsLaterThanAnyTime) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const Machines settling{.trials = 2000, .never = 0.03};
  Machines lost = settling;
  lost.never = 0.08;
  const Judgement worse = compare_settled(settled_trials(settling, 1), settled_trials(lost, 2), false).back();
  EXPECT_TRUE(std::isfinite(worse.baseline));
  EXPECT_EQ(worse.current, infinity);
  EXPECT_EQ(worse.effect, infinity);
  EXPECT_EQ(worse.change, ChangeVerdict::worse);
  const Judgement better =
      compare_settled(settled_trials(lost, 2), settled_trials(settling, 1), false).back();
  EXPECT_EQ(better.effect, -infinity);
  EXPECT_EQ(better.change, ChangeVerdict::better);
  const Judgement neither = compare_settled(settled_trials(lost, 1), settled_trials(lost, 2), false).back();
  EXPECT_EQ(neither.verdict, comparison::GateVerdict::not_measured);
}

// Half as many trials on each machine show more machines without a miss; they are no better.
TEST(GoalMeasures, JudgeEveryMachineByTheSameNumberOfMoves) {
  const Machines few{.machines = 200, .trials = 400};
  Machines many = few;
  many.trials = 4000;
  const auto of_machines = [](const std::vector<Judgement>& all) { return all[1]; };
  const Judgement found =
      of_machines(compare_settled(settled_trials(many, 1), settled_trials(few, 2), false));
  EXPECT_TRUE(says(found.note, "first 2 trials on each"));
  EXPECT_NEAR(found.effect, 0.0, 0.1);
}

}  // namespace
}  // namespace zerocount::testing
