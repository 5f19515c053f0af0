#include "runners/tuning/tuner.hpp"

#include <algorithm>
#include <chrono>
#include <limits>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "analysis/parallel/parallel.hpp"
#include "analysis/theory/goal_plausibility.hpp"
#include "core/failure/failure.hpp"
#include "core/hash/sha256.hpp"
#include "core/trial/trial.hpp"
#include "results/layout/header.hpp"
#include "results/reading/all_trials_file.hpp"
#include "results/shards/pieces.hpp"
#include "runners/status/progress.hpp"
#include "runners/status/status.hpp"
#include "runners/tuning/extras.hpp"
#include "runners/tuning/race/proof.hpp"
#include "runners/tuning/search/proof_runner.hpp"
#include "runners/tuning/search/study_search.hpp"
#include "runners/tuning/search/tuning_journal.hpp"

namespace zerocount::tuning {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::int64_t max_proof_moves = 2'000'000;
constexpr std::int64_t units_of_frontier = 512;
constexpr std::int64_t units_of_behaviour = 128;  // that show what values do, before their proof

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

/// Trials per second of the study by which a budget is planned; infinite without a limit of time.
double speed_of(const study::Study& study, const TuneBudget& budget, const trials::Effort& effort,
                const TuningJournal& journal) {
  if (!budget.seconds) return std::numeric_limits<double>::infinity();
  return journal.speed() ? *journal.speed() : measured_speed(study, effort);
}

/// A little of the time is kept back for the start and the end of the program, and for the page.
trials::Effort whole_effort(const TuneSettings& settings, const TuningJournal& journal,
                            const std::stop_token& stop) {
  const TuneBudget& budget = settings.budget;
  if (!budget.seconds) return trials::Effort(stop).share(budget.trials, {});
  const double page = settings.page ? std::min(0.8, 0.2 * *budget.seconds) : 0.0;
  return trials::Effort(stop).share({}, 0.97 * *budget.seconds - 0.05 - page - journal.seconds());
}

/// A candidate on the units of a proof, and the verdict on it.
struct Judged {
  Candidate candidate;
  trials::Replicates units;
  goal::Verdict verdict;
  GoalCounts counts;
  int attempts;
  std::size_t correction;  ///< of the bounds, for the attempts
};

std::vector<std::string> edges_of(const std::vector<study::FreeParameter>& free, const Values& values) {
  std::vector<std::string> edges;
  const UnitCubePoint place = place_of(free, values);
  for (std::size_t i = 0; i < place.size(); ++i) {
    constexpr double close = 0.02;
    if (place[i] > close && place[i] < 1.0 - close) continue;
    edges.push_back(fmt::format("{} = {} is at the {} end of its range", free[i].name, values[i],
                                place[i] > 0.5 ? "upper" : "lower"));
  }
  return edges;
}

/// @param slides whether the machines of the tuned values slide
void add_margins(const StudySearch& search, bool slides, const std::stop_token& stop, TuneAnswer& answer) {
  const study::Study tuned = search.examined_candidate(answer.gains);
  answer.margins = search.examiner().margins_of(tuned, slides, stop);
  answer.lowest_mode = search.examiner().lowest_mode(tuned, slides, stop);
}

/// Whether theory excludes the goal for all values of the free parameters, which are gains.
bool is_out_of_reach(const study::Study& proven, std::span<const study::FreeParameter> free) {
  const auto is_of_controller = [](const study::FreeParameter& one) {
    return one.name.starts_with("controller.") && one.name != "controller.delay" &&
           one.name != "controller.sample_rate";
  };
  return std::ranges::all_of(free, is_of_controller) && !theory::goals_out_of_reach(proven).empty();
}

/// Completes the answer by a proof, of which `file` is the results file.
void describe_proof(study::Study proven, const reading::AllTrialsFile& file, const Judged& judged,
                    TuneAnswer& answer) {
  const goal::Verdict& verdict = judged.verdict;
  answer.gains = judged.candidate.values;
  answer.at_edges = edges_of(answer.free, answer.gains);
  answer.status = verdict.status;
  if (answer.status == goal::Status::missed && !answer.missed.shows_unreachable() &&
      !is_out_of_reach(proven, answer.free))
    answer.status = goal::Status::undecided;
  answer.worst = worst_machine(proven, 0, judged.candidate.units);
  const std::size_t worst_claim = claim_at(proven, {verdict.goal, verdict.condition});
  answer.criterion = estimate_of(aim_of(proven), judged.candidate, judged.units.count).criterion;
  answer.late_limit =
      late_value(judged.candidate, worst_claim, judged.units.count, proven.goals[verdict.goal].moves) *
      criteria_of(proven)[verdict.goal].scale;
  answer.behaviour = summary::behaviour_in(file, proven);
  answer.proof = Proof{std::move(proven),
                       verdict,
                       {},
                       judged.attempts,
                       summary::claims_of_point(summary::summarise(file), 0, judged.correction)};
  if (answer.status != goal::Status::met) answer.obstacles = theory::doubtful_goals(answer.proof->study);
  if (verdict.status == goal::Status::undecided)
    answer.proof->needs = goal::needs_of(answer.proof->study.goals, judged.counts, judged.correction);
}

/// Gives the moves of a proof the torque at rest that simulated machines showed, where it does not measure
/// it.
void add_rest_torque(std::vector<summary::MoveBehaviour>& behaviour,
                     const std::vector<summary::MoveBehaviour>& simulated) {
  for (summary::MoveBehaviour& row : behaviour) {
    const auto same = std::ranges::find_if(simulated, [&](const summary::MoveBehaviour& one) {
      return one.number == row.number && one.condition == row.condition;
    });
    if (!row.rest && same != simulated.end()) row.rest = same->rest;
  }
}

class Tuner {
 public:
  Tuner(const study::Study& study, const TuneSettings& settings, const std::stop_token& stop)
      : study_(study),
        settings_(settings),
        journal_(open_journal(study, settings)),
        line_(settings.quiet, settings.listener),
        effort_(whole_effort(settings, journal_, stop)),
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
    tell_default();
    find();
    if (!result_.finalists.empty()) {
      examine(0);
      tell_found();
      prove();
      make_extras();
    } else {
      require_enough_time();
      answer_.status = goal::Status::missed;
      find_part("the nearest point", [&] { find_nearest(); });
    }
    count_effort();
    answer_.interrupted = effort_.is_interrupted();
    if (!answer_.interrupted) journal_.remove();
    return std::move(answer_);
  }

