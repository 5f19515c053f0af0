#include "analysis/record/fit/residuals.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include <fmt/format.h>
#include <unsupported/Eigen/FFT>

#include "analysis/basis/parallel/parallel.hpp"
#include "analysis/basis/statistics/quantile.hpp"
#include "analysis/record/fit/observations.hpp"
#include "core/numerics/dense.hpp"
#include "core/random/random_numbers.hpp"

namespace zerocount::fit {
namespace {

/// Normalised residuals (observed − modelled angle)/√variance of all observations along the paths, plus the
/// effect of `step` in the linearised model.
/// @param paths [record] modelled path
/// @param step change of all unknowns; empty: 0
std::vector<double> residuals_along(const FittedModel& model, const std::vector<Eigen::VectorXd>& paths,
                                    const Observations& observations, const Eigen::VectorXd& step) {
  std::vector<double> residuals;
  for (std::size_t r = 0; r < observations.size(); ++r) {
    const Eigen::MatrixXd& sensitivity = model.motions[r].sensitivity;
    for (const AngleObservation& observation : observations[r]) {
      double modelled = mean_over(observation, paths[r]).value();
      if (step.size() > 0) {
        modelled += (mean_over(observation, sensitivity) * step.head(sensitivity.cols())).value() +
                    step[sensitivity.cols() + static_cast<Eigen::Index>(r)];
      }
      residuals.push_back((observation.position - modelled) / std::sqrt(observation.variance));
    }
  }
  return residuals;
}

constexpr Eigen::Index longest_window = 1024;
constexpr Eigen::Index shortest_window = 64;
constexpr Eigen::Index transform_length = 2 * longest_window;
constexpr std::size_t spectrum_replicates = 1000;

/// First and last sample of the part of a ring-down (oscillation after a step of the torque) that is
/// examined.
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

/// The values without their mean and slope, weighted less and less towards the end, because the oscillation
/// is at the beginning.
Eigen::VectorXd faded(const Eigen::VectorXd& values) {
  const Eigen::Index count = values.size();
  const Eigen::ArrayXd time = Eigen::ArrayXd::LinSpaced(count, -1.0, 1.0);
  const Eigen::ArrayXd centred = values.array() - values.mean();
  const double slope = (centred * time).sum() / time.square().sum();
  const Eigen::ArrayXd fade = 0.5 + 0.5 * (0.5 * std::numbers::pi * (time + 1.0)).cos();
  return (centred - slope * time) * fade;
}

/// [bin] Power spectrum of the residuals in the windows, summed over the windows; bin i is the frequency
/// i/(transform_length·T).
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

/// Frequency bins at which a peak is searched: from four periods in the longest window on, except for the
/// frequencies `own` of the model's oscillation.
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

/// The usual power of the residuals: spectra of simulated replicates of the readings along the path of a
/// record.
struct UsualPower {
  /// [frequency bin] Usual power: the largest power in the first half of the replicates.
  Eigen::ArrayXd power;
  /// Largest ratio, over all bins, of the power in the other half of the replicates to `power`.
  double max_ratio{0.0};
};

UsualPower usual_power(const TestRecord& record, const Eigen::VectorXd& path, double noise,
                       const std::vector<Window>& windows, const std::vector<Eigen::Index>& bins) {
  std::vector<Eigen::ArrayXd> spectra(spectrum_replicates);
  parallel::for_each_index(spectrum_replicates, [&](std::size_t i) {
    ReplicateNoise random(i);
    const double phase = 0.5 * std::erfc(random.next() / std::numbers::sqrt2);  // between two counts
    const Eigen::VectorXd moved = path.array() + phase;
    const Eigen::VectorXd readings = read_path(record, moved, noise, random);
    spectra[i] = power_of(readings - moved, windows)(bins);
  });
  constexpr double rounding = 1e-9;  // of the arithmetic, where the readings do not change
  UsualPower usual{Eigen::ArrayXd::Constant(static_cast<Eigen::Index>(bins.size()), rounding), 0.0};
  for (std::size_t i = 0; i < spectrum_replicates / 2; ++i) usual.power = usual.power.max(spectra[i]);
  for (std::size_t i = spectrum_replicates / 2; i < spectrum_replicates; ++i) {
    usual.max_ratio = std::max(usual.max_ratio, (spectra[i] / usual.power).maxCoeff());
  }
  return usual;
}

/// Bin of the local maximum to which the power rises from `bin`; null if the maximum is at the edge of the
/// searched bins.
std::optional<Eigen::Index> peak_at(const Eigen::ArrayXd& power, const std::vector<Eigen::Index>& bins,
                                    Eigen::Index bin) {
  while (std::binary_search(bins.begin(), bins.end(), bin)) {
    const Eigen::Index next = power[bin + 1] > power[bin - 1] ? bin + 1 : bin - 1;
    if (power[next] <= power[bin]) return bin;
    bin = next;
  }
  return std::nullopt;
}

/// True if the peak is narrow: at least half of the power above the usual one lies within ±10 % of the
/// frequency of `peak`.
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

constexpr double min_chance = 0.01;

double spread_of(const ResidualStatistics& residuals) {
  return std::sqrt(residuals.squares / static_cast<double>(residuals.observations));
}

/// Estimated p-value: proportion of the replicates for which `extreme` holds, with the record itself counted
/// as one of them.
template <class Extreme>
double proportion(const std::vector<ResidualStatistics>& replicates, Extreme extreme) {
  const auto count = std::count_if(replicates.begin(), replicates.end(), extreme);
  return static_cast<double>(count + 1) / static_cast<double>(replicates.size() + 1);
}

/// Standard deviation of normally distributed residuals, estimated from the median of their magnitudes.
double robust_deviation(const std::vector<double>& magnitudes) {
  constexpr double deviation_over_median = 1.4826;
  return deviation_over_median * statistics::upper_median(magnitudes);
}

}  // namespace

ReplicateNoise::ReplicateNoise(std::size_t replicate) : replicate_(replicate) {}

double ReplicateNoise::next() {
  // An arbitrary but constant key, so that results are reproducible.
  constexpr random::RandomStream stream{{0x1d3a71f1U, 0xca710bb5U}, 0};
  return random::standard_normal(random::random_bits(stream, replicate_, draw_++));
}

Eigen::VectorXd ReplicateNoise::next(Eigen::Index size) {
  return Eigen::VectorXd::NullaryExpr(size, [this] { return next(); });
}

Eigen::VectorXd read_path(const TestRecord& record, const Eigen::VectorXd& path, double noise,
                          ReplicateNoise& random) {
  Eigen::VectorXd readings = path;
  if (noise > 0.0) readings += noise * random.next(path.size());
  if (record.counted) readings = readings.array().floor();
  return readings;
}

ResidualStatistics residual_statistics(const std::vector<double>& residuals) {
  ResidualStatistics statistics;
  statistics.observations = residuals.size();
  for (const double residual : residuals) statistics.squares += residual * residual;
  if (residuals.empty()) return statistics;
  statistics.runs = 1.0;
  for (std::size_t i = 1; i < residuals.size(); ++i) {
    if (std::signbit(residuals[i]) != std::signbit(residuals[i - 1])) statistics.runs += 1.0;
  }
  if (statistics.squares == 0.0) return statistics;
  for (std::size_t lag = 1; lag < residuals.size() / 4; ++lag) {
    double product = 0.0;
    for (std::size_t i = lag; i < residuals.size(); ++i) product += residuals[i] * residuals[i - lag];
    if (product <= 0.0) break;
    statistics.correlation_length += 2.0 * product / statistics.squares;
  }
  return statistics;
}

ResidualStatistics residual_statistics(const FittedModel& model, const Observations& observations) {
  std::vector<Eigen::VectorXd> paths;
  for (const RecordMotion& motion : model.motions) paths.push_back(motion.path);
  return residual_statistics(residuals_along(model, paths, observations, {}));
}

ReadingReplicates replicate_readings(Records records, const Fit& fit, std::size_t replicates,
                                     std::size_t first) {
  const auto& [setting, model, noise, last_observations] = fit;
  const Observations observations = observations_along(records, model, noise);
  const Eigen::MatrixXd matrix = normal_equations(model, observations, setting).matrix;
  const Eigen::MatrixXd root = numerics::cholesky_factor(matrix);

  const Eigen::Index dimension = dimension_of(setting.model);
  ReadingReplicates result;
  result.errors.resize(static_cast<Eigen::Index>(replicates), matrix.rows());
  result.residuals.resize(replicates);
  parallel::for_each_index(replicates, [&](std::size_t i) {
    ReplicateNoise random(first + i);
    // The textbook covariance is matrix⁻¹. With matrix = L·Lᵀ, L⁻ᵀz has this covariance.
    const Eigen::VectorXd away =
        truth_spread * numerics::solve_transposed_factor(root, random.next(matrix.rows()));
    NormalEquationsSum sum(records.size(), setting);
    Observations read(records.size());
    std::vector<Eigen::VectorXd> paths;
    for (std::size_t r = 0; r < records.size(); ++r) {
      const RecordMotion& motion = model.motions[r];
      Eigen::VectorXd& path = paths.emplace_back(motion.path);
      path.noalias() += motion.sensitivity * away.head(dimension);
      path.array() += away[dimension + static_cast<Eigen::Index>(r)];
      const Eigen::VectorXd readings = read_path(records[r], path, noise[r], random);
      observe(records[r], path, readings, noise[r], read[r]);
      sum.add(r, read[r], path, motion.sensitivity);
    }
    NormalEquations equations = sum.with_prior(setting.prior);
    // The error of the prior is drawn too: coordinates that only the prior determines keep its uncertainty.
    for (Eigen::Index j = 0; j < dimension; ++j) {
      if (setting.free[static_cast<std::size_t>(j)])
        equations.gradient[j] += random.next() / setting.prior_spread;
    }
    const Eigen::VectorXd error = numerics::solve_positive_definite(equations.matrix, equations.gradient);
    result.errors.row(static_cast<Eigen::Index>(i)) = error;
    result.residuals[i] = residual_statistics(residuals_along(model, paths, read, error));
  });
  return result;
}

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

ResidualChecks check_residuals(const ResidualStatistics& residuals,
                               const std::vector<ResidualStatistics>& replicates) {
  ResidualChecks checks;
  checks.observations = residuals.observations;
  checks.spread = spread_of(residuals);
  checks.runs = residuals.runs;
  checks.correlation_length = residuals.correlation_length;
  const auto count = static_cast<double>(replicates.size());
  checks.expected_correlation_length = 0.0;
  for (const ResidualStatistics& replicate : replicates) {
    checks.expected_spread += spread_of(replicate) / count;
    // Scaled to the record's number of observations.
    checks.expected_runs += replicate.runs / static_cast<double>(replicate.observations) *
                            static_cast<double>(residuals.observations) / count;
    checks.expected_correlation_length += replicate.correlation_length / count;
  }
  checks.spread_chance = proportion(
      replicates, [&](const ResidualStatistics& replicate) { return spread_of(replicate) >= checks.spread; });
  const auto off = [&](const ResidualStatistics& statistics) {
    const double scale =
        static_cast<double>(residuals.observations) / static_cast<double>(statistics.observations);
    return std::abs(statistics.runs * scale - checks.expected_runs);
  };
  const double off_here = off(residuals);
  checks.runs_chance =
      proportion(replicates, [&](const ResidualStatistics& replicate) { return off(replicate) >= off_here; });
  checks.passed = (checks.spread_chance >= min_chance && checks.runs_chance >= min_chance) ||
                  checks.spread < 0.5 * checks.expected_spread;
  if (checks.passed) return checks;
  const double larger = std::max(1.0, checks.spread / checks.expected_spread);
  const double longer = std::max(1.0, checks.correlation_length / checks.expected_correlation_length);
  checks.widening = larger * std::sqrt(longer);
  return checks;
}

FitErrors errors_of(Records records, const Fit& fit, std::size_t replicates) {
  const ReadingReplicates found = replicate_readings(records, fit, replicates);
  return {found.errors, check_residuals(residual_statistics(fit.model, fit.observations), found.residuals)};
}

std::string reason_of_misfit(const ResidualChecks& checks) {
  if (checks.passed) return "";
  const bool large = checks.spread_chance < min_chance;
  const double ratio = checks.spread / checks.expected_spread;
  const std::string size = ratio < 2.0 ? fmt::format("{:.2g} % larger than", 100.0 * (ratio - 1.0))
                                       : fmt::format("{:.3g} times as large as", ratio);
  return large ? fmt::format("the residuals are {} the encoder's steps and noise explain", size)
               : fmt::format(
                     "the residuals have {:.0f} runs of one sign, where the encoder's steps and noise "
                     "would give {:.0f}: the model departs systematically from the records",
                     checks.runs, checks.expected_runs);
}

Eigen::VectorXd residuals_along(const TestRecord& record, const Eigen::VectorXd& path) {
  Eigen::VectorXd left = readings_of(record).array() + middle_of_reading(record) - path.array();
  for (std::size_t k = 0; k < record.excluded.size(); ++k) {
    if (record.excluded[k]) left[static_cast<Eigen::Index>(k)] = 0.0;
  }
  return left;
}

double misfit_along(const TestRecord& record, const Eigen::VectorXd& path) {
  return residuals_along(record, path).norm() / std::sqrt(static_cast<double>(used_samples(record)));
}

bool is_explained(const TestRecord& record, const Eigen::VectorXd& path) {
  const auto rms = [](const Eigen::ArrayXd& values) { return std::sqrt(values.square().mean()); };
  const Eigen::ArrayXd left = residuals_along(record, path);
  const Eigen::Index steps = left.size() - 1;
  const double change = rms(left.tail(steps) - left.head(steps)) / std::numbers::sqrt2;
  if (record.counted) {
    constexpr double tolerated = 0.05;  // of a count: the accuracy of the rough fit
    // Along a path with large errors, counting_noise() overestimates.
    const double noise = std::min(counting_noise(record, path, readings_of(record)), change);
    return rms((left.abs() - 0.5).max(0.0)) < tolerated + noise;
  }
  constexpr double arithmetic = 1e-3;
  return rms(left) < 1.5 * change || rms(left) < arithmetic;
}

std::optional<std::size_t> find_glitch(const TestRecord& record, const Eigen::VectorXd& path) {
  const std::size_t samples = record.reading.size();
  std::vector<double> off(samples);  // beyond the rounding of a count; 0 where masked
  for (std::size_t k = 0; k < samples; ++k) {
    if (is_excluded(record, k)) continue;
    const double residual =
        record.reading[k] + middle_of_reading(record) - path[static_cast<Eigen::Index>(k)];
    off[k] = std::max(std::abs(residual) - middle_of_reading(record), 0.0);
  }
  constexpr double counted_deviations = 6.0;
  constexpr double deviations = 12.0;
  constexpr double arithmetic = 1e-3;
  const double least = record.counted
                           ? 1.5 + counted_deviations * counting_noise(record, path, readings_of(record))
                           : arithmetic + deviations * robust_deviation(off);
  // A reading that lies between its neighbours is right, and the path is wrong.
  const auto beside = [&](std::size_t k) {
    return std::abs(record.reading[k] - 0.5 * (record.reading[k - 1] + record.reading[k + 1]));
  };
  // A path that misses the other readings as well cannot accuse one of them.
  constexpr double beyond_others = 12.0;
  const double all = std::inner_product(off.begin(), off.end(), off.begin(), 0.0);
  const auto others = [&](std::size_t k) {
    return std::sqrt(std::max(all - off[k] * off[k], 0.0) / static_cast<double>(samples));
  };
  const double rounding = record.counted ? 1.0 : 0.0;
  constexpr std::size_t near = 3;
  constexpr std::size_t far = 6;
  for (std::size_t k = far; k + far < samples; ++k) {
    if (off[k] <= least || beside(k) < 0.5 * off[k] + rounding) continue;
    bool alone = true;
    for (std::size_t lag = near; lag <= far; ++lag) {
      alone = alone && off[k - lag] < off[k] / 3.0 && off[k + lag] < off[k] / 3.0;
    }
    if (alone && off[k] > beyond_others * others(k)) return k;
  }
  return std::nullopt;
}

std::size_t largest_misfit_growth(const TestRecord& record, const Eigen::VectorXd& path) {
  constexpr Eigen::Index lag = 20;
  Eigen::Index sample = 0;
  double largest = 0.0;
  for (Eigen::Index k = lag; k < path.size(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    if (is_excluded(record, at) || is_excluded(record, at - lag)) continue;
    const double change = record.reading[at] - path[k] - record.reading[at - lag] + path[k - lag];
    if (std::abs(change) <= largest) continue;
    largest = std::abs(change);
    sample = k;
  }
  return static_cast<std::size_t>(sample);
}

}  // namespace zerocount::fit
