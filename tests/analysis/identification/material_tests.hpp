#pragma once

#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include "analysis/fit/presliding/contact.hpp"
#include "analysis/fit/presliding/identification.hpp"
#include "analysis/fit/record.hpp"

namespace zerocount::testing {

/// A torque at every sample, from 0 N m at the start.
class TorqueProgramme {
 public:
  explicit TorqueProgramme(double sample_time = 5e-4) : sample_time_(sample_time) {}

  TorqueProgramme& ramp(double to, double rate);  ///< N m, N m/s
  TorqueProgramme& step(double to) { return ramp(to, 1e9); }
  TorqueProgramme& hold(double duration);  ///< s

  double sample_time() const { return sample_time_; }
  const std::vector<double>& torque() const { return torque_; }  ///< [sample], N m

 private:
  double sample_time_;
  std::vector<double> torque_;
};

/// What a machine's DAC and encoder do.
struct TestInstrument {
  double counts_per_revolution{1.62e6};
  double torque_step{2.4e-4};  ///< Δu, N m; 0: the torque is exact
  double noise{0.0};           ///< of the readings before rounding, counts
  double skew{0.0};            ///< the torque acts so much later than its sample, samples
  double compliance{0.0};      ///< of a fixture that gives way under the torque, rad/(N m)
};

/// A machine of the paper's kind: its numbers, each times a random factor of 0.5 to 2, and n between 1.5
/// and 2.5.
fit::ContactParameters random_contact(std::mt19937_64& random);

/// A test of a rotor, simulated by core's Plant sample by sample, and read by an encoder of random phase.
fit::TestRecord simulated_test(const motion::PlantParameters& plant,
                               const friction::FrictionAlongRotor& friction, const TorqueProgramme& programme,
                               const TestInstrument& instrument, std::mt19937_64& random);

/// The same of a contact of the pre-sliding model.
fit::TestRecord simulated_test(const fit::ContactParameters& contact, const TorqueProgramme& programme,
                               const TestInstrument& instrument, std::mt19937_64& random);

/// Slow loading and unloading with inner loops; four steps with their ring-downs; two holds. One record each.
std::vector<TorqueProgramme> three_tests();

/// All of that in one record.
std::vector<TorqueProgramme> one_test();

/// All that is to be seen in 3 s.
std::vector<TorqueProgramme> short_test();

/// The contact's parameter of the name that its estimate has; `skew` for the time offset.
double true_value(const fit::ContactParameters& contact, const std::string& name, double skew = 0.0);

/// How often the intervals of a parameter held the truth.
struct IntervalCoverage {
  std::string name;
  int held{0};
  int estimated{0};
  int open{0};                 ///< times that it was not identifiable
  double squared_errors{0.0};  ///< Σ (error/standard error)²
  double half_widths{0.0};     ///< Σ half-width/value
  double farthest{0.0};        ///< largest |error/standard error|
  int farthest_set{0};         ///< of which machine
};

/// What came of identifying many machines.
struct CoverageStudy {
  std::vector<IntervalCoverage> parameters;  ///< in the order of Identification::parameters
  int sets{0};
  int refused{0};                 ///< the identification threw
  int lacking{0};                 ///< the residual checks failed
  std::vector<int> lacking_sets;  ///< their numbers
};

/// Identifies `sets` random contacts, number `first` on, by simulated tests; the set number seeds each.
CoverageStudy study_coverage(int first, int sets, const std::vector<TorqueProgramme>& programmes,
                             const TestInstrument& instrument,
                             const fit::IdentificationOptions& options = {});

}  // namespace zerocount::testing
