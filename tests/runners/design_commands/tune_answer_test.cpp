// The sentences of an answer of `tune`, with numbers that are infinite, missing or not reached.
#include "runners/design_commands/tune/tune_answer.hpp"

#include <nlohmann/json.hpp>

#include "experiments/manifest/load_study.hpp"
#include "runners/tuning/effects/effects.hpp"
#include "tests/support/test.hpp"

namespace zerocount::design_commands {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

using tuning::NearestPoint;
using tuning::Proof;
using tuning::SmallestMargins;
using tuning::TuneAnswer;

constexpr double never = std::numeric_limits<double>::infinity();

study::Study axis() {
  return manifest::parse_study(R"(zerocount: 1
name: axis
seed: 1
trials: 10
command: {targets: [9], hold: 0.1}
controller: {ki: 2.0e-5}
goal: {band: 1, within: 0.05, moves: 0.9}
tune: {free: {controller.ki: {log: [1.0e-5, 1.0e-4]}, controller.kp: [0, 1.0e-3]}, margins: {delay: off}}
)",
                               "axis.yaml");
}

TuneAnswer answer_for(const study::Study& study, goal::Status status) {
  TuneAnswer answer;
  answer.status = status;
  answer.free = study.tuning->free;
  answer.tuned.values = {2e-5, 0.0};
  answer.proof = Proof{study, {}, {}, 1};
  answer.proof->verdict.moves = {0.853, 0.82, 0.88};
  answer.proof->criterion = never;
  answer.proof->late_limit = never;
  return answer;
}

std::string text_of(const TuneAnswer& answer, const study::Study& study) {
  return document::text(tune_answer().of({answer, study, "tuned.h5"}));
}

nlohmann::ordered_json json_of(const TuneAnswer& answer, const study::Study& study) {
  return document::json(tune_answer().of({answer, study, "tuned.h5"}));
}

TEST(TuneAnswer, AnUnreachedTimeIsStatedInASentence) {
  const study::Study study = axis();
  const std::string text = text_of(answer_for(study, goal::Status::missed), study);
  EXPECT_THAT(text, HasSubstr("band_settling_time.p95 (s): not within the hold\n"));
  EXPECT_THAT(text, HasSubstr("time until 90 % of the moves stay within the band: not within the hold\n"));
  for (const char* const hole : {"hold s", "inf", "nan", "–"}) EXPECT_THAT(text, Not(HasSubstr(hole)));
}

TEST(TuneAnswer, AnUnreachableGoalIsReportedWithItsShortfall) {
  const study::Study study = axis();
  EXPECT_EQ(
      json_of(answer_for(study, goal::Status::missed), study)["headline"],
      "unreachable in these ranges: at the best values found, controller.ki = 2e-05, controller.kp = 0, "
      "85.3 % of the moves meet the goal, and at least 90 % are wanted");
}

TEST(TuneAnswer, NamesEachMarginWithUnitAndRequirement) {
  const study::Study study = axis();
  TuneAnswer answer = answer_for(study, goal::Status::met);
  answer.tuned.margins =
      SmallestMargins{.gain = {never}, .phase = {41.0}, .delay = {10.0}, .sensitivity = {1.5}, .machines = 8};
  answer.tuned.margins->spread = study::typical_spread;
  answer.tuned.margins->before_sliding = true;
  const std::string text = text_of(answer, study);
  for (const char* const part :
       {"∞ dB (at least 6 wanted)", "41 degrees (at least 30 wanted)", "10 samples or more (none wanted)",
        "1.5 (none wanted)",
        "of 8 machines of the search before they slide, at ±10 % of inertia, at ±30 % of damping, at ±5 % of "
        "torque constant\n"})
    EXPECT_THAT(text, HasSubstr(part));
}

TEST(TuneAnswer, NamesTheMarginsThatTheNearestPointMisses) {
  const study::Study study = axis();
  TuneAnswer answer;
  answer.status = goal::Status::missed;
  answer.free = study.tuning->free;
  answer.searched.examined = 4000;
  answer.unfound.nearest =
      NearestPoint{{3e-5, 1e-4}, {.gain = {4.5}, .phase = {41.0}, .delay = {2.0}, .machines = 8}};
  const std::string text = text_of(answer, study);
  EXPECT_THAT(text, HasSubstr("none of 4000 points that were tried keeps the margins\n"));
  EXPECT_THAT(text, HasSubstr("controller.ki = 3e-05, controller.kp = 0.0001\n"));
  EXPECT_THAT(text, HasSubstr("4.5 dB\n"));
  const nlohmann::ordered_json json = json_of(answer, study);
  EXPECT_EQ(json["nearest"]["lacking"], (nlohmann::ordered_json{{"gain", 1.5}}));
  answer.unfound.nearest->margins.stable = false;
  EXPECT_THAT(text_of(answer, study), HasSubstr("unstable at all of them; at the nearest by 4.5 dB of gain"));
}

