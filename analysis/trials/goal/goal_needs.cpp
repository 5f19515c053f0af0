#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "analysis/basis/statistics/clusters/clustered_proportion.hpp"
#include "analysis/basis/statistics/clusters/machine_proportion.hpp"
#include "analysis/basis/statistics/distributions.hpp"
#include "analysis/basis/statistics/proportion.hpp"
#include "analysis/trials/goal/goal_verdict.hpp"
#include "core/numerics/roots.hpp"

namespace zerocount::goal {
namespace {

using numerics::first_where;

constexpr std::int64_t max_trials = 1'000'000'000;
constexpr std::int64_t max_machines = 100'000;

std::int64_t scaled(std::int64_t number, double factor) {
  return std::llround(static_cast<double>(number) * factor);
}

/// The expected counts of a study without machines that has `factor` times as many trials, with the
/// proportions of the observed counts.
measures::MoveCounts larger_study(const measures::MoveCounts& counts, double factor) {
  measures::MoveCounts larger;
  larger.moves = scaled(counts.moves, factor);
  larger.met = scaled(counts.met, factor);
  const statistics::ClusterSums& sums = counts.of_trials;
  larger.of_trials = {.clusters = scaled(sums.clusters, factor),
                      .hits = larger.met,
                      .events = larger.moves,
                      .hits_squared = sums.hits_squared * factor,
                      .hits_by_events = sums.hits_by_events * factor,
                      .events_squared = sums.events_squared * factor};
  return larger;
}

/// The expected counts of a study on `machines` machines that resemble the observed ones: machine i equals
/// the quantile (i + ½)/machines of the observed machines.
/// @param sorted observed machines by rising number of moves that meet the goal
measures::MoveCounts machines_like(std::vector<statistics::MachineMoves> sorted, std::int64_t machines) {
  measures::MoveCounts counts;
  for (std::int64_t i = 0; i < machines; ++i) {
    const double place = (static_cast<double>(i) + 0.5) / static_cast<double>(machines);
    const auto index = static_cast<std::size_t>(place * static_cast<double>(sorted.size()));
    const statistics::MachineMoves& machine = sorted[std::min(index, sorted.size() - 1)];
    counts.machines.push_back(machine);
    counts.moves += machine.moves;
    counts.met += machine.met;
  }
  return counts;
}

/// The smallest integer from `low` to `high` for which `decides` is true; 0 if there is none. `decides` is
/// assumed to stay true for all larger numbers.
template <class Decides>
std::int64_t smallest(std::int64_t low, std::int64_t high, const Decides& decides) {
  const std::int64_t found = numerics::first_where_by_doubling(low, high + 1, decides);
  return found <= high ? found : 0;
}

/// Largest value of PlannedSize::more_on_each_machine that is tried.
constexpr std::int64_t max_more_trials = 1024;

/// Size of a planned study: of one world (a draw of what all machines share), or of the whole study if it has
/// no worlds.
struct PlannedSize {
  std::int64_t units{0};  ///< Number of machines; in a study without machines, number of trials.
  /// Number of trials on each machine, as a multiple of the observed number.
  std::int64_t more_on_each_machine{1};
};

/// Probabilities with which a planned study will have the verdicts met and missed.
struct Chances {
  double met{0.0};
  double missed{0.0};
};

/// The probabilities that a planned study gives each verdict in one world (a draw of what all machines
/// share), given the moves observed in this world.
///
/// Goal on moves: the true proportion π is unknown. Given k hits in n independent events it has the posterior
/// distribution Beta(k + ½, n − k + ½) of Jeffreys' prior, and the probabilities are averaged over it
/// (assurance; O'Hagan, Stevens and Campbell, Pharmaceutical Statistics 4 (2005) 187). n is the effective
/// number of independent moves in the observed clusters. Without a miss, or without a hit, the observation
/// does not show how clusters differ, so each move counts as one event; the bounds of the planned study still
/// depend on its number of clusters. If a machine of m moves is worth e1 independent events, a machine of c·m
/// moves is worth 1/(1/e1 − 1/m + 1/(c·m)).
///
/// Goal on machines: the planned machines resemble the observed ones, and each meets the goal in its moves as
/// often as observed. A distribution of π is not used here: the bounds of machine_proportion.hpp leave a
/// range of proportions open that no study decides, so the probability of a decision would stay limited.
class ObservedWorld {
 public:
  /// Prepares the probabilities for a goal in one world.
  /// @param counts observed counts in this world, with at least one move
  /// @param points, parts as for judge_goal()
  ObservedWorld(const study::Goal& goal, measures::MoveCounts counts, std::size_t points, std::size_t parts)
      : goal_(goal),
        counts_(std::move(counts)),
        points_(points),
        parts_(parts),
        confidence_low_(statistics::confidence_of_each(goal.confidence, points)),
        confidence_high_(statistics::confidence_of_each(goal.confidence, points * parts)),
        sums_(measures::clusters_of(counts_)) {
    if (goal_.machines) {
      for (const statistics::MachineMoves& machine : counts_.machines) ++machines_[machine.met];
      return;
    }
    worth_ = sums_.hits > 0 && sums_.hits < sums_.events ? statistics::effective_events(sums_)
                                                         : static_cast<double>(sums_.events);
    const double hits = statistics::rate(sums_.hits, sums_.events) * worth_;
    for (std::size_t i = 0; i < likely_.size(); ++i)
      likely_[i] = statistics::lower_bound_on_p(
          hits + 0.5, worth_, (static_cast<double>(i) + 0.5) / static_cast<double>(likely_.size()));
  }

