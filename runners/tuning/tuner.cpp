#include "runners/tuning/tuner.hpp"

#include <algorithm>
#include <limits>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/parallel/parallel.hpp"
#include "analysis/theory/plausibility.hpp"
#include "core/failure/failure.hpp"
#include "core/hash/sha256.hpp"
#include "core/trial/trial.hpp"
#include "results/layout/header.hpp"
#include "results/shards/pieces.hpp"
#include "runners/status/progress.hpp"
#include "runners/tuning/race/proof.hpp"
#include "runners/tuning/search/proof_runner.hpp"
#include "runners/tuning/search/study_search.hpp"
#include "runners/tuning/search/tuning_journal.hpp"

namespace zerocount::tuning {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t max_proof_moves = 2'000'000;
constexpr std::int64_t units_of_frontier = 512;
constexpr std::int64_t units_of_behaviour = 128;  // that show what values do, before their proof
constexpr double no_limit = std::numeric_limits<double>::infinity();

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

/// Opens the journal, and refuses to overwrite what another run made.
TuningJournal open_journal(const study::Study& study, const TuneSettings& settings) {
  const layout::Provenance build = layout::current_provenance();
  const std::string all_that_decides = study.study_sha256 + build.zerocount_version + build.git_commit;
  TuningJournal journal(journal_path(settings.output), hash::sha256_hex(all_that_decides), settings.force);
  if (journal.resumed() || settings.force) return journal;
  std::error_code error;
  const bool exists = fs::exists(settings.output, error);
  if (!exists && !shards::has_begun(settings.output)) return journal;
  throw Failure(ExitCode::bad_input,
                fmt::format("{}: {}; expected another FILE, or --force to replace it",
                            settings.output.string(), exists ? "exists already" : "has an unfinished run"));
}

/// A little of the time is kept back for the start and the end of the program, and for the page.
trials::Effort whole_effort(const TuneSettings& settings, double elapsed, const std::stop_token& stop) {
  const TuneBudget& budget = settings.budget;
  if (!budget.seconds) return trials::Effort(stop).share(budget.trials, {});
  const double page = settings.page ? std::min(0.8, 0.2 * *budget.seconds) : 0.0;
  return trials::Effort(stop).share({}, 0.97 * *budget.seconds - 0.05 - page - elapsed);
}

/// What every stage uses.
struct Work {
  const study::Study& study;  ///< that is tuned, or whose proof is described
  const TuneSettings& settings;
  TuningJournal& journal;
  trials::Effort effort;
  double speed;                ///< by which a budget is planned, trials/s; infinite without a limit of time
  double measured_speed{0.0};  ///< trials/s; 0 where nothing was measured
  status::StatusLine line{settings.quiet, settings.listener};

  /// Finds a part of the answer that is not proven; one for which the effort is not enough is named.
  void find_part(TuneAnswer& answer, const std::string& name, const std::function<void()>& work) {
    line.show([&] { return name; });
    const bool ended = !effort.stop().stop_requested() && trials::within(effort, work);
    if (effort.is_interrupted()) throw trial::Interrupted{};
    if (!ended) answer.left_out.push_back(name);
  }

  void count_effort(TuneAnswer& answer) const {
    answer.seconds = journal.elapsed();
    answer.spent_trials = effort.spent_trials();
    answer.interrupted = effort.is_interrupted();
  }