TEST(TuneAnswer, NamesTheExtrasThatTheBudgetLeftOut) {
  const study::Study study = axis();
  TuneAnswer answer = answer_for(study, goal::Status::met);
  answer.budget.trials = 900;
  answer.spent_trials = 880;
  answer.extras.left_out = {{"room", "room"}, {"limits", "limits"}};
  const std::string text = text_of(answer, study);
  EXPECT_THAT(text, HasSubstr("880 of 900 trials"));
  EXPECT_THAT(text, HasSubstr("left out, because the budget is not enough: room, limits; zerocount tune "
                              "tuned.h5 --extras room,limits makes them\n"));
  answer.interrupted = true;
  EXPECT_THAT(text_of(answer, study),
              HasSubstr("left out: room, limits; the same command goes on with them\n"));
  EXPECT_EQ(json_of(answer, study)["left_out"], (nlohmann::ordered_json{"room", "limits"}));
}

TEST(TuneAnswer, SaysHowManyMovesOneMachineWouldNeed) {
  const study::Study study = manifest::parse_study(R"(zerocount: 1
name: axis
seed: 1
machines: 10
trials: 400
command: {targets: [9, 0], hold: 0.1}
conditions: {empty: {}, loaded: {plant.inertia: 8.0e-4}}
goal: {on: [0], band: 1, within: 0.05, moves: 0.9, machines: 0.8}
tune: {free: {controller.ki: {log: [1.0e-5, 1.0e-4]}, controller.kp: [0, 1.0e-3]}}
)",
                                                   "axis.yaml");
  TuneAnswer answer = answer_for(study, goal::Status::undecided);
  EXPECT_THAT(
      text_of(answer, study),
      HasSubstr("\n20 moves cannot show that one machine meets it in 90 % of its moves: 29 without a miss "
                "can; a machine just below that has no miss in as few with a probability of 12.2 %\n"));
}

/// A made-up verdict on each of two goals under each of two conditions. The worst one is the second goal
/// under the second condition.
goal::Verdict verdict_on_claims() {
  goal::Verdict whole;
  for (std::size_t goal = 0; goal < 2; ++goal) {
    for (std::size_t condition = 0; condition < 2; ++condition) {
      goal::ClaimVerdict& one = whole.claims.emplace_back();
      one.status = goal::Status::met;
      one.moves.value = 0.99 - 0.02 * static_cast<double>(goal) - 0.01 * static_cast<double>(condition);
      one.goal = goal;
      one.setting = condition;
    }
  }
  static_cast<goal::ClaimVerdict&>(whole) = whole.claims.back();
  return whole;
}

TEST(TuneAnswer, NamesTheGoalAndConditionWithTheSmallestMargin) {
  const study::Study study = manifest::parse_study(R"(zerocount: 1
name: axis
seed: 1
trials: 10
command: {targets: [9, 0], hold: 0.1}
conditions: {empty: {}, loaded: {plant.inertia: 8.0e-4}}
controller: {ki: 2.0e-5}
goals: {large: {on: [0], band: 1, within: 0.05, moves: 0.9}, small: {on: [1], band: 1, within: 0.02, moves: 0.9}}
tune: {free: {controller.ki: {log: [1.0e-5, 1.0e-4]}, controller.kp: [0, 1.0e-3]}}
)",
                                                   "axis.yaml");
  TuneAnswer answer = answer_for(study, goal::Status::met);
  answer.proof->verdict = verdict_on_claims();
  answer.proof->criterion = 0.7;
  answer.extras.found = {MoreDelay{.delays = {1.0, 1.25}, .lost = 0.5, .claim = 1},
                         std::vector{Room{"controller.ki", 1e-5, 2e-5, std::nullopt, 3}}};
  const nlohmann::ordered_json json = json_of(answer, study);
  EXPECT_EQ(
      json["headline"],
      "met: all goals are met by controller.ki = 2e-05, controller.kp = 0, least 'small' under condition "
      "loaded");
  EXPECT_EQ(json["delay_lost"], 1.75);
  EXPECT_EQ(json["delay_lost_condition"], "loaded");
  EXPECT_EQ(json["proof"]["goal"], "small");
  EXPECT_EQ(json["proof"]["condition"], "loaded");
  EXPECT_EQ(json["proof"]["rate"], 0.96);
  const std::string text = text_of(answer, study);
  EXPECT_THAT(text,
              HasSubstr("of the time that its goal allows, the largest of all goals and conditions: 0.7\n"));
  EXPECT_THAT(text, HasSubstr("with 0.5 samples more of controller.delay, at 1.75, the goal 'large' under "
                              "condition loaded seems lost\n"));
  EXPECT_THAT(text, HasSubstr("'small' under condition loaded")) << "beyond the room of controller.ki";
}

