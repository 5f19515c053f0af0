#pragma once

#include "core/batch/kernels/lane_group.hpp"
#include "core/batch/kernels/series.hpp"
#include "core/motion/disturbance_formulas.hpp"

/// The torque on the rotor, where it varies, as a power series in the fraction of an integration step.
namespace zerocount::batch {

/// Taylor series over one step of a torque on the rotor that varies in time (CourseLanes). Over a short
/// travel x, a torque ripple A·sin(q·θ + φ), with s and c the sine and cosine at the start, is approximated
/// by the parabola A·(s + c·qx − s·(qx)²/2), whose error is below A·|qx|³/6.
template <class P>
struct VaryingTorque {
  using Mask = typename P::Mask;
  P fixed[batch_order];  ///< Coefficients of the torque without its ripples. Exception: fixed[0] is the whole
                         /// < torque, ripples included.
  P velocity[batch_order];  ///< Coefficients of the rotor's ω·h, with h the length of the step, in the unit
                            /// < of length of the series
  int ripples;
  P amplitude[max_lane_ripples];
  P per_travel[max_lane_ripples];  ///< Wave number q of each ripple: phase of the ripple per unit of travel
  motion::WaveSeriesOf<P[batch_order]> waves[max_lane_ripples];

  Mask parabolic;      ///< Lanes whose ripples are approximated by parabolas.
  bool has_parabolas;  ///< Whether any lane approximates its ripples by parabolas
  bool has_waves;      ///< Whether any lane expands its ripples exactly, as sine waves
  P linear;            ///< Coefficient of the travel in the parabolas' sum: Σ A·c·q
  P quadratic;         ///< Coefficient of the squared travel in the parabolas' sum: −Σ A·s·q²/2
  P cubic;             ///< Σ |A·q³|/6, which bounds the error of the parabolas per |travel|³
  P travel[batch_order];
  P reach;  ///< Upper bound of the travel so far in the step: Σ |coefficient of the travel|

  /// Selects the lanes whose ripples are approximated by parabolas, and computes the coefficients of these
  /// parabolas.
  ZEROCOUNT_ALWAYS_INLINE void set_parabolic(const Mask& lanes) {
    parabolic = lanes;
    has_parabolas = ripples > 0 && lanes.any();
    has_waves = ripples > 0 && (~lanes).any();
    linear = quadratic = cubic = reach = P(0.0);
    if (!has_parabolas) return;
    for (int i = 0; i < ripples; ++i) {
      const P q = per_travel[i];
      linear = linear + amplitude[i] * waves[i].cosine[0] * q;
      quadratic = quadratic - P(0.5) * (amplitude[i] * waves[i].sine[0] * q * q);
      cubic = cubic + P(1.0 / 6.0) * abs(amplitude[i] * q * q * q);
    }
  }

  /// Computes coefficient k of the torque's series. Must be called in ascending order of k.
  /// @param velocity_k coefficient k of ω·h.
  ZEROCOUNT_ALWAYS_INLINE P coefficient(int k, const P& velocity_k) {
    velocity[k] = velocity_k;
    P torque = fixed[k];
    if (k == 0) return torque;
    P on_parabola = torque;
    if (has_parabolas) on_parabola = torque + coefficient_of_parabolas(k);
    if (has_waves) torque = torque_with_waves(k);
    return select(parabolic, on_parabola, torque);
  }

 private:
  ZEROCOUNT_ALWAYS_INLINE P coefficient_of_parabolas(int k) {
    travel[k] = velocity[k - 1] * P(numerics::reciprocal.of[k]);
    reach = reach + abs(travel[k]);
    P half(0.0);
#pragma GCC unroll 1
    for (int j = 1; 2 * j < k; ++j) half = half + travel[j] * travel[k - j];
    P square = half + half;
    if (k % 2 == 0) square = square + travel[k / 2] * travel[k / 2];
    return linear * travel[k] + quadratic * square;
  }