  Failure out_of_time(const std::string& what) const {
    journal.remove();
    const double seconds = settings.budget.seconds.value_or(0.0);
    return {ExitCode::inconclusive, fmt::format("option '--budget': {:.3g} s are not enough: the time {}; "
                                                "expected about {:.3g} s",
                                                seconds, what, 2.0 * seconds)};
  }
};

TuneAnswer answer_of(const Work& work, const StudySearch& search) {
  TuneAnswer answer;
  answer.free = work.study.tuning->free;
  answer.budget = work.settings.budget;
  answer.blind = search.examiner().is_blind();
  return answer;
}

/// @param slides whether the machines of the tuned values slide
void add_margins(const StudySearch& search, bool slides, const std::stop_token& stop, TuneAnswer& answer) {
  const study::Study tuned = search.examined_candidate(answer.gains);
  answer.margins = search.examiner().margins_of(tuned, slides, stop);
  answer.lowest_mode = search.examiner().lowest_mode(tuned, slides, stop);
}

// The search.

/// Without a budget: what the search may take on this machine.
void tell_default(const Work& work, TuneAnswer& answer) {
  if (answer.budget.trials || answer.budget.seconds) return;
  answer.default_seconds = default_search_seconds(work.study, work.effort);
  if (!work.settings.quiet)
    status::tell(
        "no --budget: the search takes at most {}, as measured here, then the proof and the extras\n",
        status::duration_text(*answer.default_seconds));
}

void find_values(Work& work, StudySearch& search, const SearchPlan& plan, TuneAnswer& answer) {
  const parallel::Recording stage("search");
  SearchSettings settings;
  settings.seed = work.study.seed;
  settings.begins_anew = answer.budget.trials || answer.budget.seconds;
  settings.effort = plan.effort;
  settings.tell = [&](const SearchProgress& progress) {
    work.line.show([&] {
      return fmt::format("generation {}: {} points, {} trials; best {:.4g} % at {}", progress.generation,
                         progress.points, progress.trials, 100.0 * progress.estimate.rate,
                         fmt::join(overrides_of(answer.free, progress.best->values), ", "));
    });
    if (work.settings.searching) work.settings.searching(progress);
  };
  work.line.show([] {
    return std::string("first generation: the margins of points over the ranges, then their moves");
  });
  SearchResult& found = answer.search = search.run(settings);
  answer.examined = std::ssize(search.examined());
  answer.missed.approaching = found.approaching;
  answer.missed.landscape = landscape_of(aim_of(work.study), found.tried);
  answer.frontier = frontier_of(found.tried, std::min(units_of_frontier, plan.size.max_units));
  constexpr std::int64_t enough_to_tell = 1000;
  if (search.simulated() >= enough_to_tell)
    work.measured_speed = static_cast<double>(search.simulated()) / search.simulation_seconds();
  if (answer.budget.seconds && work.measured_speed > 0.0) work.speed = work.measured_speed;
}

/// Where no candidate keeps the margins.
/// @throws Failure (inconclusive) if the search ended too soon to say that there are no such values
void explain_missing(Work& work, const StudySearch& search, const SearchPlan& plan, TuneAnswer& answer) {
  const SearchResult& found = answer.search;
  const bool had_time = found.points == 0 && answer.examined >= plan.size.first_candidates;
  if (answer.budget.seconds && found.cut && !had_time)
    throw work.out_of_time(
        fmt::format("ended in the search, when the margins of {} points were examined", answer.examined));
  answer.status = goal::Status::missed;
  const study::LoopMargins& wanted = work.study.tuning->margins;
  work.find_part(answer, "the nearest point", [&] {
    answer.nearest = search.nearest();
    if (answer.nearest && keeps(answer.nearest->margins, wanted)) answer.status = goal::Status::undecided;
    if (!answer.nearest) answer.refusal = search.refusal_of_all();
  });
}

// What the values of a finalist do, on machines of the search.

struct Examined {
  std::optional<std::size_t> finalist{};
  std::vector<summary::MoveBehaviour> moves{};
  bool margins_slide{false};  ///< the margins are those of machines that slide too
};

void examine_margins(Work& work, const StudySearch& search, bool slides, Examined& examined,
                     TuneAnswer& answer) {
  work.find_part(answer, "margins", [&] {
    add_margins(search, slides, work.effort.stop(), answer);
    examined.margins_slide = slides;
  });
}

void examine(Work& work, const StudySearch& search, std::size_t finalist, Examined& examined,
             TuneAnswer& answer) {
  if (examined.finalist == finalist) return;
  examined.finalist = finalist;
  examined.moves.clear();
  answer.left_out.clear();  // of another finalist
  const Candidate& candidate = answer.search.finalists[finalist];
  answer.gains = candidate.values;
  if (!answer.blind) examine_margins(work, search, has_slid(candidate.units), examined, answer);
  // As many as a tenth of what the smallest proof leaves is enough for.
  constexpr std::int64_t part = 10;
  const std::int64_t left = affordable_trials(work.effort, work.speed) - min_proof_trials(work.study, 1);
  const std::int64_t count = std::min(units_of_behaviour, left / part / study::condition_count(work.study));
  if (count > 0) {
    work.find_part(answer, "torque at rest", [&] {
      examined.moves =
          simulated_behaviour(search.candidate(candidate.values), search.units(), count, work.effort);
    });
  } else {
    answer.left_out.emplace_back("torque at rest");
  }
  answer.behaviour = examined.moves;
  answer.refusals = refusals_of(answer.behaviour, answer.margins, work.study);
}

// The proof.

/// A candidate on the units of a proof, and the verdict on it.
struct Judged {
  Candidate candidate;
  trials::Replicates units;
  goal::Verdict verdict{};
  GoalCounts counts{};
  int attempts{1};
  std::size_t correction{1};  ///< of the bounds, for the attempts
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

/// Whether theory excludes the goal for all values of the free parameters, which are gains.
bool is_out_of_reach(const study::Study& proven, std::span<const study::FreeParameter> free) {
  const auto is_of_controller = [](const study::FreeParameter& one) {
    return one.name.starts_with("controller.") && one.name != "controller.delay" &&
           one.name != "controller.sample_rate";
  };
  return std::ranges::all_of(free, is_of_controller) && !theory::goals_out_of_reach(proven).empty();
}

/// Completes the answer by a proof, of which `file` is the results file.
/// @param simulated moves of machines of the search, whose torque at rest stands for one that the proof does
/// not measure
void describe_proof(study::Study proven, const reading::AllTrialsFile& file, const Judged& judged,
                    std::span<const summary::MoveBehaviour> simulated, TuneAnswer& answer) {
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
  for (summary::MoveBehaviour& row : answer.behaviour) {
    const auto same = std::ranges::find_if(simulated, [&](const summary::MoveBehaviour& one) {
      return one.number == row.number && one.condition == row.condition;
    });
    if (!row.rest && same != simulated.end()) row.rest = same->rest;
  }
  answer.refusals = refusals_of(answer.behaviour, answer.margins, proven);
  answer.proof = Proof{std::move(proven),
                       verdict,
                       {},
                       judged.attempts,
                       summary::claims_of_point(summary::summarise(file), 0, judged.correction)};
  if (!answer.is_met()) answer.obstacles = theory::doubtful_goals(answer.proof->study);
  if (verdict.status == goal::Status::undecided)
    answer.proof->needs = goal::needs_of(answer.proof->study.goals, judged.counts, judged.correction);
}

/// Limit of the trials of a proof; with a time as budget those of a part of what is left at the speed of the
/// search, because the proof writes a file too.
std::int64_t max_proof_trials(const Work& work) {
  constexpr double part = 0.5;
  const std::int64_t most = std::max<std::int64_t>(max_proof_moves / work.study.moves, 1);
  return std::min(most, affordable_trials(work.effort, part * work.speed));
}

/// @throws Failure (inconclusive) if the time ended before the first attempt
void prove_values(Work& work, StudySearch& search, Examined& examined, TuneAnswer& answer) {
  const SearchResult& found = answer.search;
  const parallel::Recording stage("proof");
  const study::Study& study = work.study;
  const std::int64_t each = trials_of_machine(study);
  ProofRun run;
  ProofProblem problem;
  problem.goals = study.goals;
  const Aim aim = aim_of(study);
  for (const Estimate& one : found.estimates) {
    problem.may_meet.push_back(may_meet(aim, one));
    problem.margins.push_back(one.margin);
  }
  problem.more_units = [&](const GoalCounts& counts, std::size_t correction) {
    return proof_units(study, counts, each, correction, max_proof_trials(work));
  };
  problem.first_units = [&](std::size_t finalist, std::size_t correction) {
    const GoalCounts counts = counts_of(study, search.units(), found.finalists[finalist].units);
    return problem.more_units(with_trials_each(counts, each), correction);
  };
  problem.run = [&](const Attempt& attempt) -> std::optional<GoalCounts> {
    const trials::Replicates units{attempt.units, each};
    work.line.show([&] { return fmt::format("proof {}: {} trials", attempt.number, units.count * each); });
    std::vector<std::string> values = overrides_of(answer.free, found.finalists[attempt.finalist].values);
    values.push_back(fmt::format(
        "seed={}", trials::fresh_seed(study.seed, fmt::format("tuning, proof {}", attempt.number))));
    const bool ended = trials::within(work.effort, [&] {
      run = run_proof(study, std::move(values), units, work.settings.output, work.settings.threads,
                      work.effort);
    });
    if (!ended) return std::nullopt;
    return counts_of(study, units, run.results);
  };
  // The search examined the sliding loop of finalists that slid there.
  problem.rejects = [&](const Attempt& attempt) {
    const Candidate& finalist = found.finalists[attempt.finalist];
    return has_slid(run.results) && !has_slid(finalist.units) &&
           !search.examiner().keeps(search.examined_candidate(finalist.values), study.tuning->margins, true,
                                    work.effort.stop());
  };
  problem.goes_on = [&] { return max_proof_trials(work) >= min_proof_trials(study, max_attempts); };
  const std::optional<ProvenFinalist> proven = prove(problem);
  if (!proven) throw work.out_of_time("ended in the proof");
  const Attempt& attempt = proven->attempt;
  examine(work, search, attempt.finalist, examined, answer);
  const Candidate& candidate = found.finalists[attempt.finalist];
  const bool slid = has_slid(candidate.units) || has_slid(run.results);
  if (answer.margins && slid != examined.margins_slide) examine_margins(work, search, slid, examined, answer);
  answer.missed.all_tried = proven->all_tried;
  describe_proof(std::move(run.study), reading::AllTrialsFile(work.settings.output),
                 {{candidate.place, candidate.values, std::move(run.results)},
                  {attempt.units, each},
                  proven->verdict,
                  proven->counts,
                  attempt.number,
                  correction_of(attempt.number)},
                 examined.moves, answer);
}

/// Shows the proven answer, and makes the extras. @param study whose machines are simulated
void add_extras(Work& work, const study::Study& study, StudySearch& search, TuneAnswer& answer) {
  work.count_effort(answer);
  work.line.clear();
  if (work.settings.proven) work.settings.proven(answer);
  const parallel::Recording stage("extras");
  TunedAxis axis{study, search, work.journal, work.effort, work.speed, work.measured_speed, answer};
  make_extras(work.settings.extras, axis, work.settings.quiet, work.line, [&](const Extra& extra) {
    if (work.settings.ready) work.settings.ready(extra, answer);
  });
}

TuneAnswer tuned(const study::Study& study, const TuneSettings& settings, const std::stop_token& stop) {
  TuningJournal journal = open_journal(study, settings);
  Work work{study, settings, journal, whole_effort(settings, journal.seconds(), stop), no_limit};
  if (settings.budget.seconds) {
    work.speed = journal.speed() ? *journal.speed() : measured_speed(study, work.effort);
    journal.keep_speed(work.speed);
  }
  const SearchPlan plan = plan_search(study, settings.budget, work.effort, work.speed);
  StudySearch search(study, study.tuning->free, plan.size, journal, work.effort);
  TuneAnswer answer = answer_of(work, search);
  tell_default(work, answer);
  find_values(work, search, plan, answer);
  if (answer.search.finalists.empty()) {
    explain_missing(work, search, plan, answer);
  } else {
    Examined examined;
    examine(work, search, 0, examined, answer);
    work.line.clear();
    if (settings.found) settings.found(answer);
    prove_values(work, search, examined, answer);
    add_extras(work, study, search, answer);
  }
  work.count_effort(answer);
  if (!answer.interrupted) journal.remove();
  return answer;
}

/// The values of the file's study, on all its machines.
Judged judged_in(const reading::AllTrialsFile& file, const study::Study& study) {
  const trials::Replicates units = trials::replicates_of(study, 0);
  Judged judged{
      .candidate = {{}, values_in_manifest(study, study.tuning->free), results_in(file, study, units)},
      .units = units};
  judged.counts = counts_of(study, units, judged.candidate.units);
  judged.verdict = goal::judge_goals(study.goals, judged.counts, judged.correction);
  return judged;
}

/// The margins of values on the machines of the study.
void add_margins_in(const study::Study& study, bool slides, const trials::Effort& effort,
                    TuningJournal& journal, TuneAnswer& answer) {
  const StudySearch search(study, study.tuning->free, default_search_size(study), journal, effort);
  answer.blind = search.examiner().is_blind();
  if (!answer.blind) add_margins(search, slides, effort.stop(), answer);
}

TuneAnswer described(const study::Study& study, const TuneSettings& settings, const std::stop_token& stop) {
  TuningJournal journal({}, {}, false);
  const study::Study fresh =
      trials::variant_of(study, {fmt::format("seed={}", trials::fresh_seed(study.seed, "tuning, extras"))});
  Work work{study, settings, journal, whole_effort(settings, 0.0, stop), no_limit};
  if (!settings.budget.trials) work.measured_speed = measured_speed(fresh, work.effort);
  if (settings.budget.seconds) work.speed = work.measured_speed;
  StudySearch search(fresh, study.tuning->free, default_search_size(fresh), journal, work.effort);
  TuneAnswer answer = answer_of(work, search);
  const reading::AllTrialsFile file(settings.output);
  const Judged judged = judged_in(file, study);
  answer.gains = judged.candidate.values;
  work.find_part(answer, "margins", [&] {
    add_margins_in(study, has_slid(judged.candidate.units), work.effort, journal, answer);
  });
  std::vector<summary::MoveBehaviour> simulated;
  work.find_part(answer, "torque at rest", [&] {
    simulated =
        simulated_behaviour(search.candidate(answer.gains), search.units(), units_of_behaviour, work.effort);
  });
  describe_proof(study, file, judged, simulated, answer);
  add_extras(work, fresh, search, answer);
  work.count_effort(answer);
  return answer;
}

}  // namespace

TuneAnswer tune(const study::Study& study, const TuneSettings& settings, const std::stop_token& stop) {
  require_tunable(study);
  try {
    return tuned(study, settings, stop);
  } catch (const trial::Interrupted&) {
    throw Failure(ExitCode::interrupted, interruption_text(settings.output));
  }
}

TuneAnswer describe_tuned(const study::Study& study, const TuneSettings& settings,
                          const std::stop_token& stop) {
  require_tunable(study);
  try {
    return described(study, settings, stop);
  } catch (const trial::Interrupted&) {
    throw Failure(ExitCode::interrupted, "interrupted: nothing was made; give the same command again");
  }
}

TuneAnswer margins_in(const reading::AllTrialsFile& file) {
  const study::Study& study = file.study();
  TuningJournal journal({}, {}, false);
  TuneAnswer answer;
  answer.free = study.tuning->free;
  const Judged judged = judged_in(file, study);
  answer.gains = judged.candidate.values;
  add_margins_in(study, has_slid(judged.candidate.units), {}, journal, answer);
  return answer;
}

}  // namespace zerocount::tuning
