#include "runners/tuning/tuner.hpp"

#include <algorithm>
#include <chrono>
#include <limits>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "core/hash/sha256.hpp"
#include "core/trial/trial.hpp"
#include "results/layout/header.hpp"
#include "results/shards/pieces.hpp"
#include "runners/status/progress.hpp"
#include "runners/status/status.hpp"
#include "runners/tuning/other_controls.hpp"
#include "runners/tuning/proof_runner.hpp"
#include "runners/tuning/race/proof.hpp"
#include "runners/tuning/study_search.hpp"
#include "runners/tuning/tuning_journal.hpp"

namespace zerocount::tuning {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::int64_t max_proof_moves = 2'000'000;
constexpr std::int64_t units_of_frontier = 512;
constexpr std::int64_t points_of_delay = 20;   // that are simulated to find it
constexpr std::int64_t points_of_room = 24;    // at most, of a parameter
constexpr std::int64_t points_of_limits = 24;  // usually
constexpr std::int64_t trials_of_alternative = 125'000;

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

/// Hash of all that decides the results of the search.
std::string identity_of(const study::Study& study) {
  const layout::Provenance build = layout::current_provenance();
  return hash::sha256_hex(study.study_sha256 + build.zerocount_version + build.git_commit);
}

/// Opens the journal, and refuses to overwrite what another run made.
TuningJournal open_journal(const study::Study& study, const TuneSettings& settings) {
  TuningJournal journal(journal_path(settings.output), identity_of(study), settings.force);
  if (journal.resumed() || settings.force) return journal;
  std::error_code error;
  const bool exists = fs::exists(settings.output, error);
  if (!exists && !shards::has_begun(settings.output)) return journal;
  throw Failure(ExitCode::bad_input,
                fmt::format("{}: {}; expected another FILE, or --force to replace it",
                            settings.output.string(), exists ? "exists already" : "has an unfinished run"));
}

TunedValues named_values(const std::vector<study::FreeParameter>& free, const Values& values) {
  TunedValues named;
  for (std::size_t i = 0; i < free.size(); ++i) named[free[i].name] = values[i];
  return named;
}

/// Trials per second of the study; infinite without a limit of time.
double speed_of(const study::Study& study, const TuneBudget& budget, const trials::Effort& effort,
                const TuningJournal& journal) {
  if (!budget.seconds) return std::numeric_limits<double>::infinity();
  return journal.speed() ? *journal.speed() : measured_speed(study, effort);
}

class Tuner {
 public:
  Tuner(const study::Study& study, const TuneSettings& settings, const std::stop_token& stop)
      : study_(study),
        settings_(settings),
        journal_(open_journal(study, settings)),
        line_(settings.quiet),
        effort_(whole_effort(settings.budget, stop)),
        speed_(speed_of(study, settings.budget, effort_, journal_)),
        plan_(plan_search(study, settings.budget, effort_, speed_)),
        search_(
            study, study.tuning->free, plan_.size, journal_, [this] { return elapsed(); }, effort_) {
    if (settings.budget.seconds) journal_.keep_speed(speed_);
  }

  TuneAnswer run() {
    answer_.free = study_.tuning->free;
    answer_.budget = settings_.budget;
    answer_.blind = search_.examiner().is_blind();
    find();
    if (!result_.finalists.empty()) {
      prove();
      describe();
    } else {
      require_enough_time();
      answer_.status = goal::Status::missed;
      find_part("the nearest point", [&] { find_nearest(); });
    }
    count_effort();
    journal_.remove();
    return std::move(answer_);
  }

 private:
  /// A little of the time is kept back for the start and the end of the program, and for the page.
  trials::Effort whole_effort(const TuneBudget& budget, const std::stop_token& stop) const {
    if (!budget.seconds) return trials::Effort(stop).share(budget.trials, {});
    const double page = settings_.maps ? std::min(0.8, 0.2 * *budget.seconds) : 0.0;
    return trials::Effort(stop).share({}, 0.97 * *budget.seconds - 0.05 - page - journal_.seconds());
  }

  /// Seconds, those of interrupted runs included.
  double elapsed() const {
    return journal_.seconds() + std::chrono::duration<double>(Clock::now() - start_).count();
  }

  void count_effort() {
    answer_.seconds = elapsed();
    answer_.spent_trials = effort_.spent_trials();
  }

