#include "experiments/study/rotors.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_reduce.h>

#include "core/numerics/elementary_functions.hpp"
#include "experiments/designs/designs.hpp"

namespace zerocount::study {
namespace {

constexpr std::size_t rotors_of_task = 64;

numerics::Interval hull(const numerics::Interval& a, const numerics::Interval& b) {
  return numerics::closed(std::min(a.low, b.low), std::max(a.high, b.high));
}

std::size_t rotors_to_keep(std::size_t harmonics, std::int64_t count, std::size_t max_bytes) {
  const std::size_t bytes_of_rotor = sizeof(friction::Profile) + 2 * harmonics * sizeof(double) + 64;
  const std::size_t room = std::max<std::size_t>(1, max_bytes / bytes_of_rotor);
  return std::min(room, static_cast<std::size_t>(count));
}

}  // namespace

Rotors::Rotors(distributions::ProfileDescription description, std::optional<DrawnMean> mean,
               std::uint64_t seed, std::string_view name, std::int64_t count)
    : Rotors(description, std::move(mean), designs::random_key(seed, name), count) {}

Rotors::Rotors(const distributions::ProfileDescription& description, std::optional<DrawnMean> mean,
               const random::RandomKey& key, std::int64_t count)
    : description_(description),
      mean_(std::move(mean)),
      key_(key),
      count_(count),
      amplitudes_(distributions::field_amplitudes(description)),
      kept_(rotors_to_keep(amplitudes_.size(), count, max_kept_bytes)) {}

std::shared_ptr<const Rotors> Rotors::widened(double factor) const {
  distributions::ProfileDescription description = description_;
  description.cv *= factor;
  std::optional<DrawnMean> mean = mean_;
  if (mean) mean->distribution = distributions::widened(mean->distribution, factor);
  return std::shared_ptr<const Rotors>(new Rotors(description, std::move(mean), key_, count_));
}

bool Rotors::is_same(const Rotors& other) const {
  return description_ == other.description_ && mean_ == other.mean_ && key_ == other.key_ &&
         count_ == other.count_;
}

double Rotors::mean(std::int64_t rotor) const {
  if (!mean_) return description_.mean;
  const std::uint64_t place =
      place_in_groups(mean_->design, mean_->places, static_cast<std::uint64_t>(rotor), mean_->worlds);
  const double u =
      design_uniform(mean_->design, mean_->randomness, 0, place, static_cast<std::uint64_t>(count_));
  return distributions::quantile(mean_->distribution, u);
}

double Rotors::mean_at(double quantile) const {
  return mean_ ? distributions::quantile(mean_->distribution, quantile) : description_.mean;
}

friction::Profile Rotors::realise(std::int64_t rotor, double mean) const {
  distributions::ProfileDescription description = description_;
  description.mean = mean;
  return distributions::realise_profile(description, amplitudes_, key_, static_cast<std::uint32_t>(rotor));
}

std::shared_ptr<const friction::Profile> Rotors::rotor(std::int64_t rotor) const {
  const auto place = static_cast<std::size_t>(rotor);
  if (place < kept_.size()) {
    const std::scoped_lock lock(mutex_);
    if (kept_[place]) return kept_[place];
  }
  auto made = std::make_shared<const friction::Profile>(realise(rotor, mean(rotor)));
  if (place >= kept_.size()) return made;
  const std::scoped_lock lock(mutex_);
  if (!kept_[place]) kept_[place] = std::move(made);
  return kept_[place];
}

friction::Profile Rotors::rotor_with(std::int64_t rotor, std::optional<double> mean_quantile,
                                     std::optional<double> field, double position) const {
  friction::Profile profile = realise(rotor, mean_quantile ? mean_at(*mean_quantile) : mean(rotor));
  if (!field) return profile;
  const double change = *field - friction::field_at(profile, position);
  const double angle = position * (2.0 * std::numbers::pi / profile.period);
  for (std::size_t m = 0; m < amplitudes_.size(); ++m) {
    const double variance = amplitudes_[m] * amplitudes_[m];
    profile.cosine[m] += change * variance * numerics::cos(static_cast<double>(m) * angle);
    profile.sine[m] += change * variance * numerics::sin(static_cast<double>(m) * angle);
  }
  return profile;
}

numerics::Interval Rotors::bounds() const {
  // Maximum of √(ξ² + η²): standard normal variates are below 8.22 in magnitude
  // (core/random/random_numbers.hpp).
  constexpr double max_radius = 11.63;
  friction::Profile any = distributions::realise_profile(description_, amplitudes_, key_);
  for (std::size_t m = 0; m < amplitudes_.size(); ++m) {
    any.cosine[m] = max_radius * amplitudes_[m];
    any.sine[m] = 0.0;
  }
  const numerics::Interval about_its_mean = distributions::limits(any);
  if (!mean_) return about_its_mean;
  const double lowest = distributions::quantile(mean_->distribution, 0x1p-53) / description_.mean;
  const double highest = distributions::quantile(mean_->distribution, 1.0 - 0x1p-53) / description_.mean;
  return numerics::closed(std::min(lowest * about_its_mean.low, highest * about_its_mean.low),
                          std::max(lowest * about_its_mean.high, highest * about_its_mean.high));
}

numerics::Interval Rotors::all_limits() const {
  {
    const std::scoped_lock lock(mutex_);
    if (limits_) return *limits_;
  }
  constexpr double infinity = std::numeric_limits<double>::infinity();
  using Numbers = oneapi::tbb::blocked_range<std::int64_t>;
  const numerics::Interval limits = oneapi::tbb::parallel_reduce(
      Numbers(0, count_, rotors_of_task), numerics::closed(infinity, -infinity),
      [&](const Numbers& numbers, numerics::Interval found) {
        for (std::int64_t i = numbers.begin(); i < numbers.end(); ++i)
          found = hull(found, distributions::limits(*rotor(i)));
        return found;
      },
      hull);
  const std::scoped_lock lock(mutex_);
  limits_ = limits;
  return *limits_;
}

}  // namespace zerocount::study
