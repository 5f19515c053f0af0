#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <vector>

#include "analysis/statistics/clusters/by_cluster.hpp"
#include "analysis/statistics/clusters/clustered_proportion.hpp"
#include "analysis/statistics/clusters/machine_proportion.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::measures {

/// Number of moves that were judged, and of those that meet the goal.
struct MoveCounts {
  std::int64_t moves{0};
  std::int64_t met{0};
  /// Sums over the moves with each trial as a cluster; empty with machines.
  statistics::ClusterSums of_trials{};
  std::vector<statistics::MachineMoves> machines{};  ///< [machine] moves; empty without machines

  bool operator==(const MoveCounts&) const = default;
};

/// The moves grouped in clusters: one cluster per machine, or per trial if no trials share a machine.
statistics::ClusterSums clusters_of(const MoveCounts& counts);

/// Numbers of machines, worlds and settings among the trials of a design point; 0: the study has none.
struct Shape {
  std::int64_t machines{0};  ///< Draw j is on machine j mod machines.
  std::int64_t worlds{0};    ///< Draw j is in world j mod worlds, and machine r in world r mod worlds.
  std::int64_t settings{0};  ///< Number of settings at all ages together; see study::TrialIndices.

  bool operator==(const Shape&) const = default;
};

inline Shape shape_of(const study::Study& study) {
  return {study.machines, study.worlds, study.settings.total()};
}

/// Selection of cells of a design point: one setting or all, one world or all.
struct Cells {
  std::optional<std::size_t> setting{};
  std::optional<std::size_t> world{};
};

/// The moves of a design point, counted in cells. A cell is a machine in a setting; without machines it
/// is a world in a setting. All other counts are sums of cells.
class CellCounts {
 public:
  explicit CellCounts(const Shape& shape = {}) : shape_(shape) {}

  /// Adds the moves of a trial. @param trial index of the trial at the design point
  void add(std::int64_t trial, std::int64_t moves, std::int64_t met);
  /// Adds moves of a machine in one setting. @param setting 0 without settings
  void add_machine(std::size_t machine, std::size_t setting, const statistics::MachineMoves& moves);
  /// Adds the moves of trials of one world in one setting, without machines. @param world 0 without
  /// worlds
  void add_trials(std::size_t world, std::size_t setting, const statistics::ClusterSums& moves);
  /// Adds the moves of other counts with the same shape.
  CellCounts& operator+=(const CellCounts& other);

  const Shape& shape() const { return shape_; }
  /// Number of settings; 1 without settings.
  std::size_t settings() const {
    return static_cast<std::size_t>(std::max<std::int64_t>(shape_.settings, 1));
  }

  /// The sum of these cells, as if they were a study of their own.
  MoveCounts sum(const Cells& cells = {}) const;
  /// [world] the moves in the world; empty without worlds.
  std::vector<MoveCounts> by_world() const { return by_world(std::nullopt); }
  /// [setting] the moves in the setting; empty without settings.
  std::vector<MoveCounts> by_setting() const;
  /// [world] the moves in a setting; without worlds a single element with all of them. A claim must hold
  /// in each element.
  std::vector<MoveCounts> worlds_in(std::size_t setting) const;
  /// Counts with only the cells in one setting.
  CellCounts in_setting(std::size_t setting) const;

  /// Whether the restored counts are possible for this number of trials.
  bool is_valid(std::int64_t trials, std::int64_t moves_of_trial) const;

  /// Serialises the sums over all settings, then the sums of each setting. The shape must be known before
  /// reading.
  template <class Self, class Archive>
  static void transfer(Self& self, Archive& archive) {
    const std::size_t parts = self.shape_.settings == 0 ? 0 : self.settings();
    if constexpr (std::is_const_v<Self>) {
      self.write(archive, std::nullopt);
      for (std::size_t setting = 0; setting < parts; ++setting) self.write(archive, setting);
    } else {
      self = CellCounts(self.shape_);
      const Part all = self.read(archive, std::nullopt);
      for (std::size_t setting = 0; setting < parts; ++setting)
        archive.require(self.has_sum(self.read(archive, setting), setting));
      archive.require(self.has_sum(all, std::nullopt));
    }
  }

 private:
  using Setting = std::optional<std::size_t>;  ///< Index of a setting; empty: all settings.

  /// The sums of one setting, or of all settings, as a file stores them.
  struct Part {
    MoveCounts counts;
    std::vector<statistics::ClusterSums> of_worlds;  ///< empty without worlds, with machines
  };

  std::size_t worlds() const { return static_cast<std::size_t>(std::max<std::int64_t>(shape_.worlds, 1)); }
  std::int64_t cells_of_setting() const;
  std::int64_t cell_of(std::size_t setting, std::size_t within) const;
  std::vector<MoveCounts> by_world(Setting setting) const;
  std::vector<statistics::ClusterSums> sums_of_worlds(Setting setting) const;
  bool can_be(const Part& part) const;
  void take(std::size_t setting, const Part& part);
  bool has_sum(const Part& part, Setting setting) const;

  template <class Archive>
  void write(Archive& archive, Setting setting) const {
    const MoveCounts counts = sum({setting, std::nullopt});
    archive(counts.moves, counts.met, counts.of_trials, counts.machines);
    if (shape_.worlds > 0) archive(sums_of_worlds(setting));
  }

  /// Reads a part and returns it. The part is also added to the cells if it belongs to one setting, or if
  /// the study has no settings.
  template <class Archive>
  Part read(Archive& archive, Setting setting) {
    Part part;
    MoveCounts& counts = part.counts;
    archive(counts.moves, counts.met, counts.of_trials, counts.machines);
    if (shape_.worlds > 0) archive(part.of_worlds);
    archive.require(can_be(part));
    if (setting || shape_.settings == 0) take(setting.value_or(0), part);
    return part;
  }

  Shape shape_;
  statistics::ByCluster<statistics::ClusterSums> trials_{};     ///< [setting, world]; empty with machines
  statistics::ByCluster<statistics::MachineMoves> machines_{};  ///< [setting, machine]
};

}  // namespace zerocount::measures
