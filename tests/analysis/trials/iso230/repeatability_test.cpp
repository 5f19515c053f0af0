#include "analysis/trials/iso230/repeatability.hpp"

#include <nlohmann/json.hpp>

#include "analysis/trials/iso230/columns.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test.hpp"

namespace zerocount::iso230 {
namespace {

using Deviations = std::vector<TargetDeviations>;

std::vector<double> normals(std::mt19937_64& random, std::size_t count, double mean) {
  std::normal_distribution<double> normal(mean, 1.0 + static_cast<double>(random() % 3));
  std::vector<double> values(count);
  std::generate(values.begin(), values.end(), [&] { return normal(random); });
  return values;
}

/// Random deviations of an ISO 230-2 test with so many targets and cycles.
Deviations random_deviations(std::mt19937_64& random, std::size_t targets, std::size_t cycles) {
  std::normal_distribution<double> spread(0.0, 3.0);
  Deviations deviations(targets);
  for (TargetDeviations& target : deviations) {
    target.positive = normals(random, cycles, spread(random));
    target.negative = normals(random, cycles, spread(random));
  }
  return deviations;
}

Deviations transformed(Deviations deviations, const std::function<double(double)>& change) {
  for (TargetDeviations& target : deviations) {
    for (double& x : target.positive) x = change(x);
    for (double& x : target.negative) x = change(x);
  }
  return deviations;
}

void for_random_runs(const std::function<void(const Deviations&)>& check) {
  std::mt19937_64 random(230);
  for (int i = 0; i < 300; ++i) {
    const std::size_t targets = 1 + random() % 11;
    check(random_deviations(random, targets, 2 + random() % 6));
  }
}

template <typename Values>
void expect_near(const Values& actual, const Values& expected,
                 std::span<const RepeatabilityField<Values>> fields, double tolerance = 1e-12) {
  for (const auto& field : fields) {
    const double value = actual.*field.value;
    const double wanted = expected.*field.value;
    if (std::isnan(wanted)) {
      EXPECT_TRUE(std::isnan(value)) << field.name;
    } else {
      EXPECT_NEAR(value, wanted, tolerance) << field.name;
    }
  }
}

TEST(Repeatability, MatchesAnExampleWorkedByHand) {
  const Deviations deviations{{{1, 2, 3}, {-1, -1, -1}}, {{0, 0, 0}, {-2, 0, 2}}};
  const Repeatability result = repeatability_of(deviations);
  ASSERT_EQ(result.targets.size(), 2U);
  expect_near(result.targets[0],
              {.mean_positive = 2,
               .mean_negative = -1,
               .mean = 0.5,
               .reversal = 3,
               .uncertainty_positive = 1,
               .uncertainty_negative = 0,
               .repeatability_positive = 4,
               .repeatability_negative = 0,
               .repeatability = 5},  // 2·1 + 2·0 + 3
              target_fields(), 0.0);
  expect_near(result.targets[1],
              {.mean_positive = 0,
               .mean_negative = 0,
               .mean = 0,
               .reversal = 0,
               .uncertainty_positive = 0,
               .uncertainty_negative = 2,
               .repeatability_positive = 0,
               .repeatability_negative = 8,
               .repeatability = 8},  // that of one direction alone
              target_fields(), 0.0);
  expect_near(result.axis,
              {.reversal = 3,
               .mean_reversal = 1.5,
               .repeatability_positive = 4,
               .repeatability_negative = 8,
               .repeatability = 8,
               .systematic_positive = 2,
               .systematic_negative = 1,
               .systematic = 3,
               .mean_bidirectional = 0.5,
               .accuracy_positive = 4,
               .accuracy_negative = 8,
               .accuracy = 8},  // from 0 − 2·2 to 2 + 2·1 and 0 + 2·2
              axis_fields(), 0.0);
}

// A published test of a linear axis, m = 5, n = 5: Paul Scherrer Institute, repository ecmccfg,
// examples/test/fat_sat/report.md (8 December 2023); here in units of 1e-8 mm, to which it is rounded. Its
// bidirectional R and E are left out: R is stated there as the larger of R↑ and R↓, which is not 3.22, and E
// as E↑.
TEST(Repeatability, MatchesAPublishedTest) {
  const Deviations deviations{
      {{-8102, -10202, -8702, -9202, -10002}, {-9902, -9402, -8202, -9102, -9402}},
      {{-8702, -9702, -9702, -9502, -8202}, {-10302, -10402, -9502, -11102, -9302}},
      {{-7202, -9002, -8802, -8702, -8702}, {-8602, -10202, -9102, -7602, -9902}},
      {{-10202, -8602, -8602, -9302, -7802}, {-7202, -9202, -9502, -10302, -8102}},
      {{-10002, -11202, -12902, -10902, -9702}, {-10402, -12602, -13002, -14102, -10702}}};
  const Repeatability result = repeatability_of(deviations);
  const std::vector<TargetRepeatability> published{
      {-9242, -9202, -9222, -40, 879, 628, 3517, 2514, 3517},
      {-9162, -10122, -9642, 960, 677, 729, 2707, 2918, 3772},
      {-8482, -9082, -8782, 600, 726, 1043, 2904, 4170, 4170},
      {-8902, -8862, -8882, -40, 900, 1218, 3600, 4871, 4871},
      {-10942, -12162, -11552, 1220, 1258, 1573, 5033, 6290, 6882}};
  constexpr double rounding = 0.5 + 1e-6;
  for (std::size_t i = 0; i < published.size(); ++i) {
    SCOPED_TRACE(i);
    expect_near(result.targets[i], published[i], target_fields(), rounding);
  }
  EXPECT_NEAR(result.axis.reversal, 1220, rounding);
  EXPECT_NEAR(result.axis.mean_reversal, 540, rounding);
  EXPECT_NEAR(result.axis.repeatability_positive, 5033, rounding);
  EXPECT_NEAR(result.axis.repeatability_negative, 6290, rounding);
  EXPECT_NEAR(result.axis.systematic_positive, 2460, rounding);
  EXPECT_NEAR(result.axis.systematic_negative, 3300, rounding);
  EXPECT_NEAR(result.axis.mean_bidirectional, 2770, rounding);
  EXPECT_NEAR(result.axis.accuracy_positive, 6428, rounding);
  EXPECT_NEAR(result.axis.accuracy_negative, 8881, rounding);
  EXPECT_NEAR(result.axis.accuracy, 8881, rounding);
}

nlohmann::json as_json(const Deviations& deviations) {
  nlohmann::json json = nlohmann::json::array();
  for (const TargetDeviations& target : deviations) json.push_back({target.positive, target.negative});
  return json;
}

// The judge works with intervals: Ri is the length of what the bands x̄ ± 2s of both directions cover.
TEST(Repeatability, AgreesWithANumPyJudgeThatUsesIntervals) {
  std::vector<Deviations> runs;
  for_random_runs([&](const Deviations& deviations) { runs.push_back(deviations); });
  nlohmann::json input = nlohmann::json::array();
  for (const Deviations& run : runs) input.push_back(as_json(run));
  const testing::TemporaryFolder folder;
  folder.write("runs.json", input.dump());
  const std::string command =
      fmt::format("{} {} runs {} > {}", ZEROCOUNT_PYTHON, ZEROCOUNT_REPEATABILITY_JUDGE,
                  (folder / "runs.json").string(), (folder / "values.json").string());
  ASSERT_EQ(std::system(command.c_str()), 0);
  const nlohmann::json judged = nlohmann::json::parse(folder.read("values.json"));
  ASSERT_EQ(judged.size(), runs.size());
  for (std::size_t run = 0; run < runs.size(); ++run) {
    const Repeatability result = repeatability_of(runs[run]);
    for (const auto& field : axis_fields()) {
      EXPECT_NEAR(result.axis.*field.value, judged[run]["axis"][std::string(field.name)].get<double>(),
                  1e-12);
    }
    for (std::size_t target = 0; target < result.targets.size(); ++target) {
      for (const auto& field : target_fields()) {
        EXPECT_NEAR(result.targets[target].*field.value,
                    judged[run]["targets"][target][std::string(field.name)].get<double>(), 1e-12);
      }
    }
  }
}

TEST(Repeatability, AConstantOffsetShiftsOnlyTheMeans) {
  for_random_runs([](const Deviations& deviations) {
    const Repeatability before = repeatability_of(deviations);
    const Repeatability after = repeatability_of(transformed(deviations, [](double x) { return x + 17.25; }));
    expect_near(after.axis, before.axis, axis_fields(), 1e-11);
    for (std::size_t i = 0; i < before.targets.size(); ++i) {
      TargetRepeatability expected = before.targets[i];
      expected.mean_positive += 17.25;
      expected.mean_negative += 17.25;
      expected.mean += 17.25;
      expect_near(after.targets[i], expected, target_fields(), 1e-11);
    }
  });
}

TEST(Repeatability, AnOffsetPerTargetChangesNeitherRepeatabilityNorReversal) {
  for_random_runs([](const Deviations& deviations) {
    Deviations shifted = deviations;
    for (std::size_t i = 0; i < shifted.size(); ++i) {
      for (double& x : shifted[i].positive) x += static_cast<double>(i * i);
      for (double& x : shifted[i].negative) x += static_cast<double>(i * i);
    }
    const AxisRepeatability before = repeatability_of(deviations).axis;
    AxisRepeatability after = repeatability_of(shifted).axis;
    for (const auto member :
         {&AxisRepeatability::reversal, &AxisRepeatability::mean_reversal, &AxisRepeatability::repeatability,
          &AxisRepeatability::repeatability_positive, &AxisRepeatability::repeatability_negative}) {
      EXPECT_NEAR(after.*member, before.*member, 1e-11);
    }
  });
}

TEST(Repeatability, ScalesWithTheUnitOfTheDeviations) {
  for_random_runs([](const Deviations& deviations) {
    const Repeatability before = repeatability_of(deviations);
    const Repeatability after = repeatability_of(transformed(deviations, [](double x) { return 8.0 * x; }));
    for (const auto& field : axis_fields())
      EXPECT_EQ(after.axis.*field.value, 8.0 * before.axis.*field.value) << field.name;
    for (std::size_t i = 0; i < before.targets.size(); ++i) {
      for (const auto& field : target_fields())
        EXPECT_EQ(after.targets[i].*field.value, 8.0 * before.targets[i].*field.value) << field.name;
    }
  });
}

/// The results of the axis after its direction is reversed or its deviations are mirrored.
AxisRepeatability with_sides_exchanged(AxisRepeatability axis) {
  std::swap(axis.repeatability_positive, axis.repeatability_negative);
  std::swap(axis.systematic_positive, axis.systematic_negative);
  std::swap(axis.accuracy_positive, axis.accuracy_negative);
  return axis;
}

TEST(Repeatability, ExchangingTheDirectionsNegatesTheReversals) {
  for_random_runs([](const Deviations& deviations) {
    Deviations exchanged = deviations;
    for (TargetDeviations& target : exchanged) std::swap(target.positive, target.negative);
    const Repeatability before = repeatability_of(deviations);
    const Repeatability after = repeatability_of(exchanged);
    AxisRepeatability expected = with_sides_exchanged(before.axis);
    expected.mean_reversal = -expected.mean_reversal;
    expect_near(after.axis, expected, axis_fields(), 0.0);
    for (std::size_t i = 0; i < before.targets.size(); ++i) {
      EXPECT_EQ(after.targets[i].reversal, -before.targets[i].reversal);
      EXPECT_EQ(after.targets[i].repeatability, before.targets[i].repeatability);
    }
  });
}

TEST(Repeatability, MirroringTheDeviationsNegatesOnlyTheMeans) {
  for_random_runs([](const Deviations& deviations) {
    AxisRepeatability expected = repeatability_of(deviations).axis;
    expected.mean_reversal = -expected.mean_reversal;
    const auto mirrored = repeatability_of(transformed(deviations, [](double x) { return -x; }));
    expect_near(mirrored.axis, expected, axis_fields(), 0.0);
  });
}

TEST(Repeatability, DoesNotDependOnTheOrderOfTargetsAndCycles) {
  std::mt19937_64 random(5);
  for_random_runs([&random](const Deviations& deviations) {
    Deviations shuffled = deviations;
    std::shuffle(shuffled.begin(), shuffled.end(), random);
    for (TargetDeviations& target : shuffled) {
      std::shuffle(target.positive.begin(), target.positive.end(), random);
      std::shuffle(target.negative.begin(), target.negative.end(), random);
    }
    expect_near(repeatability_of(shuffled).axis, repeatability_of(deviations).axis, axis_fields());
  });
}

// All of these follow from the formulas. With Ui the union of the bands x̄i ± 2·si of both directions, Ri is
// the length of the interval that Ui spans, and A that of all of them: so A ≥ R.
TEST(Repeatability, ValuesSatisfyTheInequalitiesOfTheStandard) {
  for_random_runs([](const Deviations& deviations) {
    const Repeatability result = repeatability_of(deviations);
    const AxisRepeatability& a = result.axis;
    constexpr double rounding = 1e-12;
    const auto expect_at_least = [](double larger, double smaller) { EXPECT_GE(larger, smaller - rounding); };
    const double unidirectional = std::max(a.repeatability_positive, a.repeatability_negative);
    expect_at_least(a.repeatability, unidirectional);
    expect_at_least(a.repeatability, a.reversal);
    expect_at_least(unidirectional + a.reversal, a.repeatability);
    expect_at_least(a.reversal, std::abs(a.mean_reversal));
    expect_at_least(a.systematic, std::max(a.systematic_positive, a.systematic_negative));
    expect_at_least(a.systematic, a.reversal);
    expect_at_least(a.systematic, a.mean_bidirectional);
    expect_at_least(a.accuracy, std::max(a.accuracy_positive, a.accuracy_negative));
    expect_at_least(a.accuracy, a.systematic);
    expect_at_least(a.accuracy, a.repeatability);
    expect_at_least(a.systematic + unidirectional, a.accuracy);
    expect_at_least(a.accuracy_positive, std::max(a.systematic_positive, a.repeatability_positive));
    expect_at_least(a.accuracy_negative, std::max(a.systematic_negative, a.repeatability_negative));
    for (const TargetRepeatability& t : result.targets) {
      expect_at_least(t.repeatability, std::max(t.repeatability_positive, t.repeatability_negative));
      expect_at_least(t.repeatability, std::abs(t.reversal));
    }
  });
}

TEST(Repeatability, WithOneTargetTheSystematicDeviationIsTheReversal) {
  std::mt19937_64 random(1);
  const Repeatability result = repeatability_of(random_deviations(random, 1, 5));
  const AxisRepeatability& axis = result.axis;
  EXPECT_EQ(axis.systematic_positive, 0.0);
  EXPECT_EQ(axis.systematic_negative, 0.0);
  EXPECT_EQ(axis.mean_bidirectional, 0.0);
  EXPECT_EQ(axis.systematic, std::abs(result.targets[0].reversal));
  EXPECT_EQ(axis.mean_reversal, result.targets[0].reversal);
  EXPECT_DOUBLE_EQ(axis.accuracy, axis.repeatability);
  EXPECT_DOUBLE_EQ(axis.accuracy_positive, axis.repeatability_positive);
}

TEST(Repeatability, WithTwoCyclesFollowsFromTheirDifference) {
  const TargetRepeatability target = repeatability_of(Deviations{{{3, 7}, {1, 1}}}).targets[0];
  EXPECT_DOUBLE_EQ(target.uncertainty_positive, 4.0 / std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(target.repeatability_positive, 16.0 / std::sqrt(2.0));
  EXPECT_EQ(target.uncertainty_negative, 0.0);
}

TEST(Repeatability, WithOneCycleOnlyDeviationsAndReversalsAreDefined) {
  const Repeatability result = repeatability_of(Deviations{{{3}, {1}}, {{-2}, {5}}});
  const AxisRepeatability& axis = result.axis;
  EXPECT_EQ(axis.reversal, 7.0);
  EXPECT_EQ(axis.mean_reversal, -2.5);
  EXPECT_EQ(axis.systematic_positive, 5.0);
  EXPECT_EQ(axis.systematic, 7.0);
  EXPECT_EQ(axis.mean_bidirectional, 0.5);
  for (const double value : {axis.repeatability, axis.repeatability_positive, axis.repeatability_negative,
                             axis.accuracy, axis.accuracy_positive, axis.accuracy_negative}) {
    EXPECT_TRUE(std::isnan(value));
  }
}

TEST(Repeatability, WithOneDirectionOnlyItsUnidirectionalValuesAreDefined) {
  for_random_runs([](const Deviations& deviations) {
    Deviations below = deviations;
    for (TargetDeviations& target : below) target.negative.clear();
    const AxisRepeatability both = repeatability_of(deviations).axis;
    const AxisRepeatability expected{.repeatability_positive = both.repeatability_positive,
                                     .systematic_positive = both.systematic_positive,
                                     .accuracy_positive = both.accuracy_positive};
    expect_near(repeatability_of(below).axis, expected, axis_fields(), 0.0);
    for (TargetDeviations& target : below) std::swap(target.positive, target.negative);
    expect_near(repeatability_of(below).axis, with_sides_exchanged(expected), axis_fields(), 0.0);
  });
}

TEST(Repeatability, EqualCountsGiveExactlyZero) {
  // Thirds and sevenths have no finite binary fraction: sums of them would not do.
  for (const std::size_t cycles : {2U, 3U, 5U, 7U, 11U}) {
    for (const double count : {0.0, 1.0, -3.0, 405007.0}) {
      const std::vector<double> same(cycles, count);
      const AxisRepeatability axis = repeatability_of(Deviations{{same, same}, {same, same}}).axis;
      EXPECT_EQ(axis.repeatability, 0.0);
      EXPECT_EQ(axis.accuracy, 0.0);
    }
  }
}

TEST(Repeatability, WithoutTargetsIsUndefined) {
  const Repeatability result = repeatability_of({});
  EXPECT_TRUE(result.targets.empty());
  for (const auto& field : axis_fields()) EXPECT_TRUE(std::isnan(result.axis.*field.value)) << field.name;
}

}  // namespace
}  // namespace zerocount::iso230
