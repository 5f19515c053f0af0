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

#include "analysis/statistics/proportion.hpp"
#include "results/layout/measure_table.hpp"

/// The judged measures, their margins, and the absolute requirements.
namespace zerocount::comparison {

/// The change of a measure that is accepted: the larger of `absolute` and `relative` times the baseline's
/// value.
struct GateMargin {
  double absolute{0.0};       ///< Absolute margin, in the measure's unit.
  double relative{0.0};       ///< Margin as a proportion of the baseline's value.
  bool changed_fails{false};  ///< A change for the better beyond the margin fails too.
};

/// The statistic of a measure that the gate compares.
enum class GateStatistic {
  trials,    ///< proportion of trials with a quality
  mean,      ///< mean over the trials
  moves,     ///< proportion of moves that meet the goal
  machines,  ///< proportion of machines that meet the goal in Goal::moves of their moves
  quantile   ///< quantile over all moves of a time that may not be reached
};

/// One measure that a comparison judges.
struct GateMeasure {
  const layout::Measure* measure{nullptr};  ///< Row of the program's own table; null for a measure of a goal.
  std::string name{};                       ///< Name of the measure; for a named goal "goal_rate[large]".
  std::string_view unit{};
  GateMargin margin{};  ///< default margin
  GateStatistic statistic{GateStatistic::mean};
  layout::Worse worse{layout::Worse::more};
  std::size_t goal{0};  ///< Index among the goals that are judged, for a measure of a goal.

