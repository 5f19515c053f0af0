#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "analysis/measures/goal_counts.hpp"
#include "core/failure/failure.hpp"
#include "core/loop/controller/controller.hpp"
#include "core/trial/trial.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/sections/joint_draws.hpp"
#include "experiments/study/condition_study.hpp"
#include "experiments/study/point_label.hpp"
#include "experiments/study/study.hpp"
#include "experiments/yaml/text_file.hpp"
#include "results/layout/header.hpp"
#include "results/layout/measure_table.hpp"
#include "results/reading/results_file.hpp"
#include "runners/plugins/plugin_library.hpp"
#include "runners/python/arrays.hpp"
#include "runners/python/package.hpp"

namespace zerocount::python {
namespace {

namespace fs = std::filesystem;
using StudyPointer = std::shared_ptr<const study::Study>;

/// The study of a manifest's text. @param folder from which the files that it names are found
StudyPointer parsed(std::string text, const std::string& source, const fs::path& folder,
                    const std::vector<std::string>& overrides) {
  const sections::Companions companions{
      .plugin = [&](const std::string& path) { return plugins::load_plugin(folder / path); },
      .samples =
          [&](const std::string& path, std::string_view what) {
            return yaml::read_text(folder / path, sections::max_samples_size, what);
          }};
  return std::make_shared<const study::Study>(
      manifest::new_study(std::move(text), source, overrides, companions));
}

/// The plugin of a path. @throws Failure (bad_input)
std::shared_ptr<const plugin::ControllerPlugin> loaded(const fs::path& library) {
  const sections::LoadedPlugin plugin = plugins::load_plugin(library);
  if (const auto* fault = std::get_if<plugin::PluginFault>(&plugin))
    throw Failure(ExitCode::bad_input, fmt::format("plugin: {}; expected {}", fault->what, fault->expected));
  return std::get<std::shared_ptr<const plugin::ControllerPlugin>>(plugin);
}

/// The study of a results file, as its trials were run.
StudyPointer recorded(const fs::path& file, const std::optional<fs::path>& library) {
  const reading::ResultsFile results(file, reading::Require::any_part);
  return std::make_shared<const study::Study>(
      layout::recorded_study(results.header(), file, library ? loaded(*library) : nullptr));
}

py::dict axis_of(const study::SweepAxis& axis) {
  py::dict result;
  result["name"] = axis.name;
  result["unit"] = axis.unit;
  result["meaning"] = axis.meaning;
  if (axis.kind == study::SweepAxis::Kind::number) {
    result["values"] = axis.numbers;
  } else {
    result["values"] = axis.texts;
  }
  return result;
}

py::list axes_of(const study::Study& study) {
  py::list axes;
  for (const study::SweepAxis& axis : study.points.axes) axes.append(axis_of(axis));
  return axes;
}

py::list inputs_of(const study::Study& study) {
  py::list inputs;
  for (const study::InputColumn& column : study.columns.inputs) {
    py::dict input;
    input["name"] = column.name;
    input["unit"] = column.unit;
    input["meaning"] = column.meaning;
    inputs.append(input);
  }
  return inputs;
}

/// Lets the law decide in place of the study's control law.
void use_law(trial::TrialParameters& parameters, const py::object& law) {
  if (loop::has_coarse_phase(parameters.controller)) {
    throw Failure(
        ExitCode::bad_input,
        "the study has two phases of control, and a control law in Python has one; expected a study "
        "without controller.coarse");
  }
  parameters.controller.user = {python_law(law), {}};
}

/// A trial, sample by sample.
struct TracedTrial {
  std::vector<double> inputs;
  std::vector<layout::TraceRecord> samples;
  std::vector<layout::JerkRecord> jerks;
  trial::TrialOutcome outcome;
};

TracedTrial traced(const study::StudyTrial& trial, const std::stop_token& stop) {
  TracedTrial result{trial.inputs, {}, {}, {}};
  trial::TrialObservers observers;
  observers.sample = [&](const trial::SampleRecord& record) { result.samples.push_back({record, 0}); };
  observers.jerk = [&](const trial::Jerk& jerk) { result.jerks.push_back({jerk, 0}); };
  observers.stop = stop;
  result.outcome = trial::run_trial(trial.parameters, observers);
  return result;
}

template <class Record>
py::dict columns_of(const std::vector<layout::RecordField<Record>>& fields, const auto& records) {
  return arrays_of<Record>(fields, layout::pointers_to(records), {std::ssize(records)});
}

/// Runs a trial, and gives what happened.
py::dict trace(const study::Study& study, std::int64_t point, std::int64_t index, const py::object& law) {
  study::StudyTrial trial = study::study_trial(study, point, index);
  TracedTrial traced_trial;
  if (law.is_none()) {
    interruptible([&](const std::stop_token& stop) { traced_trial = traced(trial, stop); });
  } else {
    use_law(trial.parameters, law);
    traced_trial = traced(trial, {});
  }
  py::dict result;
  result["inputs"] = traced_trial.inputs;
  result["samples"] = columns_of(layout::trace_fields(study.features), traced_trial.samples);
  result["jerks"] = columns_of(layout::jerk_fields(), traced_trial.jerks);
  result["outcome"] =
      columns_of(layout::outcome_fields(study.features, layout::measure_table(study.features)),
                 traced_trial.outcome.moves);
  return result;
}

std::string_view name_of(layout::MoveReduction rule) {
  switch (rule) {
    case layout::MoveReduction::all:
      return "all";
    case layout::MoveReduction::any:
      return "any";
    case layout::MoveReduction::sum:
      return "sum";
    case layout::MoveReduction::largest:
      return "largest";
    case layout::MoveReduction::last:
      break;
  }
  return "last";
}

/// What the columns of trace() are.
py::dict descriptions(const study::Study& study) {
  const parameters::AxisKind axis = study.features.axis;
  py::dict result;
  result["samples"] = descriptions_of(layout::trace_fields(study.features), axis);
  result["jerks"] = descriptions_of(layout::jerk_fields(), axis);
  py::dict measures;
  std::set<std::string> names;
  for (const auto& field : layout::outcome_fields(study.features, layout::measure_table(study.features)))
    names.insert(field.column.name);
  for (const layout::Measure& measure : layout::measure_table(study.features)) {
    if (!names.contains(measure.field.column.name)) continue;
    py::dict description = description_of(measure.field.column, axis);
    description["of_trial"] = std::string(name_of(measure.reduction));
    measures[py::str(measure.field.column.name)] = description;
  }
  result["outcome"] = measures;
  return result;
}

std::vector<std::int64_t> bands_of(const study::Study& study) {
  const auto values = study.features.bands.values();
  return {values.begin(), values.end()};
}

std::vector<double> tolerances_of(const study::Study& study) {
  const auto values = study.features.tolerances.values();
  return {values.begin(), values.end()};
}

py::dict described_goal(const study::Goal& goal, const measures::CountedGoal& counted) {
  py::dict described;
  described["name"] = goal.name;
  described["band"] = goal.tolerance ? py::object(py::none()) : py::object(py::int_(goal.band));
  described["tolerance"] = goal.tolerance;
  described["within"] = goal.within;
  described["moves"] = goal.moves;
  described["machines"] = goal.machines;
  described["confidence"] = goal.confidence;
  described["on"] = goal.on;
  py::dict limits;
  for (const study::GoalLimit& limit : goal.limits) limits[py::str(limit.measure)] = limit.largest;
  described["limits"] = limits;
  described["latest"] = measures::latest(counted);
  return described;
}

std::vector<py::dict> goals_of(const study::Study& study) {
  std::vector<py::dict> goals;
  const std::vector<measures::CountedGoal> counted = measures::counted_goals(study);
  for (std::size_t i = 0; i < counted.size(); ++i)
    goals.push_back(described_goal(study.goals[i], counted[i]));
  return goals;
}

/// The only goal; nothing where there is none, or several.
py::object goal_of(const study::Study& study) {
  if (study.goals.size() != 1) return py::none();
  return goals_of(study).front();
}

}  // namespace

void register_study(py::module_& module) {
  using study::Study;
  py::class_<Study, std::shared_ptr<Study>> object(module, "Study", "A checked manifest.");
  object
      .def(py::init([](std::string text, const std::string& source, const fs::path& folder,
                       const std::vector<std::string>& overrides) {
             return std::const_pointer_cast<Study>(parsed(std::move(text), source, folder, overrides));
           }),
           py::arg("text"), py::arg("source"), py::arg("folder"), py::arg("overrides"))
      .def_static(
          "recorded",
          [](const fs::path& file, const std::optional<fs::path>& plugin) {
            return std::const_pointer_cast<Study>(recorded(file, plugin));
          },
          py::arg("file"), py::arg("plugin") = py::none())
      .def_readonly("name", &Study::name)
      .def_readonly("description", &Study::description)
      .def_readonly("seed", &Study::seed)
      .def_readonly("trials", &Study::trials)
      .def_readonly("rigs", &Study::rigs)
      .def_readonly("worlds", &Study::worlds)
      .def_readonly("conditions", &Study::conditions)
      .def_readonly("condition_names", &Study::condition_names)
      .def_property_readonly("ages", [](const Study& s) { return s.ages.at; })
      .def_property_readonly("age_unit", [](const Study& s) { return s.ages.unit; })
      .def_readonly("moves", &Study::moves)
      .def_property_readonly("labels", [](const Study& s) { return s.points.labels; })
      .def_readonly("sha256", &Study::study_sha256)
      .def_property_readonly("text", [](const Study& s) { return s.manifest.text; })
      .def_property_readonly("overrides", [](const Study& s) { return s.manifest.overrides; })
      .def_readonly("warnings", &Study::warnings)
      .def_readonly("observed", &Study::observed)
      .def_property_readonly("linear",
                             [](const Study& s) { return s.features.axis == parameters::AxisKind::linear; })
      .def_property_readonly("plugin", [](const Study& s) { return s.plugin != nullptr; })
      .def_property_readonly("axes", &axes_of)
      .def_property_readonly("inputs", &inputs_of)
      .def_property_readonly("bands", &bands_of)
      .def_property_readonly("tolerances", &tolerances_of)
      .def_property_readonly("goal", &goal_of)
      .def_property_readonly("goals", &goals_of)
      .def_property_readonly("descriptions", &descriptions)
      .def(
          "under",
          [](const Study& s, const std::string& condition) {
            return std::make_shared<Study>(study::under_condition(s, study::condition_named(s, condition)));
          },
          py::arg("condition"))
      .def("trace", &trace, py::arg("point"), py::arg("trial"), py::arg("law") = py::none());
  register_sampling(object);
  module.def(
      "point_named",
      [](const std::string& text, const std::vector<std::string>& labels) {
        return study::point_named(text, labels);
      },
      py::arg("text"), py::arg("labels"));
}

}  // namespace zerocount::python
