#include "runners/tuning/proof_runner.hpp"

#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "analysis/goal/goal_verdict.hpp"
#include "analysis/tuning/proof.hpp"
#include "core/failure/failure.hpp"
#include "core/random/random_numbers.hpp"
#include "experiments/designs/random_key.hpp"
#include "results/layout/header.hpp"
#include "results/reading/study_file.hpp"
#include "runners/study_run/file_run.hpp"
#include "runners/tuning/study_search.hpp"
#include "runners/tuning/tuned_study.hpp"

namespace zerocount::tuning {
namespace {

constexpr std::int64_t usual_units = 500;  // at least, where the effort is enough for them

/// The fewest units that can meet the goal.
std::int64_t least_units_of(const study::Study& study, std::int64_t each, std::size_t points) {
  std::int64_t least = std::max<std::int64_t>(study.worlds, 1);
  if (study.rigs == 0) {
    for (const goal::Needs& one :
         goal::smallest_studies(*study.goal, false, study.moves, points, study.worlds))
      least = std::max(least, one.trials);
    return least;
  }
  std::int64_t fewest = 0;
  for (const goal::Needs& one :
       goal::smallest_studies(*study.goal, true, study.moves, points, study.worlds)) {
    if (one.trials <= each * one.rigs && (fewest == 0 || one.rigs < fewest)) fewest = one.rigs;
  }
  return std::max(least, fewest);
}

bool holds_run(const std::filesystem::path& output, const study::Study& study) {
  std::error_code error;
  if (!std::filesystem::exists(output, error)) return false;
  try {
    const reading::ResultsFile file(output);
    return file.header().study_sha256 == study.study_sha256 &&
           layout::same_build(file.header().provenance, layout::current_provenance());
  } catch (const Failure&) {
    return false;  // no results file: it is made anew
  }
}

void make_run(const study::Study& study, const std::filesystem::path& output, int threads,
              const Effort& effort) {
  try {
    study_run::run_to_file(
        {study, output, layout::all_rows(study), threads, true, study_run::ForeignShards::remove, true},
        study_run::ExistingUse::none, effort.stop());
  } catch (const Failure& failure) {
    if (failure.code() != ExitCode::interrupted || effort.is_interrupted()) throw;
    std::error_code error;
    std::filesystem::remove_all(layout::shards_directory(output), error);
    throw Spent{};
  }
}

}  // namespace

std::uint64_t fresh_seed(std::uint64_t seed, std::string_view purpose) {
  constexpr unsigned seed_bits = 52;  // readable as a double everywhere
  return random::random_bits({designs::random_key(seed, purpose), 0}, 0, random::Draw::trial) >>
         (64U - seed_bits);
}

measures::MoveCounts counts_of(const study::Study& study, const Units& units,
                               std::span<const UnitResult> results) {
  measures::MoveCounts counts;
  counts.worlds = study.worlds;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const UnitResult& unit = results[i];
    if (study.rigs == 0) {
      counts.add(static_cast<std::int64_t>(i), 0, unit.moves, unit.met);
      continue;
    }
    counts.moves += unit.moves;
    counts.met += unit.met;
    counts.rigs.push_back({units.trials_each, unit.moves, unit.met});
  }
  return counts;
}

measures::MoveCounts with_trials_each(measures::MoveCounts counts, std::int64_t each) {
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

std::int64_t proof_units(const study::Study& study, const measures::MoveCounts& counts, std::int64_t each,
                         std::size_t points, std::int64_t most_trials) {
  const std::int64_t worlds = std::max<std::int64_t>(study.worlds, 1);
  const std::int64_t most = std::max<std::int64_t>(most_trials / each / worlds, 1) * worlds;
  const std::int64_t least = std::max(usual_units, least_units_of(study, each, points));
  // Half as many more are taken below.
  const goal::Needs needs = goal::needs_of(*study.goal, counts, points, 0.5);
  const std::int64_t wanted = needs.trials == 0 ? most / 8 : (study.rigs > 0 ? needs.rigs : needs.trials);
  return in_equal_worlds(study, std::clamp(wanted + wanted / 2, std::min(least, most), most));
}

std::int64_t least_proof_trials(const study::Study& study, int attempt) {
  const std::int64_t each = trials_of_machine(study);
  return in_equal_worlds(study, least_units_of(study, each, correction_of(attempt))) * each;
}

ProofRun run_proof(const study::Study& study, std::vector<std::string> values, const Units& units,
                   const std::filesystem::path& output, int threads, const Effort& effort) {
  effort.spend(units.count * units.trials_each);
  for (const std::string& one : overrides_for(study, units)) values.push_back(one);
  if (layout::has_sums(study.kept)) values.emplace_back("keep=trials");
  ProofRun run{with_values_in_text(study, values), {}};
  if (!holds_run(output, run.study)) make_run(run.study, output, threads, effort);
  run.results = results_in(reading::StudyFile(output), run.study, units);
  return run;
}

}  // namespace zerocount::tuning
