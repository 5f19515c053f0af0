#include "analysis/machine/monitor/machine_monitor.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/parallel/parallel.hpp"
#include "analysis/basis/text/text.hpp"
#include "analysis/machine/monitor/change_test.hpp"
#include "analysis/trials/measures/stream_name.hpp"
#include "core/failure/failure.hpp"
#include "core/numerics/interval.hpp"
#include "core/random/random_numbers.hpp"
#include "experiments/designs/designs.hpp"

namespace zerocount::monitor {
namespace {

constexpr double usual_relative_change = 0.2;
constexpr double usual_change_of_proportion = 0.1;
constexpr int sequences = 200;
constexpr int max_misses = 12;  // binomial: P(12 or fewer of 200) = 3 % where each has the probability 10 %
constexpr std::array all_forms{ChangeForm::shift, ChangeForm::factor};
constexpr std::size_t max_resample = 5000;

/// Interval of the values that a measure can have.
numerics::Interval range_of(const MonitoredMeasure& measure) {
  const layout::ValidValues& valid = measure.row->field.valid;
  numerics::Interval range =
      valid.expected.empty() ? numerics::all_numbers() : numerics::closed(valid.low, valid.high);
  if (measure.row->values.magnitude) range.low = std::max(range.low, 0.0);
  return range;
}

bool can_be(const MonitoredMeasure& measure, double value) {
  const numerics::Interval range = range_of(measure);
  return value >= range.low && value <= range.high;
}

/// Change of a measure that the monitor must be able to see, for the values of one class of similar moves.
struct ChangeOfClass {
  double size{0.0};
  /// Directions in which the measure can change by `size`; empty: no change can be stated for the class.
  std::vector<Direction> directions{};
};

ChangeOfClass change_of_class(const MonitoredMeasure& measure, std::span<const double> baseline,
                              std::optional<double> change) {
  if (baseline.empty()) return {};
  const double middle = typical_value(measure, {baseline.begin(), baseline.end()});
  if (std::isinf(middle)) return {};
  ChangeOfClass to_see;
  const auto allow = [&](bool higher, bool lower) {
    if (higher) to_see.directions.push_back(Direction::higher);
    if (lower) to_see.directions.push_back(Direction::lower);
  };
  if (measure.scale == Scale::proportion) {
    to_see.size = change.value_or(usual_change_of_proportion);
    allow(middle + to_see.size <= 1.0, middle - to_see.size >= 0.0);
    return to_see;
  }
  const auto [low, high] = std::ranges::minmax(baseline);
  const bool has_both_signs = low < 0.0 && high > 0.0 && std::isfinite(low) && std::isfinite(high);
  if (middle == 0.0 || has_both_signs) return {};
  to_see.size = change.value_or(usual_relative_change) * std::abs(middle);
  allow(can_be(measure, middle + to_see.size), can_be(measure, middle - to_see.size));
  return to_see;
}

/// Draws one of the values, each with the same probability.
template <class Values>
auto value_from(const Values& values, random::NumberSource& numbers) {
  const auto place = static_cast<std::size_t>(numbers.uniform() * static_cast<double>(values.size()));
  return values[std::min(place, values.size() - 1)];
}

/// Draws random values of one class of similar moves as a changed machine would have them: values resampled
/// from the baseline, with the assumed change.
class ChangedValue {
 public:
  ChangedValue(const DelayQuestion& question, std::size_t of_class)
      : scale_(question.measure.scale),
        baseline_(question.baseline[of_class]),
        lowest_(range_of(question.measure).low),
        size_(question.sizes[of_class]),
        sign_(question.direction == Direction::higher ? 1.0 : -1.0),
        is_binary_(question.measure.quality &&
                   std::ranges::all_of(baseline_, [](double x) { return x == 0.0 || x == 1.0; })) {
    if (baseline_.empty() || size_ == 0.0) return;
    const double typical = typical_value(question.measure, {baseline_.begin(), baseline_.end()});
    if (is_binary_) flipped_ = size_ / (sign_ > 0.0 ? 1.0 - typical : typical);
    if (question.form == ChangeForm::factor) factor_ = 1.0 + sign_ * size_ / typical;
  }

