#include "runners/tuning/tuner.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/parallel/parallel.hpp"
#include "core/failure/failure.hpp"
#include "core/hash/sha256.hpp"
#include "core/trial/trial.hpp"
#include "results/layout/header.hpp"
#include "results/shards/pieces.hpp"
#include "runners/status/progress.hpp"
#include "runners/tuning/search/tuning_journal.hpp"

namespace zerocount::tuning {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t machines_of_behaviour = 128;  // simulated before the proof, to describe the moves

/// Opens the journal from which an interrupted tuning resumes. Fails if the output or an unfinished run of
/// another study is there already, unless settings.force is set.
/// @throws Failure (bad_input) in this case
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

/// Effort of the whole tuning, from its budget. A little of the time is kept for the start and end of the
/// program and for the page.
/// @param elapsed time that earlier, interrupted runs of the tuning took, s
trials::Effort whole_effort(const TuneSettings& settings, double elapsed, const std::stop_token& stop) {
  const TuneBudget& budget = settings.budget;
  if (!budget.seconds) return trials::Effort(stop).limited_to(budget.trials, {});
  const double page = settings.page ? std::min(0.8, 0.2 * *budget.seconds) : 0.0;
  return trials::Effort(stop).limited_to({}, 0.97 * *budget.seconds - 0.05 - page - elapsed);
}

Failure out_of_time(TuningJournal& journal, const TuneBudget& budget, const std::string& what) {
  journal.remove();
  const double seconds = budget.seconds.value_or(0.0);
  return {ExitCode::inconclusive,
          fmt::format("option '--budget': {:.3g} s are not enough: the time {}; expected about {:.3g} s",
                      seconds, what, 2.0 * seconds)};
}

/// State of a running tuning; its answer grows from stage to stage.
struct Work {
  const TuneSettings& settings;
  TuningJournal& journal;
  Space space;
  StudySearch search;
  TuneAnswer answer{.free = space.free(), .budget = space.budget, .blind = search.examiner().is_blind()};
  status::StatusLine line{settings.quiet, settings.listener};

  /// Runs `work`, which adds an unproven part to the answer. If the effort is not enough, `name` is listed as
  /// left out.
  void find_part(const std::string& name, const std::function<void()>& work) {
    line.show([&] { return name; });
    const bool found = ended(space.effort, work);
    if (space.effort.is_interrupted()) throw trial::Interrupted{};
    if (!found) answer.extras.left_out.push_back({name});
  }

