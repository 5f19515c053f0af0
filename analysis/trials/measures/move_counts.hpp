#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <vector>

#include "analysis/basis/statistics/clusters/by_cluster.hpp"
#include "analysis/basis/statistics/clusters/clustered_proportion.hpp"
#include "analysis/basis/statistics/clusters/machine_proportion.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::measures {

/// Number of moves that a goal judges, and of moves that meet it.
struct MoveCounts {
  std::int64_t moves{0};
  std::int64_t met{0};
  /// Sums over the moves with each trial as a cluster of dependent moves; empty in a study with machines.
  statistics::ClusterSums of_trials{};
  /// [machine] Numbers of judged moves and of moves that meet the goal; empty in a study without machines.
  std::vector<statistics::MachineMoves> machines{};

  bool operator==(const MoveCounts&) const = default;
};

/// Sums over clusters of dependent moves: one cluster per machine, or per trial if no trials share a machine.
statistics::ClusterSums clusters_of(const MoveCounts& counts);

/// Numbers of machines, worlds (draws of what all machines share) and settings (conditions at ages) among the
/// trials of a design point. Each is 0 if the study has none.
struct Shape {
  std::int64_t machines{0};  ///< Number of machines. Draw j is on machine j mod machines.
  /// Number of worlds. Draw j is in world j mod worlds, and machine r is in world r mod worlds.
  std::int64_t worlds{0};
  std::int64_t settings{0};  ///< Number of settings, counted over all ages together; see study::TrialIndices.

  bool operator==(const Shape&) const = default;
};

inline Shape shape_of(const study::Study& study) {
  return {study.machines, study.worlds, study.settings.listed()};
}

/// Selection among the counts of a design point: one setting or all (null), one world or all (null).
struct Cells {
  std::optional<std::size_t> setting{};
  std::optional<std::size_t> world{};
};

/// Counts of the moves of a design point, kept in cells. A cell is a machine in a setting; without machines
/// it is a world in a setting. All other counts are sums of cells.
class CellCounts {
 public:
  explicit CellCounts(const Shape& shape = {}) : shape_(shape) {}

  /// Adds the moves of a trial.
  /// @param trial index of the trial at the design point
  /// @param moves number of judged moves
  /// @param met number of these that meet the goal
  void add(std::int64_t trial, std::int64_t moves, std::int64_t met);
  /// Adds the moves of a machine in one setting.
  /// @param setting index of the setting; 0 without settings
  void add_machine(std::size_t machine, std::size_t setting, const statistics::MachineMoves& moves);
  /// Adds the moves of trials of one world in one setting, in a study without machines.
  /// @param world 0 without worlds
  /// @param setting 0 without settings
  void add_trials(std::size_t world, std::size_t setting, const statistics::ClusterSums& moves);
  /// Adds the counts of another object with the same shape.
  CellCounts& operator+=(const CellCounts& other);

  const Shape& shape() const { return shape_; }
  /// Number of settings (conditions at ages) in which moves are counted; 1 if the study has none.
  std::size_t settings() const {
    return static_cast<std::size_t>(std::max<std::int64_t>(shape_.settings, 1));
  }

  /// The sum of the selected cells, as if they were a study of their own.
  MoveCounts sum(const Cells& cells = {}) const;
  /// [world] Counts of the moves in each world, over all settings; empty without worlds.
  std::vector<MoveCounts> by_world() const { return by_world(std::nullopt); }
  /// [setting] Counts of the moves in each setting; empty without settings.
  std::vector<MoveCounts> by_setting() const;
  /// [world] Counts of the moves in one setting, for each world; without worlds a single element with all of
  /// them. A claim in this setting must hold in each element.
  std::vector<MoveCounts> worlds_in(std::size_t setting) const;
  /// A copy that contains only the counts in one setting.
  /// @param setting index of the setting
  CellCounts in_setting(std::size_t setting) const;

  /// Whether the counts that were read from a file are possible for this number of trials.
  /// @param moves_of_trial number of judged moves of a trial
  bool is_valid(std::int64_t trials, std::int64_t moves_of_trial) const;

  /// Writes or reads the counts: the sums over all settings, then the sums of each setting. The shape must be
  /// known before reading.
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
  using SettingOrAll = std::optional<std::size_t>;  ///< Index of a setting; empty: all settings.

  /// The sums of one setting, or of all settings, as a file stores them.
  struct Part {
    MoveCounts counts;
    /// [world] Sums over the moves in each world; empty without worlds, and in a study with machines.
    std::vector<statistics::ClusterSums> of_worlds;
  };

  std::size_t worlds() const { return static_cast<std::size_t>(std::max<std::int64_t>(shape_.worlds, 1)); }
  std::int64_t cells_of_setting() const;
  std::int64_t cell_of(std::size_t setting, std::size_t within) const;
  std::vector<MoveCounts> by_world(SettingOrAll setting) const;
  std::vector<statistics::ClusterSums> sums_of_worlds(SettingOrAll setting) const;
  bool can_be(const Part& part) const;
  void take(std::size_t setting, const Part& part);
  bool has_sum(const Part& part, SettingOrAll setting) const;

  template <class Archive>
  void write(Archive& archive, SettingOrAll setting) const {
    const MoveCounts counts = sum({setting, std::nullopt});
    archive(counts.moves, counts.met, counts.of_trials, counts.machines);
    if (shape_.worlds > 0) archive(sums_of_worlds(setting));
  }

  /// Reads the sums of one setting, or of all settings, and returns them. They are also added to the cells if
  /// they belong to one setting, or if the study has no settings.
  template <class Archive>
  Part read(Archive& archive, SettingOrAll setting) {
    Part part;
    MoveCounts& counts = part.counts;
    archive(counts.moves, counts.met, counts.of_trials, counts.machines);
    if (shape_.worlds > 0) archive(part.of_worlds);
    archive.require(can_be(part));
    if (setting || shape_.settings == 0) take(setting.value_or(0), part);
    return part;
  }

  Shape shape_;
  /// [setting][world] Sums over the moves with each trial as a cluster; empty in a study with machines.
  statistics::ByCluster<statistics::ClusterSums> trials_{};
  /// [setting][machine] Numbers of judged moves and of moves that meet the goal.
  statistics::ByCluster<statistics::MachineMoves> machines_{};
};

}  // namespace zerocount::measures
