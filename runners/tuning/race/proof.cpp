#include "runners/tuning/race/proof.hpp"

#include <utility>

namespace zerocount::tuning {
namespace {

/// Index of the finalist with the largest margin among those that may meet the goals and were not tried;
/// nothing if there is none.
/// @param tried [finalist] whether an attempt has run it
std::optional<std::size_t> surest(const ProofProblem& problem, const std::vector<bool>& tried) {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < problem.may_meet.size(); ++i) {
    if (!problem.may_meet[i] || tried[i]) continue;
    if (!found || problem.margins[i] > problem.margins[*found]) found = i;
  }
  return found;
}

/// The attempt that should follow the attempt `last`: the same finalist on more machines, or another
/// finalist. Nothing if no further attempt is worth making.
/// @param tried [finalist] whether an attempt has run it
std::optional<Attempt> next_attempt(const ProofProblem& problem, const std::vector<bool>& tried,
                                    const ProvenFinalist& last) {
  const Attempt& before = last.attempt;
  const std::size_t correction = correction_of(before.number + 1);
  switch (last.keeps_margins ? last.verdict.status : goal::Status::missed) {
    case goal::Status::met:
      return std::nullopt;
    case goal::Status::undecided: {
      const std::int64_t machines = problem.more_machines(last.counts, correction);
      if (machines <= before.machines) return std::nullopt;
      return Attempt{before.number + 1, before.finalist, machines};
    }
    case goal::Status::missed:
      break;
  }
  const std::optional<std::size_t> finalist = surest(problem, tried);
  if (!finalist) return std::nullopt;
  return Attempt{before.number + 1, *finalist, problem.first_machines(*finalist, correction)};
}

}  // namespace

std::size_t correction_of(int attempt) {
  return attempt == 1 ? 2 : 4;
}

std::optional<ProvenFinalist> prove(const ProofProblem& problem) {
  std::optional<ProvenFinalist> proven;
  std::vector<bool> tried(problem.may_meet.size(), false);
  std::optional<Attempt> attempt = Attempt{1, 0, problem.first_machines(0, correction_of(1))};
  while (attempt) {
    std::optional<AttemptResult> result = problem.run(*attempt);
    if (!result) break;
    tried[attempt->finalist] = true;
    proven = ProvenFinalist{std::move(*result), *attempt, !problem.rejects(*attempt)};
    if (attempt->number == max_attempts || !problem.goes_on()) break;
    attempt = next_attempt(problem, tried, *proven);
  }
  if (proven) proven->all_tried = !surest(problem, tried);
  return proven;
}

}  // namespace zerocount::tuning
