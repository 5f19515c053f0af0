#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/comparison/comparison_report.hpp"
#include "analysis/goal/goal_description.hpp"
#include "analysis/goal/goal_text.hpp"
#include "analysis/text/text.hpp"

namespace zerocount::comparison {
namespace {

using document::bounded;
using document::Description;
using document::everywhere;
using document::in_data;
using document::to_people;
using document::with_words;
using Comparison = const StudyComparison&;

std::optional<std::int64_t> whole(const std::optional<double>& trials) {
  return trials ? std::optional(static_cast<std::int64_t>(*trials)) : std::nullopt;
}

template <class Verdict>
std::vector<std::string> words_of(std::initializer_list<Verdict> verdicts) {
  std::vector<std::string> words;
  for (const Verdict verdict : verdicts) words.emplace_back(to_string(verdict));
  return words;
}

std::vector<std::string> gate_words() {
  return words_of({GateVerdict::regression, GateVerdict::changed, GateVerdict::inconclusive,
                   GateVerdict::passed, GateVerdict::not_measured});
}

std::vector<std::string> change_words() {
  return words_of({ChangeVerdict::worse, ChangeVerdict::better, ChangeVerdict::equivalent,
                   ChangeVerdict::not_worse, ChangeVerdict::undecided, ChangeVerdict::not_measured});
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

Description<MeasureComparison> measure_description() {
  using Measure = const MeasureComparison&;
  return Description<MeasureComparison>()
      .value(in_data("measure", "name of the measure"), &MeasureComparison::measure)
      .value(in_data("unit", "unit of all values"), &MeasureComparison::unit)
      .value(with_words(in_data("verdict", "change that the data show"), change_words()),
             [](Measure m) { return to_string(m.change); })
      .value(with_words(in_data("gate", "verdict of the gate"), gate_words()),
             [](Measure m) { return to_string(m.verdict); })
      .value(in_data("baseline", "proportion or mean in the baseline"), &MeasureComparison::baseline)
      .value(in_data("current", "proportion or mean in the file"), &MeasureComparison::current)
      .value(in_data("baseline_n", "trials with a value in the baseline"), &MeasureComparison::baseline_n)
      .value(in_data("current_n", "trials with a value in the file"), &MeasureComparison::current_n)
      .value(in_data("effect", "change for the worse, with one-sided bounds"),
             [](Measure m) { return bounded(m.effect, m.bounds); })
      .value(in_data("margin", "largest accepted effect"), &MeasureComparison::margin)
      .value(in_data("changed_fails", "whether a change for the better beyond the margin fails too"),
             &MeasureComparison::changed_fails)
      .value(in_data("detectable_change", "smallest change for the worse that these trials find"),
             &MeasureComparison::detectable_change)
      .value(in_data("test", "test that p is of"), &MeasureComparison::test)
      .value(in_data("p", "p-value against a change for the worse", "1"), &MeasureComparison::p)
      .value(in_data("adjusted_p", "p after control of the false discoveries", "1"),
             &MeasureComparison::adjusted_p)
      .value(in_data("improvement_p", "p-value against a change for the better", "1"),
             &MeasureComparison::improvement_p)
      .value(in_data("adjusted_improvement_p", "improvement_p after control of the false discoveries", "1"),
             &MeasureComparison::adjusted_improvement_p)
      .value(in_data("trials_to_decide", "trials per design point that decide an inconclusive measure"),
             [](Measure m) { return whole(m.trials_to_decide); })
      .value(in_data("decided_margin", "any larger margin is decided by these trials"),
             &MeasureComparison::decided_margin)
      .value(in_data("max_trials_margin", "smallest margin that max_trials_to_decide trials decide"),
             &MeasureComparison::max_trials_margin)
      .value(in_data("note", "reason or remark"), &MeasureComparison::note);
}

Description<RequirementResult> requirement_description() {
  using Requirement = const RequirementResult&;
  return Description<RequirementResult>()
      .value(in_data("require", "the requirement as it was given"), &RequirementResult::text)
      .value(in_data("quantity", "quantity that is required"), &RequirementResult::quantity)
      .value(in_data("unit", "unit of the limit and the value"), &RequirementResult::unit)
      .value(with_words(in_data("verdict", "verdict of the gate"), gate_words()),
             [](Requirement r) { return to_string(r.verdict); })
      .value(in_data("limit", "limit of the value"), &RequirementResult::limit)
      .value(in_data("value", "value in the file"), &RequirementResult::value)
      .value(in_data("n", "trials or moves that the value is of"), &RequirementResult::n)
      .value(in_data("bounds",
                     "one-sided bounds, low and high: of the value, or of the proportion within "
                     "the limit of a quantile"),
             [](Requirement r) {
               return std::vector<double>{r.bounds.low, r.bounds.high};
             })
      .value(in_data("trials_to_decide", "trials per design point that decide the requirement"),
             [](Requirement r) { return whole(r.trials_to_decide); });
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
       .shown = document::Shown::in_json,
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
              .shown = document::Shown::in_json,
              .optional = true},
             [](Point p) { return p.condition.empty() ? std::nullopt : std::optional(p.condition); })
      .value(with_words(in_data("verdict", "verdict of the gate"), gate_words()),
             [](Point p) { return to_string(p.verdict); })
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
             &PointComparison::measures)
      .table(in_data("requirements", "absolute requirements"), requirement_description(),
             &PointComparison::requirements)
      .object(in_data("goal", "verdicts on the goal, where the points are judged by one"), statuses,
              [](Point p) { return p.goals.size() == 1 ? &p.goals.front() : nullptr; })
      .include(several, [](Point p) { return p.goals.size() > 1 ? &p : nullptr; });
}

