#include "runners/tuning/extras.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/trial/trial.hpp"
#include "runners/status/progress.hpp"
#include "runners/status/status.hpp"
#include "runners/tuning/search/proof_runner.hpp"

namespace zerocount::tuning {
namespace {

constexpr std::int64_t points_of_delay = 13;  // that are simulated to find it
constexpr std::int64_t points_of_room = 24;   // at most, of a parameter
constexpr std::int64_t points_of_robustness = 14;
constexpr std::int64_t trials_of_control = 125'000;

constexpr std::array<std::pair<Extra, std::string_view>, all_extras.size()> names{
    {{Extra::margins, "margins"},
     {Extra::ages, "ages"},
     {Extra::room, "room"},
     {Extra::robustness, "robustness"},
     {Extra::retuning, "retuning"},
     {Extra::controls, "controls"},
     {Extra::limits, "limits"},
     {Extra::maps, "maps"}}};

TunedValues named_values(const std::vector<study::FreeParameter>& free, const Values& values) {
  TunedValues named;
  for (std::size_t i = 0; i < free.size(); ++i) named[free[i].name] = values[i];
  return named;
}

std::int64_t total(std::span<const std::int64_t> trials) {
  return std::accumulate(trials.begin(), trials.end(), std::int64_t{0});
}

/// controller.delay of the first machine under each condition, samples.
std::vector<double> delays_of(const study::Study& study) {
  const study::TrialTurns turns = study::turns_of(study);
  std::vector<double> delays;
  for (std::int64_t condition = 0; condition < turns.conditions; ++condition)
    delays.push_back(study::study_trial(study, 0, turns.trial_of(0, condition)).parameters.controller.delay);
  return delays;
}

}  // namespace

std::string_view name_of(Extra extra) {
  return std::ranges::find(names, extra, &std::pair<Extra, std::string_view>::first)->second;
}

std::optional<Extra> extra_named(std::string_view name) {
  const auto found = std::ranges::find(names, name, &std::pair<Extra, std::string_view>::second);
  return found == names.end() ? std::nullopt : std::optional(found->first);
}

ExtrasMaker::ExtrasMaker(const Context& context, TuneAnswer& answer)
    : of_(context),
      answer_(answer),
      controls_(other_controls(of_.study)),
      tuned_(of_.search.candidate(answer.gains)),
      details_{tuned_, answer.free, answer.gains, of_.search.units(), 0, of_.effort} {
  const auto points_if = [&](Extra extra, std::int64_t points) { return wants(extra) ? points : 0; };
  const std::int64_t points =
      points_if(Extra::limits, points_of_limits()) + points_if(Extra::ages, points_of_ages()) +
      (is_met()
           ? points_if(Extra::margins, points_of_delay) + points_if(Extra::robustness, points_of_robustness) +
                 points_if(Extra::room, points_of_room * std::ssize(answer_.free))
           : 0);
  if (!wants(Extra::controls)) controls_.clear();
  if (wants(Extra::retuning)) intervals_ = intervals_of_life(of_.study.ages, *of_.settings.retune_every);
  for (const LifeInterval& one : intervals_)
    least_of_intervals_.push_back(least_trials_of_retuning(study_in(of_.study, one), answer_.free));
  plan_ = plan_rest(of_.study, points,
                    wants(Extra::maps) ? trials_of_maps(of_.search.units(), answer_.free.size()) : 0,
                    least_of_controls() + total(least_of_intervals_), of_.effort, of_.speed);
  details_.count = plan_.units;
}

bool ExtrasMaker::wants(Extra extra) const {
  return std::ranges::find(of_.settings.extras, extra) != of_.settings.extras.end();
}

/// Points under all conditions at all ages that take as long as the ages at which claims are lost.
std::int64_t ExtrasMaker::points_of_ages() const {
  const std::int64_t ages = std::ssize(of_.study.ages.at);
  return ages == 0 ? 0 : (points_of_lost_ages(of_.study) + ages - 1) / ages;
}

std::int64_t ExtrasMaker::points_of_limits() const {
  return std::llround(runs_of_limits(tuned_, 0, of_.search.units().count));
}

/// Machines of one age, as many as take the trials of the planned units, and enough to show that the goals
/// are met if no move misses them.
trials::Replicates ExtrasMaker::units_of_ages() const {
  const std::int64_t each = trials_of_machine(of_.study);
  const std::int64_t units = plan_.units * of_.search.units().trials_each / each;
  const std::int64_t least = min_proof_trials(of_.study, 1) / each;
  return {trials::in_equal_worlds(of_.study, std::max(units, least)), trials_at_one_age(of_.study, each)};
}

/// What an extra takes, at most.
std::int64_t ExtrasMaker::trials_of(Extra extra) const {
  const std::int64_t each = plan_.units * of_.search.units().trials_each;
  switch (extra) {
    case Extra::margins:
      return is_met() ? points_of_delay * each : units_of_limits().trials();
    case Extra::ages:
      return points_of_lost_ages(of_.study) * units_of_ages().trials();
    case Extra::room:
      return is_met() ? points_of_room * std::ssize(answer_.free) * each : 0;
    case Extra::robustness:
      return is_met() ? points_of_robustness * units_of_limits().trials() : 0;
    case Extra::retuning:
      return std::min(std::ssize(intervals_) * trials_of_control,
                      affordable_trials(one_of_shares(1.0), of_.speed));
    case Extra::controls: {
      const std::int64_t searches = std::ssize(controls_);
      return searches * std::min(trials_of_control,
                                 affordable_trials(one_of_shares(static_cast<double>(searches)), of_.speed));
    }
    case Extra::limits:
      return points_of_limits() * units_of_limits().trials();
    case Extra::maps:
      return trials_of_maps(of_.search.units(), answer_.free.size());
  }
  return 0;
}

double ExtrasMaker::seconds_of(Extra extra) const {
  return std::max(
      0.0, std::min(static_cast<double>(trials_of(extra)) / of_.measured_speed, of_.effort.seconds_left()));
}

/// The room usually takes half of its points; searches take what there is.
bool ExtrasMaker::fits(Extra extra) const {
  const std::int64_t usual = trials_of(extra) / (extra == Extra::room ? 2 : 1);
  return extra == Extra::controls || extra == Extra::retuning ||
         usual <= affordable_trials(of_.effort, of_.speed);
}

void ExtrasMaker::make() {
  std::vector<Extra> wanted;
  for (const Extra extra : all_extras) {
    if (wants(extra)) wanted.push_back(extra);
  }
  const auto remaining = [&](std::size_t first) {
    double seconds = 0.0;
    for (std::size_t i = first; i < wanted.size(); ++i)
      seconds += fits(wanted[i]) ? seconds_of(wanted[i]) : 0.0;
    return std::max(0.0, std::min(seconds, of_.effort.seconds_left()));
  };
  if (remaining(0) > 0.0 && !of_.settings.quiet && of_.measured_speed > 0.0) {
    std::vector<std::string> each;
    each.reserve(wanted.size());
    for (const Extra extra : wanted) {
      each.push_back(fits(extra)
                         ? fmt::format("{} {}", name_of(extra), status::duration_text(seconds_of(extra)))
                         : fmt::format("{} not within the budget", name_of(extra)));
    }
    of_.line.clear();
    status::tell("the extras take at most {} more: {}; Ctrl-C keeps what is printed\n",
                 status::duration_text(remaining(0)), fmt::join(each, ", "));
  }
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    of_.line.show([&] {
      return fmt::format(
          "proven; {}{}", name_of(wanted[i]),
          of_.measured_speed > 0.0 && fits(wanted[i])
              ? fmt::format(": at most {} of {} that remain", status::duration_text(seconds_of(wanted[i])),
                            status::duration_text(remaining(i)))
              : std::string());
    });
    make(wanted[i]);
    of_.line.clear();
    if (of_.settings.ready && !of_.effort.is_interrupted()) of_.settings.ready(wanted[i], answer_);
  }
}

