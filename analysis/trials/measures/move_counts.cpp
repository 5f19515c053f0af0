#include "analysis/trials/measures/move_counts.hpp"

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

std::int64_t CellCounts::cells_of_setting() const {
  return shape_.machines > 0 ? shape_.machines : static_cast<std::int64_t>(worlds());
}

/// Index of a cell: a machine in a setting or, without machines, a world in a setting.
/// @param within index of the machine; without machines, of the world
std::int64_t CellCounts::cell_of(std::size_t setting, std::size_t within) const {
  return static_cast<std::int64_t>(setting) * cells_of_setting() + static_cast<std::int64_t>(within);
}

void CellCounts::add(std::int64_t trial, std::int64_t moves, std::int64_t met) {
  const study::TrialIndices indices{.machines = std::max<std::int64_t>(shape_.machines, 1),
                                    // Only the number of settings matters for the two indices below.
                                    .settings = {.conditions = static_cast<std::int64_t>(settings())}};
  const auto setting = static_cast<std::size_t>(indices.setting_of(trial));
  const auto within = static_cast<std::size_t>(indices.draw_of(trial) % cells_of_setting());
  if (shape_.machines > 0) {
    add_machine(within, setting, {1, moves, met});
  } else {
    trials_.sum_of(cell_of(setting, within)).add(met, moves);
  }
}

void CellCounts::add_machine(std::size_t machine, std::size_t setting,
                             const statistics::MachineMoves& moves) {
  machines_.add(cell_of(setting, machine), moves);
}

void CellCounts::add_trials(std::size_t world, std::size_t setting, const statistics::ClusterSums& moves) {
  trials_.add(cell_of(setting, world), moves);
}

CellCounts& CellCounts::operator+=(const CellCounts& other) {
  trials_ += other.trials_;
  machines_ += other.machines_;
  return *this;
}

MoveCounts CellCounts::sum(const Cells& cells) const {
  MoveCounts sum;
  const std::size_t first = cells.setting.value_or(0);
  const std::size_t end = cells.setting ? first + 1 : settings();
  // Machines of which nothing was counted in these settings are none.
  if (shape_.machines > 0 && (machines_.end() <= cell_of(first, 0) || machines_.first() >= cell_of(end, 0)))
    return sum;
  const std::size_t step = cells.world ? worlds() : 1;
  for (std::size_t i = cells.world.value_or(0); i < static_cast<std::size_t>(cells_of_setting()); i += step) {
    statistics::MachineMoves of_machine;
    for (std::size_t setting = first; setting < end; ++setting) {
      sum.of_trials += trials_[cell_of(setting, i)];
      of_machine += machines_[cell_of(setting, i)];
    }
    if (shape_.machines > 0) sum.machines.push_back(of_machine);
    sum.moves += of_machine.moves;
    sum.met += of_machine.met;
  }
  sum.moves += sum.of_trials.events;
  sum.met += sum.of_trials.hits;
  return sum;
}

std::vector<MoveCounts> CellCounts::by_world(SettingOrAll setting) const {
  std::vector<MoveCounts> each;
  for (std::size_t world = 0; shape_.worlds > 0 && world < worlds(); ++world)
    each.push_back(sum({setting, world}));
  return each;
}

std::vector<MoveCounts> CellCounts::by_setting() const {
  std::vector<MoveCounts> each;
  for (std::size_t setting = 0; shape_.settings > 0 && setting < settings(); ++setting)
    each.push_back(sum({setting, std::nullopt}));
  return each;
}

std::vector<MoveCounts> CellCounts::worlds_in(std::size_t setting) const {
  return shape_.worlds > 0 ? by_world(setting) : std::vector{sum({setting, std::nullopt})};
}

CellCounts CellCounts::in_setting(std::size_t setting) const {
  CellCounts counts({shape_.machines, shape_.worlds, 0});
  for (std::int64_t i = 0; i < cells_of_setting(); ++i) {
    const std::int64_t cell = cell_of(setting, 0) + i;
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

/// [world] Sums over the moves in each world, in the form in which files store them. Empty if the study has
/// machines, and if nothing was counted.
std::vector<statistics::ClusterSums> CellCounts::sums_of_worlds(SettingOrAll setting) const {
  std::vector<statistics::ClusterSums> sums;
  for (const MoveCounts& world : by_world(setting)) sums.push_back(world.of_trials);
  const auto is_empty = [](const statistics::ClusterSums& one) { return one.clusters == 0; };
  if (shape_.machines > 0 || std::ranges::all_of(sums, is_empty)) sums.clear();
  return sums;
}

/// Whether the counts that were read from a file are possible. The limits ensure that sums of cells do not
/// overflow.
bool CellCounts::can_be(const Part& part) const {
  constexpr std::int64_t most_moves = std::int64_t{1} << 53;
  const std::int64_t most = most_moves / cells_of_setting() / static_cast<std::int64_t>(settings());
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

void CellCounts::take(std::size_t setting, const Part& part) {
  const std::vector<statistics::MachineMoves>& machines = part.counts.machines;
  for (std::size_t machine = 0; machine < machines.size(); ++machine)
    add_machine(machine, setting, machines[machine]);
  for (std::size_t world = 0; world < part.of_worlds.size(); ++world)
    add_trials(world, setting, part.of_worlds[world]);
  if (shape_.worlds == 0 && shape_.machines == 0) add_trials(0, setting, part.counts.of_trials);
}

bool CellCounts::has_sum(const Part& part, SettingOrAll setting) const {
  const MoveCounts found = sum({setting, std::nullopt});
  const auto is_same = [](const statistics::ClusterSums& a, const statistics::ClusterSums& b) {
    return a.clusters == b.clusters && a.hits == b.hits && a.events == b.events;  // squares may be rounded
  };
  return found.moves == part.counts.moves && found.met == part.counts.met &&
         found.machines == part.counts.machines && is_same(found.of_trials, part.counts.of_trials) &&
         std::ranges::equal(sums_of_worlds(setting), part.of_worlds, is_same);
}

}  // namespace zerocount::measures
