#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/basis/text/text.hpp"
#include "analysis/trials/goal/goal_text.hpp"
#include "analysis/trials/summary/cells_of_point.hpp"
#include "analysis/trials/summary/chosen_point.hpp"
#include "analysis/trials/worlds/learning.hpp"
#include "runners/answers/answer_format.hpp"
#include "runners/command_line/command_line.hpp"
#include "runners/commands/command.hpp"
#include "runners/result_commands/result_commands.hpp"

namespace zerocount::result_commands {
namespace {

using document::in_data;

constexpr double usual_precision = 0.1;
constexpr double significance = 0.05;

constexpr const char* learn_help =
    "Says what to do next about the unknowns of a study with worlds: it gives the verdict of 'zerocount\n"
    "judge', and what follows from it. If a world is the truth and the unknown were measured to ±10 %\n"
    "(--precision), the worlds near its value remain possible, at least the four nearest. Where all\n"
    "of them meet the goal, or all fall short of it, the measurement decides. Each world is judged by\n"
    "the others, so that a measurement may misjudge it: reject a world that meets the goal, or miss\n"
    "one that falls short. Where few worlds fall short, any unknown decides most of them: 'by chance'\n"
    "is the probability of as many if the unknowns did not matter. A measurement is advised only if\n"
    "it finds more worlds that fall short than it rejects of the others: to call all worlds good\n"
    "without measuring finds and rejects none.\n"
    "Beside the unknowns it tests what follows from those of the friction, such as the extension at\n"
    "which creep ends. What decides need not be the cause.\n"
    "Without a goal, worlds fall short that are shown to succeed less often than the median world.\n"
    "With several goals or conditions a world falls short where it does so of any goal under any\n"
    "condition; without a goal success is averaged over the conditions.\n"
    "The last column names the record of 'zerocount identify' that tells the unknown;\n"
    "'zerocount experiment' designs it.\n"
    "The exit code is 3 if these trials are too few: the goal is undecided, and no unknown is named.\n"
    "\n"
    "Example: zerocount learn unknown-friction.h5\n"
    "         zerocount learn unknown-friction.h5 --point 2 --precision 0.05 --format json\n";

/// Next step that the command `learn` recommends. A world is one draw of the values that all machines share
/// and nobody knows.
enum class Next {
  nothing,      ///< The goal is met in every world: nothing needs to be done.
  change_axis,  ///< The goal is missed in every world: the axis must be changed.
  /// The trials show no difference between the worlds and do not decide the goal: run more trials.
  more_trials,
  measure,  ///< The unknown that Outcome::best() names should be measured next.
  /// Worlds (draws of the values that nobody knows) differ in the verdict, but no single measurement is shown
  /// to tell them apart.
  no_single
};

/// How much the measurement of one unknown would decide: a row of the table.
struct Measurement {
  const worlds::Learned& learned;
  const worlds::WorldInput& input;
  std::size_t worlds;

  double decided_proportion() const {
    return static_cast<double>(learned.decided()) / static_cast<double>(worlds);
  }
};

struct Outcome {
  const summary::StudySummary& summary;
  summary::ChosenPoint chosen;
  std::optional<summary::JudgedPoint> judged;  ///< Judged design point; nothing if the study has no goal.
  double precision;
  worlds::PointWorlds worlds;
  std::vector<worlds::Learned> learned{};

