#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/study/plan.hpp"
#include "experiments/study/point_limits.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::study {

/// Result of PointEdit::widen(): the values that it widened, and those that it did not.
struct Widened {
  /// Dotted paths of the drawn parameters whose distributions were widened.
  std::vector<std::string> changed;
  /// Dotted paths of the drawn parameters that were not widened, because they would have left their ranges.
  std::vector<std::string> kept;
};

/// The scaling of a value by a factor. If the value is a number or drawn from a list, one number can be
/// exempt.
struct Scaling {
  double factor{1.0};  ///< factor, above 0
  /// Number that is not scaled, in addition to the number that means "none" (the feature is off).
  std::optional<double> off{};
  /// Minimum of the value after scaling. Not enforced for values drawn from a continuous distribution.
  double least{-std::numeric_limits<double>::infinity()};

  double operator()(double value) const { return value == off ? value : std::max(least, factor * value); }
};

/// Makes a study with other values at one of its design points, in the units of its manifest. All other
/// values and all random numbers stay: a scaled value is drawn with the same random number. In a study with
/// settings, set() sets the value in every setting. scale(), widen() and add() are for a study of one
/// setting (in_setting()).
class PointEdit {
 public:
  PointEdit(const Study& study, std::int64_t point);

  /// The points of the plan that belong to the edited design point, one per setting (condition at an age).
  std::vector<std::size_t> points() const;
  const StudyPlan& plan() const { return plan_; }
  StudyPlan& plan() { return plan_; }
  /// @param parameter dotted path
  ParameterRange limits(std::string_view parameter, std::int64_t setting = 0) const;

  void set(std::size_t slot, double number);
  void set(std::string_view parameter, double number);
  /// Scales the value of a slot (a parameter in the plan). The value "none" stays, and so does a required
  /// value that the study does not have (NaN).
  void scale(std::size_t slot, const Scaling& scaling);
  void scale(std::string_view parameter, const Scaling& scaling);
  void scale(std::size_t slot, double factor) { scale(slot, Scaling{factor}); }
  void scale(std::string_view parameter, double factor) { scale(parameter, Scaling{factor}); }
  /// Widens the distributions of all drawn values, except starts and commands of moves: each value then lies
  /// `factor` times as far from its centre (distributions::widened). Values that would leave their ranges,
  /// whole numbers, choices and rows of samples stay as they are.
  Widened widen(double factor);
  /// Adds `number` to the value of a parameter that takes whole numbers.
  void add(std::string_view parameter, std::int64_t number);

  /// Message about the first new value outside the range of its parameter, "path: what; expected …"; empty if
  /// all are inside.
  std::string out_of_range() const;

  /// The study with the edits so far: its trials at the edited point have the new values. Later edits do not
  /// change it.
  Study study() const;

 private:
  const Value& value_of(std::size_t slot) const;
  void assign(std::size_t slot, const Value& value);
  Value drawn_from(const Value& like, distributions::Distribution distribution);

  Study study_;
  StudyPlan plan_;     // its last axis has one option, the new values
  std::size_t point_;  // of the plan, in the first setting
};

}  // namespace zerocount::study
