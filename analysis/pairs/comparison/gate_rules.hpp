#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "analysis/basis/statistics/proportion.hpp"
#include "core/text/relation.hpp"
#include "experiments/study/goal.hpp"
#include "results/layout/measure_table.hpp"

/// The judged measures, their margins, and the absolute requirements.
namespace zerocount::comparison {

/// The largest change of a measure for the worse that is accepted: the larger of `absolute` and of `relative`
/// times the baseline's value.
struct GateMargin {
  double absolute{0.0};  ///< Absolute margin: largest accepted change, in the measure's unit.
  /// Relative margin: largest accepted change as a proportion of the baseline's value.
  double relative{0.0};
  /// True: a change for the better beyond the margin fails the gate, too. False: only a change for the worse
  /// fails.
  bool changed_fails{false};
};

/// The statistic of a measure that is compared between the two files.
enum class GateStatistic {
  trials,  ///< Proportion of trials that have a quality, such as success.
  mean,    ///< Mean over the trials.
  moves,   ///< Proportion of moves that meet the goal.
  /// Proportion of machines on which at least the proportion Goal::moves of the moves meets the goal.
  machines,
  quantile  ///< Quantile over all moves of a time that some moves may never reach (infinite).
};

/// One measure that a comparison judges.
struct GateMeasure {
  /// Row of the program's own table of measures; null for a measure that a goal of the manifest defines.
  const layout::Measure* measure{nullptr};
  std::string name{};  ///< Name of the measure; for a named goal "goal_rate[large]".
  std::string_view unit{};
  GateMargin margin{};  ///< Margin that applies if the rules state none for this measure.
  GateStatistic statistic{GateStatistic::mean};
  layout::Worse worse{layout::Worse::more};
  /// For a measure of a goal: index of the goal among the goals by which the study is judged; otherwise 0.
  std::size_t goal{0};

