#include "analysis/basis/text/text.hpp"
#include "analysis/report/figures/figure.hpp"
#include "core/numerics/roots.hpp"
#include "runners/design_commands/tune/tune_answer.hpp"

namespace zerocount::design_commands {
namespace {

using tuning::Values;

/// Result of this extra: for each free parameter, the range in which all goals seem to be met.
using Rooms = std::vector<Room>;

constexpr std::int64_t points_of_parameter = 24;  // at most; usually half of them

tuning::ExtraCost cost_of_room(const tuning::TunedAxis& axis) {
  const std::int64_t points = points_of_parameter * std::ssize(axis.free());
  return {
      .applies = axis.is_met, .points = points, .trials = points * axis.trials_of_point(), .usual_part = 0.5};
}

Room room_of(std::size_t parameter, const tuning::TunedAxis& axis) {
  const tuning::UnitCubePoint place = tuning::place_of(axis.free(), axis.values);
  const auto values = [&](double fraction) {
    tuning::UnitCubePoint moved = place;
    moved[parameter] = fraction;
    Values at = axis.values;
    at[parameter] = tuning::values_at(axis.free(), moved)[parameter];
    return at;
  };
  std::optional<std::size_t> lost;
  const auto holds = [&](double fraction) {
    const std::optional<study::Study> study = tuning::at_values(axis.tuned, axis.free(), values(fraction));
    if (!study) return false;
    const std::optional<std::size_t> claim = axis.lost_claim(*study, nullptr);
    if (claim) lost = claim;
    return !claim;
  };
  // Outwards in steps, because the goal may be lost and met again farther off.
  const auto end = [&](double to, std::optional<std::size_t>& lost_beyond) {
    constexpr int steps = 8;
    constexpr int halvings = 4;
    double kept = place[parameter];
    for (int step = 1; step <= steps; ++step) {
      const double next = place[parameter] + (to - place[parameter]) * step / steps;
      if (!holds(next)) {
        const double last = numerics::bisect({kept, next}, holds, numerics::after_halvings(halvings)).holds;
        lost_beyond = lost;
        return last;
      }
      kept = next;
    }
    return to;
  };
  Room room{.name = axis.free()[parameter].name};
  room.low = values(end(0.0, room.lost_below))[parameter];
  room.high = values(end(1.0, room.lost_above))[parameter];
  return room;
}

std::any find_room(tuning::TunedAxis& axis) {
  Rooms rooms;
  for (std::size_t i = 0; i < axis.free().size(); ++i) rooms.push_back(room_of(i, axis));
  return rooms;
}

struct RoomRow {
  const Room& room;
  const std::string& unit;
  const study::Study& study;

  /// Text that names a claim (goal in a setting) if there are several, such as " 'small' under condition
  /// loaded"; empty without a claim.
  /// @param claim index in Aim::claims
  std::string text_of(const std::optional<std::size_t>& claim) const {
    return claim ? claim_text(study, tuning::place_of_claim(study, *claim)) : "";
  }
};

std::vector<RoomRow> room_rows(const Tuning& tuning) {
  const Rooms& rooms = found_by_extra<Rooms>(tuning);
  std::vector<RoomRow> rows;
  for (std::size_t i = 0; i < rooms.size(); ++i)
    rows.push_back({rooms[i], tuning.answer.free[i].unit, tuning.study});
  return rows;
}

document::Description<RoomRow> room_columns() {
  return document::Description<RoomRow>()
      .value({.heading = "parameter"}, [](const RoomRow& row) { return row.room.name; })
      .value({.heading = "goal seems met from"}, [](const RoomRow& row) { return row.room.low; })
      .value({.heading = "to"}, [](const RoomRow& row) { return row.room.high; })
      .value({.heading = "unit"}, [](const RoomRow& row) { return row.unit; })
      .value({.heading = "lost below"}, [](const RoomRow& row) { return row.text_of(row.room.lost_below); })
      .value({.heading = "lost above"}, [](const RoomRow& row) { return row.text_of(row.room.lost_above); });
}

std::vector<document::Figure> room_figures(const Tuning& tuning) {
  const Rooms& rooms = found_by_extra<Rooms>(tuning);
  if (!is_drawn(tuning) || rooms.empty()) return {};
  const tuning::TuneAnswer& answer = tuning.answer;
  Values low, high;
  for (const Room& one : rooms) {
    low.push_back(one.low);
    high.push_back(one.high);
  }
  const tuning::UnitCubePoint tuned = tuning::place_of(answer.free, answer.tuned.values);
  const tuning::UnitCubePoint low_place = tuning::place_of(answer.free, low);
  const tuning::UnitCubePoint high_place = tuning::place_of(answer.free, high);
  document::FigureData data{"room",
                            {{"parameter", "parameter", ""},
                             {"tuned", "tuned", ""},
                             {"low", "goal seems met from", ""},
                             {"high", "to", ""},
                             {"range", "", ""},
                             {"place", "", ""},
                             {"low_place", "", ""},
                             {"high_place", "", ""}}};
  using report::datum;
  for (std::size_t i = 0; i < rooms.size(); ++i) {
    data.rows.push_back({rooms[i].name, datum(answer.tuned.values[i]), datum(low[i]), datum(high[i]),
                         text::range_text(low[i], high[i], answer.free[i].unit), datum(tuned[i]),
                         datum(low_place[i]), datum(high_place[i])});
  }
  return {report::figure_of("tuning-room", "tuning-room", "How far may each parameter move?",
                            "The interval around the tuned value in which the goal seems met, the others as "
                            "tuned, by simulation on machines of the search, with its ends.",
                            {std::move(data)})};
}

void describe_room(Items& items) {
  items
      .value(document::in_data("room",
                               "range of each parameter in which the goal seems met, the others as tuned"),
             [](const Tuning& t) {
               std::vector<std::pair<std::string, std::vector<double>>> ranges;
               for (const Room& one : found_by_extra<Rooms>(t))
                 ranges.emplace_back(one.name, std::vector{one.low, one.high});
               return ranges;
             })
      .table({.heading = "room of each parameter, the others as tuned",
              .shown = document::Visibility::to_people},
             room_columns(), room_rows)
      .figures(room_figures);
}

}  // namespace

tuning::Extra room_extra() {
  return {.name = "room",
          .question = "How much may each value change?",
          .cost = cost_of_room,
          .run = find_room,
          .describe = describe_room};
}

}  // namespace zerocount::design_commands
