#pragma once

#include "core/batch/kernels/lane_group.hpp"
#include "core/loop/formulas.hpp"
#include "core/numerics/normal_quantile_formula.hpp"

namespace zerocount::batch {

// The random numbers of running trials (core/random/random_numbers.hpp), one in each lane.

/// The random number generator Philox4x32-10 in each lane. Counter and key words are in the lower 32 bits of
/// their elements; the upper bits are not used.
/// @returns output word 0 + 2³²·word 1.
template <int Width>
ZEROCOUNT_ALWAYS_INLINE typename VectorOf<Width>::Bits philox(typename VectorOf<Width>::Bits counter[4],
                                                              typename VectorOf<Width>::Bits key[2]) {
  using Vector = VectorOf<Width>;
  using Bits = typename Vector::Bits;
  const Bits none{};
  constexpr int rounds = 10;
  for (int round = 0; round < rounds; ++round) {
    const Bits a = Vector::product_of_words(counter[0], none + 0xD2511F53);
    const Bits b = Vector::product_of_words(counter[2], none + 0xCD9E8D57);
    counter[0] = (b >> 32) ^ counter[1] ^ key[0];
    counter[2] = (a >> 32) ^ counter[3] ^ key[1];
    counter[1] = b;
    counter[3] = a;
    key[0] += 0x9E3779B9;
    key[1] += 0xBB67AE85;
  }
  return (counter[0] & UINT32_MAX) | (counter[1] << 32);
}

/// Sets `uniform` to the uniform random number in (0, 1) with number `k` of each lane's stream and trial, as
/// open_uniform(random_bits_at(stream, trial, k)) gives it.
/// @param k a whole number below 2⁴⁰, usually the number of the sample.
template <int Width, int Chains, class At>
ZEROCOUNT_ALWAYS_INLINE void set_uniform_at(const RandomLanes& r, const At& at, const Simd<Width, Chains>& k,
                                            Simd<Width, Chains>& uniform) {
  using P = Simd<Width, Chains>;
  using Bits = typename P::Bits;
  using Real = typename P::Real;
  const P shift(0x1p52);  // x + 2⁵² has x as its lower bits
  const P sample = k + shift;
  const P words[] = {at.load(r.trial_low) + shift, at.load(r.trial_high) + shift, at.load(r.stream) + shift,
                     at.load(r.key[0]) + shift, at.load(r.key[1]) + shift};
  P drawn;
  for (int i = 0; i < Chains; ++i) {
    const auto word = [&](int of) { return (Bits)words[of].part[i]; };
    const Bits number = (Bits)sample.part[i];
    Bits counter[4] = {word(0), word(1) + ((number >> 32) << 24), number, word(2)};
    Bits key[2] = {word(3), word(4)};
    const Bits bits = philox<Width>(counter, key);
    constexpr std::int64_t exponent = std::int64_t{1023 + 52} << 52;
    drawn.part[i] = (Real)(((bits >> 12) & ((std::int64_t{1} << 52) - 1)) | exponent);
  }
  uniform = ((drawn - shift) + P(0.5)) * P(0x1p-52);
}

/// Reading of a noisy fine encoder at a sampling instant.
template <class P>
struct NoisyReading {
  P count;
  P state;      ///< Noise value w at this sample, in standard deviations
  P disagrees;  ///< 1 if no single angle gives both this count and the count of the coarse encoder
};

/// Reads the noisy fine encoder.
/// @param angle true angle at the encoder, rad.
/// @param k sample number from the start of the trial.
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
