#include "runners/tuning/tuner.hpp"

#include <algorithm>
#include <chrono>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "analysis/tuning/proof.hpp"
#include "core/failure/failure.hpp"
#include "core/hash/sha256.hpp"
#include "core/trial/trial.hpp"
#include "results/layout/header.hpp"
#include "results/shards/pieces.hpp"
#include "runners/status/status.hpp"
#include "runners/study_run/progress.hpp"
#include "runners/tuning/other_controls.hpp"
#include "runners/tuning/proof_runner.hpp"
#include "runners/tuning/study_search.hpp"
#include "runners/tuning/tuning_journal.hpp"

namespace zerocount::tuning {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::int64_t max_units = 2048;
constexpr std::int64_t max_proof_moves = 2'000'000;
constexpr std::int64_t units_of_alternative = 1000;
constexpr std::int64_t units_of_frontier = 512;

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

class Tuner {
 public:
  Tuner(const study::Study& study, const TuneSettings& settings, const std::stop_token& stop)
      : study_(study),
        settings_(settings),
        stop_(stop),
        journal_(open_journal(study, settings)),
        line_(settings.quiet),
        search_(
            study, study.tuning->free, max_units, journal_, [this] { return elapsed(); }, stop) {}

  TuneAnswer run() {
    answer_.free = study_.tuning->free;
    answer_.blind = search_.examiner().is_blind();
    find();
    if (!result_.finalists.empty()) {
      prove();
      describe();
    } else {
      answer_.status = goal::Status::missed;
    }
    answer_.examined += search_.examined();
    answer_.seconds = elapsed();
    journal_.remove();
    line_.finish("");
    return std::move(answer_);
  }

 private:
  /// Seconds, those of interrupted runs included.
  double elapsed() const {
    return journal_.seconds() + std::chrono::duration<double>(Clock::now() - start_).count();
  }
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
    answer_.tried = result_.tried;
    answer_.frontier = frontier_of(result_.tried, units_of_frontier);
    search_seconds_ = elapsed();
  }

  /// Limit of the trials of a proof: with a time as budget, those of a third of it at the speed of the
  /// search.
  std::int64_t most_proof_trials() const {
    const std::int64_t most = std::max<std::int64_t>(max_proof_moves / study_.moves, 1);
    if (!settings_.seconds) return most;
    const double speed = static_cast<double>(result_.trials) / std::max(search_seconds_, 1e-3);
    return std::clamp<std::int64_t>(static_cast<std::int64_t>(*settings_.seconds / 3.0 * speed), 1, most);
  }

  void prove() {
    const std::int64_t each = trials_of_machine(study_);
    const std::int64_t most = most_proof_trials();
    ProofRun run;
    ProofProblem problem;
    problem.goal = *study_.goal;
    for (const Estimate& one : result_.estimates)
      problem.promising.push_back(seems_to_meet(aim_of(study_), one));
    problem.first_units = [&](std::size_t finalist, std::size_t correction) {
      const std::vector<UnitResult>& found = result_.finalists[finalist].units;
      const measures::MoveCounts counts = counts_of(study_, search_.units(), found);
      return proof_units(study_, with_trials_each(counts, each), each, correction, most);
    };
    problem.more_units = [&](const measures::MoveCounts& counts, std::size_t correction) {
      return proof_units(study_, counts, each, correction, most);
    };
    problem.run = [&](const Attempt& attempt) {
      const Units units{attempt.units, each};
      line_.show([&] { return fmt::format("proof {}: {} trials", attempt.number, units.count * each); });
      std::vector<std::string> values =
          overrides_of(answer_.free, result_.finalists[attempt.finalist].values);
      values.push_back(
          fmt::format("seed={}", fresh_seed(study_.seed, fmt::format("tuning, proof {}", attempt.number))));
      run = run_proof(study_, std::move(values), units, settings_.output, settings_.threads, stop_);
      return counts_of(study_, units, run.results);
    };
    // The search examined the sliding loop of finalists that slid there.
    problem.rejects = [&](const Attempt& attempt) {
      const Candidate& finalist = result_.finalists[attempt.finalist];
      return has_slid(run.results) && !has_slid(finalist.units) &&
             !search_.examiner().keeps(search_.candidate(finalist.values), study_.tuning->margins, true);
    };
    problem.has_time = [this] { return has_time(0.8); };
    const ProvenFinalist proven = tuning::prove(problem);
    adopt(proven, std::move(run));
  }

