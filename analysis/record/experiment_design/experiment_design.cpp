#include "analysis/record/experiment_design/experiment_design.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/basis/parallel/parallel.hpp"
#include "core/failure/failure.hpp"
#include "core/loop/dac.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::experiment_design {
namespace {

void require_known_law(const study::Study& study, const Machine& machine) {
  const friction::FrictionModel model = machine.parameters.friction.model;
  if (!friction::has_spring(model))
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: friction.model: an experiment can be designed only for presliding and "
                              "spring; 'zerocount identify --model' fits other laws to any record",
                              study.name));
  if (motion::has_load(machine.parameters.plant))
    throw Failure(ExitCode::bad_input, fmt::format("{}: it has a second mass (plant.load), which the model "
                                                   "of 'zerocount identify' lacks; expected one mass",
                                                   study.name));
}

/// Time in which the free motion on the spring falls to 1/e, s: 2J/c for an oscillation; for an overdamped
/// motion the reciprocal of its slower rate.
double ring_down_time(const fit::ContactParameters& contact) {
  const double damping = contact.plant.presliding_damping;
  const double discriminant = damping * damping - 4.0 * contact.plant.inertia * contact.friction.k1;
  if (discriminant <= 0.0) return 2.0 * contact.plant.inertia / damping;
  return 0.5 * (damping + std::sqrt(discriminant)) / contact.friction.k1;
}

/// The limits (torque, number of samples, ring-down time) of a protocol for all the machines.
/// @param machines the median machine first
/// @param least_breakaway smallest breakaway torque of all machines, N m
ProtocolFrame frame_for(const std::vector<Machine>& machines, const DesignSettings& settings,
                        double least_breakaway) {
  const trial::TrialParameters& median = machines.front().parameters;
  ProtocolFrame frame;
  frame.axis = machines.front().axis;
  frame.dac = median.dac;
  frame.sample_time = 1.0 / median.controller.sample_rate;
  frame.samples = std::llround(settings.duration * median.controller.sample_rate);
  frame.max_torque = std::min(settings.max_torque * least_breakaway, loop::highest_torque(frame.dac));
  constexpr double ring_down = 5.0;       // exp(−5) of the median machine's oscillation is left
  constexpr double min_ring_down = 30.0;  // samples
  constexpr double max_ring_down = 1e9;   // of an axis without damping
  frame.ring_down_samples = static_cast<std::int64_t>(
      std::ceil(std::clamp(ring_down * ring_down_time(machines.front().contact) / frame.sample_time,
                           min_ring_down, max_ring_down)));
  return frame;
}

void require_room(const ProtocolFrame& frame) {
  if (frame.samples >= min_samples(frame)) return;
  throw Failure(ExitCode::bad_input,
                fmt::format("{:g} s are too short for an experiment of this axis; expected {:.3g} s at least",
                            static_cast<double>(frame.samples) * frame.sample_time,
                            static_cast<double>(min_samples(frame)) * frame.sample_time));
}

double guess_of(const fit::ContactParameters& contact, std::size_t parameter) {
  const double values[] = {contact.friction.k1,     contact.friction.k2,
                           contact.friction.beta,   contact.plant.presliding_damping,
                           contact.plant.inertia,   contact.friction.alpha,
                           contact.friction.lambda, contact.friction.n};
  return values[parameter];
}

/// Relative half-width of the interval of a parameter: half-width divided by value.
/// @param parameter index in fit::coordinate_keys
/// @param width half-width on the scale of Widths
double relative_width(std::size_t parameter, double width, const fit::ContactParameters& contact) {
  return parameter == fit::creep_exponent ? width / contact.friction.n : std::sinh(width);
}

std::vector<ExpectedParameter> expected_parameters(const ExperimentDesign& design,
                                                   const std::vector<Machine>& machines,
                                                   const std::vector<Widths>& widths) {
  std::vector<ExpectedParameter> parameters;
  for (const fit::ParameterEstimate& estimate : design.identification.parameters) {
    const auto at = std::ranges::find(fit::coordinate_keys, estimate.key);
    if (estimate.key.empty() || at == fit::coordinate_keys.end()) continue;
    const auto j = static_cast<std::size_t>(at - fit::coordinate_keys.begin());
    ExpectedParameter parameter{estimate.key, estimate.unit, guess_of(design.median.contact, j), estimate};
    parameter.narrowest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < machines.size(); ++i) {
      if (!(widths[i][j] <= fit::max_half_width(j != fit::creep_exponent))) continue;
      const double relative = relative_width(j, widths[i][j], machines[i].contact);
      parameter.narrowest = std::min(parameter.narrowest, relative);
      parameter.widest = std::max(parameter.widest, relative);
      ++parameter.told;
    }
    parameters.push_back(std::move(parameter));
  }
  return parameters;
}

