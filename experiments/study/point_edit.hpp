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

/// The dotted paths of drawn values that were widened, and of those that would leave their ranges.
struct Widened {
  std::vector<std::string> changed;
  std::vector<std::string> kept;
};

/// The scaling of a value. Where it is a number or drawn from a list, some of its values can be exempt.
struct Scaling {
  double factor{1.0};           ///< above 0
  std::optional<double> off{};  ///< the value that stays, beside "none"
  /// Least value afterwards; of values drawn from a range it is not enforced.
  double least{-std::numeric_limits<double>::infinity()};

  double operator()(double value) const { return value == off ? value : std::max(least, factor * value); }
};

/// A study with other values at one of its design points, in the units of its manifest. All other values and
/// all random numbers stay: a scaled value is drawn as before. With conditions a value that is set is that
/// under each of them; values are scaled and added to under one condition alone (under_condition()).
class PointEdit {
 public:
  PointEdit(const Study& study, std::int64_t point);

  /// The points of the plan: the design point under each condition.
  std::vector<std::size_t> points() const;
  const StudyPlan& plan() const { return plan_; }
  StudyPlan& plan() { return plan_; }
  /// @param parameter dotted path
  ValueLimits limits(std::string_view parameter, std::int64_t condition = 0) const;

  void set(std::size_t slot, double number);
  void set(std::string_view parameter, double number);
  /// The value "none" stays, and a required one that the study does not have.
  void scale(std::size_t slot, const Scaling& scaling);
  void scale(std::string_view parameter, const Scaling& scaling);
  void scale(std::size_t slot, double factor) { scale(slot, Scaling{factor}); }
  void scale(std::string_view parameter, double factor) { scale(parameter, Scaling{factor}); }
  /// Lets all that is drawn of the axis and its surroundings lie `factor` times as far from its centre
  /// (distributions::widened), but for the starts and the commands of moves. What would leave its range, and
  /// whole numbers, choices and rows of samples, stay as they are.
  Widened widen(double factor);
  /// For a slot of whole numbers.
  void add(std::string_view parameter, std::int64_t number);

  /// The first new value outside the range of its parameter, "path: what; expected …"; empty if there is
  /// none.
  std::string out_of_range() const;

  /// Its trials at the point are those with the new values. Later edits do not change it.
  Study study() const;

 private:
  const Value& value_of(std::size_t slot) const;
  void assign(std::size_t slot, const Value& value);
  Value drawn_from(const Value& like, distributions::Distribution distribution);

  Study study_;
  StudyPlan plan_;     // its last axis has one option, the new values
  std::size_t point_;  // of the plan, under the first condition
};

}  // namespace zerocount::study