  double operator()(random::NumberSource& numbers) const {
    const double before = value_from(baseline_, numbers);
    if (is_binary_) {
      const bool can_flip = before == (sign_ > 0.0 ? 0.0 : 1.0);
      return can_flip && numbers.uniform() < flipped_ ? 1.0 - before : before;
    }
    if (std::isinf(before)) return before;
    const double after = factor_ ? *factor_ * before : before + sign_ * size_;
    switch (scale_) {
      case Scale::proportion:
        return std::clamp(after, 0.0, 1.0);
      case Scale::counts: {
        const double more = after - before;
        const double whole = std::floor(more);
        return std::max(0.0, before + whole + (numbers.uniform() < more - whole ? 1.0 : 0.0));
      }
      case Scale::plain:
        break;
    }
    return std::max(lowest_, after);
  }

 private:
  Scale scale_;
  std::span<const double> baseline_;
  double lowest_;  ///< Smallest value that the measure can have, such as 0 for a time; −∞ without a limit.
  double size_;
  double sign_;
  bool is_binary_;
  /// For a measure that is only 0 or 1: probability that a drawn value flips to the other number, if the flip
  /// has the direction of the change.
  double flipped_{0.0};
  /// Number by which each value is multiplied if the change is a factor; nothing for a shift.
  std::optional<double> factor_{};
};

std::string_view word_of(ChangeForm form) {
  return form == ChangeForm::shift ? "" : ".factor";
}

std::vector<std::vector<double>> resample(std::span<const std::vector<double>> classes, std::size_t total,
                                          random::NumberSource& numbers) {
  const double part = std::min(1.0, static_cast<double>(max_resample) / static_cast<double>(total));
  std::vector<std::vector<double>> drawn;
  for (const std::vector<double>& values : classes) {
    const auto size = static_cast<std::size_t>(std::rint(part * static_cast<double>(values.size())));
    drawn.emplace_back(values.empty() ? 0 : std::max<std::size_t>(1, size));
    for (double& value : drawn.back()) value = value_from(values, numbers);
  }
  return drawn;
}

constexpr std::int64_t max_simulated = 100'000;  // values of a simulated sequence
constexpr std::int64_t min_simulated = 64;

/// Smallest proportion of the variance of a measure's ranks that lies between classes of similar moves
/// (part_between()) for medians per class. At a smaller proportion one median for all moves is reported.
constexpr double most_between_likes = 0.5;
constexpr double dependent_p = 0.01;      // significance level for one measure
constexpr double any_dependent_p = 0.05;  // for all measures together, used if it allows more

/// [value] Index one past the last move of each value, in the moves of the baseline. A value comes from one
/// move, a block of consecutive moves or a group of moves. An incomplete last block is not used.
std::vector<std::size_t> ends_of(const Baseline& baseline, const MonitorSettings& settings) {
  std::vector<std::size_t> ends;
  const auto moves = static_cast<std::size_t>(baseline.moves);
  if (settings.group.empty()) {
    const auto block = static_cast<std::size_t>(settings.block);
    for (std::size_t end = block; end <= moves; end += block) ends.push_back(end);
    if (ends.empty())
      throw Failure(ExitCode::bad_data,
                    fmt::format("the baseline has {} moves; expected at least a block of {}", moves, block));
    return ends;
  }
  for (std::size_t move = 1; move <= moves; ++move)
    if (move == moves || baseline.groups[move] != baseline.groups[move - 1]) ends.push_back(move);
  return ends;
}

/// Unit in which the values of a column with this unit are stored: the measure's unit, or the one that it has
/// on a linear axis.
std::string shown_unit(const MonitoredMeasure& measure, const std::string& unit) {
  return have_same_dimension(unit, measure.unit) ? measure.unit : linear_unit(measure);
}

/// The settings with the names of the measures as the program writes them (measure_named()).
MonitorSettings with_own_names(MonitorSettings settings) {
  for (std::string& name : settings.measures)
    if (const std::optional<MonitoredMeasure> measure = measure_named(name)) name = measure->name;
  return settings;
}

bool is_wanted(const MonitorSettings& settings, const MonitoredMeasure& measure) {
  if (settings.measures.empty()) return !measure.accumulates;
  return std::ranges::find(settings.measures, measure.name) != settings.measures.end();
}

/// Columns of one side (baseline or log) that are not watched: heads of the columns that are not measures,
/// then the names of the measures that are not in `watched`.
std::vector<std::string> unread_columns(const Moves& side, const std::vector<std::string>& watched) {
  std::vector<std::string> heads = side.other_columns;
  for (const Moves::Column& column : side.columns)
    if (std::ranges::find(watched, column.measure.name) == watched.end())
      heads.push_back(column.measure.name);
  return heads;
}

/// Names of the measures that `other` has and `side` lacks. One of them is the baseline, the other the log.
std::vector<std::string> missing_measures(const Moves& side, const Moves& other) {
  std::vector<std::string> missing;
  for (const Moves::Column& column : side.columns)
    if (other.find(column.measure.name) == nullptr) missing.push_back(column.measure.name);
  return missing;
}

/// Hint, for a message, at a column of this side (baseline or log) whose name resembles the missing measure:
/// "; its column 'Arrival_Time' looks like it". Empty if there is none.
std::string near_text(const Moves& side, const std::string& measure) {
  const std::optional<std::string> near = resembling_column(measure, unread_columns(side, {}));
  return near ? fmt::format("; its column '{}' looks like it", text::printable(*near)) : "";
}

/// Names of the measures of one side (baseline or log), for a message: "arrival_time, overshoot and 30 more".
std::string names_of(const Moves& side) {
  constexpr std::size_t max_shown = 8;
  std::vector<std::string> names;
  for (const Moves::Column& column : side.columns) names.push_back(column.measure.name);
  const std::size_t more = names.size() > max_shown ? names.size() - max_shown : 0;
  names.resize(names.size() - more);
  return fmt::format("{}{}", fmt::join(names, ", "), more > 0 ? fmt::format(" and {} more", more) : "");
}

/// Tells that a label of moves (`move` or `target`) is not used, because only the baseline or only the log
/// has it; nothing if both or neither have it. If the baseline is a simulated study, which always has labels,
/// it tells so only if the log has the column in another letter case.
std::optional<UnwatchedMeasure> unused_label(const Baseline& baseline, const MoveLog& log,
                                             const std::string& label, bool MoveLabels::*has) {
  if (baseline.labels.*has == log.labels.*has) return std::nullopt;
  const bool is_missing = baseline.labels.*has;
  const Moves& without = is_missing ? static_cast<const Moves&>(log) : baseline;
  UnwatchedMeasure unused{label, is_missing ? WhyUnwatched::missing : WhyUnwatched::not_in_baseline,
                          resembling_column(label, without.other_columns)};
  const auto is_label = [&](const std::string& head) {
    return std::ranges::equal(column_head(head).name, label, [](char a, char b) {
      return std::tolower(static_cast<unsigned char>(a)) == static_cast<unsigned char>(b);
    });
  };
  if (baseline.is_model && !(unused.near && is_label(*unused.near))) return std::nullopt;
  return unused;
}

/// The labels `move` and `target`, as far as unused_label() finds that only one side has them.
std::vector<UnwatchedMeasure> labels_on_one_side(const Baseline& baseline, const MoveLog& log) {
  std::vector<UnwatchedMeasure> labels;
  for (const auto& [label, has] :
       {std::pair{"move", &MoveLabels::numbered}, std::pair{"target", &MoveLabels::targeted}})
    if (std::optional<UnwatchedMeasure> unused = unused_label(baseline, log, label, has))
      labels.push_back(std::move(*unused));
  return labels;
}

[[noreturn]] void refuse_without_common(const Baseline& baseline, const MoveLog& log,
                                        std::span<const UnwatchedMeasure> unwatched) {
  std::string hints;
  for (const UnwatchedMeasure& one : unwatched) {
    if (one.why == WhyUnwatched::accumulates)
      hints += fmt::format("; {} is compared only where --measure names it", one.measure);
    if (one.near)
      hints += fmt::format("; the column '{}' of {} looks like {}", text::printable(*one.near),
                           one.why == WhyUnwatched::missing ? log.name : baseline.name, one.measure);
  }
  throw Failure(
      ExitCode::bad_input,
      fmt::format("{}: no measure to compare: it has {}, and {} has {}; expected columns named alike{}",
                  log.name, names_of(log), baseline.name, names_of(baseline), hints));
}

}  // namespace

ChangeToSee change_to_see(const MonitoredMeasure& measure, std::span<const std::vector<double>> baseline,
                          std::optional<double> change) {
  ChangeToSee to_see;
  std::vector<Direction> possible{Direction::higher, Direction::lower};
  bool any = false;
  for (const std::vector<double>& values : baseline) {
    const ChangeOfClass one = change_of_class(measure, values, change);
    to_see.sizes.push_back(one.directions.empty() ? 0.0 : one.size);
    if (one.directions.empty()) continue;
    any = true;
    std::erase_if(possible, [&](Direction direction) {
      return std::ranges::find(one.directions, direction) == one.directions.end();
    });
  }
  if (any) to_see.directions = possible;
  return to_see;
}

std::span<const ChangeForm> forms_of(const MonitoredMeasure& measure) {
  return std::span(all_forms).first(measure.scale == Scale::proportion ? 1 : all_forms.size());
}

std::optional<std::int64_t> values_to_see(const DelayQuestion& question) {
  std::vector<std::size_t> classes;  // [value of the baseline]
  for (std::size_t i = 0; i < question.baseline.size(); ++i)
    classes.insert(classes.end(), question.baseline[i].size(), i);
  std::vector<ChangedValue> changed;
  for (std::size_t i = 0; i < question.baseline.size(); ++i) changed.emplace_back(question, i);
  const random::RandomKey values = designs::random_key(
      question.seed,
      fmt::format("monitor.{}.{}{}", measures::stream_name(question.measure.name),
                  question.direction == Direction::higher ? "higher" : "lower", word_of(question.form)));
  std::vector<std::int64_t> delays;
  int misses = 0;
  for (std::uint32_t i = 0; i < sequences && misses <= max_misses; ++i) {
    random::NumberSource numbers(values, i);
    ChangeTest test(
        resample(question.baseline, classes.size(), numbers),
        designs::random_key(question.seed,
                            fmt::format("monitor.{}.{}", measures::stream_name(question.measure.name), i)));
    while (test.martingale().values() < question.max_values && test.martingale().capital() < question.alarm) {
      const std::size_t next = question.baseline.size() == 1 ? 0 : value_from(classes, numbers);
      test.update(changed[next](numbers), next);
    }
    const bool seen = test.martingale().capital() >= question.alarm;
    if (!seen) ++misses;
    delays.push_back(seen ? test.martingale().values() : std::numeric_limits<std::int64_t>::max());
  }
  if (misses > max_misses) return std::nullopt;
  std::ranges::sort(delays);
  return delays[sequences - max_misses - 1];
}

MachineMonitor::MachineMonitor(const Baseline& baseline, const MoveLog& log, MonitorSettings settings)
    : settings_(with_own_names(std::move(settings))),
      baseline_ends_(ends_of(baseline, settings_)),
      likes_(likes_of(baseline.labels, static_cast<std::size_t>(baseline.moves), baseline_ends_, log.labels,
                      log.name)),
      last_group_(baseline.groups.empty() ? std::string() : baseline.groups.back()) {
  for (const std::string& name : log.others()) {
    const std::string label = column_head(name).name;
    const bool is_used = (label == "move" && likes_.uses_number()) ||
                         (label == "target" && (likes_.uses_target() || likes_.uses_direction())) ||
                         (!settings_.group.empty() && (label == settings_.group || name == settings_.group));
    if (!is_used) unused_.push_back(name);
  }
  std::size_t first = 0;
  for (const std::size_t end : baseline_ends_) {
    const auto likes = std::span(likes_.of_baseline()).subspan(first, end - first);
    baseline_classes_.push_back(classes_.try_emplace(set_of(likes), classes_.size()).first->second);
    first = end;
  }
  std::vector<std::vector<double>> values;
  const std::vector<Pair> common = common_columns(baseline, log);
  for (const auto& [before, column] : common) values.push_back(add(*before, *column));
  if (settings_.measures.empty()) note_unwatched(baseline, log, common);
  unused_labels_ = labels_on_one_side(baseline, log);
  if (states_.empty()) refuse_without_common(baseline, log, unwatched_);
  for (MeasureState& state : states_) state.evidence = 1.0 / static_cast<double>(states_.size());
  if (!baseline.is_model) test_dependence(values);
}

std::vector<MachineMonitor::Pair> MachineMonitor::common_columns(const Baseline& baseline,
                                                                 const MoveLog& log) {
  for (const std::string& name : settings_.measures) {
    if (log.find(name) != nullptr && baseline.find(name) != nullptr) continue;
    const Moves& without = log.find(name) == nullptr ? static_cast<const Moves&>(log) : baseline;
    throw Failure(ExitCode::bad_input, fmt::format("--measure {}: {} has no such measure{}", name,
                                                   without.name, near_text(without, name)));
  }
  std::vector<Pair> common;
  for (const MoveLog::Column& column : log.columns) {
    const MoveLog::Column* const before = baseline.find(column.measure.name);
    const bool named = !settings_.measures.empty();
    const bool wanted = before != nullptr && is_wanted(settings_, column.measure);
    if (!wanted && (before == nullptr || !named)) unused_.push_back(column.measure.name);
    if (!wanted) continue;
    if (!have_same_dimension(before->unit, column.unit))
      throw Failure(ExitCode::bad_input,
                    fmt::format("{}: {} is in '{}', and in {} in '{}'; expected units of the same dimension",
                                log.name, column.measure.name, column.unit, baseline.name, before->unit));
    common.emplace_back(before, &column);
  }
  return common;
}

void MachineMonitor::note_unwatched(const Baseline& baseline, const MoveLog& log,
                                    const std::vector<Pair>& common) {
  std::vector<std::string> watched;
  for (const auto& [before, column] : common) watched.push_back(column->measure.name);
  const auto note = [&](const Moves& side, const Moves& other, WhyUnwatched why) {
    const std::vector<std::string> missing = missing_measures(side, other);
    const std::vector<std::string> unread = unread_columns(other, watched);
    for (const std::string& measure : missing) {
      std::optional<std::string> near = resembling_column(measure, unread);
      if (near && resembling_column(column_head(*near).name, missing) != measure) near.reset();
      unwatched_.push_back({measure, why, std::move(near)});
    }
  };
  note(baseline, log, WhyUnwatched::missing);
  note(log, baseline, WhyUnwatched::not_in_baseline);
  for (const Moves::Column& column : log.columns)
    if (column.measure.accumulates && baseline.find(column.measure.name) != nullptr)
      unwatched_.push_back({column.measure.name, WhyUnwatched::accumulates});
}

std::vector<double> MachineMonitor::add(const MoveLog::Column& before, const MoveLog::Column& column) {
  const MonitoredMeasure& measure = column.measure;
  const std::span<const std::size_t> likes(likes_.of_baseline());
  std::vector<double> values;
  std::vector<std::vector<double>> by_class(classes_.size());
  std::size_t first = 0;
  for (std::size_t value = 0; value < baseline_ends_.size(); ++value) {
    const std::size_t length = baseline_ends_[value] - first;
    values.push_back(value_of(measure, likes_, likes.subspan(first, length),
                              std::span(before.values).subspan(first, length)));
    by_class[baseline_classes_[value]].push_back(values.back());
    first = baseline_ends_[value];
  }
  MeasureState state{.measure = measure,
                     .unit = shown_unit(measure, before.unit.empty() ? column.unit : before.unit)};
  std::vector<std::vector<double>> by_like(likes_.count());
  std::vector<double> oriented;
  for (std::size_t move = 0; move < likes.size(); ++move) {
    oriented.push_back(likes_.oriented(measure, likes[move], before.values[move]));
    by_like[likes[move]].push_back(oriented.back());
  }
  if (likes_.count() > 1 && !measure.quality && part_between(oriented, likes) >= most_between_likes)
    for (std::size_t like = 0; like < by_like.size(); ++like)
      state.by_like.push_back({.measure = measure.name,
                               .like = likes_.name(like),
                               .baseline = typical_value(measure, by_like[like]),
                               .baseline_moves = std::ssize(by_like[like])});
  else
    state.baseline_median = typical_value(measure, std::move(oriented));
  state.to_see = change_to_see(measure, by_class, settings_.change);
  for (std::vector<double>& alike : by_class) std::ranges::sort(alike);
  const random::RandomKey ties =
      designs::random_key(settings_.seed, fmt::format("monitor.{}", measures::stream_name(measure.name)));
  ChangeTest test(by_class, ties);
  watched_.push_back({.test = std::move(test), .baseline = std::move(by_class)});
  states_.push_back(std::move(state));
  return values;
}

void MachineMonitor::test_dependence(const std::vector<std::vector<double>>& values) {
  parallel::for_each_index(states_.size(), [&](std::size_t i) {
    MeasureState& state = states_[i];
    state.correlation =
        serial_correlation(classes_.size() == 1 ? values[i] : ranks_within(values[i], baseline_classes_));
    state.dependence = dependence_of(
        values[i], baseline_classes_,
        designs::random_key(settings_.seed,
                            fmt::format("monitor.order.{}", measures::stream_name(state.measure.name))));
  });
}

std::vector<const MeasureState*> MachineMonitor::dependent() const {
  const double level = std::max(dependent_p, any_dependent_p / static_cast<double>(states_.size()));
  std::vector<const MeasureState*> states;
  for (const MeasureState& state : states_)
    if (state.dependence.p <= level) states.push_back(&state);
  return states;
}

void MachineMonitor::update_measure(std::size_t number, std::size_t of_class, double value) {
  Watched& watched = watched_[number];
  MeasureState& state = states_[number];
  const double p = watched.test.update(value, of_class);
  const ChangeMartingale& martingale = watched.test.martingale();
  const double capital = martingale.capital();
  state.evidence = std::max(state.evidence, capital / static_cast<double>(states_.size()));
  if (state.alarm_at) return;
  watched.p_values.push_back(p);
  if (capital < alarm_capital()) return;
  state.direction = martingale.direction();
  state.alarm_at = units_.back().last + 1;
  state.since = units_[static_cast<std::size_t>(martingale.since(watched.p_values) - 1)].first + 1;
  watched.p_values = {};
}

/// Adds a move of the log to the current value (a value is one move, a block or a group of moves). A block is
/// complete with its last move. A group is complete only when the first move of the next group arrives.
void MachineMonitor::take_move(const MoveLog& log, const Columns& columns, std::size_t move) {
  const std::optional<std::size_t> like = likes_.of(log.labels.of(move));
  like_at_.push_back(like);
  const bool grouped = !settings_.group.empty();
  if (grouped) {
    const std::string& group = log.groups[move];
    continues_baseline_ = continues_baseline_ && group == last_group_;
    if (continues_baseline_) {
      like_at_.back().reset();
      ++continued_;
      return;
    }
    if (move > 0 && group != log.groups[move - 1]) finish_unit(columns);
  }
  if (!like) {
    if (unlike_++ == 0) first_unlike_ = likes_.name_of(log.labels.of(move));
    return;
  }
  open_.push_back(move);
  open_likes_.push_back(*like);
  if (!grouped && std::ssize(open_) == settings_.block) finish_unit(columns);
}

void MachineMonitor::finish_unit(const Columns& columns) {
  if (open_.empty()) return;
  const auto found = classes_.find(set_of(open_likes_));
  if (found != classes_.end()) {
    units_.push_back({static_cast<std::int64_t>(open_.front()), static_cast<std::int64_t>(open_.back())});
    std::vector<double> values(open_.size());
    for (std::size_t i = 0; i < states_.size(); ++i) {
      for (std::size_t k = 0; k < open_.size(); ++k) values[k] = (*columns[i])[open_[k]];
      update_measure(i, found->second, value_of(states_[i].measure, likes_, open_likes_, values));
    }
  } else {
    unlike_ += std::ssize(open_);
    for (const std::size_t move : open_) like_at_[move].reset();
    if (first_unlike_.empty()) first_unlike_ = likes_.name(open_likes_.front());
  }
  open_.clear();
  open_likes_.clear();
}

void MachineMonitor::update(const MoveLog& log) {
  Columns columns;
  for (const MeasureState& state : states_) columns.push_back(&log.find(state.measure.name)->values);
  for (auto move = static_cast<std::size_t>(moves_); move < static_cast<std::size_t>(log.moves); ++move)
    take_move(log, columns, move);
  moves_ = log.moves;
  for (MeasureState& state : states_) update_median(state, log);
}

/// Updates the medians of a measure in the log: of the moves since the change if there is an alarm, otherwise
/// of all moves. Moves without a similar move in the baseline are left out.
void MachineMonitor::update_median(MeasureState& state, const MoveLog& log) {
  const std::vector<double>& moves = log.find(state.measure.name)->values;
  std::vector<std::vector<double>> by_like(likes_.count());
  std::vector<double> all;
  for (auto move = static_cast<std::size_t>(state.since.value_or(1) - 1); move < moves.size(); ++move) {
    if (!like_at_[move]) continue;
    all.push_back(likes_.oriented(state.measure, *like_at_[move], moves[move]));
    by_like[*like_at_[move]].push_back(all.back());
  }
  for (std::size_t like = 0; like < state.by_like.size(); ++like) {
    state.by_like[like].moves = std::ssize(by_like[like]);
    if (!by_like[like].empty()) state.by_like[like].median = typical_value(state.measure, by_like[like]);
  }
  if (state.by_like.empty() && !all.empty()) state.median = typical_value(state.measure, std::move(all));
}

/// For all measures in parallel, simulates how many values it takes until a change of each direction and form
/// would be seen. The limit of the number of values is a power of two, at least `values`, so that the
/// simulations are seldom repeated while the log grows.
void MachineMonitor::simulate_changes(std::int64_t values) {
  const auto limit = std::min(
      max_simulated,
      std::max(min_simulated, static_cast<std::int64_t>(std::bit_ceil(static_cast<std::uint64_t>(values)))));
  struct Task {
    std::size_t measure;
    Direction direction;
    ChangeForm form;
    std::optional<std::int64_t> seen{};
  };
  std::vector<Task> tasks;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    if (watched_[i].seen_limit >= limit) continue;
    for (const Direction direction : states_[i].to_see.directions)
      for (const ChangeForm form : forms_of(states_[i].measure))
        if (!watched_[i].seen[{direction, form}]) tasks.push_back({i, direction, form});
    watched_[i].seen_limit = limit;
  }
  parallel::for_each_index(tasks.size(), [&](std::size_t number) {
    Task& task = tasks[number];
    const MeasureState& state = states_[task.measure];
    task.seen = values_to_see({.measure = state.measure,
                               .baseline = watched_[task.measure].baseline,
                               .direction = task.direction,
                               .form = task.form,
                               .sizes = state.to_see.sizes,
                               .alarm = alarm_capital(),
                               .max_values = limit,
                               .seed = settings_.seed});
  });
  for (const Task& task : tasks) watched_[task.measure].seen[{task.direction, task.form}] = task.seen;
}

bool MachineMonitor::is_unchanged(std::int64_t values) {
  simulate_changes(values);
  bool any = false;
  bool all = true;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    states_[i].seen_after.reset();
    if (states_[i].to_see.directions.empty()) continue;
    any = true;
    std::int64_t last = 0;
    for (const auto& [change, seen] : watched_[i].seen) last = std::max(last, seen.value_or(values + 1));
    if (last <= values) states_[i].seen_after = units_[static_cast<std::size_t>(last - 1)].last + 1;
    all = all && last <= values;
  }
  return any && all;
}

MonitorState MachineMonitor::state() {
  MonitorState state{.moves = moves_};
  for (const MeasureState& one : states_) {
    state.evidence = std::max(state.evidence, one.evidence);
    const bool is_first =
        one.alarm_at && (state.alarm == nullptr || *one.alarm_at < *state.alarm->alarm_at ||
                         (*one.alarm_at == *state.alarm->alarm_at && one.evidence > state.alarm->evidence));
    if (is_first) state.alarm = &one;
  }
  if (state.alarm != nullptr)
    state.status = MachineStatus::changed;
  else if (values() > 0 && is_unchanged(values()))
    state.status = MachineStatus::unchanged;
  return state;
}

}  // namespace zerocount::monitor
