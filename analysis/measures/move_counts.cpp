#include "analysis/measures/move_counts.hpp"

#include <iterator>

namespace zerocount::measures {
namespace {

bool is_possible(const statistics::MachineMoves& machine, std::int64_t most) {
  return machine.trials >= 0 && machine.trials <= most && machine.met >= 0 && machine.met <= machine.moves &&
         machine.moves <= most;
}

}  // namespace

statistics::ClusterSums clusters_of(const MoveCounts& counts) {
  statistics::ClusterSums sums = counts.of_trials;
  for (const statistics::MachineMoves& machine : counts.machines) sums.add(machine.met, machine.moves);
  return sums;
}

std::int64_t CellCounts::cells_of_condition() const {
  return shape_.machines > 0 ? shape_.machines : static_cast<std::int64_t>(worlds());
}

/// Index of a cell. @param within index of the machine; without machines, of the world
std::int64_t CellCounts::cell_of(std::size_t condition, std::size_t within) const {
  return static_cast<std::int64_t>(condition) * cells_of_condition() + static_cast<std::int64_t>(within);
}

void CellCounts::add(std::int64_t trial, std::int64_t moves, std::int64_t met) {
  const study::TrialIndices indices{std::max<std::int64_t>(shape_.machines, 1),
                                    static_cast<std::int64_t>(conditions())};
  const auto condition = static_cast<std::size_t>(indices.condition_of(trial));
  const auto within = static_cast<std::size_t>(indices.draw_of(trial) % cells_of_condition());
  if (shape_.machines > 0) {
    add_machine(within, condition, {1, moves, met});
  } else {
    trials_.sum_of(cell_of(condition, within)).add(met, moves);
  }
}

void CellCounts::add_machine(std::size_t machine, std::size_t condition,
                             const statistics::MachineMoves& moves) {
  machines_.add(cell_of(condition, machine), moves);
}

void CellCounts::add_trials(std::size_t world, std::size_t condition, const statistics::ClusterSums& moves) {
  trials_.add(cell_of(condition, world), moves);
}

CellCounts& CellCounts::operator+=(const CellCounts& other) {
  trials_ += other.trials_;
  machines_ += other.machines_;
  return *this;
}

MoveCounts CellCounts::sum(const Cells& cells) const {
  MoveCounts sum;
  const std::size_t first = cells.condition.value_or(0);
  const std::size_t end = cells.condition ? first + 1 : conditions();
  // Machines of which nothing was counted under these conditions are none.
  if (shape_.machines > 0 && (machines_.end() <= cell_of(first, 0) || machines_.first() >= cell_of(end, 0)))
    return sum;
  const std::size_t step = cells.world ? worlds() : 1;
  for (std::size_t i = cells.world.value_or(0); i < static_cast<std::size_t>(cells_of_condition());
       i += step) {
    statistics::MachineMoves of_machine;
    for (std::size_t condition = first; condition < end; ++condition) {
      sum.of_trials += trials_[cell_of(condition, i)];
      of_machine += machines_[cell_of(condition, i)];
    }
    if (shape_.machines > 0) sum.machines.push_back(of_machine);
    sum.moves += of_machine.moves;
    sum.met += of_machine.met;
  }
  sum.moves += sum.of_trials.events;
  sum.met += sum.of_trials.hits;
  return sum;
}

std::vector<MoveCounts> CellCounts::by_world(Condition condition) const {
  std::vector<MoveCounts> each;
  for (std::size_t world = 0; shape_.worlds > 0 && world < worlds(); ++world)
    each.push_back(sum({condition, world}));
  return each;
}

std::vector<MoveCounts> CellCounts::by_condition() const {
  std::vector<MoveCounts> each;
  for (std::size_t condition = 0; shape_.conditions > 0 && condition < conditions(); ++condition)
    each.push_back(sum({condition, std::nullopt}));
  return each;
}

std::vector<MoveCounts> CellCounts::worlds_under(std::size_t condition) const {
  return shape_.worlds > 0 ? by_world(condition) : std::vector{sum({condition, std::nullopt})};
}

CellCounts CellCounts::under(std::size_t condition) const {
  CellCounts counts({shape_.machines, shape_.worlds, 0});
  for (std::int64_t i = 0; i < cells_of_condition(); ++i) {
    const std::int64_t cell = cell_of(condition, 0) + i;
    if (shape_.machines > 0) {
      counts.machines_.add(i, machines_[cell]);
    } else {
      counts.trials_.add(i, trials_[cell]);
    }
  }
  return counts;
}

bool CellCounts::is_valid(std::int64_t trials, std::int64_t moves_of_trial) const {
  return sum().moves == trials * moves_of_trial &&
         std::ranges::all_of(machines_.sums(), [moves_of_trial](const statistics::MachineMoves& machine) {
           return machine.moves % moves_of_trial == 0 && machine.moves / moves_of_trial == machine.trials;
         });
}

/// [world] the sums in the form of files: empty with machines, and if nothing was counted.
std::vector<statistics::ClusterSums> CellCounts::sums_of_worlds(Condition condition) const {
  std::vector<statistics::ClusterSums> sums;
  for (const MoveCounts& world : by_world(condition)) sums.push_back(world.of_trials);
  const auto is_empty = [](const statistics::ClusterSums& one) { return one.clusters == 0; };
  if (shape_.machines > 0 || std::ranges::all_of(sums, is_empty)) sums.clear();
  return sums;
}

/// Whether the part that was read is possible. The limits ensure that sums of cells do not overflow.
bool CellCounts::can_be(const Part& part) const {
  constexpr std::int64_t most_moves = std::int64_t{1} << 53;
  const std::int64_t most = most_moves / cells_of_condition() / static_cast<std::int64_t>(conditions());
  if (std::ranges::any_of(part.counts.machines,
                          [&](const auto& machine) { return !is_possible(machine, most); }) ||
      std::ranges::any_of(part.of_worlds, [&](const auto& world) { return world.events > most; }))
    return false;
  const auto has_size = [](std::size_t size, std::int64_t wanted) {
    return size == 0 || static_cast<std::int64_t>(size) == wanted;
  };
  return part.counts.of_trials.events <= most_moves &&
         has_size(part.counts.machines.size(), shape_.machines) &&
         has_size(part.of_worlds.size(), shape_.machines > 0 ? 0 : shape_.worlds);
}

void CellCounts::take(std::size_t condition, const Part& part) {
  const std::vector<statistics::MachineMoves>& machines = part.counts.machines;
  for (std::size_t machine = 0; machine < machines.size(); ++machine)
    add_machine(machine, condition, machines[machine]);
  for (std::size_t world = 0; world < part.of_worlds.size(); ++world)
    add_trials(world, condition, part.of_worlds[world]);
  if (shape_.worlds == 0 && shape_.machines == 0) add_trials(0, condition, part.counts.of_trials);
}

bool CellCounts::has_sum(const Part& part, Condition condition) const {
  const MoveCounts found = sum({condition, std::nullopt});
  const auto is_same = [](const statistics::ClusterSums& a, const statistics::ClusterSums& b) {
    return a.clusters == b.clusters && a.hits == b.hits && a.events == b.events;  // squares may be rounded
  };
  return found.moves == part.counts.moves && found.met == part.counts.met &&
         found.machines == part.counts.machines && is_same(found.of_trials, part.counts.of_trials) &&
         std::ranges::equal(sums_of_worlds(condition), part.of_worlds, is_same);
}

}  // namespace zerocount::measures
