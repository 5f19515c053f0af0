#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/parallel/parallel.hpp"
#include "analysis/trials/theory/theory_prediction.hpp"
#include "core/loop/encoder.hpp"
#include "experiments/parameters/handles.hpp"
#include "experiments/rules/value_rules.hpp"
#include "experiments/study/study_trial.hpp"
#include "runners/tuning/effects/effects.hpp"

namespace zerocount::tuning {
namespace {

constexpr double added_noise = 0.1;        // counts rms
constexpr double added_delay = 1.0;        // samples
constexpr double allowed_loss = 0.01;      // largest fall of each rate by a mode that is tolerated
constexpr double lowest_frequency = 10.0;  // Hz
constexpr double precision = 1.05;         // ratio of frequencies at which the search ends
constexpr double samples_of_mode = 8.0e5;  // samples simulated for the rate with one mode
constexpr std::int64_t few = 8;            // the search uses one machine in this many

// Noise.

bool closes_the_loop(const loop::ControllerParameters& controller, loop::EncoderChoice encoder) {
  return controller.encoder == encoder ||
         (std::isfinite(controller.coarse.coarse_beyond) && controller.coarse.encoder == encoder);
}

void add_noise(trial::TrialParameters& p) {
  const auto add_to = [&](loop::EncoderChoice encoder, double& noise) {
    if (closes_the_loop(p.controller, encoder)) noise = std::hypot(noise, added_noise);
  };
  add_to(loop::EncoderChoice::fine, p.encoder.fine_errors.noise);
  add_to(loop::EncoderChoice::coarse, p.encoder.coarse_errors.noise);
  if (loop::has_other(p.encoder))
    p.encoder.other.errors.noise = std::hypot(p.encoder.other.errors.noise, added_noise);
}

std::string refusal_of_noise(study::PointEdit at) {
  for (const parameter::Handle noise :
       {parameter::encoder::fine_errors::noise, parameter::encoder::coarse_errors::noise})
    at.set(noise, std::hypot(at.limits(noise).high, added_noise));
  return rules::refusal_of(at);
}

// Delay.

std::string refusal_of_delay(study::PointEdit at) {
  at.set(parameter::controller::delay, at.limits(parameter::controller::delay).high + added_delay);
  return rules::refusal_of(at);
}

// Mode.

std::string refusal_of_load(study::PointEdit at, double frequency) {
  const motion::PlantParameters rigid{.inertia = at.limits(parameter::plant::inertia).typical};
  const motion::PlantParameters plant = theory::with_load_mode(rigid, frequency);
  at.scale(parameter::plant::inertia, plant.inertia / rigid.inertia);
  at.set(parameter::plant::load::inertia, plant.load.inertia);
  at.set(parameter::plant::load::stiffness, plant.load.stiffness);
  at.set(parameter::plant::load::damping, plant.load.damping);
  return rules::refusal_of(at);
}

/// Searches for the lowest natural frequency of a load mode (a second mass behind a spring) at which every
/// success rate falls by at most 1 %. See additions_to().
class ModeSearch {
 public:
  explicit ModeSearch(const EffectRuns& runs)
      : runs_(runs), first_(study::study_trial(runs.settings().front(), runs.point(), 0).parameters) {
    double samples = 0.0;
    for (std::size_t move = 0; move < first_.command.targets.size(); ++move)
      samples += static_cast<double>(samples_of_move(first_, move));
    samples *= static_cast<double>(runs.trials_each() * std::ssize(runs.settings()));
    machines_ = whole_worlds(std::max<std::int64_t>(few, std::llround(samples_of_mode / samples)));
    few_machines_ = whole_worlds((machines_ + few - 1) / few);
  }

  Limit lowest() const {
    const double highest = 0.5 * first_.controller.sample_rate;
    const ChangedPoint at_highest = run(highest, few_machines_);
    if (!at_highest.refusal.empty()) return limit_of(runs_, at_highest);
    if (!is_borne(at_highest, few_machines_) && !is_borne(run(highest, machines_), machines_))
      return beyond_rate(highest);
    double borne = highest;
    double missed = to_three_digits(0.5 * borne);
    while (borne >= lowest_frequency && is_borne(run(missed, few_machines_), few_machines_)) {
      borne = missed;
      missed = to_three_digits(0.5 * borne);
    }
    const bool any_is_missed = borne >= lowest_frequency;
    while (any_is_missed && borne > precision * missed) {
      const double middle = to_three_digits(std::sqrt(borne * missed));
      (is_borne(run(middle, few_machines_), few_machines_) ? borne : missed) = middle;
    }
    ChangedPoint found = run(borne, machines_);
    if (is_borne(found, machines_)) {
      while (any_is_missed) {
        ChangedPoint lower = run(missed, machines_);
        if (!is_borne(lower, machines_)) break;
        found = std::move(lower);
        missed = to_three_digits(missed / precision);
      }
    } else {
      for (; !is_borne(found, machines_); found = run(borne, machines_)) {
        if (borne >= highest) return beyond_rate(highest);
        missed = borne;
        borne = std::min(to_three_digits(precision * borne), highest);
      }
    }
    return row(found, any_is_missed ? fmt::format("{:.6g} Hz costs more than 1 %", missed)
                                    : "no higher mode that was tried costs more than 1 %");
  }