/// [machine] Expected half-widths of the parameters' intervals; all infinite if `identify` refuses the record
/// of the machine.
std::vector<Widths> widths_on(const std::vector<Machine>& machines, const TorqueProtocol& protocol) {
  std::vector<Widths> widths(machines.size());
  parallel::for_each_index(machines.size(), [&](std::size_t i) {
    try {
      widths[i] = expected_widths(machines[i], protocol, simulate(machines[i], protocol));
    } catch (const Failure&) {
      widths[i].assign(fit::time_offset, std::numeric_limits<double>::infinity());
    }
  });
  return widths;
}

void set_shape(ExperimentDesign& design, const ProtocolShape& shape) {
  design.shape = shape;
  design.segments = segments_of(shape, design.frame);
  design.protocol = sampled_protocol(design.segments, design.frame);
  design.record = simulate(design.median, design.protocol);
}

/// Chooses the best protocol shape with which `identify` succeeds on the median machine. The linear theory
/// does not know whether a fit converges from its starting values; shapes nearer to the usual one are easier
/// for it. A record whose residuals are not explained is accepted only if there is no other: the manifest may
/// have effects that `identify` does not model.
void identify_median(ExperimentDesign& design, const fit::StageReport& report) {
  const std::vector<JudgedShape> shapes = design.search.improvements;
  std::optional<ExperimentDesign> unexplained;
  std::string refusal;
  constexpr double misfit = 1.25;  // widening of the intervals that is more than an estimated noise explains
  for (std::size_t back = 1; back <= shapes.size(); back *= 2) {
    set_shape(design, shapes[shapes.size() - back].shape);
    try {
      design.identification = identified(design.median, design.protocol, design.record, report);
      if (design.identification.checks.widening < misfit) return;
      if (!unexplained) unexplained = design;
    } catch (const Failure& failure) {
      refusal = failure.what();
    }
  }
  if (!unexplained)
    throw Failure(ExitCode::inconclusive,
                  fmt::format("{}: identify refuses the record of the median machine under the best {}: {}",
                              design.study, parameters::text_on(design.frame.axis, "$torque"), refusal));
  design = std::move(*unexplained);
}

}  // namespace

ExperimentDesign design_experiment(const study::Study& study, const DesignSettings& settings) {
  const auto enter = [&](std::string_view stage) {
    if (settings.report) settings.report(stage);
  };
  ExperimentDesign design;
  design.study = study.name;
  design.median = median_machine(study, settings.point);
  require_known_law(study, design.median);
  std::vector<Machine> machines{design.median};
  for (Machine& machine : drawn_machines(study, settings.point, settings.machines))
    machines.push_back(std::move(machine));
  design.machines = static_cast<std::int64_t>(machines.size());
  design.least_breakaway = std::numeric_limits<double>::infinity();
  for (const Machine& machine : machines)
    design.least_breakaway = std::min(design.least_breakaway, machine.contact.friction.breakaway);
  design.frame = frame_for(machines, settings, design.least_breakaway);
  require_room(design.frame);

  enter("search of the protocol");
  const SearchProblem problem{design.frame, machines, 4, settings.max_travel};
  SearchSettings search = settings.search;
  search.go_on = [&](int protocols) {
    enter(fmt::format("search: {} protocols", protocols));
    return !settings.search.go_on || settings.search.go_on(protocols);
  };
  design.search = search_protocol(problem, search);
  identify_median(design, settings.report);
  design.travel = safety_of(problem, design.protocol).travel;

  enter("widths on all machines");
  const std::vector<Widths> widths = widths_on(machines, design.protocol);
  design.parameters = expected_parameters(design, machines, widths);
  return design;
}

}  // namespace zerocount::experiment_design
