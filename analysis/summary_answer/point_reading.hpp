#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/goal/goal_verdict.hpp"
#include "analysis/summary/chosen_point.hpp"
#include "analysis/summary/observed_comparison.hpp"
#include "analysis/summary/summary.hpp"
#include "analysis/worlds/world_statistics.hpp"

/// The summary of a study as an answer.
namespace zerocount::summary_answer {

/// A design point, with what is found out of it alone.
struct PointReading {
  const summary::StudySummary& summary;
  std::int64_t point{0};
  bool marked{false};                      ///< it is the chosen one of several
  std::optional<goal::Verdict> verdict{};  ///< with a goal, of a point with trials
  std::optional<worlds::PointWorlds> worlds{};
  std::optional<summary::ObservedComparison> observed{};  ///< where counts were observed on the real rig

  std::size_t index() const { return static_cast<std::size_t>(point); }
  const std::string& label() const { return summary.labels[index()]; }
  const measures::PointSummary& statistics() const { return summary.points[index()]; }
};

/// The level of a point of an open-loop study.
struct LevelReading {
  const PointReading& point;
  std::size_t level{0};

  const measures::LevelStatistics& statistics() const { return point.statistics().levels[level]; }
};

/// A design point run again with a fresh seed.
struct Confirmation {
  std::int64_t point{0};
  std::uint64_t seed{0};
  std::int64_t trials{0};
  std::int64_t rigs{0};                       ///< 0: no trials share one that they were drawn for
  std::int64_t successes{0};                  ///< trials all of whose moves ended at zero error
  std::vector<measures::CellCounts> goals{};  ///< [goal]
};

/// How a summary is shown.
struct SummaryForm {
  std::vector<std::int64_t> points{};    ///< that are shown, in their order; empty: all
  std::optional<std::int64_t> chosen{};  ///< point that the headline is of; nothing: the best
  bool legend{false};                    ///< the columns of the tables are explained
};

/// A summary with all that its answer needs.
struct SummaryReading {
  const summary::StudySummary& summary;
  summary::ChosenPoint chosen;
  std::vector<PointReading> points;  ///< those that are shown, in their order
  bool legend{false};
  std::optional<Confirmation> confirmation{};

  std::vector<LevelReading> levels() const;
};

PointReading read_point(const summary::StudySummary& summary, std::int64_t point);

/// @param summary stays as long as the reading
/// @throws Failure (bad_data) unless the summary is consistent
SummaryReading read_summary(const summary::StudySummary& summary, const SummaryForm& form = {});

}  // namespace zerocount::summary_answer
