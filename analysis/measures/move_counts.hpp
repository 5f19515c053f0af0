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

/// Moves of which some meet what is asked.
struct MoveCounts {
  std::int64_t moves{0};
  std::int64_t met{0};
  statistics::ClusterSums of_trials{};               ///< moves; each trial is a cluster. Empty with machines
  std::vector<statistics::MachineMoves> machines{};  ///< [machine]; empty without machines

  bool operator==(const MoveCounts&) const = default;
};

/// The moves in clusters: machines, or trials where none share a machine.
statistics::ClusterSums clusters_of(const MoveCounts& counts);

/// Sizes of the dimensions by which the trials of a design point are told apart; 0: not by this one.
struct Shape {
  std::int64_t machines{0};    ///< draw j is on machine j mod machines
  std::int64_t worlds{0};      ///< draw j is in world j mod worlds, and machine r in world r mod worlds
  std::int64_t conditions{0};  ///< with ages each condition at each age; see study::TrialTurns

  bool operator==(const Shape&) const = default;
};

inline Shape shape_of(const study::Study& study) {
  return {study.machines, study.worlds, std::ssize(study.conditions)};
}

/// Cells of a design point: those under one condition, of one world, or all.
struct Cells {
  std::optional<std::size_t> condition{};
  std::optional<std::size_t> world{};
};

/// The moves of a design point, counted in cells: each world under each condition, or with machines each
/// machine under each condition. All other counts are sums of cells.
class CellCounts {
 public:
  explicit CellCounts(const Shape& shape = {}) : shape_(shape) {}

  /// Adds moves of a trial.
  void add(std::int64_t trial, std::int64_t moves, std::int64_t met);
  /// Adds moves of a machine under one condition. @param condition 0 without conditions
  void add_machine(std::size_t machine, std::size_t condition, const statistics::MachineMoves& moves);
  /// Adds the moves of trials of one world under one condition, without machines. @param world 0 without
  /// worlds
  void add_trials(std::size_t world, std::size_t condition, const statistics::ClusterSums& moves);
  /// Adds other moves, of the same shape.
  CellCounts& operator+=(const CellCounts& other);

  const Shape& shape() const { return shape_; }
  /// 1 without conditions.
  std::size_t conditions() const {
    return static_cast<std::size_t>(std::max<std::int64_t>(shape_.conditions, 1));
  }

  /// The moves of these cells, as those of a study of its own.
  MoveCounts sum(const Cells& cells = {}) const;
  /// [world] and [condition] the moves of each; empty without worlds, conditions.
  std::vector<MoveCounts> by_world() const { return by_world(std::nullopt); }
  std::vector<MoveCounts> by_condition() const;
  /// The moves under a condition by world, [world]; without worlds all of them as one. A claim must hold in
  /// each.
  std::vector<MoveCounts> worlds_under(std::size_t condition) const;
  /// The cells under one condition.
  CellCounts under(std::size_t condition) const;

  /// Whether restored counts can be those of so many trials.
  bool is_valid(std::int64_t trials, std::int64_t moves_of_trial) const;

  /// In files stand the sums of all conditions, then those of each. The shape is known beforehand.
  template <class Self, class Archive>
  static void transfer(Self& self, Archive& archive) {
    const std::size_t parts = self.shape_.conditions == 0 ? 0 : self.conditions();
    if constexpr (std::is_const_v<Self>) {
      self.write(archive, std::nullopt);
      for (std::size_t condition = 0; condition < parts; ++condition) self.write(archive, condition);
    } else {
      self = CellCounts(self.shape_);
      const Part all = self.read(archive, std::nullopt);
      for (std::size_t condition = 0; condition < parts; ++condition)
        archive.require(self.has_sum(self.read(archive, condition), condition));
      archive.require(self.has_sum(all, std::nullopt));
    }
  }

 private:
  using Condition = std::optional<std::size_t>;  ///< nothing: all

  /// The sums of one condition, or of all, as a file has them.
  struct Part {
    MoveCounts counts;
    std::vector<statistics::ClusterSums> of_worlds;  ///< empty without worlds, with machines
  };

  std::size_t worlds() const { return static_cast<std::size_t>(std::max<std::int64_t>(shape_.worlds, 1)); }
  std::int64_t cells_of_condition() const;
  std::int64_t cell_of(std::size_t condition, std::size_t within) const;
  std::vector<MoveCounts> by_world(Condition condition) const;
  std::vector<statistics::ClusterSums> sums_of_worlds(Condition condition) const;
  bool can_be(const Part& part) const;
  void take(std::size_t condition, const Part& part);
  bool has_sum(const Part& part, Condition condition) const;

  template <class Archive>
  void write(Archive& archive, Condition condition) const {
    const MoveCounts counts = sum({condition, std::nullopt});
    archive(counts.moves, counts.met, counts.of_trials, counts.machines);
    if (shape_.worlds > 0) archive(sums_of_worlds(condition));
  }

  /// @returns the part, which is kept where it is of one condition, or there is none
  template <class Archive>
  Part read(Archive& archive, Condition condition) {
    Part part;
    MoveCounts& counts = part.counts;
    archive(counts.moves, counts.met, counts.of_trials, counts.machines);
    if (shape_.worlds > 0) archive(part.of_worlds);
    archive.require(can_be(part));
    if (condition || shape_.conditions == 0) take(condition.value_or(0), part);
    return part;
  }

  Shape shape_;
  statistics::ByCluster<statistics::ClusterSums> trials_{};     ///< [condition, world]; empty with machines
  statistics::ByCluster<statistics::MachineMoves> machines_{};  ///< [condition, machine]
};

}  // namespace zerocount::measures
