#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "analysis/basis/document/answer.hpp"
#include "analysis/record/fit/presliding/contact.hpp"
#include "analysis/record/fit/presliding/contact_fit.hpp"
#include "analysis/record/fit/record.hpp"
#include "analysis/record/fit/records/checked_record.hpp"
#include "analysis/record/fit/report.hpp"
#include "analysis/record/fit/residuals.hpp"

namespace zerocount::fit {

/// A sample of joint draws of the estimated parameters, which shows their correlations.
struct JointDraws {
  std::vector<std::string> keys;          ///< [column] Manifest key of the parameter.
  std::vector<std::vector<double>> rows;  ///< [draw][column] Value in the parameter's own unit.
};

/// An estimated parameter of the manifest with its intervals, on the scale of Quantity::value.
struct EstimatedQuantity {
  Quantity quantity;
  QuantityEstimate by_replicates;  ///< Interval from the replicates, see interval_of_errors().
  /// Reported interval: `by_replicates`, or the interval by profile likelihood.
  QuantityEstimate reported;
};

/// Appends one draw for each row of `errors` (see ReadingReplicates). With the error e of a replicate, the
/// mean error ē and the widening w, the draw is value − w·(e − ē). If the reported interval comes from the
/// profile likelihood, the distances above and below the value are scaled to its two ends. Both maps are
/// monotonic, so the rank correlations are those of the replicates. Draws with n < 1 are left out.
/// @param max_rows number of draws at which to stop
void append_draws(std::span<const EstimatedQuantity> quantities, const Eigen::MatrixXd& errors,
                  double widening, std::size_t max_rows, JointDraws& draws);

/// Reason why there are fewer draws than wanted; empty if there are enough.
std::string reason_of_missing_draws(const JointDraws& draws, std::size_t wanted);

/// Covariance of the errors of estimated quantities, on the scale of Quantity::value: logarithms, except for
/// n and the time offset.
struct JointErrors {
  std::vector<std::string> names;
  /// [parameter, parameter] Covariance of the errors, in the order of the names.
  Eigen::MatrixXd covariance;

  double correlation(Eigen::Index one, Eigen::Index other) const;
};

/// The covariance of the errors of the replicates, with the errors multiplied by `widening`.
JointErrors joint_errors(std::span<const EstimatedQuantity> quantities, const Eigen::MatrixXd& errors,
                         double widening);

/// The parts detected in a record, and the quality of the fit to it.
struct RecordSummary : RecordExtent {
  double duration{0.0};  ///< Duration of the record, s.
  bool counted{false};
  double unit{0.0};  ///< Unit of the readings, rad or m: the size of a count if they are counts.
  std::size_t branches{0};
  std::size_t reversals{0};
  std::size_t holds{0};
  std::size_t ring_downs{0};
  double misfit{0.0};  ///< Root mean square of the residuals, in the readings' unit.
  double noise{0.0};   ///< Standard deviation of the readings' noise, in the readings' unit.
};

/// Result of an identification: the parameters k1, k2, k1_plus_k2, beta, presliding_damping, inertia, alpha,
/// lambda, n and time_offset, and the quality of the fit.
struct Identification : FitReport {
  double sample_time{0.0};  ///< Sampling interval of the first record, s; it is the unit of the time offset.
  std::vector<RecordSummary> records;
  std::vector<FittedRecord> fitted;  ///< [record] Readings and fitted values of each sample, for figures.
  ResidualChecks checks;
  /// Frequencies at which the fitted rotor rings, Hz: on the stiffness k1 after large steps (low), on k1 + k2
  /// after small ones (high).
  FrequencyRange own_ringing;
  /// Peak in the spectrum of the residuals, a sign of a second mass; null if there is none. It is searched
  /// only if the checks failed, below own_ringing.low/1.2 and above 1.2·own_ringing.high.
  std::optional<ResidualLine> residual_line;
  double effort{1.0};  ///< Factor on the search effort (1: usual), see fit_contact().
  /// True if the residuals are not explained and no more starting points were tried because of the effort
  /// limit.
  bool search_ended{false};
  /// Correlation of the errors of a pair of estimated parameters; listed if its magnitude is 0.9 or more.
  struct Correlation {
    std::string one;
    std::string other;
    double value{0.0};
  };
  std::vector<Correlation> correlations;
  JointErrors errors;  ///< Covariance of the errors of all estimated parameters except k1 + k2.
  /// Joint draws of the parameters, as many as IdentificationOptions::draws asks for, if possible.
  JointDraws draws;
};

struct IdentificationOptions {
  std::vector<KnownParameter> known;
  std::size_t replicates{500};
  std::size_t draws{0};  ///< Number of joint draws of the parameters that are wanted; 0: none.
  double effort{1.0};    ///< Factor on the search effort (1: usual), see fit_contact().
  StageReport report{};
};

/// Throws a Failure if a record is given twice, because it would have twice its weight.
/// @throws Failure: bad_data; bad_input if the records are of a rotary and a linear axis
void check_different(Records records);

/// Identifies a rotor and its contact from material tests, all of the same contact.
///
/// The value is the fit minus its mean error in the replicates. The 95 % interval is the fit minus the 97.5 %
/// and the 2.5 % quantile of that error; it is widened if the encoder alone does not explain the residuals.
/// If the interval is so wide that the model is not linear across it, it is computed by profile likelihood at
/// the same level. A parameter whose interval spans more than a factor of 4 (n: more than 2) is not
/// identifiable.
///
/// The time offset between torque and angle is fitted together with the contact, before any reading is called
/// wrong; so the other intervals include its uncertainty. If its interval is wider than ±1 sample, the fit is
/// repeated with the given delay.
/// @throws Failure (bad_data) if a record is given twice, the torque reverses less than twice, a single
/// reading is an outlier, or the model does not explain the records.
Identification identify(std::vector<TestRecord> records, const IdentificationOptions& options = {});

/// A sentence on the peak in the spectrum of the residuals and its likely cause (a second mass), without the
/// full stop; empty if there is no peak.
std::string second_mass_text(const Identification& identification);

/// The identified parameters as text for a manifest, with the strong correlations as comments.
std::string manifest_fragment(const Identification& identification);

/// The joint draws as a text table for the key `samples` of a manifest: comments with #, a header with the
/// keys of the parameters, and a line of comma-separated numbers for each draw.
std::string posterior_table(const Identification& identification);

/// Description of the answer: the parameters, the parts of the records, the checks of the residuals and the
/// fragment of a manifest.
document::AnswerDescription<Identification> identification_answer();

}  // namespace zerocount::fit
