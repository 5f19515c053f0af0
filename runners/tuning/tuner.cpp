#include "runners/tuning/tuner.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include "analysis/tuning/proof.hpp"
#include "core/failure/failure.hpp"
#include "core/random/random_numbers.hpp"
#include "core/trial/trial.hpp"
#include "experiments/designs/random_key.hpp"
#include "experiments/manifest/edited_text.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/study/plan.hpp"
#include "experiments/study/study_table.hpp"
#include "results/layout/layout.hpp"
#include "runners/status/status.hpp"
#include "runners/study_run/file_run.hpp"
#include "runners/study_run/progress.hpp"
#include "runners/tuning/answer_details.hpp"

namespace zerocount::tuning {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::int64_t max_units = 2048;
constexpr std::int64_t max_search_trials_of_machine = 20;
constexpr std::int64_t least_proof_units = 500;
constexpr std::int64_t max_proof_trials = 2'000'000;

std::uint64_t fresh_seed(std::uint64_t seed, std::string_view purpose) {
  constexpr unsigned seed_bits = 52;  // readable as a double everywhere
  return random::random_bits({designs::random_key(seed, purpose), 0}, 0, random::Draw::trial) >>
         (64U - seed_bits);
}

/// Trials of a machine that tell whether it meets the goal; 1 where the goal does not ask for machines.
std::int64_t trials_of_machine(const study::Study& study) {
  if (!study.goal->machines) return 1;
  return std::max<std::int64_t>(study.trials / study.rigs, 10);
}

void require_tunable(const study::Study& study) {
  if (!study.tuning) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: its manifest does not say what to tune; expected a section such as tune: "
                              "{{free: {{controller.ki: {{log: [5.0e+3, 3.0e+5]}}}}}}",
                              study.name));
  }
  if (study::point_count(study) > 1) {
    throw Failure(
        ExitCode::bad_input,
        fmt::format("{}: it has {} design points; expected a manifest without a sweep, or values with "
                    "--set, because tuning seeks one point",
                    study.name, study::point_count(study)));
  }
}

/// The values of the free parameters in the manifest, where they lie inside the ranges.
std::vector<Values> starts_of(const study::Study& study, std::span<const study::FreeParameter> free) {
  Values values;
  for (const study::FreeParameter& one : free) {
    const std::size_t slot = study::find_slots(one.name, study.plan->table).value().first;
    values.push_back(study.plan->base[slot].number);
    if (!(values.back() >= one.low && values.back() <= one.high)) return {};
  }
  return {values};
}

/// The search for the best values of `free`, with the other values of the study.
class StudySearch {
 public:
  StudySearch(const study::Study& study, std::vector<study::FreeParameter> free, std::int64_t most_units,
              const std::stop_token& stop)
      : study_(study),
        free_(std::move(free)),
        criterion_(criterion_of(study)),
        units_{most_units, std::min(trials_of_machine(study), max_search_trials_of_machine)},
        base_(variant_of(study, overrides_for(study, units_))),
        examiner_(base_),
        stop_(stop) {}

  SearchResult run(const SearchSettings& settings) {
    SearchProblem problem;
    problem.free = free_;
    problem.aim = aim();
    problem.starts = starts_of(study_, free_);
    problem.max_units = units_.count;
    problem.trials_of_unit = units_.trials_each;
    problem.evaluate = [this](std::span<Candidate* const> candidates, std::int64_t to) {
      evaluate(candidates, to);
    };
    problem.admissible = [this](std::span<const Values> values) { return admissible(values); };
    problem.verified = [this](const Values& values) { return verified(values); };
    return search(problem, settings);
  }

  Aim aim() const { return aim_of(study_, criterion_); }
  study::Study candidate(const Values& values) const {
    return variant_of(base_, overrides_of(free_, values));
  }
  const LoopExaminer& examiner() const { return examiner_; }
  const Units& units() const { return units_; }

 private:
  void evaluate(std::span<Candidate* const> candidates, std::int64_t to) const {
    std::vector<study::Study> studies(candidates.size());
    oneapi::tbb::parallel_for(std::size_t{0}, candidates.size(),
                              [&](std::size_t i) { studies[i] = candidate(candidates[i]->values); });
    std::vector<UnitsToRun> entries;
    for (std::size_t i = 0; i < candidates.size(); ++i)
      entries.push_back({&studies[i], std::ssize(candidates[i]->units), to, &candidates[i]->units, nullptr});
    run_units(entries, units_, criterion_, stop_);
  }

