#include "runners/tuning/effects/effect_runs.hpp"

#include <algorithm>
#include <utility>

#include "core/failure/failure.hpp"
#include "experiments/rules/value_rules.hpp"
#include "experiments/study/condition_study.hpp"

namespace zerocount::tuning {
namespace {

/// The study of a condition with these effects changed; nothing, and its refusal, where its manifest could
/// not describe it.
std::optional<study::Study> changed_study(const study::Study& study, std::int64_t point,
                                          std::span<const Effect* const> effects, std::string& refusal) {
  study::PointEdit at(study, point);
  for (const Effect* one : effects) {
    if (one->edit) one->edit(at);
  }
  for (const Effect* one : effects) {
    if (refusal.empty()) refusal = one->refusal;
  }
  if (refusal.empty() && !effects.empty()) refusal = rules::refusal_of(at);
  return refusal.empty() ? std::optional(at.study()) : std::nullopt;
}

Change all_changes(const std::vector<const Effect*>& effects) {
  std::vector<Change> changes;
  for (const Effect* one : effects) {
    if (one->change) changes.push_back(one->change);
  }
  return [changes = std::move(changes)](trial::TrialParameters& p) {
    for (const Change& change : changes) change(p);
  };
}

}  // namespace

EffectRuns::EffectRuns(const study::Study& study, const trials::Replicates& units, trials::Effort effort)
    : study_(study), aim_(aim_of(study)), units_(units), effort_(std::move(effort)) {
  for (std::int64_t condition = 0; condition < study::condition_count(study); ++condition)
    conditions_.push_back(under_condition(study, condition));
  units_.trials_each /= std::ssize(conditions_);
  base_ = changed({});
  run({&base_, 1}, units_.count);
}

std::vector<ConditionEffects> EffectRuns::effects(
    const std::function<std::vector<Effect>(const study::Study&, std::int64_t)>& effects_of) const {
  std::vector<ConditionEffects> all;
  for (std::size_t condition = 0; condition < conditions_.size(); ++condition) {
    for (Effect& effect : effects_of(conditions_[condition], units_.point)) {
      auto same = std::ranges::find(all, effect.name, &ConditionEffects::name);
      if (same == all.end()) {
        all.push_back({effect.name, {}});
        same = all.end() - 1;
        same->under.resize(conditions_.size());
      }
      same->under[condition] = std::move(effect);
    }
  }
  return all;
}

ChangedPoint EffectRuns::changed(std::span<const ConditionEffects* const> together) const {
  ChangedPoint point;
  for (const ConditionEffects* one : together) point.name += (point.name.empty() ? "" : " and ") + one->name;
  if (point.name.empty()) point.name = "none";
  for (std::size_t condition = 0; condition < conditions_.size(); ++condition) {
    std::vector<const Effect*> effects;
    for (const ConditionEffects* one : together) {
      if (one->under[condition]) effects.push_back(&*one->under[condition]);
    }
    for (const Effect* one : effects) {
      if (point.note.empty()) point.note = one->note;
    }
    std::optional<study::Study> study =
        changed_study(conditions_[condition], units_.point, effects, point.refusal);
    if (!study) return point;
    point.studies.push_back(std::move(*study));
    point.changes.push_back(all_changes(effects));
  }
  return point;
}

void EffectRuns::run(std::span<ChangedPoint> points, std::int64_t count) const {
  try {
    run_all(points, count);
  } catch (const Failure& failure) {  // by a change of a trial
    if (failure.code() != ExitCode::bad_input) throw;
    if (points.size() > 1) {
      for (ChangedPoint& one : points) run({&one, 1}, count);
    } else {
      points.front().refusal = failure.what();
    }
  }
}

void EffectRuns::run_all(std::span<ChangedPoint> points, std::int64_t count) const {
  const std::size_t conditions = conditions_.size();
  count = std::min(count, units_.count);
  std::vector<std::vector<UnitResult>> results(points.size() * conditions);
  std::vector<UnitsToRun> entries;
  for (std::size_t p = 0; p < points.size(); ++p) {
    const ChangedPoint& point = points[p];
    const std::int64_t from = std::ssize(point.run.units);
    if (!point.refusal.empty() || from >= count) continue;
    for (std::size_t c = 0; c < conditions; ++c)
      entries.push_back({&point.studies[c], from, count, &results[p * conditions + c], &point.changes[c]});
  }
  if (entries.empty()) return;
  run_units(entries, units_, effort_);
  for (std::size_t p = 0; p < points.size(); ++p) {
    std::vector<UnitResult>& units = points[p].run.units;
    const std::size_t from = units.size();
    for (std::size_t c = 0; c < conditions; ++c) {
      std::vector<UnitResult>& of_condition = results[p * conditions + c];
      units.resize(std::max(units.size(), of_condition.size()));
      for (std::size_t unit = from; unit < of_condition.size(); ++unit) {
        units[unit].claims.resize(aim_.claims.size());
        units[unit].slid = units[unit].slid || of_condition[unit].slid;
        for (std::size_t goal = 0; goal < of_condition[unit].claims.size(); ++goal)
          units[unit].claims[goal * conditions + c] = std::move(of_condition[unit].claims[goal]);
      }
    }
  }
}

}  // namespace zerocount::tuning
