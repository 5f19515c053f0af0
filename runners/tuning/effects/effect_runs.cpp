#include <algorithm>
#include <utility>

#include "core/failure/failure.hpp"
#include "experiments/rules/value_rules.hpp"
#include "experiments/study/condition_study.hpp"
#include "runners/tuning/effects/effects.hpp"

namespace zerocount::tuning {
EffectRuns::EffectRuns(const study::Study& study, const trials::Replicates& machines, trials::Effort effort)
    : study_(study), aim_(aim_of(study)), machines_(machines), effort_(std::move(effort)) {
  for (std::int64_t condition = 0; condition < study::condition_count(study); ++condition)
    conditions_.push_back(under_condition(study, condition));
  machines_.trials_each /= std::ssize(conditions_);
  base_ = {"none", std::vector<std::vector<Effect>>(conditions_.size())};
  apply_effects(base_);
  run({&base_, 1}, machines_.count);
}

std::vector<ChangedPoint> EffectRuns::points(
    const std::function<std::vector<Effect>(const study::Study&, std::int64_t)>& effects_of) const {
  std::vector<ChangedPoint> all;
  for (std::size_t condition = 0; condition < conditions_.size(); ++condition) {
    for (Effect& effect : effects_of(conditions_[condition], machines_.point)) {
      auto same = std::ranges::find(all, effect.name, &ChangedPoint::name);
      if (same == all.end()) {
        all.push_back({effect.name, std::vector<std::vector<Effect>>(conditions_.size())});
        same = all.end() - 1;
      }
      same->under[condition] = {std::move(effect)};
    }
  }
  for (ChangedPoint& one : all) apply_effects(one);
  return all;
}

ChangedPoint EffectRuns::together(const ChangedPoint& a, const ChangedPoint& b) const {
  ChangedPoint both{a.name + " and " + b.name, a.under};
  for (std::size_t i = 0; i < both.under.size(); ++i)
    both.under[i].insert(both.under[i].end(), b.under[i].begin(), b.under[i].end());
  apply_effects(both);
  return both;
}

void EffectRuns::apply_effects(ChangedPoint& point) const {
  for (std::size_t condition = 0; condition < conditions_.size(); ++condition) {
    const std::vector<Effect>& effects = point.under[condition];
    study::PointEdit at(conditions_[condition], machines_.point);
    std::vector<Change> changes;
    FinerUnits finer;
    for (const Effect& one : effects) {
      if (point.note.empty()) point.note = one.note;
      if (point.refusal.empty()) point.refusal = one.refusal;
      if (one.edit) one.edit(at);
      if (one.change) changes.push_back(one.change);
      finer.counts *= one.finer.counts;
      finer.samples *= one.finer.samples;
    }
    if (point.refusal.empty() && !effects.empty()) point.refusal = rules::refusal_of(at);
    if (!point.refusal.empty()) return;
    point.studies.push_back(at.study());
    point.finer.push_back(finer);
    point.changes.emplace_back([changes = std::move(changes)](trial::TrialParameters& p) {
      for (const Change& change : changes) change(p);
    });
  }
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
  count = std::min(count, machines_.count);
  std::vector<std::vector<MachineResult>> results(points.size() * conditions);
  std::vector<MachinesToRun> entries;
  for (std::size_t p = 0; p < points.size(); ++p) {
    const ChangedPoint& point = points[p];
    const std::int64_t from = std::ssize(point.machines);
    if (!point.refusal.empty() || from >= count) continue;
    for (std::size_t c = 0; c < conditions; ++c)
      entries.push_back(
          {&point.studies[c], from, count, &results[p * conditions + c], &point.changes[c], point.finer[c]});
  }
  if (entries.empty()) return;
  run_machines(entries, machines_, effort_);
  for (std::size_t p = 0; p < points.size(); ++p) {
    std::vector<MachineResult>& machines = points[p].machines;
    const std::size_t from = machines.size();
    for (std::size_t c = 0; c < conditions; ++c) {
      std::vector<MachineResult>& of_condition = results[p * conditions + c];
      machines.resize(std::max(machines.size(), of_condition.size()));
      for (std::size_t machine = from; machine < of_condition.size(); ++machine) {
        machines[machine].claims.resize(aim_.claims.size());
        machines[machine].slid = machines[machine].slid || of_condition[machine].slid;
        for (std::size_t goal = 0; goal < of_condition[machine].claims.size(); ++goal)
          machines[machine].claims[goal * conditions + c] = std::move(of_condition[machine].claims[goal]);
      }
    }
  }
}

}  // namespace zerocount::tuning