  std::vector<bool> admissible(std::span<const Values> values) const {
    std::vector<char> kept(values.size(), 0);
    oneapi::tbb::parallel_for(std::size_t{0}, values.size(), [&](std::size_t i) {
      if (stop_.stop_requested()) return;
      try {
        kept[i] = examiner_.is_blind() || examiner_.may_keep(candidate(values[i]), study_.tuning->margins);
      } catch (const Failure& failure) {
        if (failure.code() != ExitCode::bad_input) throw;  // such values together are not allowed
      }
    });
    if (stop_.stop_requested()) throw trial::Interrupted{};
    return {kept.begin(), kept.end()};
  }

  bool verified(const Values& values) {
    if (examiner_.is_blind() || kept_.contains(values)) return true;
    if (!examiner_.keeps(candidate(values), study_.tuning->margins)) return false;
    kept_.insert(values);
    return true;
  }

  const study::Study& study_;
  std::vector<study::FreeParameter> free_;
  Criterion criterion_;
  Units units_;
  study::Study base_;
  LoopExaminer examiner_;
  std::set<Values> kept_;
  std::stop_token stop_;
};

/// The counts of the goal in these units.
measures::GoalCounts counts_of(const study::Study& study, const Units& units,
                               std::span<const UnitResult> results) {
  measures::GoalCounts counts;
  for (const UnitResult& unit : results) {
    counts.moves += unit.moves;
    counts.met += unit.met;
    if (study.rigs > 0) {
      counts.rigs.push_back({units.trials_each, unit.moves, unit.met});
    } else {
      counts.of_trials.add(unit.met, unit.moves);
    }
  }
  return counts;
}

/// The counts as they would be with `each` trials of every machine, at the same rates.
measures::GoalCounts with_trials_each(measures::GoalCounts counts, std::int64_t each) {
  for (statistics::RigMoves& rig : counts.rigs) {
    const auto factor = static_cast<double>(each) / static_cast<double>(rig.trials);
    counts.moves -= rig.moves;
    counts.met -= rig.met;
    rig.trials = each;
    rig.moves = std::llround(static_cast<double>(rig.moves) * factor);
    rig.met = std::llround(static_cast<double>(rig.met) * factor);
    counts.moves += rig.moves;
    counts.met += rig.met;
  }
  return counts;
}

/// The manifest of the study with these values in its text; an override that is not a number stays one.
study::Study tuned_study(const study::Study& study, std::span<const study::FreeParameter> free,
                         const Values& gains, std::uint64_t seed, const Units& units) {
  std::vector<std::string> set = overrides_of(free, gains);
  set.push_back(fmt::format("seed={}", seed));
  for (const std::string& one : overrides_for(study, units)) set.push_back(one);
  std::string text = study.manifest_text;
  std::vector<std::string> kept;
  for (const std::string& one : study.overrides) {
    const std::string key = one.substr(0, one.find('=') + 1);
    const auto is_set = [&key](const std::string& other) { return other.starts_with(key); };
    if (std::ranges::none_of(set, is_set)) kept.push_back(one);
  }
  kept.insert(kept.end(), set.begin(), set.end());
  std::vector<std::string> overrides;
  for (const std::string& one : kept) {
    const auto split = one.find('=');
    try {
      if (one.find_first_of("{}[]&*#:", split) != std::string::npos) throw Failure(ExitCode::bad_input, "");
      text = manifest::with_scalar(text, one.substr(0, split), one.substr(split + 1));
    } catch (const Failure&) {
      overrides.push_back(one);
    }
  }
  std::optional<std::string> samples;
  if (study.samples) samples = study.samples->text;
  study::Study tuned =
      manifest::parse_study(text, study.name, overrides, manifest::known_companions(study.plugin, samples));
  tuned.engine = study.engine;
  return tuned;
}

/// Units with which the proof of a candidate with such results is expected to be decided, and then half as
/// many more.
std::int64_t proof_units(const study::Study& study, const measures::GoalCounts& counts, std::int64_t each,
                         std::size_t points) {
  const std::int64_t most = std::max<std::int64_t>(max_proof_trials / each, 2);
  const goal::Needs needs = goal::needs_of(*study.goal, counts, points);
  const std::int64_t wanted =
      needs.trials == 0 ? most / 8 : (study.rigs > 0 ? needs.rigs : needs.trials / study.moves);
  std::int64_t least = least_proof_units;
  for (const goal::Needs& one : goal::smallest_studies(*study.goal, study.rigs > 0, study.moves, points)) {
    const bool same = study.rigs == 0 || one.trials / std::max<std::int64_t>(one.rigs, 1) <= each;
    if (same) least = std::max(least_proof_units, study.rigs > 0 ? one.rigs : one.trials);
    if (same) break;
  }
  return std::clamp(wanted + wanted / 2, least, most);
}

TuneStatus status_of(goal::Status status) {
  switch (status) {
    case goal::Status::met:
      return TuneStatus::met;
    case goal::Status::missed:
      return TuneStatus::unreachable;
    case goal::Status::undecided:
      break;
  }
  return TuneStatus::undecided;
}

