#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/friction/profile.hpp"
#include "experiments/study/grouping.hpp"

namespace zerocount::study {

/// One axis of the sweep: the value of one swept key (or the case) at every design point.
struct SweepAxis {
  enum class Kind { number, text };
  std::string name;     ///< dotted path of the key, or "case"
  std::string unit;     ///< "1" where dimensionless; empty for text
  std::string meaning;  ///< one line, from the table of parameters
  Kind kind{Kind::number};
  std::vector<double> numbers;     ///< [point]; NaN if the key has a distribution at that point
  std::vector<std::string> texts;  ///< [point]; used if kind is text
};

/// The design points of a study.
struct DesignPoints {
  std::vector<std::string> labels;  ///< [point]
  std::vector<SweepAxis> axes;      ///< of the sweep
};

/// One column of trial inputs: a parameter that differs between trials or points.
struct InputColumn {
  std::string name;                   ///< dotted path, e.g. "friction.k1" or "command.targets.0"
  std::string unit;                   ///< "1" where dimensionless
  std::string meaning;                ///< one line, from the table of parameters
  DrawLevel level{DrawLevel::study};  ///< how often it is drawn, the most frequent of all points; study if it
                                      ///< is not drawn
};

/// Columns of the tables of inputs: the parameters that differ between trials, rigs and worlds.
struct InputColumns {
  std::vector<InputColumn> inputs;  ///< of trials
  /// Drawn for each group, the same at all points; none of a grouping without draws. What conditions override
  /// has a column for each of them: "friction.k2@loaded".
  ByGrouping<std::vector<InputColumn>> shared;
};

/// A friction profile realised for this study's seed.
struct RealisedProfile {
  std::string name;  ///< dotted path of the parameter, with "@point" appended if points differ
  std::string unit;
  std::shared_ptr<const friction::Profile> profile;  ///< of the rotor of all trials, or of rig 0
  std::function<std::shared_ptr<const friction::Profile>(std::int64_t rig)>
      of_rig{};  ///< empty if all trials use one rotor
};

}  // namespace zerocount::study
