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
#include "experiments/study/setting.hpp"

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

/// How the trials of a point are assigned to machines, settings, draws and worlds. With R machines, S
/// settings and W worlds, trial i runs on machine i mod R, in setting ⌊i/R⌋ mod S. It uses the random numbers
/// of draw j = i mod R + R·⌊i/(R·S)⌋, in world j mod W. So each machine is simulated in every setting with
/// the same draws.
struct TrialIndices {
  std::int64_t machines{1};  ///< R; 1 if no trials share a machine
  SettingCounts settings{};  ///< S is its total()
  std::int64_t worlds{1};    ///< W; 1 without worlds

  /// Index of the trial's setting.
  std::int64_t setting_of(std::int64_t trial) const { return trial / machines % settings.total(); }
  /// Draw j of the trial. A point has trials/S draws.
  std::int64_t draw_of(std::int64_t trial) const {
    return trial % machines + machines * (trial / (machines * settings.total()));
  }
  /// The trial with draw j in a setting.
  std::int64_t trial_of(std::int64_t draw, std::int64_t setting) const {
    return draw % machines + machines * (setting + settings.total() * (draw / machines));
  }
  /// Index of the trial's group, the same at every point; 0 if the study does not have the grouping.
  std::int64_t group_of(Grouping grouping, std::int64_t trial) const {
    switch (grouping) {
      case Grouping::machine:
        return trial % machines;
      case Grouping::world:
        return draw_of(trial) % worlds;
      case Grouping::condition:
        return settings.at(setting_of(trial)).condition;
      case Grouping::age:
        break;
    }
    return settings.at(setting_of(trial)).age;
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
  /// A parameter that differs between settings has one column per setting: "friction.k2@loaded".
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