  void adopt(const ProvenFinalist& proven, ProofRun run) {
    const Candidate& candidate = result_.finalists[proven.attempt.finalist];
    answer_.gains = candidate.values;
    slid_ = has_slid(candidate.units) || has_slid(run.results);
    answer_.status = proven.verdict.status;
    answer_.worst = worst_machine(run.study, 0, run.results);
    answer_.proof = Proof{std::move(run.study), proven.verdict, {}, proven.attempt.number};
    if (proven.verdict.status == goal::Status::undecided) {
      answer_.proof->needs =
          goal::needs_of(*study_.goal, proven.counts, correction_of(proven.attempt.number));
    }
    const Candidate by_proof{candidate.place, candidate.values, std::move(run.results)};
    Aim aim = aim_of(study_);
    answer_.criterion = estimate_of(aim, by_proof, proven.attempt.units).criterion;
    aim.quantile = aim.moves;
    answer_.late_limit = estimate_of(aim, by_proof, proven.attempt.units).criterion;
  }

  void describe() {
    const study::Study tuned = search_.candidate(answer_.gains);
    answer_.delay = study::study_trial(tuned, 0, 0).parameters.controller.delay;
    if (!answer_.blind) answer_.margins = search_.examiner().margins_of(tuned, slid_);
    name_edges();
    const TunedStudy details{tuned, answer_.free, answer_.gains, search_.units(), stop_};
    const auto tell = [this](std::string_view what) {
      line_.show([&] { return fmt::format("proven; {}", what); });
      return has_time(1.0);
    };
    const bool met = answer_.status == goal::Status::met;
    if (met && tell("delay at which the goal is lost"))
      answer_.delay_lost = delay_lost(details, answer_.delay);
    if (met && tell("room")) answer_.room = room_of(details);
    if (!met && tell("a wider band")) answer_.wider_band_rate = rate_in_wider_band(details);
    if (tell("limits")) answer_.limits = limits_of(tuned, search_.units(), stop_);
    if (tell("alternatives")) add_alternatives();
    if (settings_.maps && tell("maps")) answer_.maps = maps_of(details, search_.examiner());
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

  void add_alternatives() {
    for (const OtherControl& one : other_controls(study_)) {
      if (has_time(1.0)) add_alternative(one);
    }
  }

  void add_alternative(const OtherControl& control) {
    const study::Study study = variant_of(study_, control.overrides);
    StudySearch search(
        study, control.free, max_units / 2, journal_, [this] { return elapsed(); }, stop_);
    SearchSettings limits;
    limits.seed = study_.seed;
    limits.max_trials = settings_.max_trials / 4;
    limits.go_on = [&](const SearchProgress&) { return has_time(1.0); };
    const SearchResult found = search.run(limits);
    answer_.points += found.points;
    answer_.trials += found.trials;
    answer_.examined += search.examined();
    Alternative alternative;
    for (const std::string& name : control.zero) alternative.fixed.emplace_back(name, 0.0);
    if (!found.finalists.empty())
      judge_alternative(study, control.free, found.finalists.front().values, alternative);
    answer_.alternatives.push_back(std::move(alternative));
  }

  /// Runs it on fresh machines.
  void judge_alternative(const study::Study& study, const std::vector<study::FreeParameter>& free,
                         const Values& values, Alternative& alternative) const {
    for (std::size_t i = 0; i < free.size(); ++i) alternative.gains.emplace_back(free[i].name, values[i]);
    const Units units{in_equal_worlds(study, units_of_alternative), trials_of_machine(study)};
    std::vector<std::string> fresh = overrides_of(free, values);
    fresh.push_back(fmt::format("seed={}", fresh_seed(study.seed, "tuning, alternative")));
    for (const std::string& one : overrides_for(study, units)) fresh.push_back(one);
    const Candidate candidate{
        {}, values, results_of(variant_of(study, fresh), units, units.count, nullptr, stop_)};
    alternative.verdict = goal::judge_goal(*study.goal, counts_of(study, units, candidate.units), 1);
    alternative.criterion = estimate_of(aim_of(study), candidate, units.count).criterion;
  }

  const study::Study& study_;
  const TuneSettings& settings_;
  std::stop_token stop_;
  Clock::time_point start_{Clock::now()};
  TuningJournal journal_;
  status::StatusLine line_;
  StudySearch search_;
  SearchResult result_;
  double search_seconds_{0.0};
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
