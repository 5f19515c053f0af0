#include "analysis/machine/monitor/monitor_baseline.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "core/loop/encoder.hpp"
#include "core/trial/parameters.hpp"
#include "experiments/parameters/study_units.hpp"
#include "experiments/study/study_trial.hpp"
#include "results/layout/fields.hpp"

namespace zerocount::monitor {
namespace {

constexpr std::int64_t trials_at_a_time = 4096;

/// Whether all trials of the study go to the same targets: no random input belongs to the command.
bool has_fixed_targets(const study::Study& study) {
  return std::ranges::none_of(study.columns.inputs, [](const study::InputColumn& column) {
    return column.name.starts_with("command.");
  });
}

constexpr std::int64_t no_number = std::numeric_limits<std::int64_t>::min();

/// The number rounded to 30 significant bits (about nine digits), so that a target stays equal to itself
/// after conversion of its unit.
double rounded(double value) {
  constexpr int bits = 30;
  int exponent = 0;
  const double mantissa = std::frexp(value, &exponent);
  return std::ldexp(std::rint(std::ldexp(mantissa, bits)), exponent - bits);
}

std::string_view text_of(int direction) {
  return direction > 0 ? " upwards" : direction < 0 ? " downwards" : "";
}

/// Whether targets of the baseline and of the later moves can be compared: their units have the same
/// dimension, or the later ones are in SI units and the size of the baseline's count is known.
bool are_comparable(const MoveLabels& baseline, const MoveLabels& later) {
  return have_same_dimension(baseline.target_unit, later.target_unit) ||
         (baseline.count > 0.0 && have_same_dimension(baseline.si_unit, later.target_unit));
}

bool has_several_numbers(const MoveLabels& labels) {
  return std::ranges::any_of(
      labels.moves, [&](const MoveLabel& label) { return label.number != labels.moves.front().number; });
}

/// Whether at least 90 % of the baseline's values have at least four others of the same class (all others, in
/// a baseline of fewer than five values).
/// @param ends [value] index one past its last move
bool values_repeat(const Likes& likes, std::span<const std::size_t> ends) {
  constexpr std::size_t enough_alike = 5;
  std::map<std::vector<std::size_t>, std::size_t> sizes;
  std::size_t first = 0;
  for (const std::size_t end : ends) {
    ++sizes[set_of(std::span(likes.of_baseline()).subspan(first, end - first))];
    first = end;
  }
  std::size_t alike = 0;
  for (const auto& [set, size] : sizes) alike += size >= std::min(enough_alike, ends.size()) ? size : 0;
  return 10 * alike >= 9 * ends.size();
}

}  // namespace

std::vector<MoveLabel> labels_of(const trial::TrialParameters& parameters) {
  std::vector<MoveLabel> labels;
  double before = 0.0;
  for (std::size_t move = 0; move < trial::move_count(parameters); ++move) {
    const auto target = static_cast<double>(trial::target_of_move(parameters, move));
    labels.push_back({.number = static_cast<std::int64_t>(move),
                      .target = target,
                      .direction = static_cast<int>(target > before) - static_cast<int>(target < before)});
    before = target;
  }
  return labels;
}

Baseline baseline_of(const MoveLog& log) {
  log.require_header();
  if (log.moves == 0)
    throw Failure(ExitCode::bad_data,
                  fmt::format("{}: has no moves; expected a row for each move of the baseline", log.name));
  return {log};
}

Baseline baseline_of(const reading::AllTrialsFile& file, const ModelMoves& moves) {
  const study::Study& study = file.study();
  const auto of_trial = static_cast<std::size_t>(file.moves());
  Baseline baseline{{.name = file.path().string()}, true, moves.machine ? 1 : study.machines};
  if (baseline.machines == 0) baseline.machines = file.header().trials;
  std::vector<const layout::RecordField<trial::MoveOutcome>*> fields;
  for (const auto& field : file.measures()) {
    const std::optional<MonitoredMeasure> measure = measure_named(field.column.name);
    if (!measure) continue;
    fields.push_back(&field);
    baseline.columns.push_back({*measure, parameters::unit_on(file.axis(), field.column.unit), {}});
  }
  const trial::TrialParameters first_trial = study::commanded_trial(study, moves.point, 0).parameters;
  baseline.labels = {.numbered = true,
                     .targeted = true,
                     .target_unit = "count",
                     .count = loop::fine_resolution(first_trial.encoder),
                     .si_unit = parameters::unit_on(file.axis(), "rad")};
  const bool fixed = has_fixed_targets(study);
  std::vector<MoveLabel> labels = labels_of(first_trial);
  const layout::RowRange rows = file.rows_of(moves.point);
  for (std::int64_t first = 0; first < rows.count; first += trials_at_a_time) {
    const std::int64_t count = std::min(trials_at_a_time, rows.count - first);
    const std::vector<trial::MoveOutcome> outcomes = file.outcomes({rows.first + first, count});
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
      const std::int64_t trial = first + static_cast<std::int64_t>(i / of_trial);
      if (moves.machine && study::group_of(study, study::Grouping::machine, trial) != *moves.machine)
        continue;
      ++baseline.moves;
      const std::size_t move = i % of_trial;
      if (!fixed && move == 0)
        labels = labels_of(study::commanded_trial(study, moves.point, trial).parameters);
      baseline.labels.moves.push_back(move < labels.size() ? labels[move] : MoveLabel{});
      for (std::size_t column = 0; column < fields.size(); ++column)
        baseline.columns[column].values.push_back(
            ranked_value(baseline.columns[column].measure, layout::value_of(*fields[column], outcomes[i])));
    }
  }
  return baseline;
}

