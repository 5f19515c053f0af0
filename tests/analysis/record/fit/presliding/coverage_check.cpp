// How often the 95 % intervals of `zerocount identify` hold the truth, over simulated machines.
//
// usage: identification_coverage PROTOCOL SETS [FIRST] [NOISE] [TORQUE_STEP] [SKEW]
//   PROTOCOL     three: ramps, steps and holds as three records; one: all in one record; short: in 3 s
//   SETS, FIRST  so many machines, from this number on (default 0)
//   NOISE        of the readings before rounding, counts (default 0)
//   TORQUE_STEP  of the DAC, N m (default 2.4e-4; 0: exact)
//   SKEW         samples by which the torque acts late (default 0)
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tests/analysis/record/fit/presliding/material_tests.hpp"

int main(int count, char** words) {
  using namespace zerocount::testing;
  if (count < 3) {
    fmt::print(stderr, "usage: {} three|one|short SETS [FIRST] [NOISE] [TORQUE_STEP] [SKEW]\n", words[0]);
    return 2;
  }
  const std::string protocol = words[1];
  const int sets = std::atoi(words[2]);
  const int first = count > 3 ? std::atoi(words[3]) : 0;
  TestInstrument instrument;
  if (count > 4) instrument.noise = std::atof(words[4]);
  if (count > 5) instrument.torque_step = std::atof(words[5]);
  if (count > 6) instrument.skew = std::atof(words[6]);
  const CoverageStudy study = study_coverage(first, sets,
                                             protocol == "three" ? three_tests()
                                             : protocol == "one" ? one_test()
                                                                 : short_test(),
                                             instrument);
  fmt::print(
      "{} machines from number {}, noise {} counts, torque step {} N m, skew {} samples: {} refused, "
      "{} with lack of fit\n",
      study.sets, first, instrument.noise, instrument.torque_step, instrument.skew, study.refused,
      study.lacking);
  fmt::print("{:<20} {:>6} {:>10} {:>9} {:>6} {:>12} {:>11} {:>9} {:>6}\n", "parameter", "held", "estimated",
             "coverage", "open", "rms error/se", "half-width", "farthest", "machine");
  for (const IntervalCoverage& c : study.parameters) {
    const double n = c.estimated;
    fmt::print("{:<20} {:>6} {:>10} {:>7.1f} % {:>6} {:>12.2f} {:>9.2g} % {:>9.2f} {:>6}\n", c.name, c.held,
               c.estimated, 100.0 * c.held / n, c.open, std::sqrt(c.squared_errors / n),
               100.0 * c.half_widths / n, c.farthest, c.farthest_set);
  }
  fmt::print("machines with lack of fit: {}\n", fmt::join(study.lacking_sets, " "));
}