  Chances chances_of(const PlannedSize& planned) {
    return goal_.machines ? of_machines(planned) : of_moves(planned);
  }

 private:
  double chance_of_at_least(std::int64_t events, std::int64_t hits) const {
    if (hits > events) return 0.0;
    if (hits <= 0) return 1.0;
    double sum = 0.0;
    for (const double p : likely_) sum += statistics::binomial_upper_tail(events, p, hits - 1);
    return sum / static_cast<double>(likely_.size());
  }

  /// Effective number of independent moves in all clusters of the planned study.
  double planned_events(const PlannedSize& planned) const {
    const auto clusters = static_cast<double>(sums_.clusters);
    const double moves = static_cast<double>(sums_.events) / clusters;
    const double worth = std::min(moves, worth_ / clusters);
    const double between = 1.0 / worth - 1.0 / moves;
    const double events = static_cast<double>(planned.units) /
                          (between + 1.0 / (moves * static_cast<double>(planned.more_on_each_machine)));
    if (sums_.clusters == sums_.events) return events;
    // The bounds use Student's distribution, because the differences between clusters are estimated.
    const double t =
        statistics::student_t_quantile(static_cast<double>(planned.units - 1), confidence_high_) /
        statistics::student_t_quantile(std::max(1.0, events - 1.0), confidence_high_);
    return std::max(1.0, events / (t * t));
  }

  /// Probabilities of the verdicts for a goal on a proportion of moves. The clusters of dependent moves are
  /// replaced by their effective number of single events; what these can show is limited by the number of
  /// clusters.
  Chances of_moves(const PlannedSize& planned) const {
    const auto n = static_cast<std::int64_t>(planned_events(planned));
    const auto verdict = [&](std::int64_t hits) {
      const auto k = static_cast<double>(hits);
      const measures::MoveCounts counts{
          .moves = n, .met = hits, .of_trials = {n, hits, n, k, k, static_cast<double>(n)}, .machines = {}};
      return judge_goal(goal_, counts, points_, parts_);
    };
    const auto clusters = static_cast<double>(planned.units);
    const auto is_met = [&](std::int64_t hits) {
      const double shown =
          statistics::most_shown_by_clusters(clusters, statistics::rate(hits, n), confidence_low_);
      return shown >= goal_.moves && verdict(hits).status == Status::met;
    };
    const auto is_missed = [&](std::int64_t hits) {
      const double shown =
          statistics::most_shown_by_clusters(clusters, statistics::rate(n - hits, n), confidence_high_);
      return 1.0 - shown < goal_.moves && verdict(hits).status == Status::missed;
    };
    const std::int64_t met = first_where(0, n + 1, is_met);
    const std::int64_t not_missed =
        first_where(0, n + 1, [&](std::int64_t hits) { return !is_missed(hits); });
    return {chance_of_at_least(n, met), 1.0 - chance_of_at_least(n, not_missed)};
  }