  void count_effort() {
    answer.seconds = journal.elapsed();
    answer.spent_trials = space.effort.spent_trials();
    answer.interrupted = space.effort.is_interrupted();
  }
};

/// If there is no budget, prints how long the search may take on this computer.
void tell_default(Work& work) {
  if (work.space.has_budget() || work.settings.quiet) return;
  status::tell("no --budget: the search takes at most {}, as measured here, then the proof and the extras\n",
               status::duration_text(default_search_seconds(work.space.study, work.space.effort)));
}

void find_values(Work& work, const SearchPlan& plan) {
  const parallel::Recording stage("search");
  work.line.show([] {
    return std::string("first generation: the margins of points over the ranges, then their moves");
  });
  work.answer.searched = search_values(work.space, work.search, plan, [&](const SearchProgress& progress) {
    work.line.show([&] {
      return fmt::format("generation {}: {} points, {} trials; best {:.4g} % at {}", progress.generation,
                         progress.points, progress.trials, 100.0 * progress.estimate.rate,
                         fmt::join(overrides_of(work.space.free(), progress.best->values), ", "));
    });
    if (work.settings.searching) work.settings.searching(progress);
  });
}

/// Explains in the answer a search in which no candidate keeps the stability margins, and sets the status of
/// the answer.
/// @throws Failure (inconclusive) if the search ended too soon to say that there are no such values
void explain_missing(Work& work, const SearchPlan& plan) {
  const Searched& searched = work.answer.searched;
  const bool had_time = searched.result.points == 0 && searched.examined >= plan.size.first_candidates;
  if (work.space.budget.seconds && searched.result.cut && !had_time)
    throw out_of_time(
        work.journal, work.space.budget,
        fmt::format("ended in the search, when the margins of {} points were examined", searched.examined));
  work.answer.status = goal::Status::missed;
  work.find_part("the nearest point", [&] {
    Unfound& unfound = work.answer.unfound = nearest_to_margins(work.search);
    if (unfound.nearest && keeps(unfound.nearest->margins, work.space.study.tuning->margins))
      work.answer.status = goal::Status::undecided;
  });
}

void examine_margins(Work& work, bool slides) {
  if (work.answer.blind) return;
  work.find_part("margins",
                 [&] { examine_margins(work.search, slides, work.space.effort.stop(), work.answer.tuned); });
}

/// Examines the stability margins and moves of a finalist of the search, on machines of the search, and
/// stores them in the answer.
void examine(Work& work, const Candidate& finalist) {
  work.answer.tuned = {finalist.values};
  work.answer.extras.left_out.clear();  // of another finalist
  examine_margins(work, has_slid(finalist.machines));
  // As many as a tenth of what the smallest proof leaves is enough for.
  constexpr std::int64_t part = 10;
  const study::Study& study = work.space.study;
  const std::int64_t remaining =
      affordable_trials(work.space.effort, work.space.speed) - min_proof_trials(study, 1);
  const std::int64_t count = std::min(machines_of_behaviour, remaining / part / study.settings.total());
  work.find_part("torque at rest", [&] {
    if (count <= 0) throw trials::Spent{};
    work.answer.tuned.moves = simulated_behaviour(work.search.candidate(finalist.values),
                                                  work.search.machines(), count, work.space.effort);
  });
}

/// Stores a proof in the answer. If the proof did not measure the torque at rest, the value from the machines
/// of the search is kept.
void take_proof(Proof proof, TuneAnswer& answer) {
  for (summary::MoveBehaviour& row : proof.moves) {
    const auto same = std::ranges::find_if(answer.tuned.moves, [&](const summary::MoveBehaviour& one) {
      return one.number == row.number && one.setting == row.setting;
    });
    if (!row.rest && same != answer.tuned.moves.end()) row.rest = same->rest;
  }
  answer.status = status_of(proof, answer.searched);
  answer.proof = std::move(proof);
}

/// Tests on new machines whether the best finalists meet the goals. The last completed attempt becomes the
/// proof of the answer.
/// @throws Failure (inconclusive) if the time ended before the first attempt was complete
void prove(Work& work) {
  const parallel::Recording stage("proof");
  const SearchResult& found = work.answer.searched.result;
  std::optional<Proven> proven =
      prove_values(work.space, work.search, found, {work.settings.output, work.settings.threads}, work.line);
  if (!proven) throw out_of_time(work.journal, work.space.budget, "ended in the proof");
  if (proven->finalist != 0) examine(work, found.finalists[proven->finalist]);
  if (work.answer.tuned.margins && proven->slid != work.answer.tuned.slides)
    examine_margins(work, proven->slid);
  take_proof(std::move(proven->proof), work.answer);
}

/// Calls settings.proven with the proven answer, then computes the wanted extras.
void add_extras(Work& work) {
  TuneAnswer& answer = work.answer;
  work.count_effort();
  work.line.clear();
  if (work.settings.proven) work.settings.proven(answer);
  const parallel::Recording stage("extras");
  TunedAxis axis{work.space,    work.search,     work.journal,  answer.tuned.values,
                 *answer.proof, answer.is_met(), answer.extras, answer.searched.result};
  make_extras(work.settings.extras, axis, work.settings.quiet, work.line, [&](const Extra& extra) {
    if (work.settings.ready) work.settings.ready(extra, answer);
  });
}

TuneAnswer tuned(const study::Study& study, const TuneSettings& settings, const std::stop_token& stop) {
  TuningJournal journal = open_journal(study, settings);
  const Space space =
      space_of(study, settings.budget, whole_effort(settings, journal.seconds(), stop), journal.speed());
  const SearchPlan plan = plan_search(study, settings.budget, space.effort, space.speed);
  if (settings.budget.seconds) journal.keep_speed(space.speed);  // a refused budget leaves no file
  Work work{settings, journal, space, {study, space.free(), plan.size, journal, space.effort}};
  tell_default(work);
  find_values(work, plan);
  const std::vector<Candidate>& finalists = work.answer.searched.result.finalists;
  if (finalists.empty()) {
    explain_missing(work, plan);
  } else {
    examine(work, finalists.front());
    work.line.clear();
    if (settings.found) settings.found(work.answer);
    prove(work);
    add_extras(work);
  }
  work.count_effort();
  if (!work.answer.interrupted) journal.remove();
  return std::move(work.answer);
}

/// Computes the stability margins of the answer's values on the machines of `study`, and stores them in the
/// answer.
/// @param slides whether machines slide with these values
void add_margins_in(const study::Study& study, bool slides, const trials::Effort& effort,
                    TuningJournal& journal, TuneAnswer& answer) {
  const StudySearch search(study, answer.free, default_search_size(study), journal, effort);
  answer.blind = search.examiner().is_blind();
  if (!answer.blind) examine_margins(search, slides, effort.stop(), answer.tuned);
}

TuneAnswer described(const study::Study& study, const TuneSettings& settings, const std::stop_token& stop) {
  TuningJournal journal({}, {}, false);
  const trials::Effort effort = whole_effort(settings, 0.0, stop);
  const study::Study fresh =
      trials::variant_of(study, {fmt::format("seed={}", trials::fresh_seed(study.seed, "tuning, extras"))});
  Space space{fresh, settings.budget, effort};
  if (!settings.budget.trials) space.measured_speed = measured_speed(fresh, effort);
  if (settings.budget.seconds) space.speed = space.measured_speed;
  Work work{settings, journal, space, {fresh, space.free(), default_search_size(fresh), journal, effort}};
  const reading::AllTrialsFile file(settings.output);
  const trials::Replicates machines = trials::replicates_of(study, 0);
  const std::vector<MachineResult> results = results_in(file, study, machines);
  work.answer.tuned.values = values_in_manifest(study, space.free());
  work.find_part("margins", [&] { add_margins_in(study, has_slid(results), effort, journal, work.answer); });
  work.find_part("torque at rest", [&] {
    work.answer.tuned.moves = simulated_behaviour(work.search.candidate(work.answer.tuned.values),
                                                  work.search.machines(), machines_of_behaviour, effort);
  });
  take_proof(proof_of(study, machines, results, file), work.answer);
  add_extras(work);
  work.count_effort();
  return std::move(work.answer);
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
  TuneAnswer answer{.free = study.tuning->free};
  answer.tuned.values = values_in_manifest(study, answer.free);
  add_margins_in(study, has_slid(results_in(file, study, trials::replicates_of(study, 0))), {}, journal,
                 answer);
  return answer;
}

}  // namespace zerocount::tuning
