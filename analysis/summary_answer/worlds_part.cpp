#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

#include "analysis/goal/goal_description.hpp"
#include "analysis/summary/worlds_description.hpp"
#include "analysis/summary/worlds_of_point.hpp"
#include "analysis/summary_answer/parts.hpp"
#include "analysis/text/percent.hpp"
#include "analysis/text/text.hpp"

namespace zerocount::summary_answer {
namespace {

using document::Bounded;
using document::Notation;
using document::Shown;
using Point = const PointReading&;
using Worlds = const worlds::PointWorlds&;

bool has_parts(const summary::StudySummary& summary) {
  return summary.question.worlds > 0 && !summary.features.open_loop;
}

bool has_worlds(Point p) {
  return p.worlds.has_value();
}

/// A number of the worlds at a point; nothing where a world has no trials.
template <class Value>
auto of_worlds(Value value) {
  using Result = std::optional<std::invoke_result_t<Value, Worlds>>;
  return [value](Point p) { return p.worlds ? Result(value(*p.worlds)) : std::nullopt; };
}

// Of the rate that the study is judged by.
Bounded worst_asked(Worlds w) {
  return goal::bounded(w.asked.lowest);
}
double median_asked(Worlds w) {
  return w.asked.median;
}
double best_asked(Worlds w) {
  return w.asked.worlds[w.asked.best].value;
}

// Of success.
Bounded worst(Worlds w) {
  return goal::bounded(w.success.lowest);
}
double median(Worlds w) {
  return w.success.median;
}
double best(Worlds w) {
  return w.success.worlds[w.success.best].value;
}
auto worlds_with(goal::Status status) {
  return [status](Worlds w) { return std::ssize(goal::worlds_that(status, *w.goal)); };
}

/// A sentence for each of the first points, on what their bad worlds have in common.
std::string note_on_worlds(const SummaryReading& s) {
  constexpr std::size_t max_sentences = 12;
  const auto label = short_label(s.summary);
  std::string text;
  std::size_t points = 0;
  for (const PointReading& p : s.points) {
    if (!p.worlds || ++points > max_sentences) continue;
    text += fmt::format("{}: {}\n", label(p),
                        summary::bad_worlds_sentence(*p.worlds, summary::world_inputs_of(s.summary, p.point),
                                                     s.summary.question));
  }
  if (points == 0) return {};
  if (points > max_sentences)
    text += fmt::format("and {} more points (--format json has their rules)\n", points - max_sentences);
  return text + fmt::format("bounds of one side each, of the lowest rate of all worlds, with {} confidence",
                            text::percent(goal::confidence_of(s.summary.question, s.summary.confidence)));
}

}  // namespace

void add_worlds(PointDescription& point, const summary::StudySummary& summary) {
  if (!has_parts(summary)) return;
  const auto column = [](const char* key, const char* meaning) {
    return document::Item{.key = key, .meaning = meaning, .unit = "1", .shown = Shown::in_csv};
  };
  point
      .object({.key = "worlds", .meaning = "the worlds at the point", .shown = Shown::in_json},
              summary::worlds_description(),
              [](Point p) -> std::optional<summary::WorldsReading> {
                if (!p.worlds) return std::nullopt;
                return summary::WorldsReading{*p.worlds, summary::world_inputs_of(p.summary, p.point)};
              })
      .value(column("worlds_success_worst", "success rate of the world with the lowest"), of_worlds(worst))
      .value(column("worlds_success_median", "median of the success rates of the worlds"), of_worlds(median))
      .value(column("worlds_success_best", "success rate of the world with the highest"), of_worlds(best));
  if (!summary.question.claim()) return;
  point
      .value(column("worlds_goal_met", "worlds in which the goal is met"),
             of_worlds(worlds_with(goal::Status::met)))
      .value(column("worlds_goal_missed", "worlds in which the goal is missed"),
             of_worlds(worlds_with(goal::Status::missed)));
}

void add_worlds(SummaryDescription& answer, const summary::StudySummary& summary) {
  if (!has_parts(summary)) return;
  const auto column = [](std::string heading) {
    return document::Item{.heading = std::move(heading), .unit = "1", .notation = Notation::percent};
  };
  PointDescription columns = labelled_points(summary);
  columns
      .value(column(fmt::format("{} worst [bounds]", goal::judged_head(summary.question))),
             of_worlds(worst_asked))
      .value(column("median"), of_worlds(median_asked))
      .value(column("best"), of_worlds(best_asked));
  if (summary.question.claim()) {
    for (const goal::Status status : {goal::Status::met, goal::Status::missed, goal::Status::undecided})
      columns.value({.heading = fmt::format("goal {}", goal::text_of(status))},
                    of_worlds(worlds_with(status)));
  }
  answer
      .table({.heading = fmt::format("by world: the lowest, median and highest rate of {} worlds",
                                     summary.question.worlds),
              .shown = Shown::to_people},
             columns, [](const SummaryReading& s) { return points_that(s, has_worlds); })
      .sentence(note_on_worlds);
}

}  // namespace zerocount::summary_answer
