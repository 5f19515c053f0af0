#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iterator>
#include <map>
#include <optional>
#include <ranges>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/text/text.hpp"
#include "analysis/pairs/comparison/comparison.hpp"
#include "analysis/trials/goal/goal_text.hpp"

namespace zerocount::comparison {
namespace {

using document::bounded;
using document::Description;
using document::everywhere;
using document::in_data;
using document::to_people;
using document::with_words;
using Comparison = const StudyComparison&;

/// One judgement with its texts for people. It is a row of the table, and a test case of the JUnit file.
struct JudgementRow {
  const StudyComparison& comparison;
  const PointComparison& point;
  const Judgement& one;

  std::string text(double value) const { return value_text(value, one.measure, one.unit); }
  std::string place() const { return text::printable(point.label); }
  std::string name() const { return one.is_measure() ? one.measure : "require " + one.measure; }
  std::string_view verdict() const {
    return one.is_measure() ? to_string(one.change) : to_string(one.verdict);
  }
  std::string baseline() const { return text(one.baseline); }
  std::string current() const { return text(one.current); }
  std::string effect() const { return text(one.effect); }
  std::string detects() const { return text(one.detectable_change); }
  std::string bounds() const;
  std::string margin() const;
  std::string p() const;
  std::string note() const;
  bool has(GateVerdict wanted) const { return one.verdict == wanted; }
  bool has(ChangeVerdict wanted) const { return one.is_measure() && one.change == wanted; }
  /// Whether the reader should see the judgement in a long table: it did not pass, or the measure became
  /// better.
  bool is_noteworthy() const { return !has(GateVerdict::passed) || one.change == ChangeVerdict::better; }
};

std::vector<JudgementRow> all_rows(Comparison comparison) {
  std::vector<JudgementRow> rows;
  for (const PointComparison& point : comparison.points)
    for (const Judgement& one : point.judgements) rows.push_back({comparison, point, one});
  return rows;
}

/// Number of judgements with this verdict. A GateVerdict counts measures and requirements, a ChangeVerdict
/// only measures.
template <class Verdict>
std::int64_t count(Comparison comparison, Verdict verdict) {
  return std::ranges::count_if(all_rows(comparison),
                               [&](const JudgementRow& row) { return row.has(verdict); });
}

std::int64_t failed(Comparison comparison) {
  return count(comparison, GateVerdict::regression) + count(comparison, GateVerdict::changed);
}

/// Number of judgements (on measures and requirements) that have enough values for a verdict.
std::int64_t judged(Comparison comparison) {
  return std::ranges::count_if(all_rows(comparison),
                               [](const JudgementRow& row) { return !row.has(GateVerdict::not_measured); });
}

/// Text of the number of failed judgements: "3 of 40 judgements failed (1 worse, 2 better)"; empty if none
/// failed.
std::string failures_text(Comparison comparison) {
  if (failed(comparison) == 0) return "";
  std::string text = fmt::format("{} of {} judgements failed", failed(comparison), judged(comparison));
  if (const std::int64_t changed = count(comparison, GateVerdict::changed); changed > 0)
    text += fmt::format(" ({} worse or below a requirement, {} better, where every change fails)",
                        count(comparison, GateVerdict::regression), changed);
  return text;
}

/// Sentence that advises the user of the number of trials that would decide an inconclusive comparison.
std::string advice_text(Comparison comparison) {
  if (comparison.trials_to_decide)
    return fmt::format("; {} trials per design point would decide, with a probability of {:.0f} %",
                       trials_text(*comparison.trials_to_decide), 100.0 * decision_probability);
  if (std::isnan(comparison.max_trials_to_decide)) return "";
  std::vector<std::string> open;
  for (const JudgementRow& row : all_rows(comparison)) {
    if (row.one.is_measure() && !std::isnan(row.one.max_trials_margin))
      open.push_back(fmt::format("{} at {} (margin {}; {} would be decided)", row.one.measure, row.place(),
                                 row.text(row.one.margin), row.text(row.one.max_trials_margin)));
    if (!row.one.is_measure() && row.one.is_open() && !row.one.trials_to_decide)
      open.push_back(fmt::format("{} at {}", row.one.requirement, row.place()));
  }
  return fmt::format("; {} trials per design point would not decide{}{}",
                     trials_text(comparison.max_trials_to_decide), open.empty() ? " all of them" : ": ",
                     fmt::join(open, ", "));
}

/// Answer to a comparison of two design points: the names of the measures grouped by their change, "better:
/// success_rate, arrival_time; worse: none; ...", for each setting.
std::string answer_text(Comparison comparison) {
  std::string text = fmt::format("{} against {}", text::printable(comparison.points.front().design_point),
                                 text::printable(comparison.baseline_label));
  for (const ChangeVerdict change : {ChangeVerdict::better, ChangeVerdict::worse, ChangeVerdict::equivalent,
                                     ChangeVerdict::not_worse, ChangeVerdict::undecided}) {
    std::vector<std::string> names;
    for (const JudgementRow& row : all_rows(comparison)) {
      if (!row.has(change)) continue;
      names.push_back(row.one.measure);
      if (!row.point.setting.empty()) names.back() += " under " + text::printable(row.point.setting);
    }
    if (!names.empty()) text += fmt::format("; {}: {}", to_string(change), fmt::join(names, ", "));
  }
  return text;
}

/// The smallest changes for the worse that the trials find with decision_probability, as a range over the
/// points for each measure: "Detectable changes: success_rate 3.4 % to 6.7 %, ...". Empty if nothing was
/// measured.
std::string detectable_sentence(Comparison comparison) {
  std::vector<std::string> names;
  std::map<std::string, std::vector<JudgementRow>> measured;
  for (const JudgementRow& row : all_rows(comparison)) {
    if (std::isnan(row.one.detectable_change)) continue;
    if (measured[row.one.measure].empty()) names.push_back(row.one.measure);
    measured[row.one.measure].push_back(row);
  }
  for (std::string& name : names) {
    const auto change = [](const JudgementRow& row) { return row.one.detectable_change; };
    const auto lowest = std::ranges::min_element(measured[name], {}, change)->detects();
    const auto highest = std::ranges::max_element(measured[name], {}, change)->detects();
    name += " " + lowest + (lowest == highest ? "" : " to " + highest);
  }
  return names.empty() ? "" : fmt::format("Detectable changes: {}", fmt::join(names, ", "));
}

std::optional<std::int64_t> whole(const std::optional<double>& trials) {
  return trials ? std::optional(static_cast<std::int64_t>(*trials)) : std::nullopt;
}

/// The texts of the verdicts in the order of the enumerators of Verdict, from the first one to `last`.
template <class Verdict>
std::vector<std::string> words_until(Verdict last) {
  std::vector<std::string> words;
  for (int i = 0; i <= static_cast<int>(last); ++i) words.emplace_back(to_string(static_cast<Verdict>(i)));
  return words;
}

document::Item gate_item(const char* key, const char* meaning) {
  return with_words(in_data(key, meaning), words_until(GateVerdict::not_measured));
}

Description<ComparedFile> file_description() {
  using layout::FileHeader;
  using layout::Provenance;
  const auto build =
      Description<Provenance>()
          .value(in_data("zerocount_version", "version of the program"), &Provenance::zerocount_version)
          .value(in_data("git_commit", "commit of the program"), &Provenance::git_commit)
          .value(in_data("created", "time of the run, UTC"), &Provenance::created);
  const auto header = Description<FileHeader>()
                          .value(in_data("name", "name of the study"), &FileHeader::name)
                          .include(build, &FileHeader::provenance)
                          .value(in_data("engine", "engine that simulated the trials"),
                                 [](const FileHeader& of) { return layout::name_of(of.engine); })
                          .value(in_data("seed", "seed of the study"), &FileHeader::seed)
                          .value(in_data("trials", "trials per design point"), &FileHeader::trials);
  return Description<ComparedFile>()
      .value(in_data("path", "path of the file"), &ComparedFile::path)
      .include(header, &ComparedFile::header);
}

using Judged = const Judgement&;

Description<Judgement> measure_description() {
  return Description<Judgement>()
      .value(in_data("measure", "name of the measure"), &Judgement::measure)
      .value(in_data("unit", "unit of all values"), &Judgement::unit)
      .value(with_words(in_data("verdict", "change that the data show"),
                        words_until(ChangeVerdict::not_measured)),
             [](Judged m) { return to_string(m.change); })
      .value(gate_item("gate", "verdict of the gate"), [](Judged m) { return to_string(m.verdict); })
      .value(in_data("baseline", "proportion or mean in the baseline"), &Judgement::baseline)
      .value(in_data("current", "proportion or mean in the file"), &Judgement::current)
      .value(in_data("baseline_n", "trials with a value in the baseline"), &Judgement::baseline_n)
      .value(in_data("current_n", "trials with a value in the file"), &Judgement::current_n)
      .value(in_data("effect", "change for the worse, with one-sided bounds"),
             [](Judged m) { return bounded(m.effect, m.bounds); })
      .value(in_data("margin", "largest accepted effect"), &Judgement::margin)
      .value(in_data("changed_fails", "whether a change for the better beyond the margin fails too"),
             &Judgement::changed_fails)
      .value(in_data("detectable_change", "smallest change for the worse that these trials find"),
             &Judgement::detectable_change)
      .value(in_data("test", "test that gives p"), &Judgement::test)
      .value(in_data("p", "p-value against a change for the worse", "1"), &Judgement::p)
      .value(
          in_data("adjusted_p",
                  "p against a change for the worse beyond the margin, with control of the false discoveries",
                  "1"),
          &Judgement::adjusted_p)
      .value(in_data("improvement_p", "p-value against a change for the better", "1"),
             &Judgement::improvement_p)
      .value(in_data(
                 "adjusted_improvement_p",
                 "p against a change for the better beyond the margin, with control of the false discoveries",
                 "1"),
             &Judgement::adjusted_improvement_p)
      .value(in_data("trials_to_decide", "trials per design point that decide an inconclusive measure"),
             [](Judged m) { return whole(m.trials_to_decide); })
      .value(in_data("decided_margin", "any larger margin is decided by these trials"),
             &Judgement::decided_margin)
      .value(in_data("max_trials_margin", "smallest margin that max_trials_to_decide trials decide"),
             &Judgement::max_trials_margin)
      .value(in_data("note", "reason or remark"), &Judgement::note);
}

Description<Judgement> requirement_description() {
  return Description<Judgement>()
      .value(in_data("require", "the requirement as it was given"), &Judgement::requirement)
      .value(in_data("quantity", "quantity that is required"), &Judgement::measure)
      .value(in_data("unit", "unit of the limit and the value"), &Judgement::unit)
      .value(gate_item("verdict", "verdict of the gate"), [](Judged r) { return to_string(r.verdict); })
      .value(in_data("limit", "limit of the value"), &Judgement::margin)
      .value(in_data("value", "value in the file"), &Judgement::current)
      .value(in_data("n", "trials or moves from which the value is computed"), &Judgement::current_n)
      .value(
          in_data(
              "bounds",
              "one-sided bounds, low and high: of the value, or of the proportion within the limit of a quantile"),
          [](Judged r) {
            return std::vector<double>{r.bounds.low, r.bounds.high};
          })
      .value(in_data("trials_to_decide", "trials per design point that decide the requirement"),
             [](Judged r) { return whole(r.trials_to_decide); });
}

Description<measures::UndecidedMoves> undecided_description() {
  Description<measures::UndecidedMoves> description;
  description.value(in_data("moves", "moves of all trials"), &measures::UndecidedMoves::moves);
  for (const measures::UndecidedCount& each : measures::undecided_counts)
    description.value(in_data(each.name, each.long_name), each.count);
  return description;
}

Description<PointComparison> point_description() {
  using Point = const PointComparison&;
  const auto statuses =
      Description<GoalStatuses>()
          .value(with_words(in_data("baseline", "verdict on the baseline"), goal::status_words()),
                 [](const GoalStatuses& s) { return goal::text_of(s.baseline); })
          .value(with_words(in_data("current", "verdict on the file"), goal::status_words()),
                 [](const GoalStatuses& s) { return goal::text_of(s.current); });
  const auto several = Description<PointComparison>().table(
      {.key = "goals",
       .meaning = "verdicts on each of several goals",
       .shown = document::Visibility::in_json,
       .optional = true},
      Description<GoalStatuses>()
          .value(in_data("name", "name of the goal"), &GoalStatuses::name)
          .include(
              statuses, [](const GoalStatuses& s) -> const auto& { return s; }),
      &PointComparison::goals);
  return Description<PointComparison>()
      .value(in_data("label", "label of the design point, with the condition"), &PointComparison::label)
      .value({.key = "condition",
              .meaning = "condition that the trials are under",
              .shown = document::Visibility::in_json,
              .optional = true},
             [](Point p) { return p.setting.empty() ? std::nullopt : std::optional(p.setting); })
      .value(gate_item("verdict", "verdict of the gate"), [](Point p) { return to_string(p.verdict); })
      .value(in_data("baseline_point", "number of the point in the baseline"),
             &PointComparison::baseline_point)
      .value(in_data("current_point", "number of the point in the file"), &PointComparison::current_point)
      .value(in_data("baseline_trials", "trials of the baseline"), &PointComparison::baseline_trials)
      .value(in_data("current_trials", "trials of the file"), &PointComparison::current_trials)
      .value(in_data("pairs", "trials that were compared one by one"), &PointComparison::pairs)
      .object(in_data("baseline_undecided", "undecided moves of the baseline"), undecided_description(),
              &PointComparison::baseline_undecided)
      .object(in_data("current_undecided", "undecided moves of the file"), undecided_description(),
              &PointComparison::current_undecided)
      .table(in_data("measures", "comparison of each measure"), measure_description(),
             [](Point p) { return std::views::filter(p.judgements, &Judgement::is_measure); })
      .table(in_data("requirements", "absolute requirements"), requirement_description(),
             [](Point p) { return std::views::filter(p.judgements, std::not_fn(&Judgement::is_measure)); })
      .object(in_data("goal", "verdicts on the goal, where the points are judged by one"), statuses,
              [](Point p) { return p.goals.size() == 1 ? &p.goals.front() : nullptr; })
      .include(several, [](Point p) { return p.goals.size() > 1 ? &p : nullptr; });
}

Description<StudyComparison> counts_description() {
  Description<StudyComparison> counts;
  const auto add = [&](const char* key, auto verdict, const char* meaning) {
    counts.value(in_data(key, meaning), [verdict](Comparison c) { return count(c, verdict); });
  };
  add("passed", GateVerdict::passed, "judgements that passed");
  add("regression", GateVerdict::regression, "worse, or a requirement that is not met");
  add("changed", GateVerdict::changed, "better, where every change fails");
  add("inconclusive", GateVerdict::inconclusive, "judgements that are open");
  add("not_measured", GateVerdict::not_measured, "judgements without enough values");
  add("worse", ChangeVerdict::worse, "measures that are worse");
  add("better", ChangeVerdict::better, "measures that are better");
  add("equivalent", ChangeVerdict::equivalent, "measures that are equivalent");
  add("not_worse", ChangeVerdict::not_worse, "measures that are better or equivalent");
  add("undecided", ChangeVerdict::undecided, "measures whose change is open");
  return counts;
}

/// Text of the bounds of the change. For a requirement, bounds of the required quantity; for a requirement on
/// a quantile, bounds of the proportion of trials within the limit.
std::string JudgementRow::bounds() const {
  if (std::isnan(one.bounds.low)) return "–";
  if (one.is_measure() || one.measure.find('.') == std::string::npos)
    return fmt::format("[{}, {}]", text(one.bounds.low), text(one.bounds.high));
  const auto percent = [](double value) { return value_text(value, "success_rate", "1"); };
  return fmt::format("[{}, {}] within", percent(one.bounds.low), percent(one.bounds.high));
}

std::string JudgementRow::margin() const {
  if (!one.is_measure()) return fmt::format("{} {}", text::sign_of(one.relation), text(one.margin));
  return (one.changed_fails ? "± " : "") + text(one.margin);
}

/// The adjusted p-value that is shown: of a change for the better if the measure is better, otherwise of a
/// change for the worse.
double shown_p(const Judgement& measure) {
  return measure.change == ChangeVerdict::better ? measure.adjusted_improvement_p : measure.adjusted_p;
}

std::string JudgementRow::p() const {
  const double p = shown_p(one);
  if (std::isnan(p)) return "–";
  return p < 1e-4 ? "< 1e-4" : fmt::format("{:.2g}", p);
}

/// The remarks on the judgement: its reason, the verdicts on the goal for the proportion of moves in the
/// goal, the undecided moves for the proportion of stable trials, and what would decide it.
std::string JudgementRow::note() const {
  std::vector<std::string> notes;
  if (!one.note.empty()) notes.push_back(one.note);
  for (const GoalStatuses& goal : point.goals) {
    if (one.is_measure() && one.measure == name_of_goal_measure("goal_rate", goal.name))
      notes.push_back(fmt::format("goal {} in the baseline, {} in the file", goal::text_of(goal.baseline),
                                  goal::text_of(goal.current)));
  }
  const measures::UndecidedMoves& before = point.baseline_undecided;
  const measures::UndecidedMoves& after = point.current_undecided;
  if (one.measure == "stable_rate" && before.off_target + after.off_target > 0)
    notes.push_back(fmt::format("undecided: {} of {} moves in the baseline, {} of {} in the file",
                                before.off_target, before.moves, after.off_target, after.moves));
  if (one.trials_to_decide)
    notes.push_back(fmt::format("{} trials would decide", trials_text(*one.trials_to_decide)));
  if (!std::isnan(one.decided_margin))
    notes.push_back(fmt::format("these trials decide a margin above {}", text(one.decided_margin)));
  if (!std::isnan(one.decided_margin) && !std::isnan(one.max_trials_margin))
    notes.back() += fmt::format(", {} trials one of {}", trials_text(comparison.max_trials_to_decide),
                                text(one.max_trials_margin));
  return fmt::format("{}", fmt::join(notes, "; "));
}

Description<JudgementRow> row_description() {
  // One column names the rows, so that every part of a divided table has it.
  return Description<JudgementRow>()
      .value(to_people("point, measure"),
             [](const JudgementRow& row) { return fmt::format("{} {}", row.place(), row.name()); })
      .value(to_people("verdict"), &JudgementRow::verdict)
      .value(to_people("baseline"), &JudgementRow::baseline)
      .value(to_people("file"), &JudgementRow::current)
      .value(to_people("worse by"), &JudgementRow::effect)
      .value(to_people("bounds"), &JudgementRow::bounds)
      .value(to_people("margin"), &JudgementRow::margin)
      .value(to_people("detects"), &JudgementRow::detects)
      .value(to_people("p"), &JudgementRow::p)
      .value(to_people("note"), &JudgementRow::note);
}

std::string file_text(const ComparedFile& file) {
  const layout::FileHeader& header = file.header;
  const layout::Provenance& build = header.provenance;
  return text::printable(
      fmt::format("{}: study {}, seed {}, {} trials at {} points, zerocount {} ({}), {} engine, {}",
                  file.path, header.name, header.seed, header.trials, header.points, build.zerocount_version,
                  build.git_commit, layout::name_of(header.engine), build.created));
}

constexpr std::size_t max_rows = 60;

Description<manifest_text::ManifestDifference> difference_description() {
  using Difference = manifest_text::ManifestDifference;
  const auto shown = [](std::string Difference::*value) {
    return [value](const Difference& one) { return (one.*value).empty() ? "(absent)" : one.*value; };
  };
  return Description<Difference>()
      .value(everywhere("key", "key", "dotted path"), &Difference::key)
      .value(everywhere("baseline", "baseline", "value in the baseline"), &Difference::baseline)
      .shown_as(shown(&Difference::baseline))
      .value(everywhere("current", "file", "value in the file"), &Difference::current)
      .shown_as(shown(&Difference::current));
}

/// The rows of the table that people see: all judgements, or only the noteworthy ones if there are more than
/// max_rows.
std::vector<JudgementRow> rows_shown(Comparison comparison) {
  std::vector<JudgementRow> all = all_rows(comparison);
  if (all.size() <= max_rows) return all;
  std::vector<JudgementRow> noteworthy;
  std::ranges::copy_if(all, std::back_inserter(noteworthy), &JudgementRow::is_noteworthy);
  return noteworthy;
}

std::string omitted_sentence(Comparison comparison) {
  const std::size_t omitted = all_rows(comparison).size() - rows_shown(comparison).size();
  return omitted == 0 ? "" : fmt::format("({} rows that simply passed are not shown)", omitted);
}

/// Whether any judgement has a significant test although the bounds of its effect leave the direction of the
/// change open.
bool any_contrast(Comparison comparison) {
  return std::ranges::any_of(all_rows(comparison), [&](const JudgementRow& row) {
    return shown_p(row.one) < comparison.false_discovery_rate && row.one.bounds.low < 0.0 &&
           row.one.bounds.high > 0.0;
  });
}

std::string legend(Comparison comparison) {
  return fmt::format(
      "Bounds: {:.6g} % each. p: of {} tests, adjusted for a false discovery rate of {:.6g} %. Detects: the "
      "smallest change for the worse that these trials find with a probability of {:.0f} %.{}",
      100.0 * comparison.confidence, comparison.tests, 100.0 * comparison.false_discovery_rate,
      100.0 * decision_probability,
      any_contrast(comparison) ? "\nIf p is below the false discovery rate although the bounds include 0: "
                                 "the bounds allow for one more machine or trial that differs as much as "
                                 "possible, p does not; with more machines they agree."
                               : "");
}

std::optional<std::string> baseline_label(Comparison comparison) {
  return compares_points(comparison) ? std::optional(comparison.baseline_label) : std::nullopt;
}

void add_facts(Description<StudyComparison>& items) {
  items
      .object(everywhere("baseline", "baseline", "the file of the baseline"), file_description(),
              &StudyComparison::baseline)
      .shown_as([](Comparison c) {
        return compares_points(c) ? std::nullopt : std::optional(file_text(c.baseline));
      })
      .object(everywhere("current", "file", "the file that is compared with it"), file_description(),
              &StudyComparison::current)
      .shown_as([](Comparison c) { return file_text(c.current); })
      .value(everywhere("baseline_label", "baseline point",
                        "label of the baseline's point, where two points of one file are compared"),
             baseline_label)
      .value(to_people("point"),
             [](Comparison c) { return compares_points(c) ? c.points.front().design_point : std::string(); })
      .value(with_words(everywhere("layer", "compared", "what the files have in common"),
                        {"bits", "paired", "two_samples"}),
             [](Comparison c) { return to_string(c.layer); })
      .shown_as([](Comparison c) { return fmt::format("{}: {}", to_string(c.layer), c.layer_reason); })
      .value(in_data("layer_reason", "why they are compared so"), &StudyComparison::layer_reason)
      .value(in_data("equal_to_the_bit", "whether every dataset is equal to the bit"),
             &StudyComparison::equal_to_the_bit)
      .value(everywhere("first_difference", "first difference",
                        "first dataset that differs, with the place; empty if not searched for"),
             &StudyComparison::first_difference)
      .value(everywhere("goal", "goal", "the goal by which the points are judged"),
             [](Comparison c) -> std::optional<std::string> {
               std::vector<std::string> sentences;
               for (const study::Goal& goal : c.goals) sentences.push_back(goal::goal_sentence(goal));
               if (sentences.empty()) return std::nullopt;
               return fmt::format("{}", fmt::join(sentences, "; "));
             })
      .value(everywhere("changed_inputs", "changed inputs",
                        "drawn parameters whose values differ on the same draws"),
             &StudyComparison::changed_inputs)
      .sentence([](Comparison c) {
        return c.notes.empty() ? "" : fmt::format("note: {}", fmt::join(c.notes, "\nnote: "));
      })
      .value(in_data("notes", "what else the reader should know"), &StudyComparison::notes)
      .table(everywhere("manifest_differences", "What differs in the manifest",
                        "keys whose values differ; a value is empty where its key is absent"),
             difference_description(), &StudyComparison::manifest_differences);
}

void add_judgements(Description<StudyComparison>& items) {
  items.value(in_data("confidence", "confidence of each bound", "1"), &StudyComparison::confidence)
      .value(in_data("false_discovery_rate", "accepted proportion of false discoveries", "1"),
             &StudyComparison::false_discovery_rate)
      .value(in_data("tests", "tests over which the false discoveries are controlled"),
             &StudyComparison::tests)
      .object(in_data("counts", "number of verdicts"), counts_description(),
              [](Comparison c) -> Comparison { return c; })
      .value(in_data("trials_to_decide", "trials per design point that decide the whole"),
             [](Comparison c) { return whole(c.trials_to_decide); })
      .value(in_data("decision_probability", "probability with which these decide", "1"),
             [](Comparison) { return decision_probability; })
      .value(in_data("max_trials_to_decide", "trials per design point, the most that were tried", "1"),
             &StudyComparison::max_trials_to_decide)
      .table(to_people("Judgements"), row_description(), rows_shown)
      .sentence(omitted_sentence)
      .table(in_data("points", "the design points"), point_description(), &StudyComparison::points)
      .sentence(legend)
      .sentence(detectable_sentence);
}

}  // namespace

std::string_view to_string(ComparisonLayer layer) {
  if (layer == ComparisonLayer::bits) return "bits";
  return layer == ComparisonLayer::paired ? "paired" : "two_samples";
}

std::string verdict_sentence(const StudyComparison& comparison) {
  const std::int64_t all = judged(comparison);
  const bool open = comparison.verdict == GateVerdict::inconclusive;
  if (compares_points(comparison) && all > 0)
    return answer_text(comparison) + (open ? advice_text(comparison) : "");
  switch (comparison.verdict) {
    case GateVerdict::regression:
      if (!is_unequal(comparison)) return "regression: " + failures_text(comparison);
      return fmt::format("regression: the data must be equal to the bit and are not: {}{}{}",
                         comparison.first_difference, failed(comparison) > 0 ? "; " : "",
                         failures_text(comparison));
    case GateVerdict::changed:
      return "changed: " + failures_text(comparison);
    case GateVerdict::passed:
      if (comparison.equal_to_the_bit) return "passed: every dataset is equal to the bit";
      return fmt::format(
          "passed: all {} judgements at {} design points are within their margins or better; {} better", all,
          comparison.points.size(), count(comparison, ChangeVerdict::better));
    case GateVerdict::inconclusive:
    case GateVerdict::not_measured:
      break;
  }
  if (all == 0) return "inconclusive: nothing was measured";
  return fmt::format("inconclusive: {} of {} judgements are open{}",
                     count(comparison, GateVerdict::inconclusive), all, advice_text(comparison));
}

std::string value_text(double value, std::string_view quantity, std::string_view unit) {
  if (std::isnan(value)) return "–";
  if (std::isinf(value)) return value > 0.0 ? "∞" : "−∞";
  const std::string_view measure = without_goal(quantity);
  if (measure.ends_with("_rate") || measure == "goal_machines") return fmt::format("{:.4g} %", 100.0 * value);
  return unit == "1" ? text::short_number(value) : fmt::format("{} {}", text::short_number(value), unit);
}

std::string trials_text(double trials) {
  if (trials < 100.0) return fmt::format("{:.0f}", trials);
  const double step = std::pow(10.0, std::floor(std::log10(trials)) - 1.0);
  return fmt::format("{:.0f}", std::ceil(trials / step) * step);
}

document::AnswerDescription<StudyComparison> comparison_answer() {
  document::AnswerDescription<StudyComparison> answer{
      {.name = "compare",
       .meaning = "whether a study is as good as its baseline",
       .csv_table = "points.measures"},
      {}};
  answer.items.headline(verdict_sentence)
      .value(gate_item("verdict", "verdict of the gate"), [](Comparison c) { return to_string(c.verdict); });
  add_facts(answer.items);
  add_judgements(answer.items);
  return answer;
}

std::string comparison_junit(const StudyComparison& comparison) {
  // XML cannot hold control characters: text::printable replaces them.
  const auto xml = [](std::string_view text) { return text::escaped_markup(text::printable(text)); };
  const std::string suite = xml(comparison.current.header.name);
  std::map<std::string, std::int64_t> elements;
  std::string cases;
  const auto add = [&](const std::string& name, GateVerdict verdict, const std::string& message) {
    const std::string element = fails(verdict)                         ? "failure"
                                : verdict == GateVerdict::inconclusive ? "error"
                                : verdict == GateVerdict::passed       ? "system-out"
                                                                       : "skipped";
    ++elements[element];
    cases += fmt::format("    <testcase classname=\"{}\" name=\"{}\">", suite, xml(name));
    if (element == "system-out") {
      cases += fmt::format("<system-out>{}</system-out>", xml(message));
    } else {
      const std::string type = element == "skipped" ? "" : fmt::format(" type=\"{}\"", to_string(verdict));
      cases += fmt::format("<{}{} message=\"{}\"/>", element, type, xml(message));
    }
    cases += "</testcase>\n";
  };
  for (const JudgementRow& row : all_rows(comparison)) {
    const std::string note = row.note();
    add(fmt::format("{}: {}", row.place(), row.name()), row.one.verdict,
        fmt::format("{}: baseline {}, file {}, worse by {} {}, margin {}, p {}{}", row.verdict(),
                    row.baseline(), row.current(), row.effect(), row.bounds(), row.margin(), row.p(),
                    note.empty() ? "" : "; " + note));
  }
  // A verdict that no single case gives: unequal data, or nothing measured.
  const bool silent = comparison.verdict == GateVerdict::inconclusive && elements["error"] == 0;
  if (comparison.layer == ComparisonLayer::bits || silent) {
    const GateVerdict other = silent ? GateVerdict::inconclusive : GateVerdict::passed;
    add("the data", is_unequal(comparison) ? GateVerdict::regression : other, verdict_sentence(comparison));
  }
  const std::string numbers =
      fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\" skipped=\"{}\"",
                  elements["failure"] + elements["error"] + elements["system-out"] + elements["skipped"],
                  elements["failure"], elements["error"], elements["skipped"]);
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"zerocount compare\" {0}>\n"
      "  <testsuite name=\"{1}\" {0}>\n{2}  </testsuite>\n</testsuites>\n",
      numbers, suite, cases);
}

}  // namespace zerocount::comparison