 private:
  /// Seconds, those of interrupted runs included.
  double elapsed() const {
    return journal_.seconds() + std::chrono::duration<double>(Clock::now() - start_).count();
  }

  void count_effort() {
    answer_.seconds = elapsed();
    answer_.spent_trials = effort_.spent_trials();
  }

  /// Without a budget: what the search may take on this machine.
  void tell_default() {
    if (settings_.budget.trials || settings_.budget.seconds) return;
    answer_.default_seconds = default_search_seconds(study_, effort_);
    if (!settings_.quiet)
      status::tell(
          "no --budget: the search takes at most {}, as measured here, then the proof and the extras\n",
          status::duration_text(*answer_.default_seconds));
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
    if (!answer_.nearest) answer_.refusal = search_.refusal_of_all();
  }

  void find() {
    const parallel::Recording stage("search");
    SearchSettings search;
    search.seed = study_.seed;
    search.begins_anew = settings_.budget.trials || settings_.budget.seconds;
    search.effort = plan_.effort;
    search.tell = [&](const SearchProgress& progress) {
      line_.show([&] {
        return fmt::format("generation {}: {} points, {} trials; best {:.4g} % at {}", progress.generation,
                           progress.points, progress.trials, 100.0 * progress.estimate.rate,
                           text_of(progress.best->values));
      });
      if (settings_.searching) settings_.searching(progress);
    };
    line_.show([] {
      return std::string("first generation: the margins of points over the ranges, then their moves");
    });
    result_ = search_.run(search);
    answer_.examined = std::ssize(search_.examined());
    answer_.points = result_.points;
    answer_.trials = result_.trials;
    answer_.converged = result_.converged;
    answer_.missed.approaching = result_.approaching;
    answer_.missed.landscape = landscape_of(aim_of(study_), result_.tried);
    answer_.tried = result_.tried;
    answer_.frontier = frontier_of(result_.tried, std::min(units_of_frontier, plan_.size.max_units));
    constexpr std::int64_t enough_to_tell = 1000;
    if (search_.simulated() >= enough_to_tell)
      measured_speed_ = static_cast<double>(search_.simulated()) / search_.simulation_seconds();
    if (settings_.budget.seconds && measured_speed_ > 0.0) speed_ = measured_speed_;
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

  /// What a finalist does, on machines of the search: its margins, and its moves.
  void examine(std::size_t finalist) {
    if (examined_finalist_ == finalist) return;
    answer_.left_out.clear();  // of another finalist
    examined_finalist_ = finalist;
    const Candidate& candidate = result_.finalists[finalist];
    answer_.gains = candidate.values;
    simulated_.clear();
    if (!answer_.blind) find_part("margins", [&] { examine_margins(has_slid(candidate.units)); });
    const study::Study study = search_.candidate(candidate.values);
    const std::int64_t count = std::min(units_of_behaviour, affordable_units_of_behaviour());
    if (count > 0) {
      find_part("torque at rest",
                [&] { simulated_ = simulated_behaviour(study, search_.units(), count, effort_); });
    } else {
      answer_.left_out.emplace_back("torque at rest");
    }
    answer_.behaviour = simulated_;
    answer_.refusals = refusals_of(answer_.behaviour, answer_.margins, study_);
  }

  void examine_margins(bool slides) {
    add_margins(search_, slides, effort_.stop(), answer_);
    margins_slide_ = slides;
  }

  /// As many as a tenth of what the smallest proof leaves is enough for.
  std::int64_t affordable_units_of_behaviour() const {
    constexpr std::int64_t part = 10;
    const std::int64_t left = affordable_trials(effort_, speed_) - min_proof_trials(study_, 1);
    return left / part / study::condition_count(study_);
  }

  void tell_found() {
    if (!settings_.found) return;
    line_.clear();
    settings_.found(answer_);
  }

  void prove() {
    const parallel::Recording stage("proof");
    const std::int64_t each = trials_of_machine(study_);
    ProofRun run;
    ProofProblem problem;
    problem.goals = study_.goals;
    const Aim aim = aim_of(study_);
    for (const Estimate& one : result_.estimates) {
      problem.may_meet.push_back(may_meet(aim, one));
      problem.margins.push_back(one.margin);
    }
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
      line_.clear();
      settings_.proven(answer_);
    }
  }