  /// Whether the statistic is a proportion: of trials, moves or machines.
  bool proportion() const { return statistic != GateStatistic::mean && statistic != GateStatistic::quantile; }
  /// Whether the measure is defined by a goal of the manifest, not by the program's own table.
  bool of_goal() const { return measure == nullptr; }
};

/// The measures of the table that a comparison can judge, in the order of the report: proportions before
/// means.
std::vector<GateMeasure> gate_measures(const layout::MeasureTable& measures = layout::measure_table());

/// The measures that judge a study by the goal of its manifest, in the order of the report: goal_rate,
/// goal_machines, goal_settling_time.
std::vector<GateMeasure> goal_measures();
/// Name of a measure of a goal: "goal_rate[large]", or "goal_rate" if the goal has no name.
/// @param goal name of the goal; may be empty
std::string name_of_goal_measure(std::string_view measure, std::string_view goal);
/// The name of a measure without the name of its goal in brackets: "goal_rate" for "goal_rate[large]". Other
/// names stay unchanged.
std::string_view without_goal(std::string_view measure);

/// Every measure that a comparison can judge: the measures of the goal, then those of the program's own
/// table.
std::vector<GateMeasure> all_gate_measures();

/// The measure with this name among all_gate_measures(); empty if there is none. The name of a measure of a
/// goal may include the name of the goal.
std::optional<GateMeasure> find_gate_measure(std::string_view name);

/// Names of quantiles, as they follow the name of a measure in "arrival_time.p95", with their probabilities.
inline constexpr std::array<std::pair<std::string_view, double>, 3> quantile_names{
    {{"median", 0.5}, {"p95", 0.95}, {"p99", 0.99}}};

enum class RequirementKind {
  proportion,  ///< Proportion of trials that have the quality of a gate measure.
  quantile,    ///< Quantile over the trials; the value of a trial is that of its worst move.
  mean,        ///< Mean over the trials; the value of a trial is the sum over its moves.
  goal         ///< The goal of the manifest: the requirement is that it is met.
};

/// A quantity of the current file that a requirement can limit, whatever its value in the baseline.
struct RequirableQuantity {
  std::string name;
  std::string_view unit;
  RequirementKind kind{RequirementKind::proportion};
  GateMeasure measure{};
  double probability{0.0};  ///< Probability of the quantile, such as 0.95; 0 for other kinds.
};

/// The quantities that a requirement can limit. A proportion, and the mean of a sum, have the name of their
/// gate measure. Other measures have quantiles (NAME.median, .p95, .p99). "goal" has no limit of its own.
/// Error bands are listed with the examples of the bands of 0 and 1 count.
std::vector<RequirableQuantity> requirable_quantities();
/// The quantity with this name that a requirement can limit; empty if there is none. The measures of error
/// bands and tolerances exist for bands and tolerances of every size: "band_settling_time[5].p95",
/// "tolerance_settling_time[1e-8].p95".
std::optional<RequirableQuantity> find_requirable(std::string_view name);

/// A requirement: a limit that a quantity of the current file must meet, such as "success_rate ≥ 0.995".
struct Requirement {
  std::string text;
  RequirableQuantity quantity{};
  text::Limit limit{text::Relation::at_least, 0.0};  ///< Limit that the quantity must keep.
  /// For the requirement that a goal is met: index of the goal among the judged goals; otherwise 0.
  std::size_t goal{0};
};

/// Default number of moves of each design point that are compared; it is divided by the moves of a trial to
/// give whole trials. The values of these moves take less than 0.5 GB.
constexpr std::int64_t default_compared_moves = 1'000'000;

/// Margins and requirements, for all design points or for a single one.
struct PointRules {
  std::map<std::string, GateMargin> margins{};  ///< {name of a measure: margin}
  /// Requirements. If the rules are for a single point, they apply in addition to those for all points.
  std::vector<Requirement> requirements{};
};

/// All rules of a comparison. The inherited margins and requirements apply to all design points.
struct GateRules : PointRules {
  double confidence{statistics::summary_confidence};  ///< Confidence of every one-sided bound.
  /// False discovery rate that is controlled over all measures at all points.
  double false_discovery_rate{0.05};
  /// True: for every measure, a change for the better beyond the margin fails the gate, too.
  bool changed_fails{false};
  /// Names of the measures that are judged. Empty: the measures of the goals, or without goals all
  /// (judged_measures()).
  std::vector<std::string> measures{};
  /// Largest number of trials of each point that are compared; the first ones are taken. Default:
  /// default_compared_moves divided by the number of moves of a trial.
  std::optional<std::int64_t> max_trials{};
  std::map<std::string, PointRules> points{};  ///< {label of a design point: rules for this point alone}
};

/// The measures that are judged, in the order of the report. If the rules list measures, only these are
/// judged. Otherwise, if the study has goals, the measures of the goals and the measures with a margin in the
/// rules are judged; without goals, all gate measures. "goal_rate" in the rules means this measure for every
/// goal.
/// @param goals goals by which both studies are judged; only a goal that asks for machines has goal_machines
std::vector<GateMeasure> judged_measures(const GateRules& rules, const layout::MeasureTable& table,
                                         const std::vector<study::Goal>& goals);

/// Whether the rules name a measure that a goal defines, such as "goal_rate".
bool names_goal_measure(const GateRules& rules);
/// Checks that each goal in the names of the rules' measures, such as "goal_rate[large]", is a goal that is
/// judged.
/// @param goals names of the judged goals
/// @param path path of the manifest or results file, for the message
/// @throws Failure (bad_input) if the rules name a measure of another goal
void require_named_goals(const GateRules& rules, std::span<const std::string> goals, std::string_view path);
/// Whether a study that has a goal is judged by the measures of this goal under these rules.
bool judges_by_goal(const GateRules& rules);

/// The margin of a measure at the design point with this label: the margin for this point, otherwise the
/// margin for all points, otherwise the default. A margin for the measure of one goal takes precedence over
/// one for the measure of all goals.
GateMargin margin_of(const GateRules& rules, const std::string& label, const GateMeasure& measure);

/// Whether any requirement, for all points or for a single one, is that the goal of the manifest is met.
bool requires_goal(const GateRules& rules);
/// The measures of error bands and tolerances that the requirements name. They are not gate measures, so
/// their values must be read in addition.
std::vector<GateMeasure> measures_of_limits(const GateRules& rules);

/// The rules after two replacements: the rules for a label are copied to all labels that represent it, and
/// the requirement `goal` becomes one requirement for each goal.
/// @param others {label: a label that represents it}
/// @param goals names of the goals
GateRules expanded(GateRules rules, const std::multimap<std::string, std::string>& others,
                   std::span<const std::string> goals);

/// The requirements that apply at the design point with this label: those for every point, then those for
/// this point alone.
std::vector<Requirement> requirements_of(const GateRules& rules, const std::string& label);

/// Reads the YAML file of margins and requirements (its language: docs/compare.md).
/// @param labels labels of the compared design points, which the file may name
/// @throws Failure (bad_input) with every mistake, one per line, as `file:line:column: path: what; expected`;
/// also if there is no such file
GateRules read_gate_rules(const std::filesystem::path& path, std::span<const std::string> labels);

/// Parses the YAML text of margins and requirements, like read_gate_rules().
/// @param source name of the file in messages
/// @param labels labels of the compared design points, which the text may name
GateRules parse_gate_rules(const std::string& text, std::string_view source,
                           std::span<const std::string> labels);

}  // namespace zerocount::comparison
