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

/// How often a random value is drawn: once per study, per world (one possible set of the values that nobody
/// knows and all machines share), per machine, per trial, or per contact (at the start of a trial and each
/// time that friction sticks again). In order of frequency.
enum class DrawLevel : std::uint8_t {
  study,
  world,  ///< once per world: one possible set of the values that nobody knows and all machines share
  machine,
  trial,
  /// Friction parameters only: once per contact, that is at t = 0 and each time the friction sticks again in
  /// a trial.
  contact
};

/// A way to divide the trials of a design point into groups whose results are reported separately. The groups
/// of one grouping are numbered from 0.
enum class Grouping : std::uint8_t { machine, world, condition, age };

struct GroupingTraits {
  Grouping grouping;
  /// Noun for one group in messages, such as "machine"; also the folder of the groups' tables in files.
  std::string_view name;
  /// How often values are drawn that the trials of one group share; empty: the manifest lists the groups.
  std::optional<DrawLevel> level;
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

/// One value for each way to group trials: by machine, world, condition and age.
template <class T>
struct ByGrouping {
  std::array<T, groupings.size()> values{};

  T& operator[](Grouping grouping) { return values.at(static_cast<std::size_t>(grouping)); }
  const T& operator[](Grouping grouping) const { return values.at(static_cast<std::size_t>(grouping)); }
};

/// How the trials of a design point are assigned to machines, settings, draws and worlds. A setting is a
/// condition at an age, a world one possible set of the values that nobody knows and all machines share. With
/// R machines, S settings and W worlds, trial i runs on machine i mod R, in setting ⌊i/R⌋ mod S. It uses the
/// random numbers of draw j = i mod R + R·⌊i/(R·S)⌋, in world j mod W. So each machine is simulated in every
/// setting with the same draws.
struct TrialIndices {
  std::int64_t machines{1};  ///< number of machines R; 1 if no trials share a machine
  SettingCounts settings{};  ///< numbers of conditions and ages; their product is the number of settings S
  std::int64_t worlds{1};    ///< number of worlds W; 1 without worlds

  /// Index of the setting (a condition at an age) in which the trial runs.
  std::int64_t setting_of(std::int64_t trial) const { return trial / machines % settings.total(); }
  /// Index j of the draw (set of random numbers) that the trial uses. With S settings a design point has
  /// trials/S draws.
  std::int64_t draw_of(std::int64_t trial) const {
    return trial % machines + machines * (trial / (machines * settings.total()));
  }
  /// Index of the trial that uses draw j (a set of random numbers) in the given setting (a condition at an
  /// age).
  std::int64_t trial_of(std::int64_t draw, std::int64_t setting) const {
    return draw % machines + machines * (setting + settings.total() * (draw / machines));
  }
  /// Index of the group (such as the machine) to which the trial belongs, the same at every design point; 0
  /// if the study does not have the grouping.
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

/// One axis of the sweep, as results describe it: the value of one swept key (or the name of the case) at
/// every design point.
struct SweepAxis {
  enum class Kind { number, text };
  std::string name;     ///< dotted path of the swept key, or "case"
  std::string unit;     ///< unit of the numbers, "1" if dimensionless; empty for text
  std::string meaning;  ///< description in one line, from the table of parameters
  Kind kind{Kind::number};
  /// [design point] number of the swept key; NaN if the key has a distribution at that point.
  std::vector<double> numbers;
  std::vector<std::string> texts;  ///< [design point] text of the swept key; used if kind is text
};

/// The design points of a study: the combinations of values that it sweeps.
struct DesignPoints {
  std::vector<std::string> labels;  ///< [design point] label
  std::vector<SweepAxis> axes;      ///< axes of the sweep; empty without a sweep
};

/// One column of the tables of inputs: a parameter that differs between trials or design points.
struct InputColumn {
  std::string name;     ///< dotted path of the parameter, e.g. "friction.k1" or "command.targets.0"
  std::string unit;     ///< unit of the values, "1" if dimensionless
  std::string meaning;  ///< description of the parameter in one line, from the table of parameters
  /// How often the parameter is drawn: the most frequent level of all points; `study` if it is not drawn.
  DrawLevel level{DrawLevel::study};
};

/// Columns of the tables of inputs: the parameters that differ between trials, machines and worlds.
struct InputColumns {
  std::vector<InputColumn> inputs;  ///< columns of the table of trials, one per parameter
  /// Columns of the parameters that all trials of a group (a machine, a world) share, the same at all design
  /// points; empty for a grouping without draws. A parameter that differs between settings (condition at an
  /// age) has one column per setting: "friction.k2@loaded".
  ByGrouping<std::vector<InputColumn>> shared;
};

/// A friction parameter as it varies along the axis, drawn with this study's seed.
struct RealisedProfile {
  /// Dotted path of the parameter, with "@point" appended if its profiles differ between design points.
  std::string name;
  std::string unit;
  /// Parameter along the rotor of all trials, or of machine 0 if each machine has its own.
  std::shared_ptr<const friction::Profile> profile;
  /// Returns the profile of a machine's rotor; empty if all trials use one rotor.
  std::function<std::shared_ptr<const friction::Profile>(std::int64_t machine)> of_machine{};
};

}  // namespace zerocount::study
