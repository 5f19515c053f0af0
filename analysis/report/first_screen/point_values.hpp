#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/study/point_limits.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::report {

/// The values of parameters at a design point, over all trials and conditions.
class PointValues {
 public:
  PointValues(const study::Study& study, std::int64_t point) : study_(study), point_(point) {}

  const study::Study& study() const { return study_; }
  std::int64_t point() const { return point_; }

  /// The range of the parameter with this dotted path, in its unit in the manifest.
  study::ValueLimits limits(std::string_view name) const;
  study::ValueLimits limits(std::size_t slot) const;
  /// Whether the value can be above 0 in some trial.
  bool can_be_positive(std::string_view name) const { return limits(name).high > 0.0; }

  /// Whether the value is the word "none" in all trials.
  bool is_none(std::string_view name) const;

  /// "3.2 … 4.6 kg", "presliding", "none"; of a distribution without ends "about 130 N m/rad".
  std::string text(std::string_view name) const;
  std::string text(std::size_t slot) const;

  /// "per rig", "per trial", … where the value is drawn; else empty.
  std::string draw_text(std::size_t slot) const;

 private:
  std::size_t slot_of(std::string_view name) const;
  std::vector<double> typical_values(std::size_t slot) const;  ///< under each condition

  const study::Study& study_;
  std::int64_t point_;
};

}  // namespace zerocount::report
