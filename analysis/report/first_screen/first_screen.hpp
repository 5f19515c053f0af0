#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/report/page.hpp"
#include "analysis/report/reported_study.hpp"
#include "analysis/trials/summary/cells_of_point.hpp"
#include "core/trial/parameters.hpp"
#include "experiments/study/goal.hpp"
#include "experiments/study/point_limits.hpp"
#include "experiments/study/study.hpp"

/// The first screen of a page: the verdict, the axis as a diagram, the requirements with their verdicts, the
/// gains with the margins of the loops, and the assumptions.
namespace zerocount::report {

// The quantities of analysis/basis/text, in which a line does not break between a number and its unit.
std::string quantity_text(double value, std::string_view unit);
std::string range_text(double low, double high, std::string_view unit);
std::string list_text(std::span<const double> values, std::string_view unit);

/// The values of parameters at a design point, over all trials and all settings (conditions at ages), as
/// ranges and text.
class PointValues {
 public:
  PointValues(const study::Study& study, std::int64_t point) : study_(study), point_(point) {}

  const study::Study& study() const { return study_; }
  std::int64_t point() const { return point_; }

  /// The range of the parameter with this dotted path, in its unit in the manifest.
  study::ParameterRange limits(std::string_view name) const;
  study::ParameterRange limits(std::size_t slot) const;
  /// Whether the parameter is above 0 in some trial.
  bool can_be_positive(std::string_view name) const { return limits(name).high > 0.0; }

  /// Whether the parameter is the word "none" in all trials.
  bool is_none(std::string_view name) const;

  /// Whether the study has a parameter or a list with this dotted path.
  bool has(std::string_view name) const;

  /// The value of the parameter as text: "3.2 … 4.6 kg", "presliding", "none"; for a distribution without
  /// limits "about 130 N m/rad"; for a list its values.
  std::string text(std::string_view name) const;
  std::string text(std::size_t slot) const;

  /// How often a random value is drawn: "per machine", "per trial", …; empty if the value is not random.
  std::string draw_text(std::size_t slot) const;

 private:
  std::size_t slot_of(std::string_view name) const;
  /// [setting] Typical value of the parameter, in its unit, in each setting (condition at an age).
  std::vector<double> typical_values(std::size_t slot) const;

  const study::Study& study_;
  std::int64_t point_;
};

/// The axis at a design point as a block diagram in HTML, made from axis.html. Its blocks contain the
/// components that are switched on in some trial in some setting (condition at an age). page.css joins them
/// by arrows, from left to right on wide screens and paper, from top to bottom on phones.
std::string diagram_html(const study::Study& study, std::int64_t point);

/// A goal in words, in SI units: "±10 nm for good after 30 ms; true overshoot ≤ 1 µm; in 95 % of moves 0, 3
/// of 95 % of the machines, with 95 % confidence".
std::string requirement_text(const study::Goal& goal, const study::Study& study);

/// HTML table of each goal in each setting (condition at an age) at the chosen design point: the verdict with
/// bounds, and overshoot, peak torque and saturation of the moves. Without a goal it has only overshoot,
/// torque and saturation.
/// @param claims verdicts by goal, then by setting
std::string requirements_html(const ReportedStudy& reported, const std::vector<summary::CellOfPoint>& claims);

/// Parts of the first screen that the results file does not contain. A part that is not given is made from
/// the file.
struct FirstScreenParts {
  std::string warnings{};  ///< Warnings as HTML, placed above everything else.
  std::string headline{};
  std::vector<summary::CellOfPoint> claims{};  ///< Verdicts on the goals by goal, then by setting.
  /// Stability margins as HTML, shown instead of the margins that `check` prints; empty: those.
  std::string margins{};
};

/// The first screen of a page: the verdict, the axis as a diagram, the requirements with their verdicts, the
/// gains with the margins of the loops, and the assumptions.
PageSection first_screen(const ReportedStudy& reported, const FirstScreenParts& parts);

/// HTML of the axis diagram and the assumptions, for a study that has no results yet.
std::string axis_html(const study::Study& study, std::int64_t point);

}  // namespace zerocount::report
