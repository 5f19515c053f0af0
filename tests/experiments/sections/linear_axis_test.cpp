// A linear axis: its keys, its units, and that it is its rotary twin bit for bit.
#include "core/loop/encoder.hpp"
#include "core/trial/trial.hpp"
#include "experiments/study/study_trial.hpp"
#include "tests/experiments/manifest_texts.hpp"

namespace zerocount::sections {
namespace {

/// Manifest lines with all keys that have no default on a linear axis.
const std::string stage =
    "axis: linear\n"
    "plant: {inertia: 5, presliding_damping: 1500, sliding_damping: 50}\n"
    "friction: {k1: 1.0e+5, k2: 2.0e+7, beta: 2.0e+6, lambda: 1.0e+8, breakaway: 12, stribeck_velocity: "
    "1.0e-3}\n"
    "dac: {bits: 20, resolution: 5.0e-5}\n";

std::string stage_with(const std::string& more) {
  return minimal_manifest(stage + more);
}

TEST(LinearAxis, HasLinearUnitsAndALengthPerCount) {
  const study::Study study =
      study_of(stage_with("encoder: {resolution: {choice: [1.0e-9, 2.0e-9]}}\n"
                          "controller: {kp: {uniform: [0, 1]}, ki: 1.0e-4}\n"
                          "sweep: {grid: {friction.k2: [1.0e+7, 2.0e+7]}}\n"));
  EXPECT_EQ(study.units.axis, parameters::AxisKind::linear);
  EXPECT_EQ(study.points.axes[0].unit, "N/m");
  EXPECT_EQ(study.columns.inputs[column_of(study, "controller.kp")].unit, "N/count");
  EXPECT_EQ(study.columns.inputs[column_of(study, "encoder.resolution")].unit, "m/count");
  const study::StudyTrial trial = study::study_trial(study, 0, 0);
  const double resolution = trial.inputs[column_of(study, "encoder.resolution")];
  EXPECT_EQ(loop::fine_resolution(trial.parameters.encoder), resolution);
  EXPECT_EQ(loop::coarse_resolution(trial.parameters.encoder), resolution)
      << "left out, that of the fine one";
  EXPECT_EQ(loop::fine_per_coarse(trial.parameters.encoder), 1.0);
}

TEST(LinearAxis, MustGiveTheKeysWhoseDefaultsHaveRotaryUnits) {
  const std::string refusal = refusal_of(minimal_manifest("axis: linear\ncontroller: {units: si}\n"));
  EXPECT_TRUE(says(refusal,
                   "plant.inertia: the key is missing, and its default, 0.000554 kg m^2, has another unit; "
                   "expected its value in kg",
                   "friction.lambda: the key is missing, and its default, 10 (N m)^n/rad, has another unit; "
                   "expected its value in N^n/m",
                   "encoder.resolution: the key is missing; expected its value in m/count",
                   "controller.ki: the key is missing, and its default, 3.85e-05 N m/count, has another "
                   "unit; expected its value in N/(m s)"));
  EXPECT_FALSE(says(refusal, "coarse")) << "without effect: " << refusal;
  EXPECT_FALSE(says(refusal, "profile")) << "without effect: " << refusal;
  EXPECT_EQ(refusal_of(minimal_manifest("axis: linear\nfriction: {model: none}\n"
                                        "plant: {inertia: 1, presliding_damping: 0}\n"
                                        "encoder: {resolution: 1.0e-9}\ndac: {resolution: 1.0e-4}\n"
                                        "controller: {units: si, ki: 1, kp: 1}\n")),
            "")
      << "an air bearing needs no friction";
}

TEST(LinearAxis, HasNoDefaultElementsOfGms) {
  const std::string refusal = refusal_of(
      minimal_manifest("axis: linear\nfriction: {model: gms, gms: {attraction: 100}, breakaway: 5}\n"
                       "plant: {inertia: 1, sliding_damping: 1}\nencoder: {resolution: 1.0e-9}\n"
                       "dac: {resolution: 1.0e-4}\ncontroller: {units: si, ki: 1, kp: 1}\n"));
  EXPECT_TRUE(says(refusal,
                   "friction.model: gms has no default elements on a linear axis; expected the lists "
                   "friction.gms.stiffness, N/m, and friction.gms.weight"));
}

struct Refused {
  std::string more;
  std::string message;  ///< a part of the message with which the manifest is refused
};

TEST(LinearAxis, KeysOfTheOtherKindOfAxisAreRefused) {
  const std::string loop = "controller: {ki: 1.0e-4}\n";
  const std::vector<Refused> cases{
      {stage_with(loop + "encoder: {resolution: 1.0e-9, fine: 1000}\n"),
       "encoder.fine: not available on a linear axis; expected encoder.resolution, m per count"},
      {stage_with(loop + "encoder: {resolution: 1.0e-9, fine_errors: {eccentricity: 1}}\n"),
       "not available on a linear axis; expected the key left out"},
      {stage_with(loop + "sweep: {grid: {encoder.fine: [1, 2]}}\nencoder: {resolution: 1.0e-9}\n"),
       "not available on a linear axis"},
      {minimal_manifest("encoder: {resolution: 1.0e-9}\n"),
       "encoder.resolution: not available on a rotary axis; expected encoder.fine, counts per revolution"},
      {minimal_manifest("travel: 0.1\n"), "travel: a rotary axis has no travel"},
      {minimal_manifest("axis: linaer\n"), "axis: unknown value 'linaer'"},
      {stage_with(loop + "encoder: {resolution: 1.0e-9, coarse_errors: {noise: 1}}\n"),
       "encoder.coarse_resolution: the key is missing; expected its value in m/count"},
      {stage_with("controller: {ki: 1.0e-4, encoder: coarse}\nencoder: {resolution: 1.0e-9}\n"),
       "encoder.coarse_resolution: the key is missing"},
      {stage_with(loop + "encoder: {resolution: 1.0e-9}\ninitial: {preload: 13}\n"),
       "a preload of 13 N can reach the breakaway of 12 N"},
  };
  for (const Refused& refused : cases) {
    EXPECT_TRUE(says(refusal_of(refused.more), refused.message)) << refused.message << "\n"
                                                                 << refusal_of(refused.more);
  }
}

TEST(LinearAxis, ProfilesHaveThePeriodOfTheTravel) {
  const std::string loop = "controller: {ki: 1.0e-4}\nencoder: {resolution: 1.0e-9}\n";
  const std::string profile = "{profile: {mean: 2.0e+7, cv: 0.1, correlation_length: 0.01}}";
  const auto refusal = [&](const std::string& more) {
    return refusal_of(stage_with(loop + more), {"friction.k2=" + profile});
  };
  EXPECT_TRUE(says(refusal(""), "the profile of a linear axis needs the key travel"));
  EXPECT_TRUE(says(refusal("travel: 0.005\n"), "'0.01' is out of range"))
      << "a correlation length beyond the travel";
  const study::Study study = study_of(stage_with(loop + "travel: 0.2\n"), {"friction.k2=" + profile});
  ASSERT_EQ(study.profiles.size(), 1u);
  EXPECT_EQ(study.profiles[0].unit, "N/m");
  EXPECT_EQ(study.period, 0.2);
  const friction::Profile& k2 = *study.profiles[0].profile;
  EXPECT_NE(friction::value_at(k2, 0.05), friction::value_at(k2, 0.1));
  EXPECT_NEAR(friction::value_at(k2, 0.05), friction::value_at(k2, 0.25),
              1e-12 * friction::value_at(k2, 0.05));
  EXPECT_TRUE(has_faults(study_of(stage_with(loop + "travel: «0.2»\n")).warnings, "«»: travel | no effect"));
}

std::vector<trial::SampleRecord> records_of(const trial::TrialParameters& parameters,
                                            trial::TrialOutcome& outcome) {
  std::vector<trial::SampleRecord> records;
  trial::TrialObservers observers;
  observers.sample = [&records](const trial::SampleRecord& record) { records.push_back(record); };
  outcome = trial::run_trial(parameters, observers);
  return records;
}

/// The study of a shipped linear stage converted to a rotary axis: the same numbers, in counts of a
/// revolution.
study::Study rotary_twin(const std::string& linear, std::int64_t counts) {
  std::string text;
  for (std::size_t at = 0; at < linear.size();) {
    const std::size_t end = linear.find('\n', at);
    const std::string line = linear.substr(at, end - at);
    at = end + 1;
    if (line.rfind("axis:", 0) == 0 || line.rfind("travel:", 0) == 0) continue;
    text += line.rfind("encoder:", 0) == 0 ? fmt::format("encoder: {{fine: {0}, coarse: {0}}}\n", counts)
                                           : line + "\n";
  }
  return study_of(text);
}

TEST(LinearAxis, EqualsAnEquivalentRotaryAxisBitForBit) {
  const std::int64_t counts = 6283185307;  // so that a count is about the nanometre of the stage
  const double resolution = 2.0 * std::numbers::pi / static_cast<double>(counts);
  const study::Study linear = manifest::load_study(
      std::filesystem::path(ZEROCOUNT_MANIFESTS) / "linear-stage.yaml",
      {fmt::format("encoder.resolution={}", resolution), fmt::format("travel={}", 2.0 * std::numbers::pi)});
  const study::Study rotary = rotary_twin(linear.manifest.text, counts);
  ASSERT_EQ(study::point_count(linear), study::point_count(rotary));
  std::int64_t compared = 0;
  for (std::int64_t point = 0; point < study::point_count(linear); ++point) {
    for (std::int64_t index = 0; index < 4; ++index) {
      const study::StudyTrial of_linear = study::study_trial(linear, point, index);
      const study::StudyTrial of_rotary = study::study_trial(rotary, point, index);
      ASSERT_EQ(of_linear.inputs, of_rotary.inputs);
      trial::TrialOutcome linear_outcome, rotary_outcome;
      const std::vector<trial::SampleRecord> a = records_of(of_linear.parameters, linear_outcome);
      const std::vector<trial::SampleRecord> b = records_of(of_rotary.parameters, rotary_outcome);
      ASSERT_EQ(a.size(), b.size());
      for (std::size_t k = 0; k < a.size(); ++k, ++compared) {
        ASSERT_EQ(a[k].theta, b[k].theta) << "point " << point << " trial " << index << " sample " << k;
        ASSERT_EQ(a[k].omega, b[k].omega);
        ASSERT_EQ(a[k].xp, b[k].xp);
        ASSERT_EQ(a[k].count, b[k].count);
        ASSERT_EQ(a[k].coarse_count, b[k].coarse_count);
        ASSERT_EQ(a[k].code, b[k].code);
        ASSERT_EQ(a[k].depth, b[k].depth);
      }
      EXPECT_EQ(linear_outcome.moves[0].outcome, rotary_outcome.moves[0].outcome);
      EXPECT_EQ(linear_outcome.moves[0].jerk_count, rotary_outcome.moves[0].jerk_count);
    }
  }
  EXPECT_GT(compared, 10000);
}

}  // namespace
}  // namespace zerocount::sections