  std::string text_of(const Values& values) const {
    std::string text;
    for (std::size_t i = 0; i < values.size(); ++i)
      text += fmt::format("{}{} {}", i > 0 ? ", " : "", answer_.free[i].name, values[i]);
    return text;
  }

  void find_nearest() {
    answer_.nearest = nearest_point(
        search_.examined(), search_.examiner(), study_.tuning->margins,
        [this](const Values& values) { return search_.examined_if_allowed(values); }, search_.some_slid(),
        effort_.stop());
    if (answer_.nearest && keeps(answer_.nearest->margins, study_.tuning->margins))
      answer_.status = goal::Status::undecided;
  }

  void find() {
    SearchSettings search;
    search.seed = study_.seed;
    search.effort = plan_.effort;
    search.tell = [&](const SearchProgress& progress) {
      line_.show([&] {
        return fmt::format("generation {}: {} points, {} trials; best {:.4g} % at {}", progress.generation,
                           progress.points, progress.trials, 100.0 * progress.estimate.rate,
                           text_of(progress.best->values));
      });
    };
    result_ = search_.run(search);
    answer_.examined = std::ssize(search_.examined());
    answer_.points = result_.points;
    answer_.trials = result_.trials;
    answer_.converged = result_.converged;
    answer_.tried = result_.tried;
    answer_.frontier = frontier_of(result_.tried, std::min(units_of_frontier, plan_.size.max_units));
    constexpr std::int64_t enough_to_tell = 1000;
    if (settings_.budget.seconds && search_.simulated() >= enough_to_tell)
      speed_ = static_cast<double>(search_.simulated()) / search_.simulation_seconds();
  }

  /// @throws Failure (inconclusive) if the search ended too soon to say that there are no such values
  void require_enough_time() {
    if (!settings_.budget.seconds || !result_.cut ||
        (result_.points == 0 && answer_.examined >= plan_.size.first_candidates))
      return;
    throw out_of_time(
        fmt::format("ended in the search, when the margins of {} points were examined", answer_.examined));
  }

  Failure out_of_time(const std::string& what) {
    journal_.remove();
    const double seconds = settings_.budget.seconds.value_or(0.0);
    return {ExitCode::inconclusive, fmt::format("option '--budget': {:.3g} s are not enough: the time {}; "
                                                "expected about {:.3g} s",
                                                seconds, what, 2.0 * seconds)};
  }

  /// Limit of the trials of a proof; with a time as budget those of a part of what is left at the speed of
  /// the search, because the proof writes a file too.
  std::int64_t max_proof_trials() const {
    constexpr double part = 0.5;
    const std::int64_t most = std::max<std::int64_t>(max_proof_moves / study_.moves, 1);
    return std::min(most, affordable_trials(effort_, part * speed_));
  }

  void prove() {
    const std::int64_t each = trials_of_machine(study_);
    ProofRun run;
    ProofProblem problem;
    problem.goals = study_.goals;
    for (const Estimate& one : result_.estimates) problem.promising.push_back(seems_to_meet(one));
    problem.first_units = [&](std::size_t finalist, std::size_t correction) {
      const std::vector<UnitResult>& found = result_.finalists[finalist].units;
      const GoalCounts counts = counts_of(study_, search_.units(), found);
      return proof_units(study_, with_trials_each(counts, each), each, correction, max_proof_trials());
    };
    problem.more_units = [&](const GoalCounts& counts, std::size_t correction) {
      return proof_units(study_, counts, each, correction, max_proof_trials());
    };
    problem.run = [&](const Attempt& attempt) -> std::optional<GoalCounts> {
      const trials::Replicates units{attempt.units, each};
      line_.show([&] { return fmt::format("proof {}: {} trials", attempt.number, units.count * each); });
      std::vector<std::string> values =
          overrides_of(answer_.free, result_.finalists[attempt.finalist].values);
      values.push_back(fmt::format(
          "seed={}", trials::fresh_seed(study_.seed, fmt::format("tuning, proof {}", attempt.number))));
      const bool ended = trials::within(effort_, [&] {
        run = run_proof(study_, std::move(values), units, settings_.output, settings_.threads, effort_);
      });
      if (!ended) return std::nullopt;
      return counts_of(study_, units, run.results);
    };
    // The search examined the sliding loop of finalists that slid there.
    problem.rejects = [&](const Attempt& attempt) {
      const Candidate& finalist = result_.finalists[attempt.finalist];
      return has_slid(run.results) && !has_slid(finalist.units) &&
             !search_.examiner().keeps(search_.examined_candidate(finalist.values), study_.tuning->margins,
                                       true, effort_.stop());
    };
    problem.goes_on = [this] { return max_proof_trials() >= min_proof_trials(study_, max_attempts); };
    const std::optional<ProvenFinalist> proven = tuning::prove(problem);
    if (!proven) throw out_of_time("ended in the proof");
    adopt(*proven, std::move(run));
    count_effort();
    if (settings_.proven) {
      line_.finish("");
      settings_.proven(answer_);
    }
  }

