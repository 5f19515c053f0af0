#pragma once

#include <string>
#include <vector>

#include "analysis/report/page.hpp"
#include "results/reading/all_trials_file.hpp"
#include "runners/design_commands/tune/tune_answer.hpp"
#include "runners/tuning/race/search.hpp"

namespace zerocount::design_commands {

/// The page of a tuning without sections.
report::ReportPage frame_of(const study::Study& study);

/// A search that goes on.
struct SearchMoment {
  const study::Study& study;
  const tuning::SearchProgress& progress;
  std::string spent;  ///< of the budget
};

/// The best values so far, and how sure their rate is.
report::PageSection search_section(const SearchMoment& moment);

/// The proven answer, and the extras that are there, each under its question.
std::vector<report::PageSection> tuning_sections(const Tuning& tuning);

/// HTML of the margins that tuning gives the loops of its one point, with the spreads that it adds; empty for
/// a study that says nothing of tuning.
std::string tuned_margins(const reading::AllTrialsFile& file);

/// These sections with their figures, and the search; then the report on the results file of the proof, where
/// there is one.
report::ReportPage tuning_page(Tuning tuning);

}  // namespace zerocount::design_commands