Description<VerdictCounts> counts_description() {
  return Description<VerdictCounts>()
      .value(in_data("passed", "judgements that passed"), &VerdictCounts::passed)
      .value(in_data("regression", "worse, or a requirement that is not met"), &VerdictCounts::regressions)
      .value(in_data("changed", "better, where every change fails"), &VerdictCounts::changed)
      .value(in_data("inconclusive", "judgements that are open"), &VerdictCounts::inconclusive)
      .value(in_data("not_measured", "judgements without enough values"), &VerdictCounts::not_measured)
      .value(in_data("worse", "measures that are worse"), &VerdictCounts::worse)
      .value(in_data("better", "measures that are better"), &VerdictCounts::better)
      .value(in_data("equivalent", "measures that are equivalent"), &VerdictCounts::equivalent)
      .value(in_data("not_worse", "measures that are better or equivalent"), &VerdictCounts::not_worse)
      .value(in_data("undecided", "measures whose change is open"), &VerdictCounts::undecided);
}

Description<ComparisonRow> row_description() {
  // One column names the rows, so that every part of a divided table has it.
  return Description<ComparisonRow>()
      .value(to_people("point, measure"),
             [](const ComparisonRow& row) { return fmt::format("{} {}", row.point, row.measure); })
      .value(to_people("verdict"), &ComparisonRow::verdict)
      .value(to_people("baseline"), &ComparisonRow::baseline)
      .value(to_people("file"), &ComparisonRow::current)
      .value(to_people("worse by"), &ComparisonRow::worse_by)
      .value(to_people("bounds"), &ComparisonRow::bounds)
      .value(to_people("margin"), &ComparisonRow::margin)
      .value(to_people("detects"), &ComparisonRow::detects)
      .value(to_people("p"), &ComparisonRow::p)
      .value(to_people("note"), &ComparisonRow::note);
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
  Description<Difference> description;
  description.value(everywhere("key", "key", "dotted path"), &Difference::key);
  const auto add = [&](document::Item data, const char* heading, std::string Difference::*value) {
    description.value(std::move(data), value)
        .value(to_people(heading), [value](const Difference& difference) {
          return (difference.*value).empty() ? "(absent)" : difference.*value;
        });
  };
  add(in_data("baseline", "value in the baseline"), "baseline", &Difference::baseline);
  add(in_data("current", "value in the file"), "file", &Difference::current);
  return description;
}

