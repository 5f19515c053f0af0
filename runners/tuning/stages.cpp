#include "runners/tuning/stages.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "analysis/trials/summary/chosen_point.hpp"
#include "analysis/trials/summary/study_statistics.hpp"
#include "analysis/trials/theory/plausibility.hpp"
#include "core/failure/failure.hpp"
#include "experiments/parameters/handles.hpp"
#include "runners/tuning/race/proof.hpp"

namespace zerocount::tuning {
namespace {

constexpr std::int64_t max_proof_moves = 2'000'000;
constexpr std::int64_t machines_of_frontier = 512;

/// Maximum number of trials of a proof that the effort is enough for. With a budget of time, half of the
/// search's speed is assumed, because the proof also writes a file.
std::int64_t max_proof_trials(const Space& space) {
  constexpr double part = 0.5;
  const std::int64_t most = std::max<std::int64_t>(max_proof_moves / space.study.moves, 1);
  return std::min(most, affordable_trials(space.effort, part * space.speed));
}

/// Whether all free parameters are controller gains and theory excludes that a goal is met with any values of
/// them.
bool is_out_of_reach(const study::Study& proven) {
  const auto is_of_controller = [](const study::FreeParameter& one) {
    return one.name.starts_with("controller.") && one.name != parameter::controller::delay &&
           one.name != parameter::controller::sample_rate;
  };
  return std::ranges::all_of(proven.tuning->free, is_of_controller) &&
         !theory::goals_out_of_reach(proven).empty();
}

/// The verdict that `zerocount judge` gives on the results file of a proof.
goal::Verdict verdict_in(const std::filesystem::path& path) {
  const summary::StudySummary summary = summary::summarise_file(path);
  return summary::judge_point(summary, summary::choose_point(summary)).verdict;
}

}  // namespace

bool ended(const trials::Effort& effort, const std::function<void()>& work) {
  if (effort.stop().stop_requested()) return false;
  try {
    return trials::within(effort, work);
  } catch (const trial::Interrupted&) {
    return false;
  }
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

Space space_of(const study::Study& study, const TuneBudget& budget, const trials::Effort& effort,
               const std::optional<double>& known_speed) {
  Space space{study, budget, effort};
  if (budget.seconds) space.speed = known_speed ? *known_speed : measured_speed(study, effort);
  return space;
}

Searched search_values(Space& space, StudySearch& search, const SearchPlan& plan,
                       const std::function<void(const SearchProgress&)>& tell) {
  constexpr std::int64_t enough_to_tell = 1000;  // trials
  SearchSettings settings;
  settings.seed = space.study.seed;
  settings.begins_anew = space.has_budget();
  settings.effort = plan.effort;
  settings.tell = tell;
  Searched found{search.run(settings)};
  found.examined = std::ssize(search.examined());
  found.landscape = landscape_of(aim_of(space.study), found.result.tried);
  found.frontier = frontier_of(found.result.tried, std::min(machines_of_frontier, plan.size.max_machines));
  if (search.simulated() >= enough_to_tell)
    space.measured_speed = static_cast<double>(search.simulated()) / search.simulation_seconds();
  if (space.budget.seconds && space.measured_speed > 0.0) space.speed = space.measured_speed;
  return found;
}

Unfound nearest_to_margins(const StudySearch& search) {
  Unfound unfound{search.nearest()};
  if (!unfound.nearest) unfound.refusal = search.refusal_of_all();
  return unfound;
}

void examine_margins(const StudySearch& search, bool slides, const std::stop_token& stop,
                     Examined& examined) {
  const study::Study tuned = search.examined_candidate(examined.values);
  examined.margins = search.examiner().margins_of(tuned, slides, stop);
  examined.lowest_mode = search.examiner().lowest_mode(tuned, slides, stop);
  examined.slides = slides;
}

Proof proof_of(study::Study study, const trials::Replicates& machines, std::span<const MachineResult> results,
               const reading::AllTrialsFile& file) {
  const summary::StudySummary summary = summary::summarise(file);
  summary::JudgedPoint judged = summary::judge_point(summary, summary::choose_point(summary));
  const goal::Verdict& verdict = judged.verdict;
  Proof proof{std::move(study), verdict};
  proof.claims = summary::claims_of_point(summary, 0);
  proof.criterion = estimate_of(aim_of(proof.study), results, machines.count).criterion;
  const std::size_t claim = claim_at(proof.study, {verdict.goal, verdict.setting});
  proof.late_limit = late_value(results, claim, proof.study.goals[verdict.goal].moves) *
                     (is_proportion_of_allowed(proof.study) ? proof.claims[claim].within : 1.0);
  proof.worst = worst_machine(proof.study, machines.point, results);
  proof.moves = summary::behaviour_in(file, proof.study);
  if (verdict.status != goal::Status::met) proof.obstacles = theory::obstacles_to_goals(proof.study);
  proof.needs = std::move(judged.needs);
  return proof;
}

std::optional<Proven> prove_values(const Space& space, StudySearch& search, const SearchResult& found,
                                   const ProofPlace& place, status::StatusLine& line) {
  const study::Study& study = space.study;
  const std::int64_t each = trials_of_machine(study);
  ProofRun run;
  ProofProblem problem;
  const Aim aim = aim_of(study);
  for (const RateEstimate& one : found.estimates) {
    problem.may_meet.push_back(may_meet(aim, one));
    problem.margins.push_back(one.margin);
  }
  problem.more_machines = [&](const GoalCounts& counts, std::size_t correction) {
    return proof_machines(study, counts, each, correction, max_proof_trials(space));
  };
  problem.first_machines = [&](std::size_t finalist, std::size_t correction) {
    const GoalCounts counts = counts_of(study, search.machines(), found.finalists[finalist].machines);
    return problem.more_machines(with_trials_each(counts, each), correction);
  };
  problem.run = [&](const Attempt& attempt) -> std::optional<AttemptResult> {
    const trials::Replicates machines{attempt.machines, each};
    line.show([&] { return fmt::format("proof {}: {} trials", attempt.number, machines.trials()); });
    std::vector<std::string> values = overrides_of(space.free(), found.finalists[attempt.finalist].values);
    values.push_back(fmt::format(
        "seed={}", trials::fresh_seed(study.seed, fmt::format("tuning, proof {}", attempt.number))));
    std::ranges::move(confidences_of_attempt(study, attempt.number), std::back_inserter(values));
    const bool has_run = trials::within(space.effort, [&] {
      run = run_proof(study, std::move(values), machines, place.output, place.threads, space.effort);
    });
    if (!has_run) return std::nullopt;
    return AttemptResult{counts_of(study, machines, run.results), verdict_in(place.output)};
  };
  // The search examined the sliding loop of finalists that slid there.
  problem.rejects = [&](const Attempt& attempt) {
    const Candidate& finalist = found.finalists[attempt.finalist];
    return has_slid(run.results) && !has_slid(finalist.machines) &&
           !search.examiner().keeps(search.examined_candidate(finalist.values), study.tuning->margins, true,
                                    space.effort.stop());
  };
  problem.goes_on = [&] { return max_proof_trials(space) >= min_proof_trials(study, max_attempts); };
  const std::optional<ProvenFinalist> proven = prove(problem);
  if (!proven) return std::nullopt;
  const Attempt& attempt = proven->attempt;
  const trials::Replicates machines{attempt.machines, each};
  const bool slid = has_slid(found.finalists[attempt.finalist].machines) || has_slid(run.results);
  Proof proof = proof_of(std::move(run.study), machines, run.results, reading::AllTrialsFile(place.output));
  proof.attempts = attempt.number;
  proof.keeps_margins = proven->keeps_margins;
  proof.all_tried = proven->all_tried;
  return Proven{attempt.finalist, slid, std::move(proof)};
}

goal::Status status_of(const Proof& proof, const Searched& searched) {
  const bool shows_unreachable =
      searched.landscape.leads() && !searched.result.approaching && proof.all_tried;
  if (!proof.fails()) return proof.verdict.status;
  return shows_unreachable || is_out_of_reach(proof.study) ? goal::Status::missed : goal::Status::undecided;
}

std::vector<std::string> edges_of(const std::vector<study::FreeParameter>& free, const Values& values) {
  constexpr double close = 0.02;
  std::vector<std::string> edges;
  if (values.empty()) return edges;
  const UnitCubePoint place = place_of(free, values);
  for (std::size_t i = 0; i < place.size(); ++i) {
    if (place[i] > close && place[i] < 1.0 - close) continue;
    edges.push_back(fmt::format("{} = {} is at the {} end of its range", free[i].name, values[i],
                                place[i] > 0.5 ? "upper" : "lower"));
  }
  return edges;
}

}  // namespace zerocount::tuning
