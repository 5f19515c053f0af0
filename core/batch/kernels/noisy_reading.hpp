#pragma once

#include "core/batch/kernels/lane_group.hpp"
#include "core/batch/kernels/random_numbers.hpp"
#include "core/loop/formulas.hpp"
#include "core/numerics/normal_quantile_formula.hpp"

namespace zerocount::batch {

/// What an encoder with noise reads at a sample.
template <class P>
struct NoisyReading {
  P count;
  P state;      ///< w of the noise
  P disagrees;  ///< 1 where no single angle gives this count and that of the coarse encoder
};

/// @param angle that the encoder reads, rad. @param k the sample, from the start of the trial.
/// @param last_state w of the sample before.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE NoisyReading<P> noisy_reading(const BatchState& batch, const At& at, const P& angle,
                                                      const P& k, const P& last_state) {
  const NoiseLanes& n = batch.noise;
  P uniform;
  set_uniform_at(n.random, at, k, uniform);
  NoisyReading<P> reading;
  reading.state = loop::next_noise(load_struct(at, n.constants), last_state, k == P(0.0),
                                   numerics::standard_normal_quantile(uniform));
  const P phase = at.load(batch.loop.phase);
  const P resolution = at.load(batch.loop.resolution);
  const P position = angle / resolution + phase;
  reading.count = floor(position + at.load(n.constants.deviation) * reading.state);
  const P coarse_resolution = at.load(n.coarse_resolution);
  const P coarse = loop::ideal_count(angle, coarse_resolution, phase);
  const P ratio = resolution / coarse_resolution;
  const typename P::Mask possible =
      loop::counts_may_coincide((reading.count - phase) * ratio + phase, ratio, coarse) |
      (reading.count == floor(position));
  reading.disagrees = select(possible, P(0.0), P(1.0));
  return reading;
}

}  // namespace zerocount::batch
