#include "analysis/basis/statistics/clusters/machine_proportion.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "analysis/basis/statistics/distributions.hpp"
#include "core/numerics/roots.hpp"

namespace zerocount::statistics {
namespace {

/// Rule that places one mark (threshold on a machine's number of moves that meet a requirement). The mark's c
/// is the lowest with ε(c) ≤ `wrong`, or n; its b the highest with 1 − ε(b) ≤ `left_out` (see MachineBound).
struct MarkRule {
  double wrong;
  double weight;
  double left_out{0.0};  ///< Probability with which a machine on q may show fewer than b moves; 0: b = 0.
};

/// The marks of MachineBound as {wrong, weight, left_out}, chosen for sharp bounds in populations of many
/// kinds.
constexpr MarkRule rules[] = {{0.1, 0.35}, {0.35, 0.25}, {0.6, 0.15}, {0.85, 0.15}, {0.35, 0.1, 0.1}};

/// Largest ε (chance of a machine below q to pass) of the highest mark. It is limited so that it takes at
/// most half of the margin between the bound that all machines passing would give and the wanted proportion.
double strictest(const MachineStudy& study, const MachineClaim& claim) {
  const double room = proportion_at_least(study.machines, study.machines, claim.confidence) - claim.wanted;
  return room > 0.0 ? std::min(rules[0].wrong, room / (2.0 * (1.0 - claim.wanted))) : rules[0].wrong;
}

MachineMark mark_of(const MachineStudy& study, double q, const MarkRule& rule) {
  MachineMark mark;
  if (rule.left_out > 0.0) {
    mark.among = numerics::first_where(
                     0, study.moves + 1,
                     [&](std::int64_t met) { return chance_to_show(study, q, met) < 1.0 - rule.left_out; }) -
                 1;
  }
  mark.met = numerics::first_where(
      0, study.moves, [&](std::int64_t met) { return chance_to_show(study, q, met) <= rule.wrong; });
  mark.wrong = chance_to_show(study, q, mark.met) / chance_to_show(study, q, mark.among);
  return mark;
}

std::int64_t passing(std::span<const MachineMoves> machines, std::int64_t met) {
  return std::count_if(machines.begin(), machines.end(),
                       [met](const MachineMoves& machine) { return machine.met >= met; });
}

/// Shortens every machine to `moves` moves for a cautious bound: the moves left out are taken to be moves
/// that met the requirement.
std::vector<MachineMoves> without_further_moves(std::span<const MachineMoves> machines, std::int64_t moves) {
  std::vector<MachineMoves> shortened(machines.begin(), machines.end());
  for (MachineMoves& machine : shortened) machine.met -= machine.moves - moves;
  return shortened;
}

/// The machines with met and missed moves exchanged: `met` counts the moves that miss the requirement.
std::vector<MachineMoves> missing(std::span<const MachineMoves> machines) {
  std::vector<MachineMoves> missed(machines.begin(), machines.end());
  for (MachineMoves& machine : missed) machine.met = machine.moves - machine.met;
  return missed;
}

double low_bound(std::span<const MachineMoves> machines, const MachineClaim& claim) {
  const auto [fewest, most] =
      std::minmax_element(machines.begin(), machines.end(),
                          [](const MachineMoves& a, const MachineMoves& b) { return a.moves < b.moves; });
  const MachineStudy study{std::ssize(machines), fewest->trials, fewest->moves,
                           fewest->moves == most->moves && !claim.of_least};
  const std::vector<MachineMoves> counted = without_further_moves(machines, fewest->moves);
  return MachineBound(study, claim).at_least([&](std::int64_t met) { return passing(counted, met); });
}

}  // namespace

double chance_to_show(const MachineStudy& study, double p, std::int64_t met) {
  if (met <= 0) return 1.0;
  if (study.trials == study.moves) return binomial_upper_tail(study.moves, p, met - 1);
  const double mean = static_cast<double>(met) / static_cast<double>(study.moves);
  if (mean <= p) return 1.0;
  return std::exp(-static_cast<double>(study.trials) * bernoulli_divergence(mean, p));
}

MachineBound::MachineBound(const MachineStudy& study, const MachineClaim& claim)
    : study_(study), claim_(claim) {
  std::vector<Tested> marks;  // with their weights in place of errors
  for (const MarkRule& rule : rules) {
    // Further moves change both numbers of a ratio; moves of one trial have no known ratio.
    if (rule.left_out > 0.0 && !(study.all_alike && study.trials == study.moves)) continue;
    MarkRule one = rule;
    if (&rule == &rules[0]) one.wrong = strictest(study, claim);
    const MachineMark mark = mark_of(study, claim.proportion, one);
    const bool is_idle = mark.wrong >= 1.0 || (rule.left_out > 0.0 && mark.among == 0);
    if (is_idle) continue;
    const auto same = std::ranges::find_if(marks, [&](const Tested& other) {
      return other.mark.met == mark.met && other.mark.among == mark.among;
    });
    if (same == marks.end()) {
      marks.push_back({mark, one.weight});
    } else {
      same->error += one.weight;
    }
  }
  while (!marks.empty()) {
    double weights = 0.0;
    for (const Tested& one : marks) weights += one.error;
    Stage stage{marks, 1.0};
    std::size_t lowest = 0;
    for (std::size_t i = 0; i < marks.size(); ++i) {
      Tested& one = stage.marks[i];
      one.error *= (1.0 - claim.confidence) / weights;
      const double reach = bound(one, study.machines, study.machines);
      if (reach < stage.reach) lowest = i;
      stage.reach = std::min(stage.reach, reach);
    }
    stages_.push_back(std::move(stage));
    marks.erase(marks.begin() + static_cast<std::ptrdiff_t>(lowest));
  }
}

double MachineBound::bound(const Tested& tested, std::int64_t passing, std::int64_t among) const {
  const auto& [mark, error] = tested;
  if (among == 0) return 0.0;
  const bool of_all = mark.among == 0;
  const double confidence = 1.0 - (of_all ? error : 0.5 * error);
  const double in_question = of_all ? 1.0 : proportion_at_least(among, study_.machines, confidence);
  const double pass = proportion_at_least(passing, among, confidence);
  return std::max(0.0, in_question * (pass - mark.wrong) / (1.0 - mark.wrong));
}

double MachineBound::at_least(const std::function<std::int64_t(std::int64_t met)>& passing) const {
  double low = 0.0;
  for (const Stage& stage : stages_) {
    double found = 0.0;
    for (const Tested& one : stage.marks)
      found = std::max(found, bound(one, passing(one.mark.met), passing(one.mark.among)));
    low = std::max(low, found);
    if (found < stage.reach) break;
  }
  return low;
}

std::vector<MachineBound::Enough> MachineBound::enough() const {
  std::vector<Enough> found;
  const Stage* last = nullptr;  // that shows the proportion wanted
  for (const Stage& stage : stages_)
    if (last == nullptr || last->reach < claim_.wanted) last = &stage;
  if (last == nullptr) return found;
  for (const Tested& one : last->marks) {
    if (one.mark.among > 0) continue;
    Enough& enough = found.emplace_back(Enough{one.mark.met, 0});
    for (const Stage& stage : stages_) {
      const auto here = std::ranges::find_if(stage.marks, [&](const Tested& other) {
        return other.mark.met == one.mark.met && other.mark.among == 0;
      });
      const double shown = &stage == last ? claim_.wanted : stage.reach;
      const double pass = shown + (1.0 - shown) * one.mark.wrong;
      enough.machines =
          numerics::first_where(enough.machines, study_.machines + 1, [&](std::int64_t machines) {
            return machines > 0 && binomial_upper_tail(study_.machines, pass, machines - 1) <= here->error;
          });
      if (&stage == last) break;
    }
  }
  return found;
}

MachineClaim of_missing(const MachineClaim& claim) {
  return {1.0 - claim.proportion, 1.0 - claim.wanted, claim.confidence};
}

MachineProportion machine_proportion(std::span<const MachineMoves> machines, const MachineClaim& claim) {
  if (machines.empty() ||
      std::ranges::any_of(machines, [](const MachineMoves& machine) { return machine.moves == 0; }))
    return {};
  const auto meeting = std::count_if(machines.begin(), machines.end(), [&](const MachineMoves& one) {
    return rate(one.met, one.moves) >= claim.proportion;
  });
  const double low = low_bound(machines, claim);
  const double high = 1.0 - low_bound(missing(machines), of_missing(claim));
  return {meeting, low, std::max(low, high)};
}

}  // namespace zerocount::statistics
