// Which parameter changed: simulated machines whose measures are normal, with means that are linear in the
// logarithms of two parameters.
#include "analysis/machine/monitor/parameter_change.hpp"

#include "tests/support/test.hpp"

namespace zerocount::monitor {
namespace {

constexpr std::size_t measures = 3;
/// [measure] sensitivity of the mean to a parameter: d(mean)/d(ln of the parameter's factor).
using Slopes = std::array<double, measures>;

constexpr Slopes stiffness{3.0, -1.0, 0.0};
constexpr Slopes damping{0.0, 1.5, 2.0};

/// Made-up moves of machines, each with its own means of the measures, before and after a parameter changes.
class Machines {
 public:
  explicit Machines(std::uint64_t seed, double spread) : seed_(seed), spread_(spread) {}

  std::vector<MoveValues> at(const Slopes& slopes, double factor, int machines, int moves) const {
    std::vector<MoveValues> all;
    for (int machine = 0; machine < machines; ++machine)
      all.push_back(moves_of(slopes, factor, machine, moves, 0));
    return all;
  }
  /// The moves of one machine whose parameter is multiplied by `factor`.
  /// @param width standard deviation of a measure over the moves of one machine
  MoveValues moves_of(const Slopes& slopes, double factor, int machine, int moves, int part,
                      double width = 1.0) const {
    std::mt19937_64 own(seed_ + 1000003ULL * static_cast<std::uint64_t>(machine));
    std::array<double, measures> place{};
    std::normal_distribution<double> normal;
    for (double& one : place) one = spread_ * normal(own);
    normal.reset();
    std::mt19937_64 random(seed_ + 7919ULL * static_cast<std::uint64_t>(machine) +
                           104729ULL * static_cast<std::uint64_t>(part + 1));
    MoveValues values;
    for (int move = 0; move < moves; ++move)
      for (std::size_t i = 0; i < measures; ++i)
        values.push_back(place[i] + slopes[i] * std::log(factor) + width * normal(random));
    return values;
  }

