#include "core/trial/random_history.hpp"

#include <cstddef>
#include <cstdint>

#include "core/random/random_numbers.hpp"

namespace zerocount::trial {

std::vector<double> draw_history(const RandomHistory& history, const random::TrialRandomness& randomness) {
  const random::RandomStream stream{randomness.history, randomness.stream};
  const auto uniform = [&](std::uint64_t k) {
    return random::open_uniform(random::random_bits_at(stream, randomness.trial, k));
  };
  std::vector<double> levels(static_cast<std::size_t>(history.reversals));
  double outermost = uniform(0) < 0.5 ? -history.torque : history.torque;
  double level = 0.0;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    level += uniform(i + 1) * (outermost - level);
    levels[i] = level;
    outermost = -outermost;
  }
  return levels;
}

}  // namespace zerocount::trial
