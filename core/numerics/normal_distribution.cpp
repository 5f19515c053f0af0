#include "core/numerics/normal_distribution.hpp"

#include <cmath>

#include <boost/math/constants/constants.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/tools/rational.hpp>

#include "core/numerics/elementary_functions.hpp"
#include "core/numerics/real.hpp"

namespace zerocount::numerics {
namespace {

using Normal = boost::math::normal_distribution<Real>;
using boost::math::tools::evaluate_polynomial;

/// erf⁻¹(p), p ≤ ½.
double central_erf_inverse(double p) {
  constexpr double y = 0.0891314744949340820313f;
  constexpr double numerator[] = {-0.000508781949658280665617, -0.00836874819741736770379,
                                  0.0334806625409744615033,    -0.0126926147662974029034,
                                  -0.0365637971411762664006,   0.0219878681111168899165,
                                  0.00822687874676915743155,   -0.00538772965071242932965};
  constexpr double denominator[] = {1.0,
                                    -0.970005043303290640362,
                                    -1.56574558234175846809,
                                    1.56221558398423026363,
                                    0.662328840472002992063,
                                    -0.71228902341542847553,
                                    -0.0527396382340099713954,
                                    0.0795283687341571680018,
                                    -0.00233393759374190016776,
                                    0.000886216390456424707504};
  const double g = p * (p + 10.0);
  const double r = evaluate_polynomial(numerator, p) / evaluate_polynomial(denominator, p);
  return g * y + g * r;
}

/// erf⁻¹(1 − q), ¼ ≤ q < ½. @param log_q ln q
double outer_erf_inverse(double q, double log_q) {
  constexpr double y = 2.249481201171875f;
  constexpr double numerator[] = {-0.202433508355938759655, 0.105264680699391713268, 8.37050328343119927838,
                                  17.6447298408374015486,   -18.8510648058714251895, -44.6382324441786960818,
                                  17.445385985570866523,    21.1294655448340526258,  -3.67192254707729348546};
  constexpr double denominator[] = {1.0,
                                    6.24264124854247537712,
                                    3.9713437953343869095,
                                    -28.6608180499800029974,
                                    -20.1432634680485188801,
                                    48.5609213108739935468,
                                    10.8268667355460159008,
                                    -22.6436933413139721736,
                                    1.72114765761200282724};
  const double x = q - 0.25;
  const double r = evaluate_polynomial(numerator, x) / evaluate_polynomial(denominator, x);
  return std::sqrt(-2.0 * log_q) / (y + r);
}

/// erf⁻¹(1 − q), q < ¼. @param root √(−ln q), below 3
double tail_erf_inverse(double root) {
  constexpr double y = 0.807220458984375f;
  constexpr double numerator[] = {
      -0.131102781679951906451,   -0.163794047193317060787,   0.117030156341995252019,
      0.387079738972604337464,    0.337785538912035898924,    0.142869534408157156766,
      0.0290157910005329060432,   0.00214558995388805277169,  -0.679465575181126350155e-6,
      0.285225331782217055858e-7, -0.681149956853776992068e-9};
  constexpr double denominator[] = {1.0,
                                    3.46625407242567245975,
                                    5.38168345707006855425,
                                    4.77846592945843778382,
                                    2.59301921623620271374,
                                    0.848854343457902036425,
                                    0.152264338295331783612,
                                    0.01105924229346489121};
  const double x = root - 1.125;
  const double r = evaluate_polynomial(numerator, x) / evaluate_polynomial(denominator, x);
  return y * root + r * root;
}

}  // namespace

double normal_quantile(double p, double mean, double standard_deviation) {
  return static_cast<double>(boost::math::quantile(Normal(mean, standard_deviation), Real(p)));
}

double standard_normal_quantile(double p) {
  // As normal_quantile(): −√2·erfc⁻¹(2p).
  const double z = 2.0 * p;
  const double q = z > 1.0 ? 2.0 - z : z;
  const double distance = 1.0 - q;
  double inverse;
  if (distance <= 0.5) {
    inverse = central_erf_inverse(distance);
  } else {
    const double log_q = log_of_draws(q);
    if (q >= 0.25) {
      inverse = outer_erf_inverse(q, log_q);
    } else {
      const double root = std::sqrt(-log_q);
      if (!(root < 3.0)) return normal_quantile(p);
      inverse = tail_erf_inverse(root);
    }
  }
  const double quantile = (z > 1.0 ? inverse : -inverse) * boost::math::constants::root_two<double>();
  return quantile + 0.0;  // no negative zero
}

double normal_probability(double z) {
  return static_cast<double>(boost::math::cdf(Normal(), Real(z)));
}

}  // namespace zerocount::numerics
