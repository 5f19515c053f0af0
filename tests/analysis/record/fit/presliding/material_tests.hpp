#pragma once

#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include "analysis/record/fit/presliding/contact.hpp"
#include "analysis/record/fit/presliding/identification.hpp"
#include "analysis/record/fit/record.hpp"

namespace zerocount::testing {

/// The torque of a test over time: one value for every sample. It starts at 0 N m.
class TorqueProgramme {
 public:
  explicit TorqueProgramme(double sample_time = 5e-4) : sample_time_(sample_time) {}

  TorqueProgramme& ramp(double to, double rate);  ///< appends a ramp to `to`, N m, with `rate`, N m/s
  TorqueProgramme& step(double to) { return ramp(to, 1e9); }
  TorqueProgramme& hold(double duration);  ///< appends a constant torque for `duration`, s

  double sample_time() const { return sample_time_; }
  const std::vector<double>& torque() const { return torque_; }  ///< [sample], N m

 private:
  double sample_time_;
  std::vector<double> torque_;
};

/// Properties of the DAC, the encoder and the fixture with which a simulated test is made.
struct TestInstrument {
  double counts_per_revolution{1.62e6};
  double torque_step{2.4e-4};  ///< step Δu of the DAC, N m; 0: the torque is exact
  double noise{0.0};           ///< noise of the readings before rounding, counts
  double skew{0.0};            ///< delay of the torque after the sample at which it is recorded, samples
  double compliance{0.0};      ///< compliance of the fixture, rad/(N m)
};

/// A random friction contact like the paper's: each of its numbers times a random factor of 0.5 to 2, and a
/// creep exponent n between 1.5 and 2.5.
fit::ContactParameters random_contact(std::mt19937_64& random);

/// The record of a test of a rotor, simulated by core's Plant sample by sample, and read by an encoder of
/// random phase.
fit::TestRecord simulated_test(const motion::PlantParameters& plant,
                               const friction::FrictionAlongRotor& friction, const TorqueProgramme& programme,
                               const TestInstrument& instrument, std::mt19937_64& random);

/// The record of a test of a rotor on a contact of the pre-sliding model, simulated by core's Plant and read
/// by an encoder of random phase.
fit::TestRecord simulated_test(const fit::ContactParameters& contact, const TorqueProgramme& programme,
                               const TestInstrument& instrument, std::mt19937_64& random);

/// Torque programmes of three tests, one record each: slow loading and unloading with inner loops; four steps
/// with their ring-downs; two holds.
std::vector<TorqueProgramme> three_tests();

/// Torque programme of one test with one record: loading with inner loops, steps with ring-downs, and holds.
std::vector<TorqueProgramme> one_test();

/// Torque programme of one test of 3 s: loading, steps and holds in one record.
std::vector<TorqueProgramme> short_test();

/// The true value of the parameter with this name, of which an identification gives an estimate.
/// @param skew true value of the time offset of the torque, samples
double true_value(const fit::ContactParameters& contact, const std::string& name, double skew = 0.0);

/// Coverage of the confidence intervals of one parameter.
struct IntervalCoverage {
  std::string name;
  int held{0};
  int estimated{0};
  int open{0};                 ///< number of machines for which the parameter was not identifiable
  double squared_errors{0.0};  ///< sum of (error/standard error)² over the machines
  double half_widths{0.0};     ///< sum of the intervals' half-width/value over the machines
  double farthest{0.0};        ///< largest |error/standard error|
  int farthest_set{0};         ///< number of the machine with the largest error
};

/// Results of identifying many machines.
struct CoverageStudy {
  std::vector<IntervalCoverage> parameters;  ///< coverage, in the order of Identification::parameters
  int sets{0};
  int refused{0};                 ///< number of machines for which the identification threw
  int lacking{0};                 ///< number of machines for which the residual checks failed
  std::vector<int> lacking_sets;  ///< numbers of the machines with failed residual checks
};

/// Identifies `sets` random contacts, with numbers from `first` on, from simulated tests. The number of a
/// contact seeds its random numbers.
CoverageStudy study_coverage(int first, int sets, const std::vector<TorqueProgramme>& programmes,
                             const TestInstrument& instrument,
                             const fit::IdentificationOptions& options = {});

}  // namespace zerocount::testing