  /// Expected number, among the observed machines, of those that would have at least `met` moves in the goal.
  /// @param more number of trials on a machine, as a multiple of the observed number
  double machines_passing(std::int64_t met, std::int64_t more) {
    const auto [at, is_new] = passing_.try_emplace({met, more}, 0.0);
    if (!is_new) return at->second;
    const std::int64_t moves = counts_.machines.front().moves;
    for (const auto& [observed, machines] : machines_) {
      const double chance = met <= 0 ? 1.0
                                     : statistics::binomial_upper_tail(
                                           moves * more, statistics::rate(observed, moves), met - 1);
      at->second += static_cast<double>(machines) * chance;
    }
    return at->second;
  }

  /// Probabilities of the verdicts for a goal on a proportion of machines. A verdict can be reached in
  /// several ways (MachineBound::enough()); its probability is at least that of the likeliest way, which is
  /// returned.
  Chances of_machines(const PlannedSize& planned) {
    const statistics::MachineMoves& machine = counts_.machines.front();
    const statistics::MachineStudy study{planned.units, machine.trials * planned.more_on_each_machine,
                                         machine.moves * planned.more_on_each_machine};
    const auto observed = static_cast<double>(counts_.machines.size());
    const auto chance = [&](const statistics::MachineBound::Enough& enough, double passing) {
      if (enough.machines > study.machines) return 0.0;
      return statistics::binomial_upper_tail(study.machines, std::clamp(passing / observed, 0.0, 1.0),
                                             enough.machines - 1);
    };
    Chances chances;
    const statistics::MachineClaim met{goal_.moves, *goal_.machines, confidence_low_};
    for (const auto& enough : statistics::MachineBound(study, met).enough())
      chances.met =
          std::max(chances.met, chance(enough, machines_passing(enough.met, planned.more_on_each_machine)));
    const statistics::MachineClaim missed =
        statistics::of_missing({goal_.moves, *goal_.machines, confidence_high_});
    for (const auto& enough : statistics::MachineBound(study, missed).enough()) {
      const std::int64_t at_most = study.moves - enough.met;
      const double missing = observed - machines_passing(at_most + 1, planned.more_on_each_machine);
      chances.missed = std::max(chances.missed, chance(enough, missing));
    }
    return chances;
  }

  study::Goal goal_;
  measures::MoveCounts counts_;
  std::size_t points_;
  std::size_t parts_;
  /// Confidences of the lower bounds (met) and of the upper bounds (missed).
  double confidence_low_, confidence_high_;
  statistics::ClusterSums sums_;
  double worth_{0.0};  ///< Effective number of independent moves among the observed ones.
  /// Equally probable values of the true proportion π of moves that meet the goal.
  std::array<double, 100> likely_{};
  /// {number of moves in the goal: number of observed machines with just as many}
  std::map<std::int64_t, std::int64_t> machines_{};
  /// Results of machines_passing() that were already computed, by its arguments.
  std::map<std::pair<std::int64_t, std::int64_t>, double> passing_{};
};

/// One claim: a goal in one setting, which must be met in all worlds. Worlds with the same observation have
/// the same probabilities, which are computed once.
class ObservedClaim {
 public:
  /// Prepares the probabilities for a goal in one setting.
  /// @param worlds [world] observed counts
  /// @param points number of design points among which the point was chosen
  /// @param claims number of claims of the study
  ObservedClaim(const study::Goal& goal, const std::vector<measures::MoveCounts>& worlds, std::size_t points,
                std::size_t claims) {
    std::map<std::array<double, 3>, std::size_t> known;  // of worlds without machines
    for (const measures::MoveCounts& world : worlds) {
      const std::array<double, 3> key{static_cast<double>(world.met), static_cast<double>(world.moves),
                                      world.of_trials.hits_squared};
      const auto [at, is_new] = known.try_emplace(key, different_.size());
      if (!is_new && world.machines.empty()) {
        ++different_[at->second].second;
      } else {
        different_.emplace_back(ObservedWorld(goal, world, points, claims * worlds.size()), 1);
      }
    }
  }

