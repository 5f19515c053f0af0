#include <algorithm>

#include <fmt/format.h>

#include "analysis/experiment_design/experiment_design.hpp"
#include "analysis/report/figures/answer_figures.hpp"
#include "analysis/report/figures/thinning.hpp"
#include "analysis/report/html.hpp"

namespace zerocount::report {
using experiment_design::ExperimentDesign;

Figure experiment_figure(const ExperimentDesign& design) {
  constexpr std::size_t buckets = 500;
  const auto torque = [&](std::size_t k) { return design.protocol.torque[k]; };
  const auto count = [&](std::size_t k) { return static_cast<double>(design.record.counts[k]); };
  const std::size_t samples = design.protocol.torque.size();
  const std::size_t length = std::max<std::size_t>(1, samples / buckets);
  std::vector<std::size_t> drawn;
  for (std::size_t first = 0; first < samples; first += length) {
    const auto kept = extreme_samples(first, std::min(first + length, samples), {torque, count});
    drawn.insert(drawn.end(), kept.begin(), kept.end());
  }
  constexpr int digits = 9;
  const auto time = [&](std::size_t k) { return static_cast<double>(k) * design.frame.sample_time; };
  Figure figure = figure_of(
      "experiment", "experiment", "The experiment",
      "Top: the $torque to command. Bottom: the readings that the machine with the median of every guess "
      "would give. "
      "All extremes of the samples are drawn.",
      {data_of<std::size_t>(
          "samples", drawn,
          {{{"time", "time", "s"}, [&](std::size_t k) { return datum(time(k), digits); }},
           {{"torque", "$torque", "N m"}, [&](std::size_t k) { return datum(torque(k)); }},
           {{"count", "reading", "counts"}, [&](std::size_t k) { return datum(count(k), digits); }}})});
  put_on_axis(figure, design.frame.axis);
  return figure;
}

}  // namespace zerocount::report