 private:
  std::int64_t whole_worlds(std::int64_t machines) const {
    return std::min(trials::in_equal_worlds(runs_.study(), machines), runs_.machines());
  }

  ChangedPoint with_mode(double frequency) const {
    return runs_
        .points([&](const study::Study& study, std::int64_t point) {
          return std::vector{load_mode(study, point, frequency)};
        })
        .front();
  }

  /// Simulates the point with a load mode of this frequency, Hz, on up to `machines` machines. Stops earlier
  /// if a rate must fall by more than is allowed, whatever the other machines give.
  ChangedPoint run(double frequency, std::int64_t machines) const {
    ChangedPoint point = with_mode(frequency);
    for (std::int64_t count = 2; point.refusal.empty(); count *= 2) {
      runs_.run({&point, 1}, std::min(count, machines));
      if (count >= machines || !is_borne(point, machines)) break;
    }
    return point;
  }

  /// Result of the search if even the mode at the highest frequency tried lowers a rate by more than is
  /// allowed.
  /// @param highest this frequency, half the sample rate, Hz
  Limit beyond_rate(double highest) const {
    ChangedPoint point = with_mode(highest);
    runs_.run({&point, 1}, machines_);
    return row(point, "costs more than 1 %; modes above half the sample rate are not tried");
  }

  /// Whether no success rate on the first `machines` machines falls by more than 1 % through the load mode,
  /// for any goal and setting (condition at an age). Machines that have not run yet count as meeting all
  /// goals.
  bool is_borne(const ChangedPoint& point, std::int64_t machines) const {
    std::vector<MachineResult> best = point.machines;
    for (std::size_t machine = best.size(); machine < static_cast<std::size_t>(machines); ++machine) {
      best.push_back(runs_.base().machines[machine]);
      for (ClaimResult& claim : best.back().claims) claim.met = claim.moves;
    }
    const RateEstimate with = estimate_of(runs_.aim(), best, machines);
    const RateEstimate without = estimate_of(runs_.aim(), runs_.base().machines, machines);
    constexpr double rounding = 1e-9;
    const double allowed =
        allowed_loss + rounding + (machines < machines_ ? 1.0 / static_cast<double>(with.machines) : 0.0);
    for (std::size_t claim = 0; claim < with.rates.size(); ++claim) {
      if (with.rates[claim] < without.rates[claim] - allowed) return false;
    }
    return true;
  }

  Limit row(const ChangedPoint& point, const std::string& found) const {
    Limit limit = limit_of(runs_, point);
    limit.note = fmt::format("{}; {}", found, point.note);
    if (machines_ < runs_.machines())
      limit.note += fmt::format("; first {} of {} {}: {:.4g} % without it", machines_, runs_.machines(),
                                runs_.study().machines > 0 ? "machines" : "draws",
                                100.0 * estimate_of(runs_.aim(), runs_.base().machines, machines_).rate);
    return limit;
  }