 private:
  std::uint64_t seed_;
  double spread_;
};

ChangeCandidate candidate(const char* name, const Machines& simulated, const Slopes& slopes) {
  ChangeCandidate one{name, {}};
  for (const double factor : {0.5, 0.6, 0.7, 0.8, 0.87, 0.94, 1.0, 1.06, 1.15, 1.25, 1.43, 1.67, 2.0})
    one.changes.push_back({factor, simulated.at(slopes, factor, 64, 16)});
  return one;
}

/// The moves of one machine before and after a parameter is multiplied by `factor`.
/// @param before,after number of moves
MoveValues changed_machine(const Machines& machines, const Slopes& slopes, double factor, int before,
                           int after) {
  MoveValues moves = machines.moves_of(slopes, 1.0, 1000, before, 1);
  const MoveValues later = machines.moves_of(slopes, factor, 1000, after, 2);
  moves.insert(moves.end(), later.begin(), later.end());
  return moves;
}

TEST(ParameterChange, IntervalCoversTheTrueChange) {
  const Machines simulated(1, 0.5);
  const std::vector<ChangeCandidate> candidates{candidate("stiffness", simulated, stiffness),
                                                candidate("damping", simulated, damping)};
  int covered = 0;
  int told = 0;
  constexpr int machines = 60;
  for (int i = 0; i < machines; ++i) {
    const Machines own(static_cast<std::uint64_t>(100 + i), 0.5);
    const double factor = i % 2 == 0 ? 0.7 : 1.4;
    const ChangeExplanation found =
        explain_change(candidates, changed_machine(own, stiffness, factor, 200, 300), measures);
    EXPECT_NEAR(static_cast<double>(found.since), 201.0, 60.0) << i;
    if (found.told != ExplanationKind::one || found.parameters[0].parameter != "stiffness") continue;
    ++told;
    covered += found.parameters[0].low <= factor && factor <= found.parameters[0].high ? 1 : 0;
  }
  EXPECT_GE(told, machines - 4);
  EXPECT_GE(covered, told - 8) << "95 % of " << told;
}

TEST(ParameterChange, TwoParametersThatActAlikeAreNotDistinguished) {
  const Machines simulated(2, 0.5);
  const std::vector<ChangeCandidate> candidates{candidate("stiffness", simulated, stiffness),
                                                candidate("twin", simulated, stiffness),
                                                candidate("damping", simulated, damping)};
  const ChangeExplanation found =
      explain_change(candidates, changed_machine(Machines(3, 0.5), stiffness, 0.8, 200, 300), measures);
  EXPECT_EQ(found.told, ExplanationKind::several);
  ASSERT_EQ(found.parameters.size(), 2u);
  EXPECT_NEAR(found.parameters[0].probability, 0.5, 1e-6);
}

// Noise is added where there is none: a factor of it changes nothing.
TEST(ParameterChange, AParameterThatWasZeroChangesByAnAmount) {
  const Machines simulated(8, 0.5);
  ChangeCandidate noise{"noise", {}, ChangeKind::amount, "count"};
  for (const double amount : {0.0, 0.1, 0.2, 0.4, 0.8})
    noise.changes.push_back({amount, simulated.at(damping, std::exp(amount), 64, 16)});
  const std::vector<ChangeCandidate> candidates{candidate("stiffness", simulated, stiffness), noise};
  const ChangeExplanation found = explain_change(
      candidates, changed_machine(Machines(9, 0.5), damping, std::exp(0.3), 200, 300), measures);
  ASSERT_EQ(found.told, ExplanationKind::one);
  EXPECT_EQ(found.parameters[0].parameter, "noise");
  EXPECT_EQ(found.parameters[0].kind, ChangeKind::amount);
  EXPECT_EQ(found.parameters[0].unit, "count");
  EXPECT_LE(found.parameters[0].low, 0.3);
  EXPECT_GE(found.parameters[0].high, 0.3);
  EXPECT_NEAR(found.parameters[0].change, 0.3, 0.1);
}

TEST(ParameterChange, AChangeThatNoParameterExplainsIsReported) {
  const Machines simulated(4, 0.5);
  const std::vector<ChangeCandidate> candidates{candidate("stiffness", simulated, stiffness),
                                                candidate("damping", simulated, damping)};
  const Slopes other{3.0, 3.0, -3.0};
  const ChangeExplanation found =
      explain_change(candidates, changed_machine(Machines(5, 0.5), other, 0.6, 200, 300), measures);
  EXPECT_EQ(found.told, ExplanationKind::none);
  EXPECT_GT(found.misfit, found.max_misfit);
}

// The means of the measures are where one of the parameters would bring them, but the moves scatter more than
// with any.
TEST(ParameterChange, MovesThatScatterMoreThanAnyParameterExplainsMatchNone) {
  const Machines simulated(10, 0.5);
  const std::vector<ChangeCandidate> candidates{candidate("stiffness", simulated, stiffness),
                                                candidate("damping", simulated, damping)};
  const Machines own(11, 0.5);
  for (const double width : {1.0, 1.6}) {
    MoveValues moves = own.moves_of(stiffness, 1.0, 1000, 200, 1);
    const MoveValues later = own.moves_of(stiffness, 0.7, 1000, 300, 2, width);
    moves.insert(moves.end(), later.begin(), later.end());
    EXPECT_EQ(explain_change(candidates, moves, measures).told,
              width > 1.0 ? ExplanationKind::none : ExplanationKind::one)
        << width;
  }
}

// Whatever the parameters do to the measures, and whichever of them changed, it is among those that are
// named.
TEST(ParameterChange, TheTrueParameterIsAmongTheNamedOnes) {
  std::mt19937_64 random(20261130);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  int named = 0;
  int told = 0;
  constexpr int studies = 12;
  constexpr int logs = 5;
  constexpr std::array names{"first", "second", "third", "fourth"};
  for (int study = 0; study < studies; ++study) {
    const Machines simulated(static_cast<std::uint64_t>(20 + study), 0.3);
    std::vector<Slopes> slopes(names.size());
    std::vector<ChangeCandidate> candidates;
    for (std::size_t i = 0; i < slopes.size(); ++i) {
      for (double& slope : slopes[i]) slope = 2.0 * uniform(random);
      candidates.push_back(candidate(names[i], simulated, slopes[i]));
    }
    for (int log = 0; log < logs; ++log) {
      const Machines own(static_cast<std::uint64_t>(1000 * study + log + 500), 0.3);
      const auto changed = static_cast<std::size_t>(log) % slopes.size();
      const ChangeExplanation found = explain_change(
          candidates,
          changed_machine(own, slopes[changed], std::exp(0.6 * uniform(random)), log % 2 == 0 ? 150 : 0, 200),
          measures);
      told += found.told == ExplanationKind::none || found.told == ExplanationKind::unknown ? 0 : 1;
      named += std::ranges::any_of(
          found.parameters, [&](const ParameterChange& one) { return one.parameter == names[changed]; });
    }
  }
  EXPECT_GE(told, studies * logs - 4) << "1 % are wrongly told as none";
  EXPECT_GE(named, told - 4) << "1 % are missing";
}

// A machine that is unlike the simulated ones from its first move on is compared with them, with their
// spread.
TEST(ParameterChange, WithoutAChangeTheMachineIsPlacedAmongThePopulation) {
  const Machines simulated(6, 0.2);
  const std::vector<ChangeCandidate> candidates{candidate("stiffness", simulated, stiffness),
                                                candidate("damping", simulated, damping)};
  const ChangeExplanation found =
      explain_change(candidates, Machines(7, 0.2).moves_of(stiffness, 0.6, 1000, 400, 1), measures);
  EXPECT_EQ(found.since, 1);
  EXPECT_EQ(found.parameters[0].parameter, "stiffness");
  EXPECT_LT(found.parameters[0].low, 0.62);
  EXPECT_GT(found.parameters[0].high, 0.58);
  EXPECT_GT(found.parameters[0].high - found.parameters[0].low, 0.05) << "machines differ";
}

TEST(ParameterChange, WithoutMovesOrCandidatesIsUnknown) {
  const Machines simulated(8, 0.5);
  const std::vector<ChangeCandidate> candidates{candidate("nothing", simulated, {0.0, 0.0, 0.0})};
  const MoveValues some = changed_machine(Machines(9, 0.5), stiffness, 0.8, 100, 100);
  EXPECT_EQ(explain_change(candidates, some, measures).told, ExplanationKind::unknown);
  EXPECT_EQ(explain_change({}, some, measures).told, ExplanationKind::unknown);
  const std::vector<ChangeCandidate> acts{candidate("stiffness", simulated, stiffness)};
  const MoveValues few(some.begin(), some.begin() + 30);
  EXPECT_EQ(explain_change(acts, few, measures).told, ExplanationKind::unknown);
}

}  // namespace
}  // namespace zerocount::monitor