  void adopt(const ProvenFinalist& proven, ProofRun run) {
    examine(proven.attempt.finalist);
    const Candidate& candidate = result_.finalists[proven.attempt.finalist];
    const bool slid = has_slid(candidate.units) || has_slid(run.results);
    if (answer_.margins && slid != margins_slide_) find_part("margins", [&] { examine_margins(slid); });
    const trials::Replicates units{proven.attempt.units, trials_of_machine(study_)};
    const Judged judged{{candidate.place, candidate.values, std::move(run.results)},
                        units,
                        proven.verdict,
                        proven.counts,
                        proven.attempt.number,
                        correction_of(proven.attempt.number)};
    answer_.missed.all_tried = proven.all_tried;
    describe_proof(std::move(run.study), reading::AllTrialsFile(settings_.output), judged, answer_);
    add_rest_torque(answer_.behaviour, simulated_);
    answer_.refusals = refusals_of(answer_.behaviour, answer_.margins, study_);
  }

  /// Finds a part of the answer that is not proven; one for which the effort is not enough is named.
  void find_part(const std::string& name, const std::function<void()>& work) {
    line_.show([&] { return name; });
    const bool ended = !effort_.stop().stop_requested() && trials::within(effort_, work);
    if (effort_.is_interrupted()) throw trial::Interrupted{};
    if (!ended) answer_.left_out.push_back(name);
  }

  void make_extras() {
    const parallel::Recording stage("extras");
    ExtrasMaker({study_, settings_, search_, journal_, effort_, speed_, measured_speed_,
                 [this] { return elapsed(); }, line_},
                answer_)
        .make();
  }

  const study::Study& study_;
  const TuneSettings& settings_;
  Clock::time_point start_{Clock::now()};
  TuningJournal journal_;
  status::StatusLine line_;
  trials::Effort effort_;
  double speed_;                ///< trials/s; infinite without a limit of time
  double measured_speed_{0.0};  ///< of the search; 0 where it was too short
  SearchPlan plan_;
  StudySearch search_;
  SearchResult result_;
  std::optional<std::size_t> examined_finalist_;
  std::vector<summary::MoveBehaviour> simulated_;  ///< of it, on machines of the search
  bool margins_slide_{false};                      ///< the margins are those of machines that slide too
  TuneAnswer answer_;
};