  /// Probability that a planned study meets the claim in all worlds, and probability that it misses the claim
  /// in at least one. Worlds are independent.
  Chances chances_of(const PlannedSize& planned) {
    double all_met = 1.0;
    double none_missed = 1.0;
    for (auto& [world, alike] : different_) {
      const Chances chances = world.chances_of(planned);
      all_met *= std::pow(chances.met, static_cast<double>(alike));
      none_missed *= std::pow(1.0 - chances.missed, static_cast<double>(alike));
    }
    return {all_met, 1.0 - none_missed};
  }

 private:
  /// Worlds with different observations, each with the number of worlds that have it.
  std::vector<std::pair<ObservedWorld, std::int64_t>> different_{};
};

/// All claims of the observed study: each goal in each setting. Their probabilities are evaluated one by one;
/// nothing is assumed about their dependence.
class ObservedStudy {
 public:
  ObservedStudy(std::span<const study::Goal> goals, std::span<const measures::CellCounts> counts,
                std::size_t points) {
    settings_ = static_cast<std::int64_t>(counts.front().settings());
    for (std::size_t i = 0; i < goals.size(); ++i) {
      for (std::size_t c = 0; c < static_cast<std::size_t>(settings_); ++c) {
        const std::vector<measures::MoveCounts> worlds = counts[i].worlds_in(c);
        has_moves_ = has_moves_ && std::ranges::all_of(worlds, [](const auto& of) { return of.moves > 0; });
        if (!has_moves_) return;
        worlds_ = std::ssize(worlds);
        if (!worlds.front().machines.empty()) trials_of_machine_ = worlds.front().machines.front().trials;
        claims_.emplace_back(goals[i], worlds, points, goals.size() * static_cast<std::size_t>(settings_));
      }
    }
  }

  bool has_moves() const { return has_moves_; }
  std::int64_t worlds() const { return worlds_; }
  std::int64_t settings() const { return settings_; }
  /// Number of observed trials of one machine in one setting; 0 without machines.
  std::int64_t trials_of_machine() const { return trials_of_machine_; }

  /// Lower bound of the probability that a study whose worlds have this size is decided. It is decided if no
  /// claim is undecided, or if one is missed. The bound holds for any dependence between the claims.
  double chance_of_decision(const PlannedSize& planned) {
    double undecided = 0.0;
    double missed = 0.0;
    for (ObservedClaim& claim : claims_) {
      const Chances chances = claim.chances_of(planned);
      undecided += 1.0 - chances.met - chances.missed;
      missed = std::max(missed, chances.missed);
    }
    return std::max(1.0 - undecided, missed);
  }