  ZEROCOUNT_ALWAYS_INLINE P torque_with_waves(int k) {
    P torque = fixed[k];
#pragma GCC unroll 1
    for (int i = 0; i < ripples; ++i) {
      waves[i].expand(per_travel[i], velocity, static_cast<std::size_t>(k));
      torque = torque + amplitude[i] * waves[i].sine[k];
    }
    return torque;
  }
};

/// Loads the series of the torque for a step of length h (s).
/// @param unit factor that converts a torque (N m) to the unit of the series, 1/(N m).
/// @param travel_unit one unit of length of VaryingTorque::velocity, rad.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE void load_torque(const BatchState& batch, const At& at, const P& h, const P& unit,
                                         const P& travel_unit, VaryingTorque<P>& torque) {
  const CourseLanes& c = batch.course;
  const P ratio = h * at.load(batch.time.sample_rate);
  P power = unit;
  torque.fixed[0] = unit * at.load(batch.motion.torque);
#pragma GCC unroll 1
  for (int k = 1; k < batch_order; ++k) {
    power = power * ratio;
    torque.fixed[k] = at.load(c.applied[k]) * power;
  }
  torque.ripples = 0;
  const P count = at.load(c.ripple_count);
  while (torque.ripples < max_lane_ripples &&
         ((count > P(static_cast<double>(torque.ripples))) & at.taking_part()).any()) {
    const int i = torque.ripples++;
    torque.amplitude[i] = unit * at.load(c.ripples[i].amplitude);
    torque.per_travel[i] = travel_unit * at.load(c.ripples[i].per_angle);
    torque.waves[i].sine[0] = at.load(c.ripples[i].sine);
    torque.waves[i].cosine[0] = at.load(c.ripples[i].cosine);
  }
  torque.set_parabolic(P::Mask::of_bits(0));
}

/// Upper bound of the change of the torque on the rotor from its present value within `duration` (s), N m.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE P torque_range(const BatchState& batch, const At& at, const P& duration) {
  const CourseLanes& c = batch.course;
  const P ratio = duration * at.load(batch.time.sample_rate);
  P power = ratio;
  P sum = abs(at.load(c.applied[1])) * power;
#pragma GCC unroll 1
  for (int k = 2; k < batch_order; ++k) {
    power = power * ratio;
    sum = sum + abs(at.load(c.applied[k])) * power;
  }
  const P count = at.load(c.ripple_count);
  for (int i = 0; i < max_lane_ripples && (count > P(static_cast<double>(i))).any(); ++i) {
    sum = sum + P(2.0) * abs(at.load(c.ripples[i].amplitude));
  }
  return sum;
}

/// Rate of change of the torque on the rotor at this instant, multiplied by the sample time: du/dt·T, N m.
/// @param omega velocity of the rotor, rad/s.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE P torque_rate(const BatchState& batch, const At& at, const P& omega) {
  const CourseLanes& c = batch.course;
  const P travel = omega * at.load(batch.time.sample_time);
  P rate = at.load(c.applied[1]);
  const P count = at.load(c.ripple_count);
  for (int i = 0; i < max_lane_ripples && (count > P(static_cast<double>(i))).any(); ++i) {
    rate = rate + at.load(c.ripples[i].amplitude) * at.load(c.ripples[i].per_angle) * travel *
                      at.load(c.ripples[i].cosine);
  }
  return rate;
}

/// Whether it is certain that a polynomial, whose values at 0 and 1 have opposite signs, has exactly one zero
/// in between: it is monotonic, or its curvature keeps its sign.
/// @param c coefficients, [0] to [order].
template <class P>
ZEROCOUNT_ALWAYS_INLINE typename P::Mask crosses_once(const P* c, int order) {
  P third(0.0);
#pragma GCC unroll 1
  for (int k = order; k >= 3; --k) third = third + abs(c[k]) * P(static_cast<double>(k * (k - 1) * (k - 2)));
  return (abs(c[1]) > curvature_bound(c, order)) | (P(2.0) * abs(c[2]) > third);
}

/// Time since the nominal instant k·T of the last sampling instant, s; it ignores the lateness of samples.
template <class At>
ZEROCOUNT_ALWAYS_INLINE typename At::Vector time_since_sample(const BatchState& batch, const At& at) {
  using P = typename At::Vector;
  const TimeLanes& time = batch.time;
  const P passing = (at.load(time.samples_to_stop) - P(1.0)) * at.load(time.sample_time);
  return (at.load(batch.course.piece_end) + passing) - at.load(time.time_to_stop);
}