  void adopt(const ProvenFinalist& proven, ProofRun run) {
    const Candidate& candidate = result_.finalists[proven.attempt.finalist];
    answer_.gains = candidate.values;
    slid_ = has_slid(candidate.units) || has_slid(run.results);
    answer_.status = proven.verdict.status;
    answer_.worst = worst_machine(run.study, 0, run.results);
    answer_.proof = Proof{std::move(run.study), proven.verdict, {}, proven.attempt.number};
    const std::size_t worst_goal = proven.verdict.goal;
    const study::Goal& goal = study_.goals[worst_goal];
    if (proven.verdict.status == goal::Status::undecided) {
      answer_.proof->needs =
          goal::needs_of(study_.goals, proven.counts, correction_of(proven.attempt.number));
    }
    const Candidate by_proof{candidate.place, candidate.values, std::move(run.results)};
    const Aim aim = aim_of(study_);
    answer_.criterion = estimate_of(aim, by_proof, proven.attempt.units).criterion;
    const std::size_t worst_claim = claim_at(study_, {worst_goal, proven.verdict.condition});
    answer_.late_limit = late_value(by_proof, worst_claim, proven.attempt.units, goal.moves) *
                         criteria_of(study_)[worst_goal].scale;
    name_edges();
  }

  /// Finds a part of the answer that is not proven; one for which the effort is not enough is named.
  void find_part(const std::string& name, const std::function<void()>& work) {
    line_.show([&] { return "proven; " + name; });
    const bool ended = !effort_.stop().stop_requested() && trials::within(effort_, work);
    if (effort_.is_interrupted()) throw trial::Interrupted{};
    if (!ended) answer_.left_out.push_back(name);
  }

  void describe() {
    const study::Study tuned = search_.candidate(answer_.gains);
    answer_.delay = study::study_trial(tuned, 0, 0).parameters.controller.delay;
    const std::vector<OtherControl> controls = other_controls(study_);
    const bool met = answer_.status == goal::Status::met;
    const std::int64_t points =
        points_of_limits + (met ? points_of_delay + points_of_room * std::ssize(answer_.free) : 0);
    rest_ =
        plan_rest(study_, points, settings_.maps ? trials_of_maps(search_.units(), answer_.free.size()) : 0,
                  controls, effort_, speed_);
    const TunedStudy details{tuned, answer_.free, answer_.gains, search_.units(), rest_.units, effort_};
    if (!answer_.blind) {
      find_part("margins", [&] {
        answer_.margins =
            search_.examiner().margins_of(search_.examined_candidate(answer_.gains), slid_, effort_.stop());
      });
    }
    if (met) {
      find_part("delay at which the goal is lost", [&] {
        answer_.delay_lost = delay_lost(details, answer_.delay);
        answer_.delay_sought = true;
      });
      find_part("room", [&] { answer_.room = room_of(details); });
    } else {
      find_part("a wider band", [&] {
        TunedStudy wider = details;
        wider.count = units_of_limits().count;
        answer_.wider_band_rate = rate_in_wider_band(wider, answer_.proof->verdict.goal);
      });
    }
    add_alternatives(controls);
    find_part("limits", [&] {
      const trials::Replicates units = units_of_limits();
      const study::Study of_limits = trials::variant_of(study_, trials::overrides_for(study_, units));
      const study::Study tuned_study = at_values(of_limits, answer_.free, answer_.gains).value();
      answer_.limits = limits_of(EffectRuns(tuned_study, units, effort_));
    });
    if (settings_.maps) find_part("maps", [&] { answer_.maps = maps_of(details, search_.examiner()); });
  }