class Tuner {
 public:
  Tuner(const study::Study& study, const TuneSettings& settings, const std::stop_token& stop)
      : study_(study),
        settings_(settings),
        stop_(stop),
        line_(settings.quiet),
        search_(study, study.tuning->free, max_units, stop) {}

  TuneAnswer run() {
    answer_.free = study_.tuning->free;
    answer_.blind = search_.examiner().is_blind();
    find();
    if (!result_.finalists.empty()) {
      prove();
      describe();
    } else {
      answer_.status = TuneStatus::unreachable;
    }
    answer_.seconds = elapsed();
    line_.finish("");
    return std::move(answer_);
  }

 private:
  double elapsed() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  bool has_time(double share) const { return !settings_.seconds || elapsed() < share * *settings_.seconds; }

  std::string text_of(const Values& values) const {
    std::string text;
    for (std::size_t i = 0; i < values.size(); ++i)
      text += fmt::format("{}{} {}", i > 0 ? ", " : "", answer_.free[i].name, values[i]);
    return text;
  }

  void find() {
    SearchSettings search;
    search.seed = study_.seed;
    search.max_trials = settings_.max_trials;
    search.go_on = [&](const SearchProgress& progress) {
      line_.show([&] {
        return fmt::format("generation {}: {} points, {} trials; best {:.4g} % at {}", progress.generation,
                           progress.points, progress.trials, 100.0 * progress.estimate.rate,
                           text_of(progress.best->values));
      });
      return has_time(0.5);
    };
    result_ = search_.run(search);
    answer_.points = result_.points;
    answer_.trials = result_.trials;
    answer_.converged = result_.converged;
  }

  void prove() {
    const std::int64_t each = trials_of_machine(study_);
    study::Study proven_study;
    std::vector<UnitResult> results;
    ProofProblem problem;
    problem.goal = *study_.goal;
    for (const Estimate& one : result_.estimates)
      problem.promising.push_back(seems_to_meet(search_.aim(), one));
    problem.first_units = [&](std::size_t finalist, std::size_t correction) {
      const std::vector<UnitResult>& found = result_.finalists[finalist].units;
      const measures::GoalCounts counts = counts_of(study_, search_.units(), found);
      return proof_units(study_, with_trials_each(counts, each), each, correction);
    };
    problem.more_units = [&](const measures::GoalCounts& counts, std::size_t correction) {
      return proof_units(study_, counts, each, correction);
    };
    problem.run = [&](const Attempt& attempt) {
      const Units units{attempt.units, each};
      const std::uint64_t seed = fresh_seed(study_.seed, fmt::format("tuning, proof {}", attempt.number));
      proven_study =
          tuned_study(study_, answer_.free, result_.finalists[attempt.finalist].values, seed, units);
      results = results_of(proven_study, units, nullptr, stop_);
      return counts_of(study_, units, results);
    };
    problem.has_time = [this] { return has_time(0.8); };
    const ProvenFinalist proven = tuning::prove(problem);
    adopt(proven, std::move(proven_study), results);
    write_proof();
  }

  void adopt(const ProvenFinalist& proven, study::Study proven_study, std::vector<UnitResult>& results) {
    const Candidate& candidate = result_.finalists[proven.attempt.finalist];
    answer_.gains = candidate.values;
    answer_.estimate = result_.estimates[proven.attempt.finalist];
    answer_.status = status_of(proven.verdict.status);
    answer_.proof = Proof{std::move(proven_study), proven.verdict, {}, proven.attempt.number};
    if (proven.verdict.status == goal::Status::undecided) {
      answer_.proof->needs =
          goal::needs_of(*study_.goal, proven.counts, correction_of(proven.attempt.number));
    }
    const Candidate by_proof{candidate.place, candidate.values, std::move(results)};
    Aim aim = search_.aim();
    answer_.criterion = estimate_of(aim, by_proof, proven.attempt.units).criterion;
    aim.quantile = aim.moves;
    answer_.late_limit = estimate_of(aim, by_proof, proven.attempt.units).criterion;
  }

  void write_proof() {
    const study::Study& proof = answer_.proof->study;
    study_run::run_to_file({proof, settings_.output, layout::all_rows(proof), settings_.threads, true,
                            study_run::ForeignShards::remove, true},
                           study_run::ExistingUse::none, stop_);
  }

