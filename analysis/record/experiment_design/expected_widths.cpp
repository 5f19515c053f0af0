#include "analysis/record/experiment_design/expected_widths.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "analysis/record/fit/presliding/contact.hpp"
#include "analysis/record/fit/records/checked_record.hpp"
#include "analysis/record/fit/residuals.hpp"
#include "core/loop/encoder.hpp"

namespace zerocount::experiment_design {
namespace {

using fit::coordinate_count;
using fit::TestRecord;

/// A fit of a simulated record whose point is the machine's own (true) parameters; nothing is fitted.
struct TrueFit : fit::Fit {
  std::vector<TestRecord> records;
  /// [parameter] Reported quantity of each parameter with a manifest key; null for parameters that the fit
  /// keeps fixed.
  std::array<std::optional<fit::Quantity>, fit::time_offset> quantities;
};

bool is_creep(std::size_t coordinate) {
  return coordinate == fit::log_alpha || coordinate == fit::log_limit || coordinate == fit::creep_exponent;
}

TrueFit true_fit(const Machine& machine, const TorqueProtocol& protocol, const SimulatedRecord& simulated) {
  TrueFit fit;
  fit.records.push_back(test_record_of(machine, protocol, simulated));
  fit::ContactParameters contact = machine.contact;
  const bool creeps = contact.friction.alpha > 0.0;
  if (!creeps) contact.friction.alpha = 1e-9;  // its logarithm is to be finite
  for (std::size_t j = 0; j < coordinate_count; ++j) fit.setting.free.push_back(creeps || !is_creep(j));
  const double creep_torque = fit::creep_torque_for(fit.records, {});
  fit.setting.model = fit::contact_model(creep_torque);
  fit.setting.prior = fit::point_of(contact, creep_torque);
  fit::FitPoint point{fit.setting.prior, Eigen::VectorXd(1)};
  point.offset[0] = machine.parameters.initial.encoder_phase;
  fit::observe_at(fit.records, point, fit);
  for (const fit::Quantity& quantity : fit.setting.model.quantities_at(point.axis)) {
    for (std::size_t j = 0; j < fit.quantities.size(); ++j) {
      if (quantity.key == fit::coordinate_keys[j] && fit.setting.free[j]) fit.quantities[j] = quantity;
    }
  }
  return fit;
}

}  // namespace

TestRecord test_record_of(const Machine& machine, const TorqueProtocol& protocol,
                          const SimulatedRecord& simulated) {
  const trial::TrialParameters& parameters = machine.parameters;
  fit::RawSeries series;
  series.name = "simulated record";
  for (std::size_t k = 0; k < protocol.torque.size(); ++k) {
    series.time.push_back(static_cast<double>(k) * protocol.sample_time);
    series.torque.push_back(protocol.torque[k]);
    series.angle.push_back(static_cast<double>(simulated.counts[k]));
    series.code.push_back(static_cast<double>(protocol.codes[k]));
  }
  series.sliding.assign(protocol.torque.size(), false);
  series.bandwidth = parameters.amplifier.bandwidth;
  series.delay = parameters.controller.delay;
  series.count_size = loop::fine_resolution(parameters.encoder);
  series.linear = machine.axis == parameters::AxisKind::linear;
  series.dac_bits = parameters.dac.bits;
  series.units_known = true;
  TestRecord record = fit::checked_record(series, true);
  record.parts = fit::parts_of(record);
  return record;
}

double log_spread(const Machine& machine, const TorqueProtocol& protocol, const SimulatedRecord& simulated) {
  const TrueFit fit = true_fit(machine, protocol, simulated);
  const Eigen::MatrixXd covariance = fit::textbook_covariance(fit.model, fit.observations, fit.setting)
                                         .topLeftCorner(fit::contact_dimension, fit::contact_dimension);
  double sum = 0.0;
  double count = 0.0;
  for (const std::optional<fit::Quantity>& quantity : fit.quantities) {
    if (!quantity) continue;
    sum += 0.5 * std::log(quantity->slope.dot(covariance * quantity->slope));
    count += 1.0;
  }
  return sum / count;
}

Widths expected_widths(const Machine& machine, const TorqueProtocol& protocol,
                       const SimulatedRecord& simulated) {
  constexpr std::size_t replicates = 200;
  const TrueFit fit = true_fit(machine, protocol, simulated);
  const fit::ReadingReplicates found = fit::replicate_readings(fit.records, fit, replicates);
  Widths widths;
  for (const std::optional<fit::Quantity>& quantity : fit.quantities) {
    widths.push_back(std::numeric_limits<double>::infinity());
    if (!quantity) continue;
    widths.back() = fit::interval_of_errors(*quantity, found.errors, 1.0).half_width();
  }
  return widths;
}

fit::Identification identified(const Machine& machine, const TorqueProtocol& protocol,
                               const SimulatedRecord& simulated, const fit::StageReport& report) {
  fit::IdentificationOptions options;
  options.report = report;
  return fit::identify({test_record_of(machine, protocol, simulated)}, options);
}

}  // namespace zerocount::experiment_design