  const EffectRuns& runs_;
  trial::TrialParameters first_;
  std::int64_t machines_{0};  ///< Number of machines on which the success rate is estimated.
  /// Number of machines on which the frequency is sought, about 1/8 of machines_.
  std::int64_t few_machines_{0};
};

bool can_have_load(const EffectRuns& runs) {
  return std::ranges::any_of(runs.settings(), [&](const study::Study& study) {
    return study::PointEdit(study, runs.point()).limits(parameter::plant::load::inertia).high > 0.0;
  });
}

/// Whether some goal is met in enough moves or machines that an added effect could lower its rate by more
/// than is allowed. Otherwise every effect would seem to cost nothing.
bool can_lose(const EffectRuns& runs) {
  return std::ranges::any_of(runs.estimate(runs.base()).rates,
                             [](double rate) { return rate > allowed_loss; });
}

std::vector<Limit> nothing_to_lose(const EffectRuns& runs, std::span<const ChangedPoint> points) {
  constexpr const char* why = "hardly any move meets the goal as it is, so that nothing can be lost";
  std::vector<Limit> rows;
  for (const ChangedPoint& one : points)
    rows.push_back({one.name, std::nullopt, one.refusal.empty() ? why : one.refusal});
  if (!can_have_load(runs)) rows.push_back({"a load mode", std::nullopt, why});
  return rows;
}

constexpr int other_seeds = 10;
constexpr double wider = 2.0;

Effect wider_spread(const study::Study& study, std::int64_t point) {
  study::PointEdit at(study, point);
  const study::Widened widened = at.widen(wider);
  Effect effect{.name = "twice the spread", .edit = [](study::PointEdit& of) { of.widen(wider); }};
  if (widened.changed.empty()) {
    effect.refusal = "nothing is drawn of the axis that can lie farther from its centre";
  } else if (!widened.kept.empty()) {
    effect.note =
        fmt::format("as in the study, because it would leave its range: {}", fmt::join(widened.kept, ", "));
  }
  return effect;
}

/// Effect that changes the delay of the controller.
/// @param factor factor of a delay that is not 0
/// @param instead delay that replaces a delay of 0, samples
Effect other_delay(const study::Study& study, std::int64_t point, double factor, double instead) {
  study::PointEdit at(study, point);
  const double delay = at.limits(parameter::controller::delay).high;
  const auto changed = [factor, instead](double samples) {
    return samples > 0.0 ? factor * samples : instead;
  };
  at.set(parameter::controller::delay, changed(delay));
  return {
      .name = delay > 0.0 ? fmt::format("{} the delay", factor < 1.0 ? "half" : "twice")
                          : fmt::format("{:g} samples of delay", instead),
      .refusal = rules::refusal_of(at),
      .change = [changed](trial::TrialParameters& p) { p.controller.delay = changed(p.controller.delay); }};
}

Limit with_other_seeds(const EffectRuns& runs, const trials::Replicates& machines,
                       const std::function<study::Study(std::uint64_t)>& with_seed) {
  std::array<study::Study, other_seeds> others;
  parallel::for_each_index(
      others.size(),
      [&](std::size_t i) {
        others[i] = with_seed(trials::fresh_seed(runs.study().seed, fmt::format("other seed {}", i)));
      },
      "study");
  Limit lowest;
  int held = 0;
  double highest = 0.0;
  for (std::size_t i = 0; i < others.size(); ++i) {
    const EffectRuns seeded(others[i], machines, runs.effort());
    Limit one = limit_of(seeded, seeded.base());
    held += one.holds ? 1 : 0;
    highest = std::max(highest, *one.rate);
    if (i == 0 || is_lower(one, lowest)) lowest = std::move(one);
  }
  lowest.effect = fmt::format("{} other seeds", other_seeds);
  lowest.note =
      fmt::format("holds with {} of {}; the highest rate is {:.4g} %", held, other_seeds, 100.0 * highest);
  lowest.holds = held == other_seeds;
  return lowest;
}

}  // namespace

std::vector<Effect> added_effects(const study::Study& study, std::int64_t point) {
  const study::PointEdit at(study, point);
  return {{.name = fmt::format("encoder noise of {} counts rms", added_noise),
           .refusal = refusal_of_noise(at),
           .change = add_noise},
          {.name = "one sample of delay",
           .refusal = refusal_of_delay(at),
           .change = [](trial::TrialParameters& p) { p.controller.delay += added_delay; }}};
}

Effect load_mode(const study::Study& study, std::int64_t point, double frequency) {
  return {.name = fmt::format("a load mode at {:.6g} Hz", frequency),
          .note = "half of the inertia, 1 % damping",
          .refusal = refusal_of_load(study::PointEdit(study, point), frequency),
          .change = [frequency](trial::TrialParameters& p) {
            p.plant = theory::with_load_mode(p.plant, frequency);
          }};
}

std::vector<Limit> additions_to(const EffectRuns& runs, const TellStage& tell) {
  std::vector<ChangedPoint> points = runs.points(added_effects);
  if (!can_lose(runs)) return nothing_to_lose(runs, points);
  if (tell) tell("effects that the study may assume away");
  runs.run(points, runs.machines());
  std::vector<Limit> rows;
  rows.reserve(points.size() + 1);
  for (const ChangedPoint& one : points) rows.push_back(limit_of(runs, one));
  if (!can_have_load(runs)) rows.push_back(ModeSearch(runs).lowest());
  return rows;
}

std::vector<Effect> other_premises(const study::Study& study, std::int64_t point) {
  return {wider_spread(study, point), other_delay(study, point, 0.5, 0.5),
          other_delay(study, point, 2.0, 2.0)};
}

std::vector<Limit> variations_of(const EffectRuns& runs, const trials::Replicates& machines,
                                 const std::function<study::Study(std::uint64_t)>& with_seed) {
  std::vector<Limit> found{with_other_seeds(runs, machines, with_seed)};
  std::vector<ChangedPoint> points = runs.points(other_premises);
  runs.run(points, runs.machines());
  for (const ChangedPoint& one : points) found.push_back(limit_of(runs, one));
  return found;
}

}  // namespace zerocount::tuning