  void name_edges() {
    const UnitCubePoint place = place_of(answer_.free, answer_.gains);
    for (std::size_t i = 0; i < place.size(); ++i) {
      constexpr double close = 0.02;
      if (place[i] > close && place[i] < 1.0 - close) continue;
      answer_.at_edges.push_back(fmt::format("{} = {} is at the {} end of its range", answer_.free[i].name,
                                             answer_.gains[i], place[i] > 0.5 ? "upper" : "lower"));
    }
  }

  /// All units of the search, with a budget those of the details.
  trials::Replicates units_of_limits() const {
    const trials::Replicates& all = search_.units();
    if (!has_budget()) return all;
    return {std::min(trials::in_equal_worlds(study_, rest_.units), all.count), all.trials_each};
  }

  void add_alternatives(const std::vector<OtherControl>& controls) {
    std::vector<TunedValues> tuned{named_values(answer_.free, answer_.gains)};
    const auto all = std::ssize(controls);
    for (std::int64_t i = 0; i < all; ++i) {
      const OtherControl& control = controls[static_cast<std::size_t>(i)];
      find_part(fmt::format("other control ({})", control.name),
                [&] { add_alternative(control, one_of_shares(all - i), tuned); });
    }
  }

  /// One of so many equal parts of what a budget leaves beside limits and maps; without a budget what a
  /// control takes by default.
  trials::Effort one_of_shares(std::int64_t parts) const {
    if (!has_budget()) return effort_.share(trials_of_alternative, {});
    const std::int64_t later =
        points_of_limits * rest_.units * search_.units().trials_each + rest_.trials_of_maps;
    if (settings_.budget.trials)
      return effort_.share(std::max<std::int64_t>(effort_.trials_left() - later, 0) / parts, {});
    return effort_.share(
        {}, (effort_.seconds_left() - static_cast<double>(later) / speed_) / static_cast<double>(parts));
  }

  bool has_budget() const { return settings_.budget.trials || settings_.budget.seconds; }

  /// @param tuned controls that are tuned already; gets this one
  void add_alternative(const OtherControl& control, const trials::Effort& effort,
                       std::vector<TunedValues>& tuned) {
    const study::Study study = trials::variant_of(study_, control.overrides);
    const SearchPlan plan = plan_other_search(study, control.free, effort, speed_);
    StudySearch search(
        study, control.free, plan.size, journal_, [this] { return elapsed(); }, effort);
    SearchSettings limits;
    limits.seed = study_.seed;
    limits.effort = plan.effort;
    const SearchResult found = search.run(limits, starts_from(tuned, control.free));
    answer_.points += found.points;
    answer_.trials += found.trials;
    if (found.finalists.empty() && found.cut) throw trials::Spent{};
    Alternative alternative;
    alternative.name = control.name;
    for (const std::string& name : control.zero) alternative.fixed.emplace_back(name, 0.0);
    if (!found.finalists.empty()) {
      const Values& best = found.finalists.front().values;
      judge_alternative(study, control.free, best, effort, alternative);
      tuned.push_back(named_values(control.free, best));
      for (const std::string& name : control.zero) tuned.back()[name] = 0.0;
    }
    answer_.alternatives.push_back(std::move(alternative));
  }

  /// Runs it on fresh machines.
  void judge_alternative(const study::Study& study, const std::vector<study::FreeParameter>& free,
                         const Values& values, const trials::Effort& effort, Alternative& alternative) const {
    for (std::size_t i = 0; i < free.size(); ++i) alternative.gains.emplace_back(free[i].name, values[i]);
    const trials::Replicates units{units_of_judgement(study, effort, speed_), trials_of_machine(study)};
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

  const study::Study& study_;
  const TuneSettings& settings_;
  Clock::time_point start_{Clock::now()};
  TuningJournal journal_;
  status::StatusLine line_;
  trials::Effort effort_;
  double speed_;  ///< trials/s; infinite without a limit of time
  SearchPlan plan_;
  StudySearch search_;
  SearchResult result_;
  RestPlan rest_;
  bool slid_{false};  ///< the tuned axis slid, in the search or the proof
  TuneAnswer answer_;
};

}  // namespace

TuneAnswer tune(const study::Study& study, const TuneSettings& settings, const std::stop_token& stop) {
  require_tunable(study);
  try {
    return Tuner(study, settings, stop).run();
  } catch (const trial::Interrupted&) {
    throw Failure(ExitCode::interrupted,
                  fmt::format("interrupted: the simulated points are kept in {}; give the same command again "
                              "to continue",
                              journal_path(settings.output).string()));
  }
}

}  // namespace zerocount::tuning