  void describe() {
    const study::Study tuned = search_.candidate(answer_.gains);
    answer_.delay = study::study_trial(tuned, 0, 0).parameters.controller.delay;
    if (!answer_.blind) answer_.margins = search_.examiner().margins_of(tuned);
    name_edges();
    const Details details{study_, answer_.free, answer_.gains, search_.aim(), search_.units(), stop_};
    const auto tell = [this](std::string_view what) {
      line_.show([&] { return fmt::format("proven; {}", what); });
      return has_time(1.0);
    };
    const bool met = answer_.status == TuneStatus::met;
    if (met && tell("delay at which the goal is lost"))
      answer_.delay_lost = delay_lost(details, answer_.delay);
    if (met && tell("room")) answer_.room = room_of(details);
    if (!met && tell("a wider band")) answer_.wider_band_rate = rate_in_wider_band(details);
    if (tell("limits")) answer_.limits = limits_of(tuned, limit_units(details), stop_);
    if (tell("worst machine")) {
      const Units proven{answer_.proof->study.trials / trials_of_machine(study_), trials_of_machine(study_)};
      answer_.worst = worst_machine(answer_.proof->study, proven, stop_);
    }
    if (tell("alternatives")) add_alternatives();
  }

  void name_edges() {
    const Place place = place_of(answer_.free, answer_.gains);
    for (std::size_t i = 0; i < place.size(); ++i) {
      constexpr double close = 0.02;
      if (place[i] > close && place[i] < 1.0 - close) continue;
      answer_.at_edges.push_back(fmt::format("{} = {} is at the {} end of its range", answer_.free[i].name,
                                             answer_.gains[i], place[i] > 0.5 ? "upper" : "lower"));
    }
  }

  /// Searches anew with kp or kd fixed at 0, where the ranges allow it, and with both.
  void add_alternatives() {
    std::vector<std::vector<std::string>> choices;
    std::vector<std::string> zeros;
    for (const study::FreeParameter& one : answer_.free) {
      if (one.low == 0.0 && (one.name.ends_with(".kp") || one.name.ends_with(".kd")))
        zeros.push_back(one.name);
    }
    choices.reserve(zeros.size() + 1);
    for (const std::string& one : zeros) choices.push_back({one});
    if (zeros.size() > 1) choices.push_back(zeros);
    for (const std::vector<std::string>& fixed : choices) {
      if (fixed.size() == answer_.free.size() || !has_time(1.0)) continue;
      add_alternative(fixed);
    }
  }

  void add_alternative(const std::vector<std::string>& fixed) {
    std::vector<study::FreeParameter> free;
    std::vector<std::string> overrides;
    Alternative alternative;
    for (const study::FreeParameter& one : answer_.free) {
      if (std::ranges::find(fixed, one.name) == fixed.end()) {
        free.push_back(one);
      } else {
        overrides.push_back(fmt::format("{}=0", one.name));
        alternative.fixed.emplace_back(one.name, 0.0);
      }
    }
    const study::Study with_fixed = variant_of(study_, overrides);
    StudySearch search(with_fixed, free, max_units / 2, stop_);
    SearchSettings limits;
    limits.seed = study_.seed;
    limits.max_trials = settings_.max_trials / 4;
    limits.go_on = [&](const SearchProgress&) { return has_time(1.0); };
    const SearchResult found = search.run(limits);
    answer_.points += found.points;
    answer_.trials += found.trials;
    if (!found.finalists.empty()) {
      const Values& values = found.finalists.front().values;
      for (std::size_t i = 0; i < free.size(); ++i) alternative.gains.emplace_back(free[i].name, values[i]);
      const Units units{least_proof_units * 4, 1};
      std::vector<std::string> fresh = overrides_of(free, values);
      fresh.push_back(fmt::format("seed={}", fresh_seed(study_.seed, "tuning, alternative")));
      for (const std::string& one : overrides_for(study_, units)) fresh.push_back(one);
      const std::vector<UnitResult> results =
          results_of(variant_of(with_fixed, fresh), units, nullptr, stop_);
      study::Goal of_moves = *study_.goal;
      of_moves.machines.reset();
      const goal::Verdict verdict = goal::judge_goal(of_moves, counts_of(study_, units, results), 1);
      alternative.moves = verdict.moves;
      alternative.status = verdict.status;
      alternative.criterion = estimate_of(search.aim(), {{}, values, results}, units.count).criterion;
    }
    answer_.alternatives.push_back(std::move(alternative));
  }

  const study::Study& study_;
  const TuneSettings& settings_;
  std::stop_token stop_;
  Clock::time_point start_{Clock::now()};
  status::StatusLine line_;
  StudySearch search_;
  SearchResult result_;
  TuneAnswer answer_;
};

}  // namespace

TuneAnswer tune(const study::Study& study, const TuneSettings& settings, const std::stop_token& stop) {
  require_tunable(study);
  try {
    return Tuner(study, settings, stop).run();
  } catch (const trial::Interrupted&) {
    throw Failure(ExitCode::interrupted, "interrupted: nothing was written");
  }
}

}  // namespace zerocount::tuning
