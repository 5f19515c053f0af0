#include "runners/tuning/search/study_search.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "analysis/basis/parallel/parallel.hpp"
#include "analysis/basis/statistics/unknown.hpp"
#include "core/loop/controller/controller.hpp"
#include "core/trial/trial.hpp"
#include "experiments/parameters/handles.hpp"
#include "experiments/study/plan.hpp"
#include "experiments/study/study_table.hpp"
#include "experiments/study/study_trial.hpp"

namespace zerocount::tuning {
namespace {

constexpr std::int64_t max_search_trials_of_machine = 20;
constexpr std::int64_t examined_machines = 2048;
constexpr std::int64_t max_tried_points = 1024;  // of which the nearest is sought

bool lie_in_ranges(const Values& values, std::span<const study::FreeParameter> free) {
  for (std::size_t i = 0; i < free.size(); ++i) {
    if (!(values[i] >= free[i].low && values[i] <= free[i].high)) return false;
  }
  return true;
}

constexpr parameter::Handle observer_bandwidth = parameter::controller::observer::bandwidth;

OtherControl with_zeros(const study::Study& study, const std::vector<std::size_t>& zeros) {
  OtherControl control;
  for (std::size_t i = 0; i < study.tuning->free.size(); ++i) {
    const study::FreeParameter& one = study.tuning->free[i];
    if (std::ranges::find(zeros, i) == zeros.end()) {
      control.free.push_back(one);
      continue;
    }
    control.name += fmt::format("{}{} = 0", control.name.empty() ? "" : ", ", one.name);
    control.zero.push_back(one.name);
    control.overrides.push_back(one.name + "=0");
  }
  return control;
}

/// The study's control with an added disturbance observer, to be tuned for comparison. Nothing for a study
/// with an observer, a cascade, two phases or a plugin. The bandwidth is sought up to 1/4 of the sample rate,
/// from a value at which the observer has nearly no effect: at 1/1000 of a cycle per trial, it has removed
/// 0.6 % of a constant disturbance at the end of the trial. The observer's model has the inertia of the
/// plant.
std::optional<OtherControl> with_observer(const study::Study& study) {
  const trial::TrialParameters p = study::study_trial(study, 0, 0).parameters;
  const bool is_plain = p.controller.blocks.structure == loop::ControlStructure::pid &&
                        p.controller.blocks.observer.bandwidth == 0.0 && !p.controller.user.plugin &&
                        !loop::has_coarse_phase(p.controller);
  const auto is_of_observer = [](const study::FreeParameter& one) {
    return one.name.starts_with("controller.observer.");
  };
  if (!is_plain || std::ranges::any_of(study.tuning->free, is_of_observer)) return std::nullopt;
  const double rate = p.controller.sample_rate;
  const double lowest = 0.001 / (p.command.hold * static_cast<double>(study.moves));
  OtherControl control{"observer added", {}, {}, study.tuning->free};
  control.free.push_back({.name = std::string(observer_bandwidth.path),
                          .unit = "Hz",
                          .low = lowest,
                          .high = 0.25 * rate,
                          .logarithmic = true});
  control.overrides.push_back(fmt::format("{}={}", observer_bandwidth.path, lowest));
  control.overrides.push_back(fmt::format("controller.observer.inertia={}", p.plant.inertia));
  return control;
}

}  // namespace

Values values_in_manifest(const study::Study& study, std::span<const study::FreeParameter> free) {
  Values values;
  for (const study::FreeParameter& one : free) {
    const std::size_t slot = study::find_slots(one.name, study.plan->table).value().first;
    values.push_back(study.plan->base[slot].number);
  }
  return values;
}

std::int64_t trials_of_machine(const study::Study& study) {
  const std::int64_t settings = study.settings.total();
  const bool on_machines =
      std::ranges::any_of(study.goals, [](const study::Goal& goal) { return goal.machines.has_value(); });
  if (!on_machines) return settings;
  return std::max<std::int64_t>(study.trials / (study.machines * settings), 10) * settings;
}

std::int64_t search_trials_of_machine(const study::Study& study) {
  const std::int64_t settings = study.settings.total();
  return std::min(trials_of_machine(study) / settings, max_search_trials_of_machine) * settings;
}

StudySearch::StudySearch(const study::Study& study, std::vector<study::FreeParameter> free,
                         const SearchSize& size, TuningJournal& journal, trials::Effort effort)
    : study_(study),
      free_(std::move(free)),
      size_(size),
      machines_{size.max_machines, search_trials_of_machine(study)},
      base_(trials::variant_of(study, trials::overrides_for(study, machines_))),
      examined_machines_{trials::in_equal_worlds(study, examined_machines), machines_.trials_each},
      examined_base_(trials::variant_of(study, trials::overrides_for(study, examined_machines_))),
      examiner_(examined_base_, examined_machines_.count),
      journal_(journal),
      effort_(std::move(effort)) {}

SearchResult StudySearch::run(const SearchSettings& settings, std::vector<Values> starts) {
  stop_ = settings.effort.stop();
  SearchProblem problem;
  problem.free = free_;
  problem.aim = aim_of(study_);
  starts.insert(starts.begin(), values_in_manifest(study_, free_));
  std::erase_if(starts, [this](const Values& values) { return !lie_in_ranges(values, free_); });
  problem.starts = std::move(starts);
  problem.faces = zero_sets(free_);
  problem.size = size_;
  problem.trials_of_replicate = machines_.trials_each;
  problem.evaluate = [this](std::span<Candidate* const> candidates, std::int64_t to) {
    evaluate(candidates, to);
  };
  problem.admissible = [this](std::span<const Candidate> candidates) { return admissible(candidates); };
  problem.shortfall = [this](std::span<const Values> values) { return shortfalls_of(values, false, stop_); };
  problem.verified = [this](const Candidate& candidate) { return verified(candidate); };
  return search(problem, settings);
}

void StudySearch::evaluate(std::span<Candidate* const> candidates, std::int64_t to) {
  std::vector<Candidate*> unknown;
  std::vector<std::int64_t> from;
  for (Candidate* const one : candidates) {
    const std::int64_t begin = std::ssize(one->machines);
    journal_.take(base_.study_sha256, one->values, begin, to, one->machines);
    if (std::ssize(one->machines) >= to) continue;
    from.push_back(std::ssize(one->machines));
    unknown.push_back(one);
  }
  std::vector<study::Study> studies(unknown.size());
  parallel::for_each_index(
      unknown.size(), [&](std::size_t i) { studies[i] = candidate(unknown[i]->values); }, "study");
  std::vector<MachinesToRun> entries;
  entries.reserve(unknown.size());
  for (std::size_t i = 0; i < unknown.size(); ++i)
    entries.push_back({&studies[i], from[i], to, &unknown[i]->machines, nullptr});
  const auto start = std::chrono::steady_clock::now();
  try {
    run_machines(entries, machines_, stop_);
  } catch (const trial::Interrupted&) {
    for (std::size_t i = 0; i < unknown.size(); ++i)
      unknown[i]->machines.resize(static_cast<std::size_t>(from[i]));
    throw;
  }
  simulation_seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  for (const Candidate* const one : candidates) some_slid_ = some_slid_ || has_slid(one->machines);
  for (const std::int64_t begin : from) simulated_ += (to - begin) * machines_.trials_each;
  std::vector<std::string> lines(unknown.size());
  const double seconds = journal_.elapsed();
  parallel::for_each_index(
      unknown.size(),
      [&](std::size_t i) {
        lines[i] = evaluation_line(base_.study_sha256, unknown[i]->values, from[i],
                                   std::span(unknown[i]->machines).subspan(static_cast<std::size_t>(from[i])),
                                   seconds);
        studies[i] = {};  // large, and as slow to free as to make
      },
      "journal");
  journal_.add(lines);
}

std::string StudySearch::refusal_of_all() const {
  const auto is_allowed = [this](const Values& values) { return examined_if_allowed(values).has_value(); };
  if (examined_.empty() || std::ranges::any_of(examined_, is_allowed)) return "";
  return trials::refusal_of_values(examined_base_, names_of(free_), examined_.front());
}

std::optional<NearestPoint> StudySearch::nearest() const {
  std::vector<Values> points;
  for (const std::int64_t i : statistics::spread_over(std::ssize(examined_), max_tried_points))
    points.push_back(examined_[static_cast<std::size_t>(i)]);
  const std::vector<double> shortfalls = shortfalls_of(points, some_slid_, effort_.stop());
  const auto least = std::ranges::min_element(shortfalls);
  if (least == shortfalls.end() || std::isinf(*least)) return std::nullopt;
  const Values& values = points[static_cast<std::size_t>(least - shortfalls.begin())];
  return NearestPoint{values, examiner_.margins_of(examined_candidate(values), some_slid_, effort_.stop())};
}

bool StudySearch::may_keep(const Values& values, bool slides) const {
  const std::optional<study::Study> study = examined_if_allowed(values);
  return study && examiner_.may_keep(*study, study_.tuning->margins, slides);
}

std::vector<bool> StudySearch::admissible(std::span<const Candidate> candidates) {
  std::vector<char> kept(candidates.size(), 1);
  std::vector<std::size_t> unknown;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (!may_keep_.contains(examination_of(candidates[i]))) unknown.push_back(i);
  }
  parallel::for_each_index(
      unknown.size(),
      [&](std::size_t k) {
        if (stop_.stop_requested()) return;
        const Candidate& one = candidates[unknown[k]];
        kept[unknown[k]] = may_keep(one.values, has_slid(one.machines)) ? 1 : 0;
      },
      "margins");
  if (stop_.stop_requested()) throw trial::Interrupted{};
  for (const std::size_t i : unknown) {
    if (kept[i] != 0) may_keep_.insert(examination_of(candidates[i]));
    if (candidates[i].machines.empty()) examined_.push_back(candidates[i].values);
  }
  return {kept.begin(), kept.end()};
}

