#include "core/numerics/minimum.hpp"

#include <boost/math/tools/minima.hpp>

namespace zerocount::numerics {

std::pair<double, double> minimum_between(double low, double high, int bits,
                                          const std::function<double(double)>& f) {
  return boost::math::tools::brent_find_minima(f, low, high, bits);
}

}  // namespace zerocount::numerics
