#include "analysis/measures/move_counts.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>

#include "experiments/study/study.hpp"

namespace zerocount::measures {

namespace {

bool has_valid_worlds(const MoveCounts& counts) {
  if (counts.worlds == 0) return counts.of_worlds.empty();
  if (std::ssize(counts.of_worlds) != counts.worlds) return false;
  std::int64_t events = 0;
  std::int64_t hits = 0;
  for (const statistics::ClusterSums& world : counts.of_worlds) {
    if (world.events < 0 || world.events > counts.of_trials.events - events) return false;
    events += world.events;
    hits += world.hits;
  }
  return events == counts.of_trials.events && hits == counts.of_trials.hits;
}

study::TrialTurns turns_of(const MoveCounts& counts, std::int64_t rigs) {
  return {std::max<std::int64_t>(rigs, 1), std::max<std::int64_t>(std::ssize(counts.of_conditions), 1)};
}

bool has_valid_conditions(const MoveCounts& counts, std::int64_t moves_of_trial, std::int64_t rigs) {
  std::int64_t moves = 0;
  std::int64_t met = 0;
  for (const MoveCounts& condition : counts.of_conditions) {
    if (condition.moves < 0 || condition.moves > counts.moves - moves ||
        (condition.moves > 0 && !condition.is_valid(condition.moves / moves_of_trial, moves_of_trial, rigs)))
      return false;
    moves += condition.moves;
    met += condition.met;
  }
  return counts.of_conditions.empty() || (moves == counts.moves && met == counts.met);
}

}  // namespace

void MoveCounts::tell_apart(std::int64_t worlds_of_study, std::int64_t conditions) {
  worlds = worlds_of_study;
  of_conditions.resize(static_cast<std::size_t>(conditions));
  for (MoveCounts& condition : of_conditions) condition.worlds = worlds;
}

void MoveCounts::add(std::int64_t trial_index, std::int64_t rig_count, std::int64_t of_trial,
                     std::int64_t meeting) {
  const study::TrialTurns turns = turns_of(*this, rig_count);
  const std::int64_t trial = turns.draw_of(trial_index);
  if (!of_conditions.empty())
    of_conditions[static_cast<std::size_t>(turns.condition_of(trial_index))].add(trial, rig_count, of_trial,
                                                                                 meeting);
  moves += of_trial;
  met += meeting;
  if (rig_count == 0) {
    of_trials.add(meeting, of_trial);
    if (worlds == 0) return;
    of_worlds.resize(static_cast<std::size_t>(worlds));
    of_worlds[static_cast<std::size_t>(trial % worlds)].add(meeting, of_trial);
    return;
  }
  rigs.resize(static_cast<std::size_t>(rig_count));
  statistics::RigMoves& rig = rigs[static_cast<std::size_t>(trial % rig_count)];
  ++rig.trials;
  rig.moves += of_trial;
  rig.met += meeting;
}

void MoveCounts::add_rig(std::size_t rig, std::size_t condition, const statistics::RigMoves& of_rig) {
  if (!of_conditions.empty()) of_conditions[condition].add_rig(rig, 0, of_rig);
  moves += of_rig.moves;
  met += of_rig.met;
  rigs.resize(std::max(rigs.size(), rig + 1));
  rigs[rig].trials += of_rig.trials;
  rigs[rig].moves += of_rig.moves;
  rigs[rig].met += of_rig.met;
}

MoveCounts& MoveCounts::operator+=(const MoveCounts& other) {
  moves += other.moves;
  met += other.met;
  of_trials += other.of_trials;
  worlds = std::max(worlds, other.worlds);
  of_conditions.resize(std::max(of_conditions.size(), other.of_conditions.size()));
  for (std::size_t condition = 0; condition < other.of_conditions.size(); ++condition)
    of_conditions[condition] += other.of_conditions[condition];
  of_worlds.resize(std::max(of_worlds.size(), other.of_worlds.size()));
  for (std::size_t world = 0; world < other.of_worlds.size(); ++world)
    of_worlds[world] += other.of_worlds[world];
  rigs.resize(std::max(rigs.size(), other.rigs.size()));
  for (std::size_t rig = 0; rig < other.rigs.size(); ++rig) {
    rigs[rig].trials += other.rigs[rig].trials;
    rigs[rig].moves += other.rigs[rig].moves;
    rigs[rig].met += other.rigs[rig].met;
  }
  return *this;
}

bool MoveCounts::is_valid(std::int64_t trials, std::int64_t moves_of_trial, std::int64_t rig_count) const {
  if (moves != trials * moves_of_trial || met < 0 || met > moves ||
      !has_valid_conditions(*this, moves_of_trial, rig_count))
    return false;
  if (rig_count == 0) {
    return rigs.empty() && of_trials.events == moves && of_trials.hits == met && has_valid_worlds(*this);
  }
  if (!of_worlds.empty()) return false;
  if (of_trials.clusters != 0 || std::ssize(rigs) != rig_count) return false;
  std::int64_t rig_trials = 0, rig_met = 0;
  for (const statistics::RigMoves& rig : rigs) {
    if (rig.trials < 0 || rig.trials > trials || rig.met < 0 || rig.met > rig.moves ||
        rig.moves != rig.trials * moves_of_trial)
      return false;
    rig_trials += rig.trials;
    rig_met += rig.met;
  }
  return rig_trials == trials && rig_met == met;
}

statistics::ClusterSums clusters_of(const MoveCounts& counts) {
  statistics::ClusterSums sums = counts.of_trials;
  for (const statistics::RigMoves& rig : counts.rigs) sums.add(rig.met, rig.moves);
  return sums;
}

std::vector<MoveCounts> in_worlds(const MoveCounts& counts) {
  std::vector<MoveCounts> worlds(static_cast<std::size_t>(counts.worlds));
  for (std::size_t world = 0; world < counts.of_worlds.size(); ++world) {
    worlds[world].of_trials = counts.of_worlds[world];
    worlds[world].moves = counts.of_worlds[world].events;
    worlds[world].met = counts.of_worlds[world].hits;
  }
  for (std::size_t rig = 0; counts.worlds > 0 && rig < counts.rigs.size(); ++rig) {
    MoveCounts& world = worlds[rig % worlds.size()];
    world.rigs.push_back(counts.rigs[rig]);
    world.moves += counts.rigs[rig].moves;
    world.met += counts.rigs[rig].met;
  }
  return worlds;
}

}  // namespace zerocount::measures
