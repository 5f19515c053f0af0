#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "analysis/identification/contact_fit.hpp"
#include "analysis/identification/residual_checks.hpp"
#include "analysis/identification/test_record.hpp"

namespace zerocount {

enum class EstimateStatus {
  estimated,        ///< from the records
  known,            ///< given by the user
  not_identifiable  ///< the records leave it open
};

/// What the records say of one parameter.
struct ParameterEstimate {
  std::string name;  ///< k1, k2, k1_plus_k2, beta, presliding_damping, inertia, alpha, lambda or n
  std::string key;   ///< in a manifest; empty for k1_plus_k2
  std::string unit;
  EstimateStatus status{EstimateStatus::not_identifiable};
  double value{0.0};           ///< NaN where not identifiable, as the following
  double standard_error{0.0};  ///< of the value; 0 where known
  double low{0.0};             ///< of the 95 % confidence interval
  double high{0.0};
  std::string reason;  ///< why it is not identifiable
};

/// What a record was found to be made of, and how well it is explained.
struct RecordSummary {
  std::string name;
  std::size_t samples{0};
  double duration{0.0};  ///< s
  bool counted{false};
  double unit{0.0};  ///< of the readings, rad
  std::size_t branches{0};
  std::size_t reversals{0};
  std::size_t holds{0};
  std::size_t ring_downs{0};
  double misfit{0.0};  ///< root mean square of what is left of the readings, in their unit
  double noise{0.0};   ///< of the readings, standard deviation in their unit
};

struct Identification {
  std::vector<ParameterEstimate> parameters;  ///< in the order of the names above
  std::vector<RecordSummary> records;
  ResidualChecks checks;
  /// Correlation between the errors of pairs of estimated parameters, where it is 0.9 or more.
  struct Correlation {
    std::string one;
    std::string other;
    double value{0.0};
  };
  std::vector<Correlation> correlations;
};

struct IdentificationOptions {
  std::vector<KnownParameter> known;
  std::size_t replicates{500};
};

/// Identifies a rotor and its contact from material tests on it, all of one contact.
///
/// The value is the fit less its mean error in the replicates; the interval is between the fit less the 97.5
/// % and the 2.5 % quantile of that error, widened where the residuals are not those of the encoder alone.
/// Where the interval is so wide that the model is no longer linear across it, its ends are those of the
/// profile likelihood at the same level. What is left open by more than a factor of 4 (n: by more than 2) is
/// not identifiable.
/// @throws Failure (bad_data) where a record is there twice, the torque reverses less than twice, a single
/// reading is off, the model does not explain the records, or the rotor is implausibly slow or fast in units
/// that are not believed.
Identification identify(const std::vector<TestRecord>& records, const IdentificationOptions& options = {});

}  // namespace zerocount