  /// Whether the statistic is a proportion: of trials, moves or machines.
  bool proportion() const { return statistic != GateStatistic::mean && statistic != GateStatistic::quantile; }
  /// Whether the measure belongs to a goal of the manifest.
  bool of_goal() const { return measure == nullptr; }
};

/// The gate measures of the table, in the order of the report: proportions before means.
std::vector<GateMeasure> gate_measures(const layout::MeasureTable& measures = layout::measure_table());

/// The measures that judge a study by the goal of its manifest, in the order of the report: goal_rate,
/// goal_machines, goal_settling_time.
std::vector<GateMeasure> goal_measures();
/// Name of a measure of a goal: "goal_rate[large]", or "goal_rate" if the goal has no name.
/// @param goal name of the goal; may be empty
std::string name_of_goal_measure(std::string_view measure, std::string_view goal);
/// The name of the measure without the name of its goal: "goal_rate" for "goal_rate[large]". Other names stay
/// unchanged.
std::string_view without_goal(std::string_view measure);

/// Every measure that can be judged: the measures of the goal, then those of the program's own table.
std::vector<GateMeasure> all_gate_measures();

/// The measure with this name among all_gate_measures(); empty if there is none. The name of a measure of a
/// goal may include the name of the goal.
std::optional<GateMeasure> find_gate_measure(std::string_view name);

/// Names of quantiles, as they follow the name of a measure in "arrival_time.p95", with their probabilities.
inline constexpr std::array<std::pair<std::string_view, double>, 3> quantile_names{
    {{"median", 0.5}, {"p95", 0.95}, {"p99", 0.99}}};

enum class RequirementKind {
  proportion,  ///< proportion of trials with the quality of a gate measure
  quantile,    ///< quantile over trials; the value of a trial is that of its worst move
  mean,        ///< mean over trials; the value of a trial is the sum over its moves
  goal         ///< the goal of the manifest
};

/// A quantity that a requirement can limit, independently of the baseline.
struct RequirableQuantity {
  std::string name;
  std::string_view unit;
  RequirementKind kind{RequirementKind::proportion};
  GateMeasure measure{};
  double probability{0.0};  ///< Probability of the quantile; 0 for other kinds.
};

/// The quantities that a requirement can limit; quantities of error bands are listed for the bands 0 and 1. A
/// proportion, and the mean of a sum, have the name of their gate measure. Other measures have quantiles
/// (NAME.median, .p95, .p99). "goal" has no limit of its own.
std::vector<RequirableQuantity> requirable_quantities();
/// The quantity with this name; empty if there is none. The measures of error bands and tolerances exist for
/// every band and tolerance: "band_settling_time[5].p95", "tolerance_settling_time[1e-8].p95".
std::optional<RequirableQuantity> find_requirable(std::string_view name);

/// A limit that the current file must meet, such as "success_rate ≥ 0.995".
struct Requirement {
  std::string text;
  RequirableQuantity quantity{};
  bool at_least{true};
  double limit{0.0};
  std::size_t goal{0};  ///< Index of the goal, if the requirement is one of several goals.
};

/// Default number of moves of each point that are compared, in whole trials. They take less than 0.5 GB.
constexpr std::int64_t default_compared_moves = 1'000'000;

/// The rules for all design points, or for a single one.
struct PointRules {
  std::map<std::string, GateMargin> margins{};  ///< [measure]
  std::vector<Requirement> requirements{};      ///< For a single point: in addition to those for all points.
};

/// All rules of a comparison; the inherited members are the rules for all points.
struct GateRules : PointRules {
  double confidence{statistics::summary_confidence};  ///< Confidence of every bound, one-sided.
  double false_discovery_rate{0.05};                  ///< over all measures at all points
  bool changed_fails{false};            ///< For every measure, a change for the better fails too.
  std::vector<std::string> measures{};  ///< Names of the judged measures; empty: see judged_measures().
  /// Number of trials of each point that are compared, from the first trial on. Default:
  /// default_compared_moves / moves of a trial.
  std::optional<std::int64_t> max_trials{};
  std::map<std::string, PointRules> points{};  ///< [label] rules for single points
};

/// A goal by which two studies are judged.
struct JudgedGoal {
  std::string name{};       ///< Name of the goal in `goals`; empty if the study has one goal.
  bool of_machines{false};  ///< The goal also asks for a proportion of machines.
};

/// The measures that are judged, in the order of the report. If the rules list measures, these are judged.
/// Otherwise, if the study has goals, the measures of the goals and those with a margin in the rules are
/// judged; without goals, all gate measures. "goal_rate" in the rules means the measure of every goal.
std::vector<GateMeasure> judged_measures(const GateRules& rules, const layout::MeasureTable& table,
                                         const std::vector<JudgedGoal>& goals);

/// Whether the rules name a measure of a goal.
bool names_goal_measure(const GateRules& rules);
/// Checks the goals that the rules name. @param goals names of the goals that are judged @param path path of
/// the manifest or file
/// @throws Failure (bad_input) if the rules name a measure of another goal
void require_named_goals(const GateRules& rules, std::span<const std::string> goals, std::string_view path);
/// Whether the rules judge a measure of the goal, if the study has a goal.
bool judges_by_goal(const GateRules& rules);

/// The margin of a measure at a point: the margin for this point, otherwise for all points, otherwise the
/// default. A margin for the measure of one goal takes precedence over one for the measure of all goals.
GateMargin margin_of(const GateRules& rules, const std::string& label, const GateMeasure& measure);

/// Whether any requirement, at any point, is the goal.
bool requires_goal(const GateRules& rules);
/// The measures in requirements that are not gate measures, namely those of error bands and tolerances.
std::vector<GateMeasure> measures_of_limits(const GateRules& rules);

/// The rules with the rules for a label copied to all labels that represent it, and with the requirement
/// `goal` replaced by one requirement for each goal. @param others {label: a label that represents it}
/// @param goals names of the goals
GateRules expanded(GateRules rules, const std::multimap<std::string, std::string>& others,
                   std::span<const std::string> goals);

/// The requirements at a point: those for every point, then those for this point.
std::vector<Requirement> requirements_of(const GateRules& rules, const std::string& label);

/// Reads the YAML file of margins and requirements (its language: docs/compare.md).
/// @param labels labels of the compared design points, which the file may name
/// @throws Failure (bad_input) with every mistake, one per line, as `file:line:column: path: what; expected`;
/// also if there is no such file
GateRules read_gate_rules(const std::filesystem::path& path, std::span<const std::string> labels);

/// Parses the text of a file of margins and requirements, like read_gate_rules(). @param source name of the
/// file in messages
GateRules parse_gate_rules(const std::string& text, std::string_view source,
                           std::span<const std::string> labels);

}  // namespace zerocount::comparison
