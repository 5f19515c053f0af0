#include "runners/identification_commands/identify_laws.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/fit/laws/law_identification.hpp"
#include "runners/commands/stage_progress.hpp"
#include "runners/status/status.hpp"

namespace zerocount::identification_commands {

std::vector<command_line::OptionSpec> law_options() {
  return {
      {"model", "LAW",
       fmt::format("friction law to fit, {} (default presliding), or all; may be repeated, to compare laws",
                   fmt::join(fit::law_words(), ", ")),
       true},
      {"series-compliance", "", "fit the compliance of a fixture in series with the contact, too"}};
}

fit::LawChoice chosen_laws(const command_line::Arguments& arguments) {
  const std::vector<std::string> words = fit::law_words();
  std::vector<std::string> wanted;
  for (const std::string& word : arguments.values("model")) {
    if (word == "all") {
      wanted = words;
    } else if (std::find(words.begin(), words.end(), word) != words.end()) {
      wanted.push_back(word);
    } else {
      arguments.refuse(
          fmt::format("option '--model': '{}' is not one of {}, all", word, fmt::join(words, ", ")));
    }
  }
  fit::LawChoice choice{{}, arguments.has("series-compliance")};
  const std::string& usual = words.front();
  if (wanted.empty() && choice.series_compliance) wanted.push_back(usual);
  for (const std::string& word : words) {
    if (std::find(wanted.begin(), wanted.end(), word) != wanted.end())
      choice.laws.push_back(fit::law_of(word));
  }
  const bool presliding_alone = choice.laws.size() == 1 && wanted.front() == usual;
  if (presliding_alone && !choice.series_compliance) choice.laws.clear();
  return choice;
}

void refuse_options_beside_laws(const command_line::Arguments& arguments) {
  for (const char* option : {"fix", "effort", "posterior", "plot"}) {
    if (!arguments.has(option)) continue;
    arguments.refuse(fmt::format(
        "option '--{}' is only for the pre-sliding model, without '--model' and '--series-compliance'",
        option));
  }
}

ExitCode identification_verdict(std::span<const fit::ParameterEstimate> parameters,
                                const fit::ResidualChecks& checks) {
  if (!checks.passed) {
    status::tell("zerocount identify: the result must not be trusted: {}\n", fit::reason_of_misfit(checks));
    return ExitCode::inconclusive;
  }
  if (std::ranges::any_of(parameters, fit::is_estimated)) return ExitCode::success;
  status::tell("zerocount identify: no parameter is identifiable from these records\n");
  return ExitCode::inconclusive;
}

fit::LawComparison identify_laws(const command_line::Arguments& arguments, const fit::LawChoice& choice,
                                 std::vector<fit::TestRecord> records) {
  commands::StageProgress progress("zerocount identify", arguments.has("quiet"));
  return fit::compare_laws(std::move(records), choice,
                           [&](std::string_view stage) { progress.enter(stage); });
}

}  // namespace zerocount::identification_commands
