#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/record/experiment_design/experiment_design.hpp"
#include "analysis/record/fit/presliding/identification.hpp"
#include "analysis/report/figures/answer_figures.hpp"
#include "analysis/trials/theory/point_theory.hpp"

namespace zerocount::report {
namespace {

using fit::FittedRecord;
using fit::Identification;
using fit::RecordSummary;
using nlohmann::ordered_json;

/// Half-width of the interval with 95 % of a normal distribution, in standard deviations.
constexpr double normal_95 = 1.96;

/// Largest number of groups of samples drawn per record: about two pixels each. If there are many records,
/// they share `all_buckets`, so that the page stays below 5 MB.
constexpr std::size_t max_buckets = 400;
constexpr std::size_t min_buckets = 20;
constexpr std::size_t all_buckets = 6000;

/// The unit in which a figure shows the readings of a record.
struct ShownUnit {
  std::string name;
  double size{1.0};  ///< Factor from the record's unit of readings to this unit.
};

ShownUnit shown_unit(const RecordSummary& record) {
  if (record.counted) return {"counts", 1.0};
  constexpr double micro = 1e-6;
  return {"µ" + parameters::unit_on(record.axis, "rad"), record.unit / micro};
}

/// Range of the angles in a figure: of the fitted values and of the readings, without the masked readings,
/// which may be far off.
theory::Range angle_range(const FittedRecord& record, const ShownUnit& unit) {
  theory::Range range;
  for (std::size_t k = 0; k < record.time.size(); ++k) {
    range.add(unit.size * record.fitted[k]);
    if (!record.excluded[k]) range.add(unit.size * record.reading[k]);
  }
  return range;
}

FigureData samples_data(const FittedRecord& record, const ShownUnit& unit, parameters::AxisKind axis,
                        const std::vector<std::size_t>& samples) {
  constexpr int digits = 9;  // of counts far from 0
  const auto angle = [&](double value, bool shown) {
    return shown ? datum(unit.size * value, digits) : ordered_json();
  };
  const auto used = [&](std::size_t k) { return !record.excluded[k]; };
  return data_of<std::size_t>(
      "samples", samples,
      {{{"time", "time", "s"}, [&](std::size_t k) { return datum(record.time[k], digits); }},
       {{"torque", parameters::text_on(axis, "$torque"), parameters::unit_on(axis, "N m")},
        [&](std::size_t k) { return datum(record.torque[k]); }},
       {{"reading", "measured", unit.name}, [&](std::size_t k) { return angle(record.reading[k], used(k)); }},
       {{"masked", "masked", unit.name}, [&](std::size_t k) { return angle(record.reading[k], !used(k)); }},
       {{"fitted", "fitted", unit.name}, [&](std::size_t k) { return angle(record.fitted[k], true); }},
       {{"residual", "residual", unit.name},
        [&](std::size_t k) { return used(k) ? datum(unit.size * residual(record, k)) : ordered_json(); }}});
}

/// Dataset of the time intervals with masked (unused) readings, each up to the next sample that is used.
FigureData masks_data(const FittedRecord& record) {
  FigureData data{"masks", {{"from", "", "s"}, {"to", "", "s"}}};
  const std::size_t samples = record.time.size();
  for (std::size_t first = 0; first < samples;) {
    std::size_t end = first;
    while (end < samples && record.excluded[end]) ++end;
    if (end > first)
      data.rows.push_back({datum(record.time[first], 9), datum(record.time[std::min(end, samples - 1)], 9)});
    first = end + 1;
  }
  return data;
}

FigureData band_data(double half_width) {
  return {"band", {{"low", "", ""}, {"high", "", ""}}, {{datum(-half_width), datum(half_width)}}};
}

std::string band_text(const RecordSummary& record, const ShownUnit& unit, double band) {
  const std::string text = fmt::format("The band of ±{:.3g} {} is", band, unit.name);
  if (!record.counted)
    return fmt::format(
        "{} 1.96 standard deviations of the noise, by the differences of successive residuals. ", text);
  if (record.noise == 0.0) return fmt::format("{} the rounding of the encoder. ", text);
  return fmt::format(
      "{} the rounding of the encoder, and 1.96 standard deviations of the noise ({:.3g} counts). ", text,
      record.noise);
}

std::string fit_caption(const RecordSummary& record, const ShownUnit& unit, double band, std::size_t drawn) {
  std::string caption = fmt::format(
      "{} samples in {:.4g} s. Top: the readings (wide line) and the readings that the fit expects (thin "
      "line) "
      "over time{}. Middle: the residuals, measured minus fitted; their root mean square is {:.3g} {}. {}"
      "Bottom: the {} over the measured and over the fitted {}. ",
      record.samples, record.duration,
      record.counted
          ? fmt::format("; one count is {:.4g} µ{}, and the fit is drawn half a count lower, because the "
                        "encoder rounds down",
                        1e6 * record.unit, parameters::unit_on(record.axis, "rad"))
          : "",
      unit.size * record.misfit, unit.name, band_text(record, unit, band),
      parameters::text_on(record.axis, "$torque"), parameters::text_on(record.axis, "$angle"));
  if (record.excluded > 0)
    caption += fmt::format(
        "Grey are the {} masked samples: the fit does not use their readings, so they have no residual. ",
        record.excluded);
  if (!record.note.empty()) caption += fmt::format("The record is {}. ", record.note);
  if (drawn < record.samples)
    caption += fmt::format("{} of the samples are drawn, among them all extremes. ", drawn);
  return caption;
}

Figure fit_figure(const RecordSummary& record, const FittedRecord& fit, std::size_t number,
                  std::size_t buckets) {
  const ShownUnit unit = shown_unit(record);
  const std::vector<std::size_t> samples = drawn_samples(fit, buckets);
  const double band = unit.size * residual_band(record, fit);
  Figure figure =
      figure_of("identification", fmt::format("record-{}", number), record.name,
                fit_caption(record, unit, band, samples.size()),
                {samples_data(fit, unit, record.axis, samples), masks_data(fit), band_data(band)});
  const theory::Range range = angle_range(fit, unit);
  figure.parameters["readings"] = {datum(range.low), datum(range.high)};
  if (record.excluded > 0) figure.parameters.update({{"masked", "masked"}, {"masked_colour", "var(--s8)"}});
  return figure;
}

}  // namespace

std::vector<std::size_t> drawn_samples(const FittedRecord& record, std::size_t buckets) {
  const std::size_t samples = record.time.size();
  const std::size_t length = std::max<std::size_t>(1, (samples + buckets - 1) / buckets);
  const std::vector<SampleQuantity> quantities{
      [&](std::size_t k) { return record.torque[k]; }, [&](std::size_t k) { return record.reading[k]; },
      [&](std::size_t k) { return record.fitted[k]; }, [&](std::size_t k) { return residual(record, k); }};
  return thinned_samples(samples, length, quantities,
                         [&](std::size_t k) { return record.excluded[k] != record.excluded[k - 1]; });
}

double reading_noise(const RecordSummary& record, const FittedRecord& fit) {
  if (record.counted) return record.noise;
  double squares = 0.0;
  double differences = 0.0;
  for (std::size_t k = 1; k < fit.time.size(); ++k) {
    if (fit.excluded[k] || fit.excluded[k - 1]) continue;
    const double difference = residual(fit, k) - residual(fit, k - 1);
    squares += difference * difference;
    differences += 1.0;
  }
  return differences > 0.0 ? std::sqrt(0.5 * squares / differences) : 0.0;
}

double residual_band(const RecordSummary& record, const FittedRecord& fit) {
  return (record.counted ? 0.5 : 0.0) + normal_95 * reading_noise(record, fit);
}

std::vector<Figure> identification_figures(const Identification& identification) {
  const std::size_t records = identification.records.size();
  const std::size_t buckets =
      std::clamp(all_buckets / std::max<std::size_t>(records, 1), min_buckets, max_buckets);
  std::vector<Figure> figures;
  for (std::size_t r = 0; r < records; ++r)
    figures.push_back(fit_figure(identification.records[r], identification.fitted[r], r + 1, buckets));
  return figures;
}

using experiment_design::ExperimentDesign;

Figure experiment_figure(const ExperimentDesign& design) {
  constexpr std::size_t buckets = 500;
  const auto torque = [&](std::size_t k) { return design.protocol.torque[k]; };
  const auto count = [&](std::size_t k) { return static_cast<double>(design.record.counts[k]); };
  const std::size_t samples = design.protocol.torque.size();
  const std::size_t length = std::max<std::size_t>(1, samples / buckets);
  constexpr int digits = 9;
  const auto time = [&](std::size_t k) { return static_cast<double>(k) * design.frame.sample_time; };
  Figure figure = figure_of(
      "experiment", "experiment", "The experiment",
      "Top: the $torque to command. Bottom: the readings that the machine with the median of every guess "
      "would give. "
      "All extremes of the samples are drawn.",
      {data_of<std::size_t>(
          "samples", thinned_samples(samples, length, {torque, count}),
          {{{"time", "time", "s"}, [&](std::size_t k) { return datum(time(k), digits); }},
           {{"torque", "$torque", "N m"}, [&](std::size_t k) { return datum(torque(k)); }},
           {{"count", "reading", "counts"}, [&](std::size_t k) { return datum(count(k), digits); }}})});
  put_on_axis(figure, design.frame.axis);
  return figure;
}

}  // namespace zerocount::report