Likes::Likes(LikeBy by, const MoveLabels& baseline, std::size_t moves, const MoveLabels& later)
    : by_(by), unit_(baseline.target_unit) {
  if (baseline.count > 0.0) {
    later_whole_ = true;
    if (!have_same_dimension(baseline.target_unit, later.target_unit)) later_scale_ = 1.0 / baseline.count;
  }
  for (std::size_t move = 0; move < moves; ++move) {
    const MoveLabel label = baseline.of(move);
    const auto [at, is_new] = classes_.try_emplace(key_of(label, 1.0, false), names_.size());
    if (is_new) {
      names_.push_back(name_with_target(label, 1.0));
      directions_.push_back(label.direction);
    }
    if (directions_[at->second] != label.direction) directions_[at->second] = 0;
    of_baseline_.push_back(at->second);
  }
}

Likes::Key Likes::key_of(const MoveLabel& label, double target_scale, bool whole) const {
  Key key{no_number, std::numeric_limits<double>::infinity(), 0};
  if (uses_number() && label.number) std::get<0>(key) = *label.number;
  if (uses_target() && label.target) {
    const double target = *label.target * target_scale;
    std::get<1>(key) = whole ? std::rint(target) : rounded(target);
  }
  if (uses_direction()) std::get<2>(key) = label.direction;
  return key;
}

std::optional<std::size_t> Likes::of(const MoveLabel& label) const {
  const auto found = classes_.find(key_of(label, later_scale_, later_whole_));
  return found == classes_.end() ? std::nullopt : std::optional(found->second);
}

std::optional<std::size_t> Likes::of_own(const MoveLabel& label) const {
  const auto found = classes_.find(key_of(label, 1.0, false));
  return found == classes_.end() ? std::nullopt : std::optional(found->second);
}

std::string Likes::name_of(const MoveLabel& label) const {
  return name_with_target(label, later_scale_);
}

std::string Likes::name_with_target(const MoveLabel& label, double target_scale) const {
  std::string name;
  if (uses_number()) name = label.number ? fmt::format("move {}", *label.number) : "move without a number";
  if (uses_target()) {
    if (!name.empty()) name += ", ";
    name += label.target ? fmt::format("target {:.9g}", *label.target * target_scale) : "no target";
    if (label.target && !unit_.empty()) name += " " + unit_;
  }
  if (by_ == LikeBy::direction) name = label.direction == 0 ? "no direction" : "moves";
  return uses_direction() ? name + std::string(text_of(label.direction)) : name;
}

double Likes::oriented(const MonitoredMeasure& measure, std::size_t like, double value) const {
  if (!measure.row->values.mirrored || count() < 2 || std::isinf(value)) return value;
  return directions_[like] == 0 ? std::abs(value) : directions_[like] * value;
}

bool Likes::takes_magnitudes() const {
  std::size_t magnitudes = 0;
  for (const std::size_t like : of_baseline_) magnitudes += directions_[like] == 0 ? 1 : 0;
  return count() > 1 && 2 * magnitudes > of_baseline_.size();
}

std::vector<std::size_t> set_of(std::span<const std::size_t> likes) {
  std::vector<std::size_t> set(likes.begin(), likes.end());
  std::ranges::sort(set);
  set.erase(std::ranges::unique(set).begin(), set.end());
  return set;
}

double value_of(const MonitoredMeasure& measure, const Likes& likes, std::span<const std::size_t> classes,
                std::span<const double> values) {
  if (values.size() == 1) return likes.oriented(measure, classes[0], values[0]);
  const std::vector<std::size_t> set = set_of(classes);
  double sum = 0.0;
  std::vector<double> alike;
  for (const std::size_t like : set) {
    alike.clear();
    for (std::size_t i = 0; i < values.size(); ++i)
      if (classes[i] == like) alike.push_back(likes.oriented(measure, like, values[i]));
    sum += typical_value(measure, alike);
  }
  return set.size() == 1 ? sum : sum / static_cast<double>(set.size());
}

Likes likes_of(const MoveLabels& baseline, std::size_t moves, std::span<const std::size_t> ends,
               const MoveLabels& later, const std::string& file) {
  const bool targeted = baseline.targeted && later.targeted;
  const bool numbered = baseline.numbered && later.numbered && has_several_numbers(baseline);
  if (targeted && !are_comparable(baseline, later))
    throw Failure(
        ExitCode::bad_input,
        fmt::format("{}: target is in '{}', and in the baseline in '{}'; expected units of the same "
                    "dimension",
                    file, later.target_unit, baseline.target_unit));
  std::vector<LikeBy> candidates;
  if (targeted && numbered) candidates.push_back(LikeBy::number_and_target);
  if (targeted) candidates.push_back(LikeBy::target);
  if (numbered) candidates.push_back(LikeBy::number);
  if (targeted) candidates.push_back(LikeBy::direction);
  for (const LikeBy by : candidates) {
    Likes likes(by, baseline, moves, later);
    if (values_repeat(likes, ends)) return likes;
  }
  return {LikeBy::nothing, baseline, moves, later};
}

}  // namespace zerocount::monitor