/// The study of a proof on machines of other draws.
study::Study on_fresh_machines(const study::Study& proof) {
  return trials::variant_of(proof,
                            {fmt::format("seed={}", trials::fresh_seed(proof.seed, "tuning, extras"))});
}

}  // namespace

TuneAnswer tune(const study::Study& study, const TuneSettings& settings, const std::stop_token& stop) {
  require_tunable(study);
  try {
    return Tuner(study, settings, stop).run();
  } catch (const trial::Interrupted&) {
    throw Failure(ExitCode::interrupted, interruption_text(settings.output));
  }
}

namespace {

TuneAnswer with_extras(const study::Study& study, const TuneSettings& settings, const std::stop_token& stop) {
  const auto start = Clock::now();
  TuningJournal journal({}, {}, false);
  status::StatusLine line(settings.quiet, settings.listener);
  const trials::Effort effort = whole_effort(settings, journal, stop);
  const study::Study fresh = on_fresh_machines(study);
  const double measured = settings.budget.trials ? 0.0 : measured_speed(fresh, effort);
  const double speed = settings.budget.seconds ? measured : std::numeric_limits<double>::infinity();
  const auto elapsed = [start] { return std::chrono::duration<double>(Clock::now() - start).count(); };
  StudySearch search(fresh, study.tuning->free, default_search_size(fresh), journal, elapsed, effort);
  TuneAnswer answer;
  answer.free = study.tuning->free;
  answer.budget = settings.budget;
  answer.blind = search.examiner().is_blind();
  const trials::Replicates units = trials::replicates_of(study, 0);
  const reading::AllTrialsFile file(settings.output);
  Judged judged{
      {{}, values_in_manifest(study, answer.free), results_in(file, study, units)}, units, {}, {}, 1, 1};
  judged.counts = counts_of(study, units, judged.candidate.units);
  judged.verdict = goal::judge_goals(study.goals, judged.counts, judged.correction);
  const bool slid = has_slid(judged.candidate.units);
  describe_proof(study, file, judged, answer);
  const auto find_part = [&](const std::string& name, const std::function<void()>& work) {
    if (!trials::within(effort, work)) answer.left_out.push_back(name);
  };
  if (!answer.blind) {
    find_part("margins", [&] {
      add_margins(StudySearch(study, answer.free, default_search_size(study), journal, elapsed, effort), slid,
                  effort.stop(), answer);
    });
  }
  find_part("torque at rest", [&] {
    add_rest_torque(answer.behaviour, simulated_behaviour(search.candidate(answer.gains), search.units(),
                                                          units_of_behaviour, effort));
  });
  answer.refusals = refusals_of(answer.behaviour, answer.margins, study);
  if (settings.proven) settings.proven(answer);
  ExtrasMaker({fresh, settings, search, journal, effort, speed, measured, elapsed, line}, answer).make();
  answer.seconds = elapsed();
  answer.spent_trials = effort.spent_trials();
  answer.interrupted = effort.is_interrupted();
  return answer;
}

}  // namespace

TuneAnswer margins_in(const reading::AllTrialsFile& file) {
  const study::Study& study = file.study();
  TuningJournal journal({}, {}, false);
  StudySearch search(study, study.tuning->free, default_search_size(study), journal, [] { return 0.0; }, {});
  TuneAnswer answer;
  answer.free = study.tuning->free;
  answer.gains = values_in_manifest(study, answer.free);
  answer.blind = search.examiner().is_blind();
  const bool slides = has_slid(results_in(file, study, trials::replicates_of(study, 0)));
  if (!answer.blind) add_margins(search, slides, {}, answer);
  return answer;
}

TuneAnswer describe_tuned(const study::Study& study, const TuneSettings& settings,
                          const std::stop_token& stop) {
  require_tunable(study);
  try {
    return with_extras(study, settings, stop);
  } catch (const trial::Interrupted&) {
    throw Failure(ExitCode::interrupted, "interrupted: nothing was made; give the same command again");
  }
}

}  // namespace zerocount::tuning