  const std::vector<worlds::WorldInput>& inputs() const {
    return summary::world_inputs_of(summary, chosen.point);
  }
  std::size_t bad() const {
    return static_cast<std::size_t>(std::count(worlds.bad.begin(), worlds.bad.end(), true));
  }
  bool worlds_differ() const { return bad() > 0 && bad() < worlds.bad.size(); }
  /// The measurement that decides most worlds, among those that are shown to decide more than chance, and do
  /// better than no measurement; null if there is none.
  const worlds::Learned* best() const {
    const auto found = std::ranges::find_if(learned, [](const worlds::Learned& one) {
      return one.p_value <= significance && one.does_better_than_no_measurement();
    });
    return found == learned.end() ? nullptr : &*found;
  }
  /// Number of worlds (draws of the values that nobody knows) whose verdict is `status`; 0 without a goal.
  std::size_t worlds_that(goal::Status status) const {
    return static_cast<std::size_t>(std::ranges::count(worlds.statuses, status));
  }
  std::vector<Measurement> measurements() const {
    std::vector<Measurement> all;
    for (const worlds::Learned& one : learned) all.push_back({one, inputs()[one.input], worlds.bad.size()});
    return all;
  }
  Next next() const {
    if (judged && judged->verdict.status == goal::Status::met) return Next::nothing;
    if (worlds_that(goal::Status::missed) == worlds.bad.size()) return Next::change_axis;
    if (!worlds_differ()) return Next::more_trials;
    return best() != nullptr ? Next::measure : Next::no_single;
  }
  std::optional<std::string> unknown_to_measure() const {
    return next() == Next::measure ? std::optional(inputs()[best()->input].name) : std::nullopt;
  }
};

/// Words of Next in the answer's data, in the order of Next.
constexpr std::array<const char*, 5> next_words{"nothing", "change_axis", "more_trials", "measure",
                                                "no_single_measurement"};

/// Text below the table of measurements: basis of the numbers, assumptions of the table, and definitions of
/// its derived quantities, one line each.
std::string text_below_table(const Outcome& outcome) {
  const std::size_t all = outcome.worlds.bad.size();
  std::string text =
      fmt::format("nothing was simulated: this follows from the trials of {} worlds in the file\n", all);
  if (outcome.learned.empty()) return text;
  text += fmt::format("without a measurement: to call all worlds good is right in {} of {}\n",
                      all - outcome.bad(), all);
  if (const std::size_t undecided = outcome.worlds_that(goal::Status::undecided); undecided > 0)
    text += fmt::format(
        "{} of {} worlds are undecided, and count by their observed rates here; more trials decide them\n",
        undecided, all);
  for (const worlds::WorldInput& input : outcome.inputs()) {
    if (input.is_derived()) text += fmt::format("{} ({}): {}\n", input.name, input.unit, input.meaning);
  }
  return text;
}

std::string headline_of(const Outcome& outcome) {
  const std::size_t all = outcome.worlds.bad.size();
  switch (outcome.next()) {
    case Next::nothing:
      return "no measurement is needed: the goal is met in every world, whatever the truth is within what "
             "the manifest states";
    case Next::change_axis:
      return "no measurement of these unknowns helps: the goal is missed in every world; other gains or "
             "another axis may meet it";
    case Next::more_trials:
      if (!outcome.judged)
        return "these trials show no difference between the worlds: more trials may, and a goal says what "
               "is to be decided";
      return fmt::format(
          "first more trials, then a measurement: {} of {} worlds are undecided, and {} fall short by their "
          "observed rates, so no difference between worlds is seen that a measurement could reveal",
          outcome.worlds_that(goal::Status::undecided), all,
          outcome.bad() == 0 ? std::string("none") : fmt::format("all {}", all));
    case Next::measure: {
      const worlds::Learned& best = *outcome.best();
      return fmt::format(
          "measure {}: it finds {} of the {} worlds that fall short and rejects {} of the {} "
          "others; it leaves {} open",
          outcome.inputs()[best.input].name, best.decided_bad, outcome.bad(), best.rejected_good,
          all - outcome.bad(), best.open);
    }
    case Next::no_single:
      break;
  }
  return fmt::format(
      "no single measurement is shown to decide more than chance does (at a significance of {}), and to find "
      "more worlds that fall short than it rejects of the others; more worlds, or more trials in each, may "
      "show one",
      text::percent(significance));
}

/// Paragraph about the verdict, as `judge` has it; without a goal, about the worlds that fall short.
std::string verdict_text(const Outcome& outcome) {
  if (outcome.judged) return summary::judgement_text(outcome.summary, *outcome.judged);
  return fmt::format(
      "{}: {}", summary::point_names(outcome.summary)[static_cast<std::size_t>(outcome.chosen.point)],
      summary::bad_worlds_sentence(outcome.worlds, outcome.inputs(), outcome.summary.question));
}

std::optional<std::string_view> record_of(const Measurement& measurement) {
  const std::string_view record = worlds::record_of(measurement.input.name);
  return record.empty() ? std::nullopt : std::optional(record);
}

document::Description<Measurement> measurement_description() {
  return document::Description<Measurement>()
      .value({"parameter", "unknown", "dotted path of the unknown, or name of a derived quantity"},
             [](const Measurement& m) { return m.input.name; })
      .value(in_data("unit", "unit of the unknown"), [](const Measurement& m) { return m.input.unit; })
      .value(in_data("derived", "what the derived quantity is"),
             [](const Measurement& m) {
               return m.input.is_derived() ? std::optional(m.input.meaning) : std::nullopt;
             })
      .value({.key = "decided",
              .heading = "decided",
              .meaning = "worlds that the measurement decides rightly",
              .notation = document::Notation::percent},
             [](const Measurement& m) { return m.learned.decided(); })
      .shown_as(&Measurement::decided_proportion)
      .value({"decided_good", "good found", "worlds that meet the goal and are found to"},
             [](const Measurement& m) { return m.learned.decided_good; })
      .value({"decided_bad", "bad found", "worlds that fall short and are found to"},
             [](const Measurement& m) { return m.learned.decided_bad; })
      .value({"rejected_good", "good rejected", "worlds that meet the goal and are taken to fall short"},
             [](const Measurement& m) { return m.learned.rejected_good; })
      .value({"missed_bad", "bad missed", "worlds that fall short and are taken to meet the goal"},
             [](const Measurement& m) { return m.learned.missed_bad; })
      .value(in_data("misjudged", "worlds that are unlike all that remain possible: both of these"),
             [](const Measurement& m) { return m.learned.misjudged(); })
      .value({"open", "open", "worlds that the measurement does not decide"},
             [](const Measurement& m) { return m.learned.open; })
      .value(in_data("better", "whether it does better than to call all worlds good, or all bad, unmeasured"),
             [](const Measurement& m) { return m.learned.does_better_than_no_measurement(); })
      .value({"p_value", "by chance", "probability of as many decided if the unknowns did not matter", "1",
              document::Notation::two_digits},
             [](const Measurement& m) { return m.learned.p_value; })
      .value({"record", "record", "record of 'zerocount identify' that shows the unknown; null: none"},
             record_of);
}

document::AnswerDescription<Outcome> learn_answer() {
  document::AnswerDescription<Outcome> answer{
      {.name = "learn", .meaning = "which unknown to measure next", .csv_table = "unknowns"}, {}};
  answer.items.headline(headline_of)
      .sentence(verdict_text)
      .value(in_data("point", "number of the design point"), [](const Outcome& o) { return o.chosen.point; })
      .value(in_data("label", "label of the design point"),
             [](const Outcome& o) { return o.summary.labels[static_cast<std::size_t>(o.chosen.point)]; })
      .value(with_words(in_data("status", "verdict on the goal; null without one"), goal::status_words()),
             [](const Outcome& o) {
               return o.judged ? std::optional(goal::text_of(o.judged->verdict.status)) : std::nullopt;
             })
      .value(in_data("worlds", "number of worlds"), [](const Outcome& o) { return o.worlds.bad.size(); })
      .value(in_data("bad", "worlds that fall short"), &Outcome::bad)
      .value(in_data("undecided", "worlds that are undecided"),
             [](const Outcome& o) { return o.worlds_that(goal::Status::undecided); })
      .object(in_data("needed", "study that would decide the goal"), goal::needs_description(),
              [](const Outcome& o) { return o.judged ? goal::practicable(o.judged->needs) : nullptr; })
      .value(with_words(in_data("next", "what to do next"), {next_words.begin(), next_words.end()}),
             [](const Outcome& o) { return next_words.at(static_cast<std::size_t>(o.next())); })
      .value(in_data("measure", "the unknown to measure; null: none"), &Outcome::unknown_to_measure)
      .value(in_data("precision", "relative error of the measurement", "1"), &Outcome::precision)
      .sentence([](const Outcome& o) {
        if (o.learned.empty()) return std::string();
        return fmt::format("if one unknown were measured to ±{}:", text::percent(o.precision));
      })
      .table({.key = "unknowns", .meaning = "what a measurement of each unknown decides"},
             measurement_description(), &Outcome::measurements)
      .sentence(text_below_table);
  return answer;
}

/// Checks that a study can be examined by `learn`.
/// @param name name of the study, for messages
/// @param differ whether some value differs between worlds
/// @param open_loop whether the study has torque levels instead of targets, so that no move is judged
/// @throws Failure (bad_input) if no move is judged, or nothing differs between worlds
void require_worlds(const std::string& name, bool differ, bool open_loop) {
  const auto refuse = [&](const char* what, const char* expected) {
    throw Failure(ExitCode::bad_input, fmt::format("{}: {}; expected {}", name, what, expected));
  };
  if (!differ)
    refuse("nothing differs between worlds in this study",
           "worlds: 30, and a value such as friction.alpha: {interval: [0.1, 2.0]}");
  if (open_loop) refuse("no move of an open-loop study is judged", "a study with targets");
}

Outcome outcome_of(const std::string& path, const summary::StudySummary& summary,
                   const summary::ChosenPoint& chosen, double precision) {
  require_worlds(path, !summary::world_inputs_of(summary, chosen.point).empty(), false);
  Outcome outcome{.summary = summary,
                  .chosen = chosen,
                  .judged = {},
                  .precision = precision,
                  .worlds = *summary::worlds_of_point(summary, chosen.point,
                                                      static_cast<std::size_t>(chosen.chosen_from))};
  if (summary.question.goal()) outcome.judged = summary::judge_point(summary, chosen);
  if (outcome.worlds_differ())
    outcome.learned =
        worlds::what_to_learn(outcome.inputs(), outcome.worlds.bad, outcome.precision, summary.seed);
  return outcome;
}

/// Exit code of `learn`: inconclusive if more trials are recommended, or if the goal is undecided and no
/// single measurement is named; otherwise success.
ExitCode exit_code_after(const Outcome& outcome) {
  const bool undecided = outcome.judged && outcome.judged->verdict.status == goal::Status::undecided;
  const Next next = outcome.next();
  return next == Next::more_trials || (next == Next::no_single && undecided) ? ExitCode::inconclusive
                                                                             : ExitCode::success;
}

ExitCode learn(const command_line::Arguments& arguments) {
  const std::string& path = arguments.operands()[0];
  const study::Study study = commands::described_study(path);  // is refused before its trials are read
  command_line::point_option(arguments, study.points.labels);
  require_worlds(path, study.worlds > 0, study.open_loop);
  const summary::StudySummary summary = summary::summarise_file(path);
  const auto asked = command_line::point_option(arguments, summary.labels);
  const Outcome outcome =
      outcome_of(path, summary, summary::choose_point(summary, asked),
                 command_line::probability_option(arguments, "precision").value_or(usual_precision));
  return answers::print(arguments, learn_answer().of(outcome, exit_code_after(outcome)));
}

}  // namespace

document::Answer learned_of(const std::string& name, const summary::StudySummary& summary,
                            const summary::ChosenPoint& chosen) {
  require_worlds(name, !summary.world_inputs.empty(), summary.features.open_loop);
  return learn_answer().of(outcome_of(name, summary, chosen, usual_precision));
}

commands::Command learn_command() {
  return {{"learn",
           "FILE",
           {answers::format_option(),
            {"point", "P", "the design point (default: the best)"},
            {"precision", "R", "relative error of the measurement, 0 to 1 (default 0.1)"}}},
          "say which unknown to measure next",
          learn_help,
          learn,
          [] { return std::vector{learn_answer().complete_type()}; }};
}

}  // namespace zerocount::result_commands
