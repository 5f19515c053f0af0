#include "runners/tuning/extras.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/trial/trial.hpp"
#include "runners/status/progress.hpp"

namespace zerocount::tuning {
namespace {

using Wanted = std::span<const Extra* const>;

/// Plans the number of machines on which each point of the extras is simulated, and the trials of the maps,
/// so that the budget is enough for all wanted extras.
RestPlan plan_of(Wanted wanted, const TunedAxis& axis) {
  ExtraCost all;
  for (const Extra* one : wanted) {
    const ExtraCost cost = one->cost(axis);
    all.points += cost.points;
    all.searches += cost.searches;
    all.maps += cost.maps;
  }
  return plan_rest(axis.study, all.points, all.maps, all.searches, axis.effort, axis.speed);
}

std::int64_t planned_for(Wanted extras, const TunedAxis& axis) {
  std::int64_t points = 0;
  for (const Extra* one : extras) points += one->cost(axis).points;
  return points * axis.trials_of_point() + axis.plan.trials_of_maps;
}

bool fits(const ExtraCost& cost, const TunedAxis& axis) {
  return cost.usual_part * static_cast<double>(cost.trials) <=
         static_cast<double>(affordable_trials(axis.effort, axis.speed));
}

double seconds_of(const ExtraCost& cost, const TunedAxis& axis) {
  if (!fits(cost, axis)) return 0.0;
  return std::clamp(static_cast<double>(cost.trials) / axis.measured_speed, 0.0,
                    std::max(axis.effort.seconds_left(), 0.0));
}

double seconds_of(Wanted extras, const TunedAxis& axis) {
  double seconds = 0.0;
  for (const Extra* one : extras) seconds += seconds_of(one->cost(axis), axis);
  return std::min(seconds, std::max(axis.effort.seconds_left(), 0.0));
}

/// Prints, before the first extra, the maximum duration of each extra; "not within the budget" if it does not
/// fit.
void tell_all(Wanted wanted, const TunedAxis& axis, status::StatusLine& line) {
  std::vector<std::string> each;
  for (const Extra* one : wanted) {
    const ExtraCost cost = one->cost(axis);
    each.push_back(fits(cost, axis)
                       ? fmt::format("{} {}", one->name, status::duration_text(seconds_of(cost, axis)))
                       : fmt::format("{} not within the budget", one->name));
  }
  line.clear();
  status::tell("the extras take at most {} more: {}; Ctrl-C keeps what is printed\n",
               status::duration_text(seconds_of(wanted, axis)), fmt::join(each, ", "));
}

}  // namespace

trials::Replicates TunedAxis::machines() const {
  const trials::Replicates& all = search.machines();
  if (!has_budget()) return all;
  return {std::min(trials::in_equal_worlds(study, plan.machines), all.count), all.trials_each};
}

study::Study TunedAxis::on_machines(std::vector<std::string> overrides) const {
  for (std::string& one : trials::overrides_for(study, machines())) overrides.push_back(std::move(one));
  return at_values(trials::variant_of(study, overrides), free(), values).value();
}

std::optional<std::size_t> TunedAxis::lost_claim(const study::Study& of, const Change* change) const {
  const RateEstimate estimate = estimate_on(of, search.machines(), plan.machines, change, effort);
  return reaches(aim_of(tuned), estimate) ? std::nullopt : std::optional(estimate.worst);
}

trials::Effort TunedAxis::one_of_parts(double parts, std::int64_t by_default) const {
  parts = std::max(parts, 1.0);
  if (budget.trials) {
    const std::int64_t remaining = std::max<std::int64_t>(effort.trials_left() - later, 0);
    return effort.limited_to(std::llround(static_cast<double>(remaining) / parts), {});
  }
  if (!budget.seconds) return effort.limited_to(by_default, {});
  return effort.limited_to({}, (effort.seconds_left() - static_cast<double>(later) / speed) / parts);
}

void make_extras(const std::vector<const Extra*>& wanted, TunedAxis& axis, bool quiet,
                 status::StatusLine& line, const std::function<void(const Extra&)>& ready) {
  std::vector<const Extra*> made;
  std::ranges::copy_if(wanted, std::back_inserter(made),
                       [&](const Extra* one) { return one->cost(axis).applies; });
  axis.plan = plan_of(made, axis);
  const bool tells_times = axis.measured_speed > 0.0;
  if (tells_times && !quiet && seconds_of(made, axis) > 0.0) tell_all(made, axis, line);
  for (std::size_t i = 0; i < made.size(); ++i) {
    const Extra& extra = *made[i];
    axis.later = planned_for(Wanted(made).subspan(i + 1), axis);
    const ExtraCost cost = extra.cost(axis);
    line.show([&] {
      return fmt::format(
          "proven; {}{}", extra.name,
          tells_times && fits(cost, axis)
              ? fmt::format(": at most {} of {} that remain", status::duration_text(seconds_of(cost, axis)),
                            status::duration_text(seconds_of(Wanted(made).subspan(i), axis)))
              : std::string());
    });
    std::any found;
    if (fits(cost, axis) && ended(axis.effort, [&] { found = extra.run(axis); })) {
      axis.extras.found.push_back(std::move(found));
    } else {
      axis.extras.left_out.push_back({std::string(extra.part.empty() ? extra.name : extra.part), extra.name});
    }
    line.clear();
    if (ready && !axis.effort.is_interrupted()) ready(extra);
  }
}

}  // namespace zerocount::tuning
