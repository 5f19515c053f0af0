#pragma once

#include "analysis/document/description.hpp"
#include "analysis/summary_answer/point_reading.hpp"

namespace zerocount::summary_answer {

/// A design point in data, by names as in datasets.md, and as a row for people: what the study has. A column
/// for people has its line of the legend as its meaning, or none.
/// @param summary of the study; its points decide which columns people are shown
document::Description<PointReading> point_description(const summary::StudySummary& summary);

/// A level of a point of an open-loop study, likewise.
document::Description<LevelReading> level_description(const summary::StudySummary& summary);

/// The meanings of the columns for people, a line each.
std::string legend_of(const std::vector<document::Item>& columns);

}  // namespace zerocount::summary_answer