/// Whether the work ended within the effort.
bool ExtrasMaker::ended(const std::function<void()>& work) const {
  if (of_.effort.stop().stop_requested()) return false;
  try {
    return trials::within(of_.effort, work);
  } catch (const trial::Interrupted&) {
    return false;
  }
}

void ExtrasMaker::leave_out(Extra extra, const std::string& part) {
  answer_.left_out.push_back(part);
  if (std::ranges::find(answer_.left_extras, extra) == answer_.left_extras.end())
    answer_.left_extras.push_back(extra);
}

void ExtrasMaker::make(Extra extra) {
  const auto try_to = [&](const std::function<void()>& work) {
    if (fits(extra) && ended(work)) return;
    leave_out(extra,
              extra == Extra::margins ? "margins (what more delay loses)" : std::string(name_of(extra)));
  };
  switch (extra) {
    case Extra::margins:
      return try_to([&] { find_delay(); });
    case Extra::ages:
      return try_to([&] {
        answer_.lost_ages = lost_ages(AgeRuns(of_.study, units_of_ages(), "tuning, ages", of_.effort),
                                      answer_.free, answer_.gains);
      });
    case Extra::room:
      if (is_met()) try_to([&] { answer_.room = room_of(details_); });
      return;
    case Extra::robustness:
      if (!is_met()) return;  // there is nothing that could hold
      return try_to([&] {
        const study::Study tuned = tuned_for_limits();
        const trials::Replicates units = units_of_limits();
        answer_.robustness = variations_of(
            EffectRuns(tuned, units, of_.effort), units,
            [&](std::uint64_t seed) { return tuned_for_limits({fmt::format("seed={}", seed)}); }, of_.effort);
      });
    case Extra::retuning:
      return add_retuning();
    case Extra::controls:
      return add_controls();
    case Extra::limits:
      return try_to([&] {
        const study::Study tuned = tuned_for_limits();
        answer_.limits = limits_of(EffectRuns(tuned, units_of_limits(), of_.effort));
      });
    case Extra::maps:
      return try_to([&] { answer_.maps = maps_of(details_, of_.search); });
  }
}