/// Angle θ of the rotor, rad.
template <class At>
ZEROCOUNT_ALWAYS_INLINE typename At::Vector theta_of(const BatchState& batch, const At& at) {
  const MotionLanes& m = batch.motion;
  return select(to_mask(at.load(m.slide_direction)), at.load(m.theta),
                at.load(m.hook) + at.load(m.elongation) + at.load(m.extension));
}

/// Adds the sinusoidal lines of a vibration torque to its Taylor series about the present instant.
/// @param vibration coefficients of the series in t/T, N m.
template <class P, class At>
ZEROCOUNT_ALWAYS_INLINE void add_lines(const BatchState& batch, const At& at, P* vibration) {
  const CourseLanes& c = batch.course;
  const P zero(0.0);
  const P count = at.load(c.line_count);
  if (!((count > zero) & at.taking_part()).any()) return;
  const P last = max(at.load(c.move_start) + at.load(batch.measures.samples) - P(1.0), zero);
  const P sample_time = at.load(batch.time.sample_time);
  const P time = last * sample_time + time_since_sample(batch, at);
  for (int i = 0; i < max_lane_lines && ((count > P(static_cast<double>(i))) & at.taking_part()).any(); ++i) {
    const LineLanes& line = c.lines[i];
    const P rate = at.load(line.rate);
    const P amplitude = at.load(line.amplitude);
    P sine, cosine;
    sine_and_cosine(rate * time + at.load(line.phase), sine, cosine);
    motion::add_line(rate * sample_time, amplitude * sine, amplitude * cosine, batch_order - 1, vibration);
  }
}

/// Computes the varying torque of one vector of lanes at the present instant; see course_kernel().
template <class At>
__attribute__((noinline)) void course_of(BatchState& batch, const At& at) {
  using P = typename At::Vector;
  CourseLanes& c = batch.course;
  const P time_to_stop = at.load(batch.time.time_to_stop);
  const P decay = at.load(c.decay);
  const P lag = at.load(c.lag) * exp(-decay * (at.load(c.piece) - time_to_stop));
  P vibration[vibration_order + 1];
  // Terms beyond the order of a lane are 0, so that the largest order of all lanes serves each.
  const P order = select(at.taking_part(), at.load(c.vibrates), P(0.0));
  int terms = 0;
  while ((order > P(static_cast<double>(terms))).any()) ++terms;
  if (terms > 0) {
    const P elapsed = time_since_sample(batch, at) * at.load(batch.time.sample_rate);
    for (int k = 0; k <= vibration_order; ++k) vibration[k] = k <= terms ? at.load(c.vibration[k]) : P(0.0);
      // The series about the present instant, by Horner's scheme.
#pragma GCC unroll 1
    for (int j = 0; j < batch_order; ++j) {
#pragma GCC unroll 1
      for (int k = terms - 1; k >= j; --k) vibration[k] = vibration[k] + elapsed * vibration[k + 1];
    }
  } else {
    for (int k = 0; k < batch_order; ++k) vibration[k] = P(0.0);
  }
  add_lines(batch, at, vibration);
  P torque = (at.load(c.settled) + lag) + vibration[0];
  const P count = at.load(c.ripple_count);
  for (int i = 0; i < max_lane_ripples && (count > P(static_cast<double>(i))).any(); ++i) {
    RippleLanes& ripple = c.ripples[i];
    P sine, cosine;
    sine_and_cosine(at.load(ripple.per_angle) * theta_of(batch, at) + at.load(ripple.phase), sine, cosine);
    at.store(ripple.sine, sine);
    at.store(ripple.cosine, cosine);
    torque = torque + at.load(ripple.amplitude) * sine;
  }
  at.store(batch.motion.torque, torque);
  const P step = -decay * at.load(batch.time.sample_time);
  P term = lag;
#pragma GCC unroll 1
  for (int k = 1; k < batch_order; ++k) {
    term = term * step * P(numerics::reciprocal.of[k]);
    at.store(c.applied[k], vibration[k] + term);
  }
}

/// Computes the torque on the rotor of each lane at the present instant (MotionLanes::torque), and its Taylor
/// series (CourseLanes::applied).
template <class V>
void course_kernel(BatchState& batch, const LaneSet& lanes) {
  for_each_stretch<V>(lanes, [&](const auto& at) { course_of(batch, at); });
}

}  // namespace zerocount::batch
