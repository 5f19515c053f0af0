#include "runners/study_commands/trace_writer.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "results/layout/layout.hpp"
#include "results/reading/export.hpp"

namespace zerocount::study_commands {
namespace {

std::vector<layout::RecordField<layout::TraceRecord>> columns_of(const study::StudyFeatures& features) {
  std::vector<layout::RecordField<layout::TraceRecord>> columns = layout::trace_fields(features);
  std::erase_if(columns, [](const layout::RecordField<layout::TraceRecord>& field) {
    return field.column.name == "trial";
  });
  return columns;
}

/// JSON text of one field of a record; null if its number is not finite.
template <class Record>
std::string json_text(const layout::RecordField<Record>& field, const Record& record) {
  if (!std::isfinite(layout::value_of(field, record))) return "null";
  const std::string text = reading::value_text(field, record);
  return field.column.element == hdf5::Element::int8 ? '"' + text + '"' : text;
}

nlohmann::ordered_json outcome_json(const trial::MoveOutcome& outcome,
                                    const std::vector<layout::RecordField<trial::MoveOutcome>>& measures) {
  nlohmann::ordered_json object;
  for (const layout::RecordField<trial::MoveOutcome>& field : measures) {
    const double value = layout::value_of(field, outcome);
    nlohmann::ordered_json& place = object[field.column.name];  // null where a number is not finite
    if (field.column.element == hdf5::Element::flag) {
      place = value != 0.0;
    } else if (field.column.element == hdf5::Element::int8) {
      place = reading::value_text(field, outcome);
    } else if (field.column.element != hdf5::Element::float64) {
      place = static_cast<std::int64_t>(value);
    } else if (std::isfinite(value)) {
      place = value;
    }
  }
  return object;
}

}  // namespace

void TraceWriter::begin(const TraceSubject& subject) {
  columns_ = columns_of(subject.study.features);
  measures_ = layout::outcome_fields(subject.study.features, layout::measure_table(subject.study.features));
  if (json_) {
    nlohmann::ordered_json inputs = nlohmann::ordered_json::object();
    for (std::size_t i = 0; i < subject.trial.inputs.size(); ++i) {
      inputs[subject.study.columns.inputs[i].name] = subject.trial.inputs[i];
    }
    const std::string machine =
        subject.study.machines > 0
            ? fmt::format(", \"machine\": {}",
                          study::group_of(subject.study, study::Grouping::machine, subject.index))
            : "";
    sink_(fmt::format("{{\"name\": {}, \"point\": {}, \"trial\": {}{},\n \"inputs\": {},\n \"samples\": [",
                      nlohmann::json(subject.study.name).dump(), subject.point, subject.index, machine,
                      inputs.dump()));
    return;
  }
  std::string header;
  for (const layout::RecordField<layout::TraceRecord>& field : columns_) {
    header += (header.empty() ? "" : ",") + field.column.name;
  }
  sink_(header + "\n");
}

void TraceWriter::write(const trial::SampleRecord& sample) {
  const layout::TraceRecord record{sample, 0};
  std::string line;
  for (const layout::RecordField<layout::TraceRecord>& field : columns_) {
    if (!line.empty()) line += json_ ? ", " : ",";
    if (json_) line += fmt::format("\"{}\": ", field.column.name);
    line += json_ ? json_text(field, record) : reading::value_text(field, record);
  }
  if (json_) {
    sink_(fmt::format("{}\n  {{{}}}", first_ ? "" : ",", line));
  } else {
    sink_(line + "\n");
  }
  first_ = false;
}

void TraceWriter::end(const trial::TrialOutcome& outcome) {
  if (!json_) return;
  nlohmann::ordered_json moves = nlohmann::ordered_json::array();
  for (const trial::MoveOutcome& move : outcome.moves) moves.push_back(outcome_json(move, measures_));
  sink_(fmt::format("],\n \"outcome\": {}}}\n", moves.dump()));
}

}  // namespace zerocount::study_commands
