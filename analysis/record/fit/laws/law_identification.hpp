#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "analysis/basis/document/answer.hpp"
#include "analysis/record/fit/model.hpp"
#include "analysis/record/fit/presliding/contact_fit.hpp"
#include "analysis/record/fit/presliding/identification.hpp"
#include "analysis/record/fit/record.hpp"
#include "analysis/record/fit/residuals.hpp"
#include "analysis/record/fit/solver.hpp"
#include "core/friction/friction_model.hpp"

namespace zerocount::fit {

/// Ranges of the coordinates (fitted unknowns) of a law: a fit may change each by a factor of 1000. The last
/// coordinate is the time offset.
/// @param dimension number of coordinates
std::vector<CoordinateRange> law_coordinates(std::size_t dimension);

/// Orders of magnitude in the records, from which the starting points of a law's fit follow.
struct RecordScales {
  Point contact;                 ///< Starting point of the fit of the pre-sliding model.
  double creep_torque{1.0};      ///< Torque σ0 to which the creep coordinates of `contact` refer, N m.
  double largest_torque{0.0};    ///< Largest |torque| of the records, N m.
  double secant_stiffness{0.0};  ///< Secant stiffness: range of the torque divided by travel, N m/rad.
};

RecordScales scales_of(Records records);

/// The friction laws that allow motion before sliding, and can therefore be fitted to records without
/// sliding.
std::span<const friction::FrictionModel> fitted_laws();

/// The fit model of a friction law.
/// @param law one of fitted_laws()
/// @param scales orders of magnitude for its starting points
FitModel law_model(friction::FrictionModel law, const RecordScales& scales, Records records);

/// The model extended by the compliance of a fixture in series with the friction contact. The logarithm of
/// the compliance becomes the coordinate before the time offset. The reading is then the rotor's angle plus
/// compliance times torque.
FitModel with_series_compliance(FitModel model, const RecordScales& scales);

/// The fit model of the Maxwell-slip law: parallel elements that stick or slip, with the rotor's inertia and
/// damping.
FitModel maxwell_slip_model(const RecordScales& scales, Records records);

/// If the sum of squares of a law exceeds that of the best other law by this factor, the law is not searched
/// further.
inline constexpr double hopeless = 100.0;

/// A friction law fitted to records.
struct LawFit : Fit {
  /// [record][sample] Residuals of the fit to all readings that are not masked, in the record's unit.
  std::vector<std::vector<double>> residuals;
  /// Sum of squared residuals of the fit to all readings, divided by the variance of the rounding to counts.
  double squares{0.0};
  bool converged{false};
};

/// Fits a law by non-linear least squares. The first fit is to all readings with equal weights, from the best
/// of the starting points (follow_best()). If the law explains the readings, three rounds of fits to the
/// observations (observe()) follow. A law whose best starting points have a hundred times the sum of squares
/// of another law is fitted with fewer steps.
/// @param least_squares smallest sum of squares of the laws fitted before; infinite if this is the first
/// @throws Failure (bad_data) if the law cannot be simulated from any of its starting points.
LawFit fit_law(Records records, const FitModel& model, double least_squares);

/// Repeats the fit of a law whose fit `found` does not explain the records. It starts from many more points,
/// scattered at random about the starting points of the law and about `found`.
/// @param least_squares smallest sum of squares of the laws fitted before
/// @returns the better one of the old and the new fit
LawFit search_again(Records records, const FitModel& model, double least_squares, LawFit found);

/// A friction law identified from records.
struct IdentifiedLaw : FitReport {
  friction::FrictionModel law{friction::FrictionModel::presliding};
  std::size_t fitted{0};           ///< Number of fitted coordinates (unknowns), including the time offset.
  double misfit{0.0};              ///< Root mean square of the residuals of all readings, rad or m.
  double misfit_over_travel{0.0};  ///< Misfit divided by the travel of the records, dimensionless.
  /// Bayesian information criterion (BIC) minus that of the best law; 0 for the best law, larger is worse.
  double information_criterion{0.0};
  ResidualChecks checks;
  bool converged{true};
};

/// A friction law that could not be fitted to the records, with the reason. Such a failure says nothing about
/// the friction contact.
struct LawLeftOut {
  friction::FrictionModel law{friction::FrictionModel::presliding};
  std::string reason;
};

/// Comparison of the friction laws that were fitted to the same records.
struct LawComparison {
  parameters::AxisKind axis{parameters::AxisKind::rotary};
  /// The fitted laws. Laws that explain the records come first; within both groups they are sorted by the
  /// information criterion.
  std::vector<IdentifiedLaw> laws;
  std::vector<LawLeftOut> left_out;
  std::vector<RecordExtent> records;
  double effective_readings{0.0};  ///< Number of independent residuals in all records.
  std::size_t readings{0};
  double sample_time{0.0};  ///< Sampling interval, s, in which the time offsets are expressed.
};

/// The manifest's words for the friction laws that compare_laws() can fit: the laws that allow motion before
/// sliding.
std::vector<std::string> law_words();

/// The friction law that one of law_words() names.
friction::FrictionModel law_of(const std::string& word);

/// The choice of the friction laws that are fitted.
struct LawChoice {
  std::vector<friction::FrictionModel> laws;
  /// True: the compliance of a fixture in series with the contact is fitted with each law.
  bool series_compliance{false};
};

/// Fits friction laws to material tests, all of the same contact, and compares them by Schwarz's information
/// criterion (Ann. Statist. 6, 1978, 461) on the same readings:
///
///   BIC = Σ_r m_r·ln(S_r/N_r) + p·ln Σ m_r,
///
/// with the sum of squares S_r of the N_r readings of record r and p fitted parameters, the
/// phase of each record among them. Residuals of
/// neighbouring readings are alike, so that m_r is the number of independent ones, N_r over the correlation
/// length of the residuals of the law with the least squares of this record (Thiébaux & Zwiers, J. Climate
/// Appl. Meteor. 23, 1984, 800).
///
/// A law must explain the records (check_residuals()) before BIC compares it: BIC of a law that
/// does not is the best of wrong ones. A law that does not explain them is searched again (search_again()).
/// A law that begins in a state that it does not have, or cannot be simulated along the records, is left out.
/// @throws Failure (bad_data) if a record is given twice, or no law can be fitted
LawComparison compare_laws(std::vector<TestRecord> records, const LawChoice& choice,
                           const StageReport& report = {});

/// Description of the answer: the comparison, the parameters of every law, and a fragment of a manifest for
/// the best law.
document::AnswerDescription<LawComparison> laws_answer();

}  // namespace zerocount::fit
