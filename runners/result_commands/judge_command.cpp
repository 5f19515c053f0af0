#include <filesystem>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "analysis/trials/goal/goal_text.hpp"
#include "analysis/trials/summary/cells_of_point.hpp"
#include "analysis/trials/summary/chosen_point.hpp"
#include "analysis/trials/summary/chosen_summary.hpp"
#include "results/shards/pieces.hpp"
#include "runners/answers/answer_format.hpp"
#include "runners/command_line/command_line.hpp"
#include "runners/commands/command.hpp"
#include "runners/commands/stage_progress.hpp"
#include "runners/result_commands/result_commands.hpp"

namespace zerocount::result_commands {
namespace {

constexpr const char* judge_help =
    "Judges the best design point of a finished study by the goal in its manifest, such as\n"
    "goal: {band: 1, within: 0.05, moves: 0.99, machines: 0.99, confidence: 0.95}: is the error\n"
    "within 1 count for good after 0.05 s, in at least 99 % of the moves of at least 99 % of the\n"
    "machines? One paragraph tells the point, the verdict, its bounds, and what would decide it.\n"
    "The bounds of the best of several points allow for its choice; --point judges a point that\n"
    "was chosen beforehand. In a study with worlds the goal must be met in each of them; the rates are\n"
    "those of the worst world, and a rule says what the bad worlds have in common. With conditions a\n"
    "table says under which of them the goal is met or missed; with ages from which age on it is missed.\n"
    "The exit code is 0 if the goal is met, 1 if it is missed, 3 if the trials do not decide it.\n"
    "\n"
    "Example: zerocount judge gains.h5\n"
    "         zerocount judge gains.h5 --point 3 --format json\n";

struct Judgement {
  const summary::StudySummary& summary;
  summary::JudgedPoint judged;
  std::optional<worlds::PointWorlds> worlds;
  /// Counts and bounds of all claims (pairs of goal and setting, a condition at an age).
  std::vector<summary::CellOfPoint> claims;
  /// [age] Counts and bounds of the claims at each age; empty without ages.
  std::vector<summary::CellOfPoint> ages;
  /// Moves of the worst goal and setting in which the converter was saturated; nothing if the goal is met.
  std::optional<summary::SaturatedMoves> saturated;