/// All rows, or the noteworthy ones where there are many.
std::vector<ComparisonRow> rows_shown(Comparison comparison) {
  std::vector<ComparisonRow> rows = comparison_rows(comparison);
  if (rows.size() > max_rows) std::erase_if(rows, [](const ComparisonRow& row) { return !row.noteworthy; });
  return rows;
}

std::string omitted_sentence(Comparison comparison) {
  const std::size_t omitted = comparison_rows(comparison).size() - rows_shown(comparison).size();
  return omitted == 0 ? "" : fmt::format("({} rows that simply passed are not shown)", omitted);
}

/// Whether a test is significant whose bounds leave the direction of the change open.
bool any_contrast(Comparison comparison) {
  return std::ranges::any_of(comparison.points, [&](const PointComparison& point) {
    return std::ranges::any_of(point.measures, [&](const MeasureComparison& measure) {
      return shown_p(measure) < comparison.false_discovery_rate && measure.bounds.low < 0.0 &&
             measure.bounds.high > 0.0;
    });
  });
}

std::string legend(Comparison comparison) {
  return fmt::format(
      "Bounds: {:.6g} % each. p: of {} tests, adjusted for a false discovery rate of {:.6g} %. Detects: the "
      "smallest change for the worse that these trials find with a probability of {:.0f} %.{}",
      100.0 * comparison.confidence, comparison.tests, 100.0 * comparison.false_discovery_rate,
      100.0 * decision_probability,
      any_contrast(comparison)
          ? "\nA p below the false discovery rate beside bounds that hold 0: bounds allow for one more rig "
            "or trial that differs by as much as one can, p does not; more rigs bring them together."
          : "");
}

std::optional<std::string> baseline_label(Comparison comparison) {
  return compares_points(comparison) ? std::optional(comparison.baseline_label) : std::nullopt;
}

void add_facts(Description<StudyComparison>& items) {
  items
      .value(to_people("baseline"),
             [](Comparison c) { return compares_points(c) ? std::string() : file_text(c.baseline); })
      .value(to_people("file"), [](Comparison c) { return file_text(c.current); })
      .object(in_data("baseline", "the file of the baseline"), file_description(), &StudyComparison::baseline)
      .object(in_data("current", "the file that is compared with it"), file_description(),
              &StudyComparison::current)
      .value(everywhere("baseline_label", "baseline point",
                        "label of the baseline's point, where two points of one file are compared"),
             baseline_label)
      .value(to_people("point"),
             [](Comparison c) { return compares_points(c) ? c.points.front().design_point : std::string(); })
      .value(to_people("compared"),
             [](Comparison c) { return fmt::format("{}: {}", to_string(c.layer), c.layer_reason); })
      .value(with_words(in_data("layer", "what the files have in common"), {"bits", "paired", "two_samples"}),
             [](Comparison c) { return to_string(c.layer); })
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
      .object(in_data("counts", "number of verdicts"), counts_description(), count_verdicts)
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

document::AnswerDescription<StudyComparison> comparison_answer() {
  document::AnswerDescription<StudyComparison> answer{
      {.name = "compare",
       .meaning = "whether a study is as good as its baseline",
       .csv_table = "points.measures"},
      {}};
  answer.items.headline(verdict_sentence)
      .value(with_words(in_data("verdict", "verdict of the gate"), gate_words()),
             [](Comparison c) { return to_string(c.verdict); });
  add_facts(answer.items);
  add_judgements(answer.items);
  return answer;
}

}  // namespace zerocount::comparison
