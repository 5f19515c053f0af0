#include "analysis/record_fit/residual_line.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <unsupported/Eigen/FFT>

#include "analysis/parallel/parallel.hpp"
#include "analysis/record_fit/reading_replicates.hpp"
#include "analysis/record_fit/residual_checks.hpp"

namespace zerocount::record_fit {
namespace {

constexpr Eigen::Index longest_window = 1024;
constexpr Eigen::Index shortest_window = 64;
constexpr Eigen::Index transform_length = 2 * longest_window;
constexpr std::size_t replicates = 1000;

/// The samples of a ring-down.
struct Window {
  Eigen::Index first{0};
  Eigen::Index length{0};
};

std::vector<Window> ring_downs_of(const TestRecord& record) {
  std::vector<Window> windows;
  const bool is_even = std::all_of(record.intervals.begin(), record.intervals.end(), [&](double interval) {
    return std::abs(interval - record.sample_time) <= 1e-6 * record.sample_time;
  });
  if (!is_even) return windows;
  for (const TorqueHold& hold : record.parts.holds) {
    const auto length = static_cast<Eigen::Index>(hold.last - hold.first + 1);
    if (!hold.rings_down || length < shortest_window) continue;
    windows.push_back({static_cast<Eigen::Index>(hold.first), std::min(length, longest_window)});
  }
  return windows;
}

/// Values without their mean and slope, faded out towards the end: their beginning has the oscillation.
Eigen::VectorXd faded(const Eigen::VectorXd& values) {
  const Eigen::Index count = values.size();
  const Eigen::ArrayXd time = Eigen::ArrayXd::LinSpaced(count, -1.0, 1.0);
  const Eigen::ArrayXd centred = values.array() - values.mean();
  const double slope = (centred * time).sum() / time.square().sum();
  const Eigen::ArrayXd fade = 0.5 + 0.5 * (0.5 * std::numbers::pi * (time + 1.0)).cos();
  return (centred - slope * time) * fade;
}

/// [bin] Power of the residuals in the windows; bin i is the frequency i/(transform_length·T).
Eigen::ArrayXd power_of(const Eigen::VectorXd& residuals, const std::vector<Window>& windows) {
  Eigen::FFT<double> transform;
  transform.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  Eigen::VectorXcd spectrum;
  Eigen::ArrayXd power = Eigen::ArrayXd::Zero(transform_length / 2 + 1);
  for (const Window& window : windows) {
    Eigen::VectorXd padded = Eigen::VectorXd::Zero(transform_length);
    padded.head(window.length) = faded(residuals.segment(window.first, window.length));
    transform.fwd(spectrum, padded);
    power += spectrum.array().abs2();
  }
  return power;
}

/// Bins at which a line is looked for: from four periods in the longest window, outside of `own`.
std::vector<Eigen::Index> searched_bins(const TestRecord& record, const std::vector<Window>& windows,
                                        const FrequencyRange& own) {
  Eigen::Index longest = 0;
  for (const Window& window : windows) longest = std::max(longest, window.length);
  const double spacing = 1.0 / (static_cast<double>(transform_length) * record.sample_time);
  std::vector<Eigen::Index> bins;
  for (Eigen::Index bin = 4 * transform_length / longest; bin < transform_length / 2; ++bin) {
    const double frequency = static_cast<double>(bin) * spacing;
    if (frequency < own.low || frequency > own.high) bins.push_back(bin);
  }
  return bins;
}

/// The spectra of replicates of the readings along the path of a record.
struct UsualPower {
  Eigen::ArrayXd power;   ///< [bin] largest of the first half of the replicates
  double max_ratio{0.0};  ///< to `power`, of the other half
};

UsualPower usual_power(const TestRecord& record, const Eigen::VectorXd& path, double noise,
                       const std::vector<Window>& windows, const std::vector<Eigen::Index>& bins) {
  std::vector<Eigen::ArrayXd> spectra(replicates);
  parallel::for_each_index(replicates, [&](std::size_t i) {
    ReplicateNoise random(i);
    const double phase = 0.5 * std::erfc(random.next() / std::numbers::sqrt2);  // between two counts
    const Eigen::VectorXd moved = path.array() + phase;
    const Eigen::VectorXd readings = read_path(record, moved, noise, random);
    spectra[i] = power_of(readings - moved, windows)(bins);
  });
  constexpr double rounding = 1e-9;  // of the arithmetic, where the readings do not change
  UsualPower usual{Eigen::ArrayXd::Constant(static_cast<Eigen::Index>(bins.size()), rounding), 0.0};
  for (std::size_t i = 0; i < replicates / 2; ++i) usual.power = usual.power.max(spectra[i]);
  for (std::size_t i = replicates / 2; i < replicates; ++i) {
    usual.max_ratio = std::max(usual.max_ratio, (spectra[i] / usual.power).maxCoeff());
  }
  return usual;
}

/// The maximum of the power to which it rises from `bin`; nothing if that is at the edge of the searched
/// bins.
std::optional<Eigen::Index> peak_at(const Eigen::ArrayXd& power, const std::vector<Eigen::Index>& bins,
                                    Eigen::Index bin) {
  while (std::binary_search(bins.begin(), bins.end(), bin)) {
    const Eigen::Index next = power[bin + 1] > power[bin - 1] ? bin + 1 : bin - 1;
    if (power[next] <= power[bin]) return bin;
    bin = next;
  }
  return std::nullopt;
}

/// True if at least half of the power above the usual one lies within ±10 % of the frequency of `peak`.
bool is_narrow(const Eigen::ArrayXd& power, const Eigen::ArrayXd& usual,
               const std::vector<Eigen::Index>& bins, Eigen::Index peak) {
  constexpr double half_width = 0.1;
  const Eigen::ArrayXd excess = (power - usual).max(0.0);
  const auto centre = static_cast<double>(peak);
  double near = 0.0;
  for (Eigen::Index i = 0; i < excess.size(); ++i) {
    const auto bin = static_cast<double>(bins[static_cast<std::size_t>(i)]);
    if (std::abs(bin - centre) <= half_width * centre) near += excess[i];
  }
  return near >= 0.5 * excess.sum();
}

}  // namespace

std::optional<ResidualLine> residual_line(Records records, const FittedModel& model,
                                          const std::vector<double>& noise, const FrequencyRange& own) {
  std::optional<ResidualLine> line;
  constexpr double min_ratio = 2.0;  // to the largest by chance: the noise is known roughly
  double clearest = min_ratio;
  for (std::size_t r = 0; r < records.size(); ++r) {
    const TestRecord& record = records[r];
    const std::vector<Window> windows = ring_downs_of(record);
    if (windows.empty()) continue;
    const std::vector<Eigen::Index> bins = searched_bins(record, windows, own);
    if (bins.empty()) continue;
    const Eigen::VectorXd& path = model.motions[r].path;
    const Eigen::ArrayXd all = power_of(residuals_along(record, path), windows);
    const Eigen::ArrayXd power = all(bins);
    const UsualPower usual = usual_power(record, path, noise[r], windows, bins);
    Eigen::Index clear = 0;
    const double ratio = (power / usual.power).maxCoeff(&clear) / usual.max_ratio;
    const std::optional<Eigen::Index> peak = peak_at(all, bins, bins[static_cast<std::size_t>(clear)]);
    if (ratio <= clearest || !peak || !is_narrow(power, usual.power, bins, *peak)) continue;
    clearest = ratio;
    line = {r, static_cast<double>(*peak) / (static_cast<double>(transform_length) * record.sample_time)};
  }
  return line;
}

}  // namespace zerocount::record_fit
