#pragma once

#include <string>
#include <vector>

#include "analysis/summary/summary.hpp"
#include "analysis/text/text.hpp"

/// Parts of the summary of a study, which summary_table, summary_json and summary_csv put together.
namespace zerocount::summary {

/// "95 % bounds", with the confidence of the summary: the head of a column of them.
std::string bounds_head(const StudySummary& summary);

/// A quantile of the settling times of all moves of a point, or a bound of it, as text: four significant
/// digits, "> 1 s" if it is not reached within the hold, "> hold" if trials differ in theirs, "–" if there is
/// no move with a target.
/// @param time s; NaN if not reached
std::string settling_text(const measures::PointSummary& point, double time);

/// What tells the points apart: their labels, and a column for each swept parameter with its unit in the
/// head, where these are few. In a grid, whose labels only repeat the swept values, the number of the point
/// takes the place of the label.
std::vector<text::TextColumn> sweep_columns(const StudySummary& summary);

/// The table of a study with targets, and what its columns mean.
std::vector<text::TextColumn> loop_columns(const StudySummary& summary);
std::string loop_legend(const StudySummary& summary);

/// What the design of the study means for the bounds, one line or two.
std::string design_line(const StudySummary& summary);

/// The table of an open-loop study, a row per point and level, and what its columns mean.
std::vector<text::TextColumn> level_columns(const StudySummary& summary);
std::string level_legend();

/// What was observed on the real rig, [point]; empty where nothing was at any point.
std::vector<std::string> observations(const StudySummary& summary);

/// The levels of a point: an array of objects with the names of level_fields(), by group.
nlohmann::ordered_json levels_json(const measures::PointSummary& point);

}  // namespace zerocount::summary