std::vector<double> StudySearch::shortfalls_of(std::span<const Values> values, bool slides,
                                               const std::stop_token& stop) const {
  std::vector<double> found(values.size(), std::numeric_limits<double>::infinity());
  parallel::for_each_index(
      values.size(),
      [&](std::size_t i) {
        if (stop.stop_requested()) return;
        if (const std::optional<study::Study> study = examined_if_allowed(values[i]))
          found[i] = examiner_.shortfall(*study, study_.tuning->margins, slides);
      },
      "shortfall");
  if (stop.stop_requested()) throw trial::Interrupted{};
  return found;
}

bool StudySearch::verified(const Candidate& one) {
  if (keeps_.contains(examination_of(one))) return true;
  if (!examiner_.keeps(examined_candidate(one.values), study_.tuning->margins, has_slid(one.machines),
                       effort_.stop())) {
    may_keep_.clear();  // there may be one more critical machine
    return false;
  }
  keeps_.insert(examination_of(one));
  return true;
}

std::vector<std::vector<std::size_t>> zero_sets(std::span<const study::FreeParameter> free) {
  std::vector<std::size_t> all;
  std::vector<std::vector<std::size_t>> sets;
  for (std::size_t i = 0; i < free.size(); ++i) {
    if (free[i].low != 0.0 || !(free[i].name.ends_with(".kp") || free[i].name.ends_with(".kd"))) continue;
    all.push_back(i);
    sets.push_back({i});
  }
  if (all.size() > 1) sets.push_back(all);
  std::erase_if(sets, [&](const std::vector<std::size_t>& one) { return one.size() == free.size(); });
  return sets;
}

std::vector<OtherControl> other_controls(const study::Study& study) {
  std::vector<OtherControl> controls;
  for (const std::vector<std::size_t>& zeros : zero_sets(study.tuning->free))
    controls.push_back(with_zeros(study, zeros));
  if (std::optional<OtherControl> observer = with_observer(study)) controls.push_back(std::move(*observer));
  std::ranges::stable_sort(controls, {}, [](const OtherControl& one) { return one.free.size(); });
  return controls;
}

std::vector<Values> starts_from(std::span<const TunedValues> tuned,
                                std::span<const study::FreeParameter> free) {
  std::vector<Values> starts;
  for (const TunedValues& one : tuned) {
    Values values;
    for (const study::FreeParameter& parameter : free) {
      const auto found = one.find(parameter.name);
      values.push_back(found == one.end() ? parameter.low : found->second);
    }
    starts.push_back(std::move(values));
  }
  return starts;
}

}  // namespace zerocount::tuning