// What is printed as soon as it is ready is all of the answer.
TEST(TuneAnswer, JsonHasTheProofTheExtrasAndTheEffort) {
  const study::Study study = axis();
  TuneAnswer answer = answer_for(study, goal::Status::met);
  answer.extras.found = {MoreDelay{.delays = {1.0}}, std::vector{Room{"controller.ki", 1e-5, 2e-5}},
                         std::vector{tuning::Limit{.effect = "none", .rate = 0.9}}};
  const Tuning tuning{answer, study, "tuned.h5"};
  const auto without_blank_lines = [](std::string text) {
    for (std::size_t at = 0; (at = text.find("\n\n")) != std::string::npos;) text.erase(at, 1);
    return text;
  };
  std::string parts = document::text(proven_answer().of(tuning));
  EXPECT_THAT(parts, HasSubstr("wrote tuned.h5"));
  for (const tuning::Extra& extra : all_extras()) parts += document::text(extra_answer(extra).of(tuning));
  parts += document::text(closing_answer().of(tuning));
  EXPECT_EQ(without_blank_lines(parts), without_blank_lines(document::text(tune_answer().of(tuning))));
}

/// The text that names the criterion in the answer of `tune`, for a study with this goal.
std::string criterion_text(const std::string& goals) {
  const study::Study study = manifest::parse_study(
      "zerocount: 1\nname: axis\nseed: 1\ntrials: 10\n"
      "command: {targets: [9, 0], hold: 0.1}\ncontroller: {ki: 2.0e-5}\n" +
          goals + "tune: {free: {controller.ki: {log: [1.0e-5, 1.0e-4]}, controller.kp: [0, 1.0e-3]}}\n",
      "axis.yaml");
  return text_of(answer_for(study, goal::Status::met), study);
}

TEST(TuneAnswer, NamesTheCriterionThatItMinimises) {
  const std::string band = "{'on': [0], band: 1, within: 0.05, moves: 0.9}";
  const std::string tolerance = "{'on': [1], tolerance: 1.0e-5, within: 0.05, moves: 0.9}";
  EXPECT_THAT(criterion_text("goals: {a: " + band + "}\n"), HasSubstr(" band_settling_time.p95 (s): "));
  EXPECT_THAT(criterion_text("goals: {a: " + tolerance + "}\n"),
              HasSubstr(" tolerance_settling_time.p95 (s): "));
  EXPECT_THAT(criterion_text("goals: {a: " + band + ", b: " + tolerance + "}\n"),
              HasSubstr(" goal_settling_time.p95, of the time that its goal allows, the largest"));
}

TEST(TuneAnswer, NamesTheLoopsThatHaveTheSmallestMargins) {
  const study::Study study = axis();
  TuneAnswer answer = answer_for(study, goal::Status::met);
  answer.tuned.margins = SmallestMargins{.gain = {7.0}, .phase = {41.0}, .delay = {10.0}, .machines = 8};
  answer.tuned.margins->gain.loop = tuning::CriticalLoop{"before sliding", 110.0, {}, 0};
  answer.tuned.margins->phase.loop = tuning::CriticalLoop{"while sliding", {}, 5, 0};
  EXPECT_THAT(text_of(answer, study), HasSubstr("before sliding at 110 N m/rad\n"));
  EXPECT_THAT(text_of(answer, study), HasSubstr("while sliding of machine 5\n"));
  const nlohmann::ordered_json json = json_of(answer, study);
  EXPECT_EQ(json["phase_margin_loop"]["machine"], 5);
  EXPECT_TRUE(json["delay_margin_loop"].is_null());
}

/// A made-up row of the answer about moves: 100 moves of 40 counts, with a converter of 1 N m.
summary::MoveBehaviour quiet_moves() {
  summary::MoveBehaviour row;
  row.moves = 100;
  row.overshoot = {4.0, 6.0};
  row.overshoot_length = {4e-6, 6e-6};
  row.overshoot_of_step = {0.1, 0.15};
  row.smallest_step = 40.0;
  row.range = 1.0;
  row.rest = summary::RestTorque{0.2, 0.05, 0.05};
  return row;
}