/// The delay at which the goal is lost or, of a goal that is not met, what a wider band would change.
void ExtrasMaker::find_delay() {
  if (is_met()) {
    answer_.delays = delays_of(tuned_);
    answer_.delay_lost = delay_lost(details_);
    answer_.delay_sought = true;
    return;
  }
  TunedStudy wider = details_;
  wider.count = units_of_limits().count;
  answer_.wider_band_rate = rate_in_wider_band(wider, answer_.proof->verdict.goal);
}

/// Trials of the smallest searches for all other controls.
std::int64_t ExtrasMaker::least_of_controls() const {
  std::int64_t least = 0;
  for (const OtherControl& one : controls_) least += least_trials_of_other_search(of_.study, one.free);
  return least;
}

/// All units of the search, with a budget those of the details.
trials::Replicates ExtrasMaker::units_of_limits() const {
  const trials::Replicates& all = of_.search.units();
  if (!has_budget()) return all;
  return {std::min(trials::in_equal_worlds(of_.study, plan_.units), all.count), all.trials_each};
}

/// The tuned study on the units of limits, with these overrides.
study::Study ExtrasMaker::tuned_for_limits(std::vector<std::string> overrides) const {
  for (std::string& one : trials::overrides_for(of_.study, units_of_limits()))
    overrides.push_back(std::move(one));
  return at_values(trials::variant_of(of_.study, overrides), answer_.free, answer_.gains).value();
}

void ExtrasMaker::add_controls() {
  std::vector<TunedValues> tuned{named_values(answer_.free, answer_.gains)};
  const auto all = std::ssize(controls_);
  for (std::int64_t i = 0; i < all; ++i) {
    const OtherControl& control = controls_[static_cast<std::size_t>(i)];
    if (!ended([&] { add_control(control, one_of_shares(static_cast<double>(all - i)), tuned); }))
      leave_out(Extra::controls, fmt::format("controls ({})", control.name));
  }
}

/// One of so many parts of what a budget leaves beside limits and maps; without a budget what a control takes
/// by default.
trials::Effort ExtrasMaker::one_of_shares(double parts) const {
  if (!has_budget()) return of_.effort.share(trials_of_control, {});
  const std::int64_t later =
      (wants(Extra::limits) ? points_of_limits() * plan_.units * of_.search.units().trials_each : 0) +
      plan_.trials_of_maps;
  parts = std::max(parts, 1.0);
  if (of_.settings.budget.trials) {
    const std::int64_t left = std::max<std::int64_t>(of_.effort.trials_left() - later, 0);
    return of_.effort.share(std::llround(static_cast<double>(left) / parts), {});
  }
  return of_.effort.share({}, (of_.effort.seconds_left() - static_cast<double>(later) / of_.speed) / parts);
}

SearchResult ExtrasMaker::search_from(const study::Study& study,
                                      const std::vector<study::FreeParameter>& free,
                                      const trials::Effort& effort, std::vector<Values> starts) {
  const SearchPlan plan = plan_other_search(study, free, effort, of_.speed);
  StudySearch search(study, free, plan.size, of_.journal, of_.elapsed, effort);
  SearchSettings limits;
  limits.seed = study.seed;
  limits.begins_anew = has_budget();
  limits.effort = plan.effort;
  SearchResult found = search.run(limits, std::move(starts));
  answer_.points += found.points;
  answer_.trials += found.trials;
  if (found.finalists.empty() && found.cut) throw trials::Spent{};
  return found;
}

