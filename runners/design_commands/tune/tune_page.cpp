#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "analysis/basis/document/blocks.hpp"
#include "analysis/basis/statistics/proportion.hpp"
#include "analysis/report/first_screen/first_screen.hpp"
#include "analysis/report/page.hpp"
#include "analysis/report/report.hpp"
#include "results/layout/header.hpp"
#include "runners/commands/command.hpp"
#include "runners/design_commands/design_commands.hpp"
#include "runners/design_commands/tune/tune_answer.hpp"
#include "runners/tuning/tuner.hpp"

namespace zerocount::design_commands {
namespace {

/// Success rate of the worst goal with 95 % confidence bounds, from the machines that a running search has
/// simulated.
document::Bounded bounded_rate(const SearchMoment& moment) {
  const tuning::RateEstimate& estimate = moment.progress.estimate;
  const auto meeting = std::llround(estimate.rate * static_cast<double>(estimate.machines));
  return document::bounded(estimate.rate, statistics::clopper_pearson(meeting, estimate.machines));
}

document::AnswerDescription<SearchMoment> search_answer() {
  using At = const SearchMoment&;
  document::AnswerDescription<SearchMoment> answer{
      {.name = "tune", .meaning = "values of the free parameters with which the axis meets its goal"}, {}};
  answer.items
      .headline([](At at) {
        return "best so far: " + values_text(named(at.study.tuning->free, at.progress.best->values));
      })
      .value({.heading = "rate, with 95 % bounds", .notation = document::Notation::percent}, bounded_rate)
      .value({.heading = "of"}, [](At at) { return rated_words(at.study, at.progress.estimate.worst); })
      .value({.heading = "simulated"},
             [](At at) {
               return fmt::format("{} machines, the same for all points; {} points in generation {}",
                                  at.progress.estimate.machines, at.progress.points, at.progress.generation);
             })
      .value({.heading = "budget used"}, &SearchMoment::spent)
      .sentence([](At) {
        return "The best of many points looks a little too good by the machines of the search: the proof "
               "decides, on others.";
      });
  return answer;
}

void add(std::vector<report::PageSection>& sections, std::string name, std::string title,
         const document::AnswerDescription<Tuning>& description, const Tuning& tuning) {
  report::PageSection section =
      report::answer_section(std::move(name), std::move(title),
                             description.of(tuning, ExitCode::success, document::Audience::people));
  if (!section.html.empty() || !section.figures.empty()) sections.push_back(std::move(section));
}

/// Sections of a page for the first part of the answer, and for each finished extra.
std::vector<report::PageSection> sections_of(const Tuning& tuning,
                                             const document::AnswerDescription<Tuning>& first) {
  std::vector<report::PageSection> sections;
  add(sections, "tuning", "Tuning", first, tuning);
  for (const tuning::Extra& extra : all_extras())
    add(sections, fmt::format("tuning-{}", extra.name), std::string(extra.question), extra_answer(extra),
        tuning);
  return sections;
}

std::string margins_html(const Tuning& tuning) {
  return document::html(margins_answer().of(tuning, ExitCode::success, document::Audience::people));
}

}  // namespace

report::ReportPage frame_of(const study::Study& study) {
  return {.title = fmt::format("{}: tuning", study.name),
          .subtitle = study.description,
          .footer = "",
          .sections = {},
          .kind = "tune"};
}

report::PageSection search_section(const SearchMoment& moment) {
  return report::answer_section("so-far", "The answer so far", search_answer().of(moment));
}

std::vector<report::PageSection> tuning_sections(const Tuning& tuning) {
  return sections_of(tuning, proven_answer());
}

std::string tuned_margins(const reading::AllTrialsFile& file) {
  const study::Study& study = file.study();
  if (!study.tuning || study::point_count(study) > 1) return "";
  const tuning::TuneAnswer answer = tuning::margins_in(file);
  return answer.tuned.margins ? margins_html({answer, study, file.path(), false, true}) : "";
}

report::ReportPage tuning_page(Tuning tuning) {
  tuning.drawn = true;
  report::ReportPage page = frame_of(tuning.study);
  if (tuning.answer.proof) {
    report::ReportOptions options;
    options.tuning = {.first_screen = {.headline = page_headline(tuning),
                                       .claims = tuning.answer.proof->claims,
                                       .margins = margins_html(tuning)},
                      .sections = sections_of(tuning, proof_answer())};
    add(options.tuning->sections, "tuning-search", "What was searched?", closing_answer(), tuning);
    report::ReportPage study = commands::verified_report(reading::AllTrialsFile(tuning.output), options).page;
    page.sections = std::move(study.sections);
    page.footer = std::move(study.footer);
  } else {
    page.sections = tuning_sections(tuning);
    page.sections.front().html += report::axis_html(tuning.study, 0);
    add(page.sections, "tuning-search", "What was searched?", closing_answer(), tuning);
    page.footer = fmt::format("zerocount {}", layout::current_provenance().zerocount_version);
  }
  if (tuning.answer.interrupted) page.state = report::PageState::unfinished;
  return page;
}

}  // namespace zerocount::design_commands