  const std::string& label() const { return summary.labels[static_cast<std::size_t>(judged.chosen.point)]; }
  const goal::JudgedCriterion& worst_goal() const { return summary.question.parts[judged.verdict.goal]; }
  std::optional<std::string> name() const {
    const std::string& of_goal = worst_goal().goal->name;
    return of_goal.empty() ? std::nullopt : std::optional(of_goal);
  }
  std::optional<std::string> setting() const {
    const study::Settings& settings = summary.question.settings;
    if (settings.empty()) return std::nullopt;
    return study::label_of(settings, static_cast<std::int64_t>(judged.verdict.setting));
  }
  /// Proportion, 0 to 1, of the moves that miss the goal in which the converter clipped; nothing if not
  /// known, or if no move misses.
  std::optional<double> missed_saturated() const {
    return saturated && saturated->missed > 0 ? std::optional(saturated->of_missed()) : std::nullopt;
  }
  std::vector<summary::CellOfPoint> several_claims() const {
    return claims.size() > 1 ? claims : std::vector<summary::CellOfPoint>();
  }
  std::optional<double> of_machines(double bound) const {
    return worst_goal().goal->machines ? std::optional(bound) : std::nullopt;
  }
  std::optional<summary::WorldsAtPoint> worlds_reading() const {
    if (!worlds) return {};
    return summary::WorldsAtPoint{*worlds, summary::world_inputs_of(summary, judged.chosen.point),
                                  summary.question};
  }
};

/// An example of a question with a claim, from which the type (schema) of the answer is made.
goal::Question any_claim() {
  goal::Question question;
  question.parts.front().goal.emplace();
  question.parts.front().goal->beside_load = true;
  return question;
}

document::AnswerDescription<Judgement> judge_answer(const goal::Question& question) {
  using document::Visibility;
  document::AnswerDescription<Judgement> answer{
      {.name = "judge", .meaning = "whether a study meets its goal", .csv_table = "claims"}, {}};
  answer.items.headline([](const Judgement& j) { return summary::judgement_headline(j.summary, j.judged); })
      .value(document::in_data("point", "number of the design point"),
             [](const Judgement& j) { return j.judged.chosen.point; })
      .value(document::in_data("label", "label of the design point"), &Judgement::label)
      .value({"goal", "goal", "the goal in words"},
             [](const Judgement& j) { return goal::claim_sentence(j.summary.question); })
      .value({.key = "worst_goal",
              .meaning = "name of the goal that the numbers are of, the worst of several",
              .optional = true},
             &Judgement::name)
      .value({.key = "worst_condition",
              .meaning = "the condition that they are under, the worst of several",
              .optional = true},
             &Judgement::setting)
      .value({.key = "status", .meaning = "verdict on the goal", .words = goal::status_words()},
             [](const Judgement& j) { return goal::text_of(j.judged.verdict.status); })
      .value(document::in_data("rate", "proportion of moves that meet the goal, with one-sided bounds", "1"),
             [](const Judgement& j) { return goal::bounded(j.judged.verdict.moves); })
      .value(
          document::in_data(
              "machines_low",
              "lower bound of the proportion of machines that meet the goal, if it is about machines", "1"),
          [](const Judgement& j) { return j.of_machines(j.judged.verdict.machines.low); })
      .value(document::in_data("machines_high", "its upper bound", "1"),
             [](const Judgement& j) { return j.of_machines(j.judged.verdict.machines.high); })
      .object({.key = "other_mass",
               .meaning = "the same values of the load, which the goal of the motor does not limit",
               .shown = Visibility::in_data,
               .optional = true},
              goal::load_description(), [](const Judgement& j) { return j.judged.verdict.of_load; })
      .sentence([](const Judgement& j) { return summary::judgement_details(j.summary, j.judged); })
      .value(document::in_data("missed_saturated",
                               "proportion of the moves that miss the goal in which the converter clipped; "
                               "null: the goal is met, or the file does not keep every trial",
                               "1"),
             &Judgement::missed_saturated)
      .sentence(
          [](const Judgement& j) { return j.saturated ? summary::saturation_sentence(*j.saturated) : ""; })
      .value(
          document::in_data("chosen_from", "design points that the point is the best of; 1 if it was named"),
          [](const Judgement& j) { return j.judged.chosen.chosen_from; })
      .object({.key = "needed", .meaning = "study that would decide the goal"}, goal::needs_description(),
              [](const Judgement& j) { return goal::practicable(j.judged.needs); })
      .object(document::in_data("worlds", "the worlds at the point"), summary::worlds_description(question),
              &Judgement::worlds_reading)
      .table({.key = "claims", .meaning = "each goal under each condition", .shown = Visibility::in_json},
             summary::cell_description({}, summary::CellsBy::claim), &Judgement::claims)
      .table({.heading = "by claim"}, summary::cell_description({}, summary::CellsBy::claim),
             &Judgement::several_claims)
      .value({.key = "met_until",
              .meaning = "last age up to and including which the goal is met; null if not at the first",
              .optional = true},
             [](const Judgement& j) { return summary::met_until(j.ages); })
      .value({.key = "missed_from",
              .meaning = "first age at which the goal is shown to be missed",
              .optional = true},
             [](const Judgement& j) { return summary::missed_from(j.ages); })
      .table({.key = "ages",
              .heading = "by age",
              .meaning = "the point at each age",
              .shown = Visibility::not_in_csv},
             summary::cell_description(question, summary::CellsBy::age), &Judgement::ages)
      .sentence([](const Judgement& j) { return summary::ages_sentence(j.summary.question, j.ages); });
  return answer;
}

/// Study of the results file. Refuses a file that cannot be judged from its description, before its trials
/// are read.
study::Study judgeable_study(const command_line::Arguments& arguments) {
  const std::filesystem::path path = arguments.operands()[0];
  std::error_code error;
  if (!std::filesystem::exists(path, error) && shards::has_begun(path)) {
    throw Failure(ExitCode::bad_data,
                  fmt::format("{}: unfinished: its run has not ended; 'zerocount run' goes on with it, and "
                              "'zerocount summary' describes the finished trials",
                              path.string()));
  }
  study::Study study = commands::described_study(path);
  command_line::point_option(arguments, study.points.labels);
  goal::require_claim(study, path.string());
  return study;
}

std::optional<summary::SaturatedMoves> saturated_in(const command_line::Arguments& arguments,
                                                    const study::Study& study,
                                                    const summary::JudgedPoint& judged) {
  if (judged.verdict.status == goal::Status::met) return {};
  return summary::saturated_moves(arguments.operands()[0], study,
                                  {judged.chosen.point, judged.verdict.goal, judged.verdict.setting});
}

ExitCode judge(const command_line::Arguments& arguments) {
  const study::Study study = judgeable_study(arguments);
  const auto point = command_line::point_option(arguments, study.points.labels);
  const summary::ChosenSummary found =
      commands::with_progress("zerocount judge", "computing statistics",
                              [&] { return summary::summarise_chosen(arguments.operands()[0], point); });
  const auto& [summary, chosen, measures] = found;
  const summary::JudgedPoint judged = summary::judge_point(summary, chosen);
  const Judgement judgement{
      summary,
      judged,
      summary::worlds_of_point(summary, chosen.point, static_cast<std::size_t>(chosen.chosen_from)),
      summary::claims_of_point(summary, chosen.point, static_cast<std::size_t>(chosen.chosen_from)),
      summary::ages_of_point(summary, chosen.point, static_cast<std::size_t>(chosen.chosen_from)),
      saturated_in(arguments, study, judged)};
  return answers::print(
      arguments,
      judge_answer(summary.question).of(judgement, commands::exit_code_of(judgement.judged.verdict.status)));
}

}  // namespace

commands::Command judge_command() {
  return {{"judge",
           "FILE",
           {answers::format_option(),
            {"point", "P", "the design point to judge (default: the best by the goal)"}}},
          "judge a study by the goal in its manifest",
          judge_help,
          judge,
          [] { return std::vector{judge_answer(any_claim()).complete_type()}; }};
}

}  // namespace zerocount::result_commands