 private:
  std::vector<ObservedClaim> claims_{};
  std::int64_t worlds_{1}, settings_{1}, trials_of_machine_{0};
  bool has_moves_{true};
};

/// The smallest number of machines (in a study without machines: of trials) with which a study shows that the
/// goal is met if no move misses it; 0 if there is none.
/// @param trials number of trials on each machine; 0: no trials share a machine
/// @param points number of design points among which the best is chosen
std::int64_t smallest_without_miss(const AskedGoal& asked, std::int64_t trials, std::size_t points) {
  const auto met = [&](const measures::MoveCounts& counts) {
    return judge_goal(asked.goal, counts, points).status == Status::met;
  };
  const std::int64_t moves = asked.moves;
  if (trials > 0) {
    const std::vector<statistics::MachineMoves> machine{{trials, trials * moves, trials * moves}};
    return smallest(2, max_machines, [&](std::int64_t n) { return met(machines_like(machine, n)); });
  }
  const statistics::ClusterSums of_one = {.clusters = 1,
                                          .hits = moves,
                                          .events = moves,
                                          .hits_squared = static_cast<double>(moves * moves),
                                          .hits_by_events = static_cast<double>(moves * moves),
                                          .events_squared = static_cast<double>(moves * moves)};
  const measures::MoveCounts trial{moves, moves, of_one, {}};
  return smallest(2, max_trials,
                  [&](std::int64_t n) { return met(larger_study(trial, static_cast<double>(n))); });
}

}  // namespace

std::vector<Needs> deciding_studies(std::span<const study::Goal> goals,
                                    std::span<const measures::CellCounts> counts, std::size_t points,
                                    double probability) {
  ObservedStudy observed(goals, counts, points);
  if (!observed.has_moves()) return {};
  const std::int64_t worlds = observed.worlds();
  const auto smallest_with = [&](std::int64_t most, std::int64_t more) {
    return smallest(2, most, [&](std::int64_t units) {
      return observed.chance_of_decision({units, more}) >= probability;
    });
  };
  std::vector<Needs> studies;
  if (observed.trials_of_machine() == 0) {
    const std::int64_t trials = worlds * observed.settings() * smallest_with(max_trials / worlds, 1);
    if (trials > 0) studies.push_back({0, trials});
    return studies;
  }
  // More trials on each machine are needed where those observed cannot tell machines that meet the goal from
  // others.
  const bool has_machines =
      std::ranges::any_of(goals, [](const study::Goal& goal) { return goal.machines.has_value(); });
  for (std::int64_t more = 1; more <= max_more_trials; more *= 2) {
    const std::int64_t each = more * observed.trials_of_machine() * observed.settings();
    const std::int64_t most = studies.empty() ? max_machines : studies.back().machines / worlds - 1;
    const std::int64_t machines = smallest_with(std::min(most, max_trials / each / worlds), more);
    if (machines > 0) studies.push_back({machines * worlds, machines * each * worlds});
    if (!studies.empty() && (!has_machines || machines == 0)) break;
  }
  return studies;
}

Needs needs_of(std::span<const study::Goal> goals, std::span<const measures::CellCounts> counts,
               std::size_t points, double probability) {
  const std::vector<Needs> studies = deciding_studies(goals, counts, points, probability);
  return studies.empty() ? Needs{} : cheapest(studies);
}

const Needs& cheapest(std::span<const Needs> studies) {
  return *std::ranges::min_element(studies, {}, &Needs::trials);
}

std::vector<Needs> smallest_studies(std::span<const AskedGoal> goals, const StudyShape& shape,
                                    std::size_t points) {
  const std::int64_t worlds = std::max<std::int64_t>(shape.worlds, 1);
  std::vector<Needs> studies;
  const std::vector<std::int64_t> on_each =
      shape.on_machines ? std::vector<std::int64_t>{1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000}
                        : std::vector<std::int64_t>{0};
  for (const std::int64_t trials : on_each) {
    std::int64_t units = 0;
    bool can_be_met = true;
    for (const AskedGoal& asked : goals) {
      const std::int64_t needed = smallest_without_miss(asked, trials, points);
      can_be_met = can_be_met && needed > 0;
      units = std::max(units, needed);
    }
    if (!can_be_met) continue;
    units *= worlds;
    if (!shape.on_machines) {
      studies.push_back({0, units * shape.settings});
    } else if (studies.empty() || units < studies.back().machines) {
      studies.push_back({units, units * trials * shape.settings});
    }
  }
  return studies;
}

}  // namespace zerocount::goal
