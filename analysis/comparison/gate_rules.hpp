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

/// How much a measure may change: the larger of `absolute` and `relative` times the baseline's value.
struct GateMargin {
  double absolute{0.0};       ///< in the measure's unit
  double relative{0.0};       ///< proportion of the baseline's value
  bool changed_fails{false};  ///< a change for the better beyond the margin is a failure too
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
  const layout::Measure* measure{nullptr};  ///< of the program's own table; null for a measure of the goal
  std::string name{};                       ///< of a goal with a name "goal_rate[large]"
  std::string_view unit{};
  GateMargin margin{};  ///< the default
  GateStatistic statistic{GateStatistic::mean};
  layout::Worse worse{layout::Worse::more};
  std::size_t goal{0};  ///< of the goals that are judged

  /// Judged by a proportion, of trials, moves or machines.
  bool proportion() const { return statistic != GateStatistic::mean && statistic != GateStatistic::quantile; }
  /// Whether it is of the goal of the manifest.
  bool of_goal() const { return measure == nullptr; }
};

/// The gate measures of the table, in the order of the report: proportions before means.
std::vector<GateMeasure> gate_measures(const layout::MeasureTable& measures = layout::measure_table());

/// The measures that judge a study by the goal of its manifest, in the order of the report: goal_rate,
/// goal_machines, goal_settling_time.
std::vector<GateMeasure> goal_measures();
/// "goal_rate[large]": a measure of a goal with this name; that of a goal without one has no brackets.
std::string name_of_goal_measure(std::string_view measure, std::string_view goal);
/// "goal_rate" of "goal_rate[large]", the name of a measure of whichever goal; other names as they are.
std::string_view without_goal(std::string_view measure);

/// Every measure that can be judged: those of the goal, then those of the program's own table.
std::vector<GateMeasure> all_gate_measures();

/// The measure of this name among all_gate_measures(), those of the goal with its name or without.
std::optional<GateMeasure> find_gate_measure(std::string_view name);

/// Names of quantiles behind that of a measure, as in "arrival_time.p95", and their probabilities.
inline constexpr std::array<std::pair<std::string_view, double>, 3> quantile_names{
    {{"median", 0.5}, {"p95", 0.95}, {"p99", 0.99}}};

enum class RequirementKind {
  proportion,  ///< of trials with the quality of a gate measure
  quantile,    ///< over trials; the value of a trial is that of its worst move
  mean,        ///< over trials; the value of a trial is the sum over its moves
  goal         ///< the goal of the manifest
};

/// A quantity that a requirement can limit, independently of the baseline.
struct RequirableQuantity {
  std::string name;
  std::string_view unit;
  RequirementKind kind{RequirementKind::proportion};
  GateMeasure measure{};
  double probability{0.0};  ///< of a quantile
};

/// The quantities that a requirement can limit, those of error bands for the bands 0 and 1. A proportion, or
/// the mean of a sum, has the name of its gate measure; other measures have quantiles (NAME.median, .p95,
/// .p99); "goal" has no limit of its own.
std::vector<RequirableQuantity> requirable_quantities();
/// The quantity of this name; a measure of an error band or a tolerance has any of them:
/// "band_settling_time[5].p95", "tolerance_settling_time[1e-8].p95".
std::optional<RequirableQuantity> find_requirable(std::string_view name);

/// "success_rate ≥ 0.995".
struct Requirement {
  std::string text;
  RequirableQuantity quantity{};
  bool at_least{true};
  double limit{0.0};
  std::size_t goal{0};  ///< of a requirement of one of several goals, its number
};

/// Moves of each point that are compared, in whole trials, unless another number of trials is asked for. They
/// take less than 0.5 GB.
constexpr std::int64_t default_compared_moves = 1'000'000;

/// The rules of all design points, or of one.
struct PointRules {
  std::map<std::string, GateMargin> margins{};  ///< [measure]
  std::vector<Requirement> requirements{};      ///< of one point beside those of all
};

struct GateRules : PointRules {
  double confidence{statistics::summary_confidence};  ///< of every bound, one-sided
  double false_discovery_rate{0.05};                  ///< over all measures at all points
  bool changed_fails{false};                          ///< of every measure, a change for the better fails too
  std::vector<std::string> measures{};  ///< that are judged; empty: judged_measures() says which
  /// Trials of each point that are compared, the first ones; default: default_compared_moves / moves of each.
  std::optional<std::int64_t> max_trials{};
  std::map<std::string, PointRules> points{};  ///< [label] that have rules of their own
};

/// A goal by which two studies are judged.
struct JudgedGoal {
  std::string name{};       ///< of `goals`; empty where the study has one goal
  bool of_machines{false};  ///< it asks for a proportion of machines too
};

/// The measures that are judged, in the order of the report. A goal is the question of its study: with goals,
/// and unless the rules name measures, they are those of the goals, and those that have a margin in the
/// rules. "goal_rate" in the rules is that of every goal.
std::vector<GateMeasure> judged_measures(const GateRules& rules, const layout::MeasureTable& table,
                                         const std::vector<JudgedGoal>& goals);

/// Whether the rules name a measure of the goal.
bool names_goal_measure(const GateRules& rules);
/// @param goals the names of those that are judged @param path of the manifest or file
/// @throws Failure (bad_input) where the rules name a measure of another goal
void require_named_goals(const GateRules& rules, std::span<const std::string> goals, std::string_view path);
/// Whether a measure of the goal is judged where a study has one.
bool judges_by_goal(const GateRules& rules);

/// The margin of a measure at a point: the point's own, or that of all points, or the default. A margin of
/// the measure of one goal comes before that of the measure of all goals.
GateMargin margin_of(const GateRules& rules, const std::string& label, const GateMeasure& measure);

/// Whether any requirement, at whatever point, is the goal.
bool requires_goal(const GateRules& rules);
/// The measures of requirements that are no gate measures: those of error bands and tolerances.
std::vector<GateMeasure> measures_of_limits(const GateRules& rules);

/// The rules with those of each of these labels given to the others that stand for it, and with the
/// requirement `goal` as one for each goal. @param goals their names
GateRules expanded(GateRules rules, const std::multimap<std::string, std::string>& others,
                   std::span<const std::string> goals);

/// The requirements at a point: those of every point and its own.
std::vector<Requirement> requirements_of(const GateRules& rules, const std::string& label);

/// Reads the YAML file of margins and requirements (its language: docs/compare.md).
/// @param labels of the design points that are compared, which the file may name
/// @throws Failure (bad_input) with every mistake, one a line, as `file:line:column: path: what; expected`;
/// also where there is no such file
GateRules read_gate_rules(const std::filesystem::path& path, std::span<const std::string> labels);

/// As read_gate_rules, from text; `source` stands for the file's name in messages.
GateRules parse_gate_rules(const std::string& text, std::string_view source,
                           std::span<const std::string> labels);

}  // namespace zerocount::comparison
