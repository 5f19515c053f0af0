#include <algorithm>
#include <utility>

#include "core/failure/failure.hpp"
#include "experiments/rules/value_rules.hpp"
#include "experiments/study/setting_study.hpp"
#include "runners/tuning/effects/effects.hpp"

namespace zerocount::tuning {
EffectRuns::EffectRuns(const study::Study& study, const trials::Replicates& machines, trials::Effort effort)
    : study_(study), aim_(aim_of(study)), machines_(machines), effort_(std::move(effort)) {
  for (std::int64_t setting = 0; setting < study.settings.total(); ++setting)
    settings_.push_back(in_setting(study, setting));
  machines_.trials_each /= std::ssize(settings_);
  base_ = {"none", std::vector<std::vector<Effect>>(settings_.size())};
  apply_effects(base_);
  run({&base_, 1}, machines_.count);
}

std::vector<ChangedPoint> EffectRuns::points(
    const std::function<std::vector<Effect>(const study::Study&, std::int64_t)>& effects_of) const {
  std::vector<ChangedPoint> all;
  for (std::size_t setting = 0; setting < settings_.size(); ++setting) {
    for (Effect& effect : effects_of(settings_[setting], machines_.point)) {
      auto same = std::ranges::find(all, effect.name, &ChangedPoint::name);
      if (same == all.end()) {
        all.push_back({effect.name, std::vector<std::vector<Effect>>(settings_.size())});
        same = all.end() - 1;
      }
      same->under[setting] = {std::move(effect)};
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
  for (std::size_t setting = 0; setting < settings_.size(); ++setting) {
    const std::vector<Effect>& effects = point.under[setting];
    study::PointEdit at(settings_[setting], machines_.point);
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
  const std::size_t settings = settings_.size();
  count = std::min(count, machines_.count);
  std::vector<std::vector<MachineResult>> results(points.size() * settings);
  std::vector<MachinesToRun> entries;
  for (std::size_t p = 0; p < points.size(); ++p) {
    const ChangedPoint& point = points[p];
    const std::int64_t from = std::ssize(point.machines);
    if (!point.refusal.empty() || from >= count) continue;
    for (std::size_t c = 0; c < settings; ++c)
      entries.push_back(
          {&point.studies[c], from, count, &results[p * settings + c], &point.changes[c], point.finer[c]});
  }
  if (entries.empty()) return;
  run_machines(entries, machines_, effort_);
  for (std::size_t p = 0; p < points.size(); ++p) {
    std::vector<MachineResult>& machines = points[p].machines;
    const std::size_t from = machines.size();
    for (std::size_t c = 0; c < settings; ++c) {
      std::vector<MachineResult>& of_setting = results[p * settings + c];
      machines.resize(std::max(machines.size(), of_setting.size()));
      for (std::size_t machine = from; machine < of_setting.size(); ++machine) {
        machines[machine].claims.resize(aim_.claims.size());
        machines[machine].slid = machines[machine].slid || of_setting[machine].slid;
        for (std::size_t goal = 0; goal < of_setting[machine].claims.size(); ++goal)
          machines[machine].claims[goal * settings + c] = std::move(of_setting[machine].claims[goal]);
      }
    }
  }
}

}  // namespace zerocount::tuning
