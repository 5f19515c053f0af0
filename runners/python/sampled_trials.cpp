#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/parallel/parallel.hpp"
#include "core/failure/failure.hpp"
#include "core/trial/outcome.hpp"
#include "core/trial/trial.hpp"
#include "experiments/randomness/random_variables.hpp"
#include "results/layout/fields.hpp"
#include "runners/python/arrays.hpp"
#include "runners/python/package.hpp"
#include "runners/trials/trial_set.hpp"

namespace zerocount::python {
namespace {

namespace d = distributions;
using Matrix = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Numbers = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;

constexpr std::int64_t trials_at_a_time = 64;

// The form that a distribution has in a manifest.
py::dict form_of(const d::Uniform& u) {
  return py::dict(py::arg("uniform") = py::make_tuple(u.low, u.high));
}
py::dict form_of(const d::LogUniform& u) {
  return py::dict(py::arg("log_uniform") = py::make_tuple(u.low, u.high));
}
py::dict form_of(const d::Normal& n) {
  return py::dict(py::arg("normal") = py::dict(py::arg("mean") = n.mean, py::arg("sd") = n.sd));
}
py::dict form_of(const d::TruncatedNormal& n) {
  return py::dict(py::arg("truncated_normal") = py::dict(py::arg("mean") = n.mean, py::arg("sd") = n.sd,
                                                         py::arg("low") = n.low, py::arg("high") = n.high));
}
py::dict form_of(const d::Lognormal& l) {
  return py::dict(py::arg("lognormal") = py::dict(py::arg("median") = l.median, py::arg("cv") = l.cv));
}
py::dict form_of(const d::Triangular& t) {
  return py::dict(py::arg("triangular") = py::make_tuple(t.low, t.mode, t.high));
}
py::dict form_of(const d::Integers& i) {
  return py::dict(py::arg("integers") = py::make_tuple(i.low, i.high));
}
py::dict form_of(const d::Choice& c) {
  return py::dict(py::arg("choice") = py::cast(c.values));
}

/// What a variable is: a value in its unit, the normal score of a profile, or the row of joint samples.
std::string_view kind_of(const randomness::RandomCoordinate& coordinate) {
  if (coordinate.rows > 0) return "row";
  return coordinate.kind == randomness::RandomCoordinate::Kind::profile_at_start ? "score" : "value";
}

void require_one_condition(const study::Study& study) {
  if (study.conditions.empty()) return;
  throw Failure(ExitCode::bad_input, fmt::format("{}: a sample is of one condition; expected one of {}",
                                                 study.name, fmt::join(study.conditions, ", ")));
}

/// The random variables of a point: {"names", "kinds", "units", "distributions", "correlations"}.
py::dict variables_of(const study::Study& study, std::int64_t point) {
  require_one_condition(study);
  const randomness::RandomVariables variables = randomness::random_variables(study, point);
  py::list names, kinds, units, forms;
  std::vector<double> correlations;
  for (const randomness::RandomVariable& variable : variables.variables) {
    names.append(variable.name);
    kinds.append(std::string(kind_of(variable.coordinate)));
    units.append(variable.unit);
    forms.append(
        std::visit([](const auto& distribution) { return form_of(distribution); }, variable.distribution));
  }
  for (const std::vector<double>& row : variables.correlations)
    correlations.insert(correlations.end(), row.begin(), row.end());
  const py::ssize_t size = std::ssize(variables.variables);
  py::dict result;
  result["names"] = names;
  result["kinds"] = kinds;
  result["units"] = units;
  result["distributions"] = forms;
  result["correlations"] = array_of(std::move(correlations), {size, size});
  return result;
}

/// [trial, variable] The values at standard normal scores, to which the correlations were applied.
py::array values_at_scores(const study::Study& study, std::int64_t point, const Matrix& scores) {
  const randomness::RandomVariables variables = randomness::random_variables(study, point);
  const std::size_t width = variables.variables.size();
  std::vector<double> values(scores.data(), scores.data() + scores.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double u = randomness::uniform_of_score(values[i]);
    values[i] = distributions::quantile(variables.variables[i % width].distribution, u);
  }
  return array_of(std::move(values), {scores.shape(0), scores.shape(1)});
}

/// [trial] The outcomes of trials with these values, on all cores.
std::vector<trial::TrialOutcome> simulated(const study::Study& study, std::int64_t point,
                                           std::span<const double> x, std::span<const std::int64_t> numbers,
                                           const std::stop_token& stop) {
  require_one_condition(study);
  const randomness::RandomVariables variables = randomness::random_variables(study, point);
  const std::size_t width = variables.variables.size();
  const auto draw = [&](std::int64_t number) {
    const auto i = static_cast<std::size_t>(number);
    const study::GivenDraws draws =
        randomness::draws_with(study, variables, x.subspan(i * width, width), numbers[i]);
    return study::study_trial(study, point, 0, draws).parameters;
  };
  return trials::results_of(std::ssize(numbers), trials_at_a_time, draw, stop,
                            [](const trial::TrialOutcome& outcome) { return outcome; });
}

/// {measure: [trial, move]} of trials with these values.
py::dict simulate(const study::Study& study, std::int64_t point, const Matrix& x, const Numbers& numbers,
                  int threads) {
  const std::span<const double> values(x.data(), static_cast<std::size_t>(x.size()));
  const std::span<const std::int64_t> trials(numbers.data(), static_cast<std::size_t>(numbers.size()));
  std::vector<trial::TrialOutcome> outcomes;
  interruptible([&](const std::stop_token& stop) {
    const parallel::ThreadLimit limit(threads);
    outcomes = simulated(study, point, values, trials, stop);
  });
  std::vector<const trial::MoveOutcome*> moves;
  for (const trial::TrialOutcome& outcome : outcomes) {
    for (const trial::MoveOutcome& move : outcome.moves) moves.push_back(&move);
  }
  const auto fields = layout::outcome_fields(study.features, layout::measure_table(study.features));
  return arrays_of<trial::MoveOutcome>(fields, moves, {std::ssize(outcomes), study.moves});
}

}  // namespace

void register_sampling(py::class_<study::Study, std::shared_ptr<study::Study>>& object) {
  object.def("variables", &variables_of, py::arg("point"))
      .def("values_at_scores", &values_at_scores, py::arg("point"), py::arg("scores"))
      .def("simulate", &simulate, py::arg("point"), py::arg("x"), py::arg("numbers"), py::arg("threads"));
}

}  // namespace zerocount::python
