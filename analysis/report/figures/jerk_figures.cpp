#include <algorithm>

#include <fmt/format.h>

#include "analysis/basis/statistics/unknown.hpp"
#include "analysis/basis/text/text.hpp"
#include "analysis/report/figures/report_figures.hpp"
#include "analysis/trials/jerks/jerk_statistics.hpp"
#include "core/numerics/sign.hpp"

namespace zerocount::report {
namespace {

using nlohmann::ordered_json;

constexpr std::int64_t max_moves = 50;
constexpr std::int64_t max_jerks_of_a_row = 120;

/// A move with jerks (excursions of the position error from 0 after arrival), for a figure.
struct JerkingMove {
  std::int64_t row{0};
  std::int64_t move{0};
  trial::MoveOutcome outcome;
};

/// The moves with jerks (excursions of the position error from 0 after arrival) at a design point that
/// figures show.
struct ShownMoves {
  std::int64_t all{0};
  std::vector<JerkingMove> shown;
};

ShownMoves shown_moves(const ReportedStudy& reported, std::int64_t point) {
  ShownMoves moves;
  const layout::RowRange rows = rows_of(reported, point);
  const auto visit_jerking = [&](const auto& act) {
    std::int64_t index = 0;
    measures::visit_trials(
        reported.file, rows, [&](std::int64_t row, std::span<const trial::MoveOutcome> outcomes) {
          for (std::size_t move = 0; move < outcomes.size(); ++move) {
            if (outcomes[move].jerk_count > 0)
              act(index++, JerkingMove{row, static_cast<std::int64_t>(move), outcomes[move]});
          }
        });
  };
  visit_jerking([&](std::int64_t, const JerkingMove&) { ++moves.all; });
  const std::vector<std::int64_t> chosen = statistics::spread_over(moves.all, max_moves);
  visit_jerking([&](std::int64_t index, const JerkingMove& move) {
    if (std::binary_search(chosen.begin(), chosen.end(), index)) moves.shown.push_back(move);
  });
  return moves;
}

std::int64_t add_jerks(FigureData& data, const reading::AllTrialsFile& file, const JerkingMove& move,
                       std::int64_t number) {
  std::int64_t left_out = 0;
  std::int64_t added = 0;
  for (const layout::JerkRecord& jerk : file.jerks({move.row, 1})) {
    if (jerk.move != move.move) continue;
    if (added == max_jerks_of_a_row) {
      ++left_out;
      continue;
    }
    ++added;
    const bool towards = jerk.direction == numerics::sign_of(move.outcome.holding_torque);
    data.rows.push_back(ordered_json::array(
        {number, move.row % file.header().trials, move.move, datum(jerk.onset - move.outcome.arrival_time),
         datum(jerk.duration), jerk.magnitude, towards ? "towards the holding torque" : "against it"}));
  }
  return left_out;
}

/// Sentence on the cause of the jerks (excursions of the position error from 0 after arrival) that their
/// directions suggest.
std::string direction_sentence(const statistics::ClusteredProportion& agreement) {
  const std::string proportion = text::percentage(agreement.hits, agreement.events);
  if (agreement.hits == agreement.events)
    return fmt::format(
        "All {} jerks of the point go in the direction of the holding $torque, as creep makes them.",
        agreement.events);
  return fmt::format(
      "{} of the {} jerks of the point go in the direction of the holding $torque, as creep makes "
      "them; the others have another cause, such as a coarse DAC or noise.",
      proportion, agreement.events);
}

/// Sentence on whether the intervals between the jerks of a move grow, and whether the rate of jerks falls:
/// only both together show that jerks become rarer.
std::string trend_sentence(const jerks::JerkStatistics& jerks) {
  if (jerks.slowing.moves == 0) return "";
  constexpr double level = 0.05;
  const std::string test = fmt::format("p {}", text::short_number(jerks.slowing.p_slowing));
  if (jerks.slowing.p_slowing > level)
    return fmt::format(" That their intervals grow within a move is not shown ({}).", test);
  const bool rate_falls =
      jerks.rates.size() >= 2 && jerks.rates.back().bounds.high < jerks.rates.front().bounds.low;
  return rate_falls
             ? fmt::format(" They become rarer: intervals grow within a move ({}), and the rate falls.", test)
             : fmt::format(
                   " Their intervals grow within a move ({}); that the rate of all falls is not "
                   "shown.",
                   test);
}

Figure raster(const ReportedStudy& reported, std::int64_t point, const jerks::JerkStatistics& jerks) {
  const ShownMoves moves = shown_moves(reported, point);
  FigureData data{"jerks",
                  {{"row", "", "1"},
                   {"trial", "trial of the point", "1"},
                   {"move", "move", "1"},
                   {"since_arrival", "time since arrival", "s"},
                   {"duration", "duration", "s"},
                   {"magnitude", "magnitude", "count"},
                   {"towards", "direction", ""}}};
  std::int64_t left_out = 0;
  std::int64_t number = 0;
  for (const JerkingMove& move : moves.shown) left_out += add_jerks(data, reported.file, move, number++);
  std::string caption = fmt::format(
      "Each row is a move of point {}, from its arrival on; each mark is the onset of a jerk, coloured by "
      "its direction. {}{} ",
      label_of(reported, point), direction_sentence(jerks.agreement), trend_sentence(jerks));
  if (std::ssize(moves.shown) < moves.all) {
    caption += fmt::format("Shown are {} of the {} moves with jerks, evenly spaced. ", moves.shown.size(),
                           moves.all);
  }
  if (left_out > 0) {
    caption += fmt::format("Of each move at most {} jerks are shown; {} later ones are omitted. ",
                           max_jerks_of_a_row, left_out);
  }
  return figure_of("jerk-raster", "jerk-raster", "When do single moves jerk?", caption, {std::move(data)});
}

std::optional<Figure> rate(const ReportedStudy& reported, std::int64_t point,
                           const jerks::JerkStatistics& jerks) {
  if (jerks.rates.size() < 2) return std::nullopt;
  using Rate = const jerks::JerkRate&;
  FigureData data = data_of<jerks::JerkRate>(
      "rates", jerks.rates,
      {{{"from", "time since arrival from", "s"}, [](Rate r) { return datum(r.from); }},
       {{"to", "to", "s"}, [](Rate r) { return datum(r.to); }},
       {{"rate", "jerk rate", "1/s"}, [](Rate r) { return datum(r.rate); }},
       {{"low", "lower 95 % bound", "1/s"}, [](Rate r) { return datum(r.bounds.low); }},
       {{"high", "upper 95 % bound", "1/s"}, [](Rate r) { return datum(r.bounds.high); }},
       {{"jerks", "jerks", "1"}, [](Rate r) { return r.jerks; }},
       {{"moves", "moves", "1"}, [](Rate r) { return r.moves; }},
       {{"exposure", "exposure", "s"}, [](Rate r) { return datum(r.exposure); }}});
  Figure figure = figure_of(
      "jerk-rate", "jerk-rate", "How often are there jerks after the arrival?",
      fmt::format(
          "Number of jerks per second after arrival at point {}, over all moves that "
          "arrived (line), against the time since arrival. The boxes are 95 % bounds of the rate in each "
          "range of time (Garwood, widened if trials differ), for each range separately.",
          label_of(reported, point)),
      {std::move(data)});
  const bool from_zero = jerks.rates.front().from == 0.0;  // which a logarithmic axis cannot show
  figure.parameters["scale"] = from_zero ? "symlog" : "log";
  if (from_zero) figure.parameters["constant"] = jerks.rates.front().to;
  return figure;
}

}  // namespace

std::vector<Figure> jerk_figures(const ReportedStudy& reported) {
  const std::int64_t point = reported.chosen.point;
  if (point_of(reported, point).of(&trial::MoveOutcome::jerk_count).total == 0) return {};
  const jerks::JerkStatistics jerks = jerks::jerk_statistics(reported.file, reported.study, point);
  std::vector<Figure> figures{raster(reported, point, jerks)};
  if (std::optional<Figure> rates = rate(reported, point, jerks)) figures.push_back(std::move(*rates));
  return figures;
}

}  // namespace zerocount::report
