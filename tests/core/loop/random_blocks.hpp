#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "core/loop/parameters.hpp"

namespace zerocount::testing {

/// Kind of controller blocks that are random: a single kind, or each of them with some probability.
enum class BlockKind {
  none,
  deadband,
  zone,
  leak,
  derivative,
  filters,
  feedforward,
  observer,
  cascade,
  error_deadband,
  hold,
  standstill,
  all
};
inline constexpr int block_kinds = 13;
inline constexpr const char* block_kind_names[block_kinds] = {
    "none",     "deadband", "zone",           "leak", "derivative", "filters", "feedforward",
    "observer", "cascade",  "error deadband", "hold", "standstill", "all"};

/// Random blocks with which a loop around the paper's machine often stays within the converter's range.
class RandomBlocks {
 public:
  explicit RandomBlocks(std::uint64_t seed) : random_(seed) {}

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  double log_uniform(double low, double high) { return low * std::pow(high / low, uniform(0.0, 1.0)); }
  bool chance(double probability) { return uniform(0.0, 1.0) < probability; }
  double some(double value) { return chance(0.7) ? value : 0.0; }

  std::uint64_t integer() { return random_(); }

  loop::Filter filter(double sample_rate) {
    loop::Filter f;
    f.kind = static_cast<loop::FilterKind>(random_() % 4);
    f.frequency = sample_rate * log_uniform(0.02, 0.45);
    f.damping = log_uniform(0.3, 1.5);
    f.depth = uniform(0.0, 1.0);
    f.ratio = log_uniform(0.5, 4.0);
    f.a[1] = uniform(-0.5, 0.5);
    f.a[0] = uniform(-0.7, 0.7) * (1.0 + f.a[1]);
    const double sum = 1.0 + f.a[0] + f.a[1];
    f.b = {uniform(0.0, 0.5) * sum, uniform(0.0, 0.3) * sum, uniform(0.0, 0.3) * sum};
    return f;
  }

  loop::ControlBlocks blocks(BlockKind kind, double sample_rate) {
    const auto has = [&](BlockKind one) { return kind == one || (kind == BlockKind::all && chance(0.6)); };
    loop::ControlBlocks b;
    if (has(BlockKind::deadband)) {
      b.deadband.enter = static_cast<double>(random_() % 4);
      if (chance(0.5)) b.deadband.leave = b.deadband.enter + static_cast<double>(random_() % 3);
    }
    if (has(BlockKind::zone)) b.integrator_zone = uniform(2.0, 40.0);
    if (has(BlockKind::leak)) b.integrator_leak = log_uniform(0.01, 10.0);
    if (has(BlockKind::derivative)) b.derivative_cutoff = sample_rate * log_uniform(0.01, 0.5);
    if (has(BlockKind::filters)) {
      for (std::uint64_t i = random_() % 3 + 1; i > 0; --i) b.filters.push_back(filter(sample_rate));
    }
    if (has(BlockKind::feedforward))
      b.feedforward = {some(log_uniform(0.01, 0.5)), some(log_uniform(1e-4, 1e-2)), some(uniform(0.0, 0.1))};
    if (has(BlockKind::observer)) b.observer = {log_uniform(2.0, 40.0), 5.54e-4 * log_uniform(0.5, 2.0)};
    if (has(BlockKind::cascade)) {
      b.structure = loop::ControlStructure::cascade;
      b.cascade = {
          .kv = log_uniform(10.0, 200.0), .kp = log_uniform(0.02, 0.3), .ki = some(log_uniform(0.5, 20.0))};
    }
    if (has(BlockKind::error_deadband))
      b.error_deadband = {static_cast<double>(random_() % 4), static_cast<loop::DeadbandForm>(random_() % 2)};
    if (has(BlockKind::hold)) {
      const auto enter = static_cast<double>(random_() % 3);
      b.hold = {enter, enter + static_cast<double>(random_() % 3), dwell(sample_rate)};
    }
    if (has(BlockKind::standstill))
      b.standstill = {static_cast<double>(random_() % 3), dwell(sample_rate), some(log_uniform(1e-5, 5e-4)),
                      some(log_uniform(1e-6, 1e-4)), some(log_uniform(1e-5, 1e-3))};
    return b;
  }

  /// Adds random parameters that only a fine phase may have, such as a window of the derivative and a
  /// feedforward between two loops.
  void add_drive(loop::ControlBlocks& b) {
    if (chance(0.5)) b.derivative_window = 1 + static_cast<int>(random_() % 6);
    if (b.structure != loop::ControlStructure::cascade) return;
    loop::CascadeParameters& c = b.cascade;
    c.feedforward = some(uniform(0.0, 1.2));
    if (chance(0.5)) c.divider = 1 + static_cast<int>(random_() % 5);
    if (chance(0.5)) c.latency = static_cast<int>(random_() % 8);
    if (chance(0.5)) c.resolution = log_uniform(1e-5, 1e-2);
    if (chance(0.5)) c.limit = log_uniform(1e-3, 1.0);
  }

  /// A random dwell time (how long a condition must hold), s: up to 19 samples, or 0.
  double dwell(double sample_rate) {
    return chance(0.3) ? 0.0 : static_cast<double>(random_() % 20) / sample_rate;
  }

 private:
  std::mt19937_64 random_;
};

}  // namespace zerocount::testing
