#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/friction/profile.hpp"

namespace zerocount::study {

/// How often a random value is drawn: once per study, world, machine, trial or contact. In order of
/// frequency.
enum class DrawLevel : std::uint8_t {
  study,
  world,  ///< once per possible truth about unknown values that all machines share
  machine,
  trial,
  contact  ///< friction only: at t = 0 and at each re-stick of a trial
};

/// A way to divide the trials of a design point into groups whose results are reported separately. The groups
/// of one grouping are numbered from 0.
enum class Grouping : std::uint8_t { machine, world, condition, age };

struct GroupingTraits {
  Grouping grouping;
  std::string_view name;  ///< noun for one group in messages; also the folder in files
  std::optional<DrawLevel>
      level;  ///< level of the values drawn for each group; empty: the manifest lists them
};

/// All groupings, in the order of the enumeration. group_count() (study.hpp) returns their numbers of groups.
/// Trial i is in group TrialIndices::group_of(grouping, i).
inline constexpr std::array<GroupingTraits, 4> groupings{{{Grouping::machine, "machine", DrawLevel::machine},
                                                          {Grouping::world, "world", DrawLevel::world},
                                                          {Grouping::condition, "condition", std::nullopt},
                                                          {Grouping::age, "age", std::nullopt}}};

constexpr const GroupingTraits& traits_of(Grouping grouping) {
  return groupings.at(static_cast<std::size_t>(grouping));
}

/// One value for each grouping.
template <class T>
struct ByGrouping {
  std::array<T, groupings.size()> values{};

  T& operator[](Grouping grouping) { return values.at(static_cast<std::size_t>(grouping)); }
  const T& operator[](Grouping grouping) const { return values.at(static_cast<std::size_t>(grouping)); }
};

/// How the trials of a point are assigned to machines, conditions, draws and worlds. Trial i runs on machine
/// i mod R, under condition ⌊i/R⌋ mod C. It uses the random numbers of draw j = i mod R + R·⌊i/(R·C)⌋, in
/// world j mod W. So each machine is simulated under every condition with the same draws. With ages, C counts
/// the pairs of condition and age: index c + (C/A)·a is condition c at age a.
struct TrialIndices {
  std::int64_t machines{1};    ///< R; 1 if no trials share a machine
  std::int64_t conditions{1};  ///< C; 1 without conditions and ages
  std::int64_t worlds{1};      ///< W; 1 without worlds
  std::int64_t ages{1};        ///< A, a divisor of C; 1 without ages

  std::int64_t condition_of(std::int64_t trial) const { return trial / machines % conditions; }
  /// Draw j of the trial. A point has trials/C draws.
  std::int64_t draw_of(std::int64_t trial) const {
    return trial % machines + machines * (trial / (machines * conditions));
  }
  /// The trial with draw j under a condition.
  std::int64_t trial_of(std::int64_t draw, std::int64_t condition) const {
    return draw % machines + machines * (condition + conditions * (draw / machines));
  }
  /// Index of the trial's group, the same at every point; 0 if the study does not have the grouping.
  std::int64_t group_of(Grouping grouping, std::int64_t trial) const {
    switch (grouping) {
      case Grouping::machine:
        return trial % machines;
      case Grouping::world:
        return draw_of(trial) % worlds;
      case Grouping::condition:
        return condition_of(trial) % (conditions / ages);
      case Grouping::age:
        break;
    }
    return condition_of(trial) / (conditions / ages);
  }
  bool operator==(const TrialIndices&) const = default;
};

/// One axis of the sweep: the value of one swept key (or the case) at every design point.
struct SweepAxis {
  enum class Kind { number, text };
  std::string name;     ///< dotted path of the key, or "case"
  std::string unit;     ///< unit of the numbers, "1" if dimensionless; empty for text
  std::string meaning;  ///< description in one line, from the table of parameters
  Kind kind{Kind::number};
  std::vector<double> numbers;     ///< [point]; NaN if the key has a distribution at that point
  std::vector<std::string> texts;  ///< [point]; used if kind is text
};

/// The design points of a study.
struct DesignPoints {
  std::vector<std::string> labels;  ///< [point] label
  std::vector<SweepAxis> axes;      ///< axes of the sweep; empty without a sweep
};

/// One column of trial inputs: a parameter that differs between trials or points.
struct InputColumn {
  std::string name;     ///< dotted path, e.g. "friction.k1" or "command.targets.0"
  std::string unit;     ///< unit of the values, "1" if dimensionless
  std::string meaning;  ///< description in one line, from the table of parameters
  /// How often the parameter is drawn: the most frequent level of all points; `study` if it is not drawn.
  DrawLevel level{DrawLevel::study};
};

/// Columns of the tables of inputs: the parameters that differ between trials, machines and worlds.
struct InputColumns {
  std::vector<InputColumn> inputs;  ///< columns of the table of trials
  /// Columns of parameters drawn for each group, the same at all points; empty for a grouping without draws.
  /// A parameter that conditions override has one column per condition: "friction.k2@loaded".
  ByGrouping<std::vector<InputColumn>> shared;
};

/// A friction profile realised for this study's seed.
struct RealisedProfile {
  std::string name;  ///< dotted path of the parameter, with "@point" appended if points differ
  std::string unit;
  std::shared_ptr<const friction::Profile> profile;  ///< profile of the rotor of all trials, or of machine 0
  /// Returns the profile of a machine; empty if all trials use one rotor.
  std::function<std::shared_ptr<const friction::Profile>(std::int64_t machine)> of_machine{};
};

}  // namespace zerocount::study
