#include "analysis/trials/measures/point_accumulator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include "core/failure/failure.hpp"
#include "core/numerics/sign.hpp"
#include "core/trial/divergence.hpp"

namespace zerocount::measures {
namespace {

/// The interval between two jerks, rounded to 1 ps. Onsets are whole multiples of the sample time; without
/// rounding, the rounding errors of their differences would make equal intervals differ.
double rounded_interval(double seconds) {
  return std::round(seconds * 1e12) / 1e12;
}

/// Upper tolerance limits of the settling times of trials, one for each of statistics::tolerance_contents.
/// The limits stay unset if there are no times, or if the outcomes decided the number of trials, because the
/// limits need a fixed number.
auto tolerance_limits(const statistics::ClusteredSample& times, const StatisticsOptions& options) {
  std::array<statistics::ToleranceLimit, std::size(statistics::tolerance_contents)> limits{};
  for (std::size_t i = 0; i < limits.size(); ++i) {
    limits[i].content = statistics::tolerance_contents[i];
    if (options.stopped_by_outcomes || times.size() == 0) continue;
    limits[i].within = statistics::clustered_upper_limit(times, limits[i].content, options.confidence);
  }
  return limits;
}

void require_move_count(std::size_t moves, std::int64_t trials, std::size_t expected) {
  if (moves > 0 && (trials == 0 || moves == expected)) return;
  throw Failure(ExitCode::bad_data,
                fmt::format("a trial with {} moves; expected {}", moves,
                            trials == 0 ? "at least one" : fmt::format("{} as before", expected)));
}

/// Requires that the move is of the kind of the study.
/// @throws Failure (bad_data) if the move has a target in an open-loop study, or a torque level in another
/// study
void require_kind(const trial::MoveOutcome& move, bool open_loop) {
  if (move.outcome == trial::Outcome::nonfinite || (move.outcome == trial::Outcome::open_loop) == open_loop)
    return;
  throw Failure(ExitCode::bad_data, open_loop ? "a move that was judged; expected a torque level"
                                              : "a move with a torque level; expected one with a target");
}

std::vector<MeasureStatistics> statistics_of(const std::vector<MeasureAccumulator>& measures,
                                             const StatisticsOptions& options) {
  std::vector<MeasureStatistics> statistics(measures.size());
  oneapi::tbb::parallel_for(std::size_t{0}, measures.size(),
                            [&](std::size_t i) { statistics[i] = measures[i].statistics(options); });
  return statistics;
}

template <class Summand>
void add_each(std::vector<Summand>& sums, const std::vector<Summand>& added) {
  for (std::size_t i = 0; i < added.size(); ++i) sums[i] += added[i];
}

}  // namespace

MoveKind move_kind(const study::Study& study) {
  MoveKind kind{.open_loop = study.open_loop, .shape = shape_of(study), .goals = criteria_of_goals(study)};
  kind.has_observed_counts = !study.observed_counts.empty();
  if (std::ranges::none_of(study.goals, &study::Goal::beside_load)) return kind;
  for (const study::Goal& goal : study.goals)
    kind.for_the_load.push_back(
        goal.beside_load ? move_criterion_of(study::for_the_load(goal), study.features) : std::nullopt);
  return kind;
}

OutcomeCounts& OutcomeCounts::operator+=(const OutcomeCounts& other) {
  for (const auto counter : outcome_counters) this->*counter += other.*counter;
  return *this;
}

std::int64_t OutcomeCounts::total() const {
  std::int64_t sum = 0;
  for (const auto counter : outcome_counters) sum += this->*counter;
  return sum;
}

PointCounts& PointCounts::operator+=(const PointCounts& other) {
  trials += other.trials;
  moves += other.moves;
  outcomes += other.outcomes;
  if (by_move.size() < other.by_move.size()) by_move.resize(other.by_move.size());
  add_each(by_move, other.by_move);
  jerks_agreeing += other.jerks_agreeing;
  return *this;
}

std::int64_t OutcomeCounts::*counter_of(trial::Outcome outcome) {
  const auto number = static_cast<std::size_t>(outcome);
  if (number < outcome_counters.size()) return outcome_counters[number];
  throw Failure(ExitCode::bad_data,
                fmt::format("a move with outcome {}; expected 0 to 5", static_cast<int>(outcome)));
}

PointAccumulator::PointAccumulator(const MoveKind& kind, const layout::MeasureTable& table,
                                   std::int64_t first_trial)
    : kind_(kind),
      first_trial_(first_trial),
      table_(&table),
      goals_(kind.goals.size(), CellCounts(kind.shape)),
      for_the_load_(kind.for_the_load.size(), CellCounts(kind.shape)),
      groups_{CellCounts(kind.shape), CellCounts(kind.shape)},
      trial_settling_times_(kind.shape.machines) {
  for (const MoveCriterion& goal : kind.goals) goal_settling_.emplace_back(goal, kind.shape);
  for (const layout::Measure& measure : table) measures_.emplace_back(measure, measure.point, kind);
}

void PointAccumulator::add(const trial::TrialOutcome& trial, std::span<const trial::Jerk> jerks) {
  add_counts(trial.moves, jerks);
  add_measures(layout::pointers_to(trial.moves), trial.moves.size());
}

void PointAccumulator::add_measures(std::span<const trial::MoveOutcome* const> moves,
                                    std::size_t moves_of_trial) {
  // Few enough moves to stay in the cache while all measures are added.
  constexpr std::size_t moves_at_a_time = 1024;
  const std::size_t trials_at_a_time = std::max<std::size_t>(1, moves_at_a_time / moves_of_trial);
  while (!moves.empty()) {
    const MovesOfTrials some{first_trial_ + measured_, moves_of_trial,
                             moves.first(std::min(moves.size(), trials_at_a_time * moves_of_trial))};
    for (MeasureAccumulator& measure : measures_) measure.add(some);
    if (!kind_.open_loop) add_trial_settling_times(some);
    measured_ += some.trials();
    moves = moves.subspan(some.moves.size());
  }
}

void PointAccumulator::add_counts(std::span<const trial::MoveOutcome> moves,
                                  std::span<const trial::Jerk> jerks) {
  require_move_count(moves.size(), counted_.trials, counted_.by_move.size());
  add_moves(moves);
  std::size_t next = 0;
  for (std::size_t move = 0; move < moves.size(); ++move) {
    const std::size_t first = next;
    while (next < jerks.size() && jerks[next].move == static_cast<std::int64_t>(move)) ++next;
    add_jerks(moves[move], jerks.subspan(first, next - first));
  }
  if (next != jerks.size()) {
    throw Failure(
        ExitCode::bad_data,
        fmt::format("jerk {} of a trial is of move {}; expected jerks in order of their moves, 0 to {}", next,
                    jerks[next].move, moves.size() - 1));
  }
  jerks_ += std::ssize(jerks);
  ++counted_.trials;
}

void PointAccumulator::add_moves(std::span<const trial::MoveOutcome> moves) {
  counted_.by_move.resize(moves.size());
  for (std::size_t i = 0; i < moves.size(); ++i) {
    require_kind(moves[i], kind_.open_loop);
    ++(counted_.by_move[i].*counter_of(moves[i].outcome));
    if (kind_.open_loop) add_level(i, moves.subspan(i, 1));
  }
  counted_.moves += std::ssize(moves);
  ++(counted_.outcomes.*counter_of(trial::worst_outcome(moves)));
  if (kind_.open_loop) return;
  if (kind_.shape.machines > 0) add_to_machine(moves);
  for (std::size_t i = 0; i < goals_.size(); ++i) {
    count_moves(goals_[i], kind_.goals[i], first_trial_ + counted_.trials, moves);
    goal_settling_[i].add(first_trial_ + counted_.trials, kind_.goals[i], moves);
  }
  for (std::size_t i = 0; i < for_the_load_.size(); ++i)
    if (kind_.for_the_load[i])
      count_moves(for_the_load_[i], *kind_.for_the_load[i], first_trial_ + counted_.trials, moves);
  if (kind_.counts_trials()) add_to_groups(moves);
}

void PointAccumulator::add_to_groups(std::span<const trial::MoveOutcome> moves) {
  const std::int64_t trial = first_trial_ + counted_.trials;
  groups_.succeeded.add(trial, 1, trial::succeeded(moves) ? 1 : 0);
  if (kind_.goals.empty()) return;
  const bool meeting =
      std::ranges::all_of(kind_.goals, [&](const MoveCriterion& goal) { return all_meet(goal, moves); });
  groups_.meeting.add(trial, 1, meeting ? 1 : 0);
}

void PointAccumulator::add_level(std::size_t level, std::span<const trial::MoveOutcome> move) {
  if (level == levels_.size()) add_level_accumulators();
  if (move.front().outcome == trial::Outcome::nonfinite) {
    ++lost_in_levels_[level];
  } else {
    const trial::MoveOutcome* const one = move.data();
    for (MeasureAccumulator& measure : levels_[level])
      measure.add({first_trial_ + counted_.trials, 1, std::span(&one, 1)});
  }
}

void PointAccumulator::add_level_accumulators() {
  lost_in_levels_.push_back(0);
  std::vector<MeasureAccumulator>& measures = levels_.emplace_back();
  for (const layout::Measure& measure : *table_) measures.emplace_back(measure, measure.level, kind_);
}

void PointAccumulator::add_to_machine(std::span<const trial::MoveOutcome> moves) {
  const auto zero = std::count_if(moves.begin(), moves.end(),
                                  [](const trial::MoveOutcome& m) { return trial::is_success(m.outcome); });
  const statistics::MachineTrials trial{
      .trials = 1, .successes = trial::succeeded(moves), .moves = std::ssize(moves), .zero_moves = zero};
  machines_.add((first_trial_ + counted_.trials) % kind_.shape.machines, trial);
}

/// Adds the settling times of trials. The settling time of a trial is the arrival time of its slowest move.
/// It is censored if a move did not arrive, or was not run because an earlier move diverged.
void PointAccumulator::add_trial_settling_times(const MovesOfTrials& some) {
  values_.clear();
  for (std::size_t first = 0; first < some.moves.size(); first += some.of_trial) {
    double& slowest = values_.emplace_back(0.0);
    for (const trial::MoveOutcome* move : some.moves.subspan(first, some.of_trial)) {
      const bool arrived = trial::was_run(*move) && move->arrived;
      slowest = arrived ? std::max(slowest, move->arrival_time) : statistics::unknown;
      if (!arrived) break;
    }
  }
  trial_settling_times_.add_trials(some.first_trial, values_, 1, true);
}

void PointAccumulator::add_jerks(const trial::MoveOutcome& move, std::span<const trial::Jerk> jerks) {
  if (static_cast<std::int64_t>(jerks.size()) != move.jerk_count) {
    throw Failure(ExitCode::bad_data,
                  fmt::format("{} jerks recorded of a move that counted {}", jerks.size(), move.jerk_count));
  }
  values_.clear();
  for (std::size_t i = 0; i < jerks.size(); ++i) {
    counted_.jerks_agreeing += jerks[i].direction == numerics::sign_of(move.holding_torque);
    one_count_jerks_ += jerks[i].magnitude == 1;
    if (i == 0) continue;
    const double interval = rounded_interval(jerks[i].onset - jerks[i - 1].onset);
    if (!(interval > 0.0)) {
      throw Failure(ExitCode::bad_data,
                    fmt::format("a jerk at {} s after one at {} s; expected jerks in order of onset",
                                jerks[i].onset, jerks[i - 1].onset));
    }
    values_.push_back(interval);
    jerk_intervals_.add(interval);
  }
  if (values_.size() < 2) return;
  const statistics::RankTrend trend = statistics::rank_trend(values_);
  interval_trend_ += trend;
  ++jerk_slowing_.moves;
  jerk_slowing_.slowing += trend.rising > trend.falling;
  jerk_slowing_.quickening += trend.rising < trend.falling;
}

PointAccumulator& PointAccumulator::operator+=(const PointAccumulator& next) {
  counted_ += next.counted_;
  measured_ += next.measured_;
  add_each(measures_, next.measures_);
  if (levels_.empty()) {
    levels_ = next.levels_;
    lost_in_levels_ = next.lost_in_levels_;
  } else {
    for (std::size_t level = 0; level < next.levels_.size(); ++level)
      add_each(levels_[level], next.levels_[level]);
    add_each(lost_in_levels_, next.lost_in_levels_);
  }
  machines_ += next.machines_;
  add_each(goals_, next.goals_);
  add_each(for_the_load_, next.for_the_load_);
  add_each(goal_settling_, next.goal_settling_);
  groups_.succeeded += next.groups_.succeeded;
  groups_.meeting += next.groups_.meeting;
  trial_settling_times_ += next.trial_settling_times_;
  jerks_ += next.jerks_;
  jerk_intervals_ += next.jerk_intervals_;
  jerk_slowing_.moves += next.jerk_slowing_.moves;
  jerk_slowing_.slowing += next.jerk_slowing_.slowing;
  jerk_slowing_.quickening += next.jerk_slowing_.quickening;
  interval_trend_ += next.interval_trend_;
  one_count_jerks_ += next.one_count_jerks_;
  return *this;
}

template <class Self, class Archive>
void PointAccumulator::transfer(Self& self, Archive& archive) {
  archive(self.counted_, self.machines_);
  for (auto& counts : self.goals_) archive(counts);
  for (auto& counts : self.for_the_load_) archive(counts);
  for (auto& settling : self.goal_settling_) archive(settling);
  archive(self.trial_settling_times_, self.jerks_, self.jerk_intervals_, self.jerk_slowing_,
          self.interval_trend_, self.one_count_jerks_);
  if constexpr (!std::is_const_v<Self>) {
    while (self.kind_.open_loop && self.levels_.size() < self.counted_.by_move.size())
      self.add_level_accumulators();
  }
  if (self.kind_.counts_trials()) archive(self.groups_);
  for (auto& measure : self.measures_) archive(measure);
  for (std::size_t level = 0; level < self.levels_.size(); ++level) {
    archive(self.lost_in_levels_[level]);
    for (auto& measure : self.levels_[level]) archive(measure);
  }
}

bool PointAccumulator::is_valid(std::int64_t moves) const {
  const auto are_valid = [](const std::vector<MeasureAccumulator>& measures, std::int64_t trials,
                            std::int64_t moves_of_trial) {
    return std::all_of(measures.begin(), measures.end(),
                       [&](const auto& one) { return one.is_valid(trials, moves_of_trial); });
  };
  if (!has_valid_counts(moves) || !has_valid_jerks() || !has_valid_machines() || !has_valid_groups())
    return false;
  for (std::size_t i = 0; i < goals_.size(); ++i) {
    if (!goals_[i].is_valid(counted_.trials, asked_moves(kind_.goals[i], moves)) ||
        !goal_settling_[i].is_valid(goals_[i].sum().moves))
      return false;
  }
  for (std::size_t level = 0; level < levels_.size(); ++level) {
    const std::int64_t lost = lost_in_levels_[level];
    if (lost < 0 || lost > counted_.trials || !are_valid(levels_[level], counted_.trials - lost, 1))
      return false;
  }
  return are_valid(measures_, counted_.trials, moves);
}

bool PointAccumulator::has_valid_counts(std::int64_t moves) const {
  constexpr std::int64_t max_trials = std::int64_t{1} << 53;  // sums of counts up to this do not overflow
  const auto complete = [this](const OutcomeCounts& counts) {
    return counts.total() == counted_.trials && std::ranges::all_of(outcome_counters, [&](auto counter) {
             return counts.*counter >= 0 && counts.*counter <= counted_.trials;
           });
  };
  return counted_.trials > 0 && counted_.trials <= max_trials && counted_.moves % moves == 0 &&
         counted_.moves / moves == counted_.trials && complete(counted_.outcomes) &&
         std::ssize(counted_.by_move) == moves &&
         std::all_of(counted_.by_move.begin(), counted_.by_move.end(), complete) &&
         trial_settling_times_.size() == (kind_.open_loop ? 0 : counted_.trials);
}

bool PointAccumulator::has_valid_jerks() const {
  const auto within = [](std::int64_t count, std::int64_t most) { return count >= 0 && count <= most; };
  return jerks_ >= 0 && within(counted_.jerks_agreeing, jerks_) && within(one_count_jerks_, jerks_) &&
         jerk_intervals_.size <= jerks_ && within(jerk_slowing_.moves, counted_.moves) &&
         within(jerk_slowing_.slowing, jerk_slowing_.moves) &&
         within(jerk_slowing_.quickening, jerk_slowing_.moves - jerk_slowing_.slowing) &&
         interval_trend_.rising >= 0 && interval_trend_.falling >= 0 && interval_trend_.equal >= 0;
}

bool PointAccumulator::has_valid_machines() const {
  if (kind_.shape.machines == 0 || kind_.open_loop) return machines_.sums().empty();
  if (machines_.end() > kind_.shape.machines) return false;
  statistics::MachineTrials sum;
  for (const statistics::MachineTrials& machine : machines_.sums()) {
    if (machine.successes < 0 || machine.successes > machine.trials ||
        machine.trials > counted_.trials - sum.trials || machine.zero_moves < 0 ||
        machine.zero_moves > machine.moves || machine.moves > counted_.moves - sum.moves)
      return false;
    sum += machine;
  }
  return sum.trials == counted_.trials && sum.successes == counted_.outcomes.zero_count &&
         sum.moves == counted_.moves;
}

bool PointAccumulator::has_valid_groups() const {
  if (!kind_.counts_trials() || kind_.open_loop) return true;
  return groups_.succeeded.is_valid(counted_.trials, 1) &&
         groups_.succeeded.sum().met == counted_.outcomes.zero_count &&
         (kind_.goals.empty() || groups_.meeting.is_valid(counted_.trials, 1));
}

statistics::State PointAccumulator::state() const {
  statistics::State state;
  statistics::StateWriter writer(state);
  transfer(*this, writer);
  return state;
}

void PointAccumulator::restore(std::span<const std::int64_t> whole, std::span<const double> real,
                               std::int64_t moves) {
  statistics::StateReader reader(whole, real);
  PointAccumulator restored(kind_, *table_, first_trial_);
  transfer(restored, reader);
  reader.require_end();
  reader.require(restored.is_valid(moves));
  restored.measured_ = restored.counted_.trials;
  *this = std::move(restored);
}

std::vector<LevelStatistics> PointAccumulator::level_statistics(const StatisticsOptions& options) const {
  std::vector<LevelStatistics> levels(levels_.size());
  for (std::size_t i = 0; i < levels.size(); ++i) {
    levels[i].table = table_;
    levels[i].nonfinite = lost_in_levels_[i];
    levels[i].measures = statistics_of(levels_[i], options);
  }
  return levels;
}

statistics::SuccessClaim PointAccumulator::claim(const PointSummary& point,
                                                 const StatisticsOptions& options) const {
  const std::int64_t successes = point.judged > 0 ? point.outcomes.zero_count : 0;
  const auto at_any_time = [&] {
    return statistics::success_claim_at_any_time(successes, point.judged, options.confidence);
  };
  if (kind_.shape.machines == 0 || point.judged == 0) {
    return options.stopped_by_outcomes
               ? at_any_time()
               : statistics::success_claim(successes, point.judged, options.confidence);
  }
  const statistics::SuccessClaim on_machines =
      statistics::success_claim_on_machines(point.machines.successes, options.confidence);
  return options.stopped_by_outcomes ? statistics::weaker_claim(on_machines, at_any_time()) : on_machines;
}

PointSummary PointAccumulator::statistics(const StatisticsOptions& options) const {
  PointSummary result;
  result.table = table_;
  static_cast<PointCounts&>(result) = counted_;
  result.judged = kind_.open_loop ? 0 : result.trials;
  result.measures = statistics_of(measures_, options);
  result.levels = level_statistics(options);
  if (kind_.shape.machines > 0 && result.judged > 0)
    result.machines = statistics::machine_statistics(machines_.from_zero(), options.confidence);
  result.claim = claim(result, options);
  result.goals = goals_;
  result.for_the_load = for_the_load_;
  for (const GoalSettling& settling : goal_settling_)
    result.goal_settling.push_back(settling.statistics(options.confidence));
  if (kind_.counts_trials() && result.judged > 0) result.trials_of_groups = groups_;
  if (options.stopped_by_outcomes)
    result.machines.tolerance = {};  // it takes a number of trials that was fixed beforehand
  result.settles_within = tolerance_limits(trial_settling_times_.sample(), options);
  result.jerk_interval = {jerk_intervals_.size, statistics::mean(jerk_intervals_),
                          statistics::quantile(jerk_intervals_, 0.5).value};
  result.jerk_slowing = jerk_slowing_;
  result.jerk_slowing.proportion = statistics::rate(result.jerk_slowing.slowing, result.jerk_slowing.moves);
  result.jerk_slowing.tau = statistics::kendall_tau(interval_trend_);
  result.jerk_agreement = statistics::rate(result.jerks_agreeing, jerks_);
  result.jerk_one_count_share = statistics::rate(one_count_jerks_, jerks_);
  return result;
}

}  // namespace zerocount::measures
