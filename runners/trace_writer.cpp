#include "runners/trace_writer.hpp"

#include <cmath>
#include <variant>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "results/layout/layout.hpp"

namespace zerocount {
namespace {

/// The columns of a trace: those of the results file's /trace but for the trial, and in their order.
bool is_column(const RecordField<TraceRecord>& field) {
  return field.column.name != "trial";
}

std::string number_text(double value, bool json) {
  if (json && !std::isfinite(value)) return "null";
  return fmt::format("{}", value);  // the shortest text that reads back to the same double
}

std::string value_text(const RecordField<TraceRecord>& field, const TraceRecord& record, bool json) {
  const auto text = [&](auto member) -> std::string {
    const auto value = record.*member;
    if constexpr (std::is_same_v<std::remove_const_t<decltype(value)>, double>) {
      return number_text(value, json);
    } else {
      const auto number = static_cast<std::int64_t>(value);
      for (const FlagMeaning& flag : field.column.flags) {
        if (flag.value == number) return json ? '"' + flag.word + '"' : flag.word;
      }
      return fmt::format("{}", number);
    }
  };
  return std::visit(text, field.member);
}

nlohmann::ordered_json outcome_json(const MoveOutcome& outcome) {
  nlohmann::ordered_json object;
  for (const RecordField<MoveOutcome>& field : outcome_fields()) {
    const auto put = [&](auto member) {
      const auto value = outcome.*member;
      using Value = std::remove_const_t<decltype(value)>;
      if constexpr (std::is_same_v<Value, double>) {
        object[field.column.name] =
            std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
      } else if constexpr (std::is_same_v<Value, bool>) {
        object[field.column.name] = value;
      } else {
        const auto number = static_cast<std::int64_t>(value);
        object[field.column.name] = number;
        for (const FlagMeaning& flag : field.column.flags) {
          if (flag.value == number) object[field.column.name] = flag.word;
        }
      }
    };
    std::visit(put, field.member);
  }
  return object;
}

}  // namespace

void TraceWriter::begin(const TraceSubject& subject) {
  if (json_) {
    nlohmann::ordered_json inputs = nlohmann::ordered_json::object();
    for (std::size_t i = 0; i < subject.trial.inputs.size(); ++i) {
      inputs[subject.study.input_columns[i].name] = subject.trial.inputs[i];
    }
    fmt::print(file_, "{{\"name\": {}, \"point\": {}, \"trial\": {},\n \"inputs\": {},\n \"samples\": [",
               nlohmann::json(subject.study.name).dump(), subject.point, subject.index, inputs.dump());
    return;
  }
  std::string header;
  for (const RecordField<TraceRecord>& field : trace_fields()) {
    if (is_column(field)) header += (header.empty() ? "" : ",") + field.column.name;
  }
  fmt::print(file_, "{}\n", header);
}

void TraceWriter::write(const SampleRecord& sample) {
  const TraceRecord record{sample, 0};
  std::string line;
  for (const RecordField<TraceRecord>& field : trace_fields()) {
    if (!is_column(field)) continue;
    if (!line.empty()) line += json_ ? ", " : ",";
    if (json_) line += fmt::format("\"{}\": ", field.column.name);
    line += value_text(field, record, json_);
  }
  if (json_) {
    fmt::print(file_, "{}\n  {{{}}}", first_ ? "" : ",", line);
  } else {
    fmt::print(file_, "{}\n", line);
  }
  first_ = false;
}

void TraceWriter::end(const TrialOutcome& outcome) {
  if (!json_) return;
  nlohmann::ordered_json moves = nlohmann::ordered_json::array();
  for (const MoveOutcome& move : outcome.moves) moves.push_back(outcome_json(move));
  fmt::print(file_, "],\n \"outcome\": {}}}\n", moves.dump());
}

}  // namespace zerocount