/// From the last interval on, in which the machines have changed most, as many as the budget is enough for by
/// their smallest searches; each gets a part in proportion to these.
void ExtrasMaker::add_retuning() {
  answer_.retuning = Retuning{*of_.settings.retune_every, intervals_.size(), {}};
  const auto leave_out_interval = [&](const LifeInterval& one) {
    leave_out(Extra::retuning,
              fmt::format("retuning ({} to {})", one.from(), study::age_text(of_.study.ages, one.to())));
  };
  const std::span<const std::int64_t> least = least_of_intervals_;
  const std::size_t first =
      has_budget() ? first_affordable(least, affordable_trials(one_of_shares(1.0), of_.speed)) : 0;
  for (std::size_t i = 0; i < first; ++i) leave_out_interval(intervals_[i]);
  const std::int64_t of_controls = first == 0 ? least_of_controls() : 0;
  std::vector<TunedValues> tuned{named_values(answer_.free, answer_.gains)};
  for (std::size_t i = intervals_.size(); i-- > first;) {
    const std::int64_t all = total(least.subspan(first, i + 1 - first)) + of_controls;
    const trials::Effort effort = one_of_shares(static_cast<double>(all) / static_cast<double>(least[i]));
    if (!ended([&] { retune(intervals_[i], effort, tuned); })) leave_out_interval(intervals_[i]);
  }
}

/// Tunes for an interval, and runs the values beside those of the whole life on fresh machines.
/// @param tuned the values for the whole life, and those of the intervals after; gets those of this one
void ExtrasMaker::retune(const LifeInterval& interval, const trials::Effort& effort,
                         std::vector<TunedValues>& tuned) {
  const study::Study study = study_in(of_.study, interval);
  // Two sets of values run at every age: that takes more than the judgement of a control.
  const double seconds = effort.seconds_left();
  const trials::Effort of_search =
      effort.share(std::llround(search_part_of_retuning * static_cast<double>(effort.trials_left())),
                   std::isinf(seconds) ? std::nullopt : std::optional(search_part_of_retuning * seconds));
  const SearchResult found = search_from(study, answer_.free, of_search, starts_from(tuned, answer_.free));
  RetunedInterval one{interval, {}, {}, {}};
  one.units = units_of_judgement(study, effort.part(2), of_.speed);
  const AgeRuns runs(of_.study, {one.units, trials_at_one_age(study, trials_of_machine(study))},
                     "tuning, retuning", effort);
  if (!found.finalists.empty()) one.gains = found.finalists.front().values;
  for (const double age : interval.ages) {
    one.one_set.push_back(runs.at(age, answer_.free, answer_.gains));
    if (!one.gains.empty()) one.retuned.push_back(runs.at(age, answer_.free, one.gains));
  }
  if (!one.gains.empty()) tuned.push_back(named_values(answer_.free, one.gains));
  answer_.retuning->intervals.insert(answer_.retuning->intervals.begin(), std::move(one));
}

/// @param tuned controls that are tuned already; gets this one
void ExtrasMaker::add_control(const OtherControl& control, const trials::Effort& effort,
                              std::vector<TunedValues>& tuned) {
  const study::Study study = trials::variant_of(of_.study, control.overrides);
  const SearchResult found = search_from(study, control.free, effort, starts_from(tuned, control.free));
  Alternative alternative;
  alternative.name = control.name;
  for (const std::string& name : control.zero) alternative.fixed.emplace_back(name, 0.0);
  if (!found.finalists.empty()) {
    const Values& best = found.finalists.front().values;
    judge_control(study, control.free, best, effort, alternative);
    tuned.push_back(named_values(control.free, best));
    for (const std::string& name : control.zero) tuned.back()[name] = 0.0;
  }
  answer_.alternatives.push_back(std::move(alternative));
}

/// Runs it on fresh machines.
void ExtrasMaker::judge_control(const study::Study& study, const std::vector<study::FreeParameter>& free,
                                const Values& values, const trials::Effort& effort,
                                Alternative& alternative) const {
  for (std::size_t i = 0; i < free.size(); ++i) alternative.gains.emplace_back(free[i].name, values[i]);
  const trials::Replicates units{units_of_judgement(study, effort, of_.speed), trials_of_machine(study)};
  std::vector<std::string> fresh = overrides_of(free, values);
  fresh.push_back(fmt::format("seed={}", trials::fresh_seed(study.seed, "tuning, alternative")));
  for (const std::string& one : trials::overrides_for(study, units)) fresh.push_back(one);
  const Candidate candidate{
      {}, values, results_of(trials::variant_of(study, fresh), units, units.count, nullptr, effort)};
  alternative.verdict = goal::judge_goals(study.goals, counts_of(study, units, candidate.units), 1);
  alternative.criterion = estimate_of(aim_of(study), candidate, units.count).criterion;
  const ClaimPlace worst{alternative.verdict->goal, alternative.verdict->condition};
  if (has_named_claims(study)) alternative.worst_goal = goal_name(study, worst);
  alternative.worst_condition = condition_name(study, worst);
}

}  // namespace zerocount::tuning