TEST(TuneAnswer, NamesImplausibleBehaviourAndItsRemedy) {
  study::Study study = axis();
  const auto remedies_of = [&](const summary::MoveBehaviour& row, double phase) {
    std::vector<std::string> remedies;
    for (const tuning::Refusal& one : tuning::refusals_of(
             {row}, SmallestMargins{.gain = {9.0}, .phase = {phase}, .delay = {2.0}, .machines = 8}, study))
      remedies.push_back(one.remedy);
    return remedies;
  };
  using Texts = std::vector<std::string>;
  EXPECT_EQ(remedies_of(quiet_moves(), 30.0), Texts({}));
  EXPECT_EQ(remedies_of(quiet_moves(), 29.9), Texts({"tune: {margins: {phase: 30}}"}));
  summary::MoveBehaviour row = quiet_moves();
  row.overshoot_of_step.p95 = 0.26;
  EXPECT_EQ(remedies_of(row, 41.0), Texts({"limits: {overshoot: 10}"}));
  study.goals.front().of_other_mass = true;  // no reading is of it
  EXPECT_EQ(remedies_of(row, 41.0), Texts({"limits: {true_overshoot: 1e-05}"}));
  study.goals.front().of_other_mass = false;
  row.overshoot = {1.0, 1.0};  // within the goal's band of 1 count
  EXPECT_EQ(remedies_of(row, 41.0), Texts({}));
  row.saturated = 0.02;
  EXPECT_EQ(remedies_of(row, 41.0), Texts({"limits: {peak_torque: 0.95}"}));
  row.rest->of_range = 0.11;
  EXPECT_EQ(remedies_of(row, 41.0),
            Texts({"limits: {peak_torque: 0.95}",
                   "limits: {rest_torque_noise: 0.01}, with verdict: {motion: true}"}));
  TuneAnswer answer = answer_for(study, goal::Status::met);
  answer.proof->moves = {row};
  for (const char* const part : {"a drive engineer would refuse this",
                                 "the converter clips in 2 % of the moves", "limits: {peak_torque: 0.95}"})
    EXPECT_THAT(text_of(answer, study), HasSubstr(part));
  EXPECT_EQ(json_of(answer, study)["refusals"][0]["finding"], "saturation");
  EXPECT_THAT(sanity_line({answer, study, "tuned.h5"}),
              HasSubstr("before the proof: a drive engineer would refuse"));
}

TEST(TuneAnswer, IsUndecidedIfAnotherFinalistMayMeetTheGoal) {
  const study::Study study = axis();
  TuneAnswer answer = answer_for(study, goal::Status::undecided);
  answer.proof->verdict.status = goal::Status::missed;
  answer.searched.landscape = {.points = 100, .telling = 100, .varies = true};
  EXPECT_THAT(text_of(answer, study),
              HasSubstr("undecided: not all values that may meet the goal were tried"));
  answer.searched.landscape.telling = 4;
  EXPECT_THAT(text_of(answer, study),
              HasSubstr("undecided: at 96 of 100 points that were tried hardly any move meets the goal"));
}

TEST(TuneAnswer, NamesASimplerControlThatIsBetter) {
  const study::Study study = axis();
  TuneAnswer answer = answer_for(study, goal::Status::met);
  answer.proof->verdict.status = goal::Status::met;
  answer.proof->criterion = 0.02;
  goal::Verdict met;
  met.status = goal::Status::met;
  Alternative simpler{"controller.kp = 0", {{"controller.kp", 0.0}}, {{"controller.ki", 3e-5}}, met, 0.0195};
  answer.extras.found = {std::vector{simpler}};
  EXPECT_THAT(text_of(answer, study), Not(HasSubstr("to do better")));
  simpler.criterion = 0.015;
  answer.extras.found = {std::vector{simpler}};
  EXPECT_THAT(text_of(answer, study),
              HasSubstr("controller.kp = 0 seems to do better, and lies in the ranges too; "
                        "begin there: --set controller.kp=0 --set "
                        "controller.ki=3e-05"));
  simpler.fixed.clear();  // a block is added
  answer.extras.found = {std::vector{simpler}};
  EXPECT_THAT(text_of(answer, study), Not(HasSubstr("to do better")));
}

}  // namespace
}  // namespace zerocount::design_commands
