#include "analysis/report/report.hpp"

#include <fmt/format.h>

#include "analysis/basis/document/blocks.hpp"
#include "analysis/report/figures/answer_figures.hpp"
#include "analysis/report/report_sections.hpp"

namespace zerocount::report {
namespace {

constexpr std::size_t max_history_figures = 12;  ///< Largest number of history figures that a report shows.

/// Simulates trials again for figures, and collects warnings where they differ from the results file.
struct Replays {
  const ReportedStudy& reported;
  const ReportOptions& options;
  std::vector<std::string> warnings{};

  ReplayedTrial run(const SampleTrial& trial) {
    ReplayedTrial replayed = replay_trial(reported.study, trial.point, trial.index, trial.buckets);
    replayed.result.row = rows_of(reported, trial.point).first + trial.index;
    if (!options.check) return replayed;
    const std::vector<std::string> different = options.check(replayed);
    if (different.empty()) return replayed;
    warnings.push_back(
        fmt::format("point {}, trial {}: the repeated trial differs from the recorded one: {}{}", trial.point,
                    trial.index, different.front(),
                    different.size() > 1 ? fmt::format("; and {} more", different.size() - 1) : ""));
    return replayed;
  }
};

std::string warnings_html(const std::vector<std::string>& warnings) {
  std::string html;
  for (const std::string& warning : warnings)
    html += fmt::format("<p class=\"warning\">{}</p>\n", document::markup(warning));
  return html;
}

void add(ReportPage& page, PageSection section) {
  if (!section.html.empty() || !section.figures.empty()) page.sections.push_back(std::move(section));
}

/// Whether the only verdict is that on the first screen: the study has a goal and one design point. The
/// tables of points then describe only zero counts.
bool has_one_verdict(const ReportedStudy& reported) {
  return reported.summary.points.size() == 1 && question_of(reported).goal();
}

PageSection success_section(const ReportedStudy& reported) {
  const char* title = reported.study.open_loop       ? "$Torque levels"
                      : question_of(reported).goal() ? "The goal"
                                                     : "Success";
  PageSection section{"points", title, "", {}};
  std::vector<Figure> maps = stability_maps(reported);
  // A map shows many points better than a table.
  if (!has_one_verdict(reported)) (maps.empty() ? section.html : section.html_after) = points_html(reported);
  if (std::optional<Figure> success = success_figure(reported))
    section.figures.push_back(std::move(*success));
  for (Figure& map : maps) section.figures.push_back(std::move(map));
  return section;
}

/// The figures with captions that begin with the name of the setting that worst_of_settings() chose.
std::vector<Figure> under_worst_setting(const ReportedStudy& reported, std::vector<Figure> figures) {
  for (Figure& figure : figures) figure.caption = worst_setting_phrase(reported) + figure.caption;
  return figures;
}

/// Section on zero counts (moves that end at zero error), for a study that is judged by a goal; empty without
/// a goal.
PageSection zero_count_section(const ReportedStudy& reported) {
  PageSection section{"zero-counts", "Zero counts", "", {}};
  if (!question_of(reported).goal()) return section;
  section.html = zero_counts_html(reported);
  if (has_one_verdict(reported)) section.html += html_folded("Numbers", points_html(reported));
  return section;
}

/// Converts titles and figures from a rotary axis, for which they are written, to the study's axis. Also
/// stores the names of the settings in all figures, so that settings have the same colours everywhere.
void put_on_axis(const study::Study& study, ReportPage& page) {
  for (PageSection& section : page.sections) {
    section.title = parameters::text_on(study.units.axis, section.title);
    for (Figure& figure : section.figures) {
      report::put_on_axis(figure, study.units.axis);
      figure.parameters["conditions"] = study::labels_of(study.settings);
    }
  }
}

/// HTML paragraph that tells why the report of a study with a controller plugin cannot show trials over time.
std::string without_traces_html(const plugin::ControllerPlugin& plugin) {
  return fmt::format(
      "<p>The trials cannot be run again for this page: the controller is the plugin {} {}, and only the "
      "commands run, check and trace load plugins.</p>",
      document::markup(plugin.description.name), document::markup(plugin.description.version));
}

/// Marks, on the page of a study with dependent trials, all bounds that assume independent trials: all except
/// those of the sensitivity indices.
void qualify_bounds(const ReportedStudy& reported, ReportPage& page) {
  if (!reported.summary.features.dependent_trials) return;
  for (PageSection& section : page.sections) {
    if (section.name == sensitivity_section_name) continue;
    for (Figure& figure : section.figures)
      call_bounds_too_narrow(
          figure,
          fmt::format("{} Bounds assume independent trials, and are too narrow here.", dependence_sentence));
  }
}

}  // namespace

StudyReport study_report(const reading::AllTrialsFile& file, const ReportOptions& options) {
  const ReportedStudy reported = reported_study(file, options.point);
  Replays replays{reported, options};
  StudyReport report;
  ReportPage& page = report.page;
  page.title = reported.summary.name;
  page.subtitle = reported.study.description;
  const layout::Provenance& made = file.header().provenance;
  page.footer = fmt::format(
      "zerocount {} ({}), study of {}. This page is self-contained and requests nothing from anywhere.",
      made.zerocount_version, made.git_commit, made.created);
  page.sections.emplace_back();  // the first screen, when the warnings are known
  if (options.tuning)
    for (const PageSection& section : options.tuning->sections) add(page, section);
  if (options.comparison)
    add(page,
        answer_section("baseline", "Against the baseline", comparison_answer().of(*options.comparison)));
  if (options.history) add(page, history_section(*options.history, max_history_figures));
  add(page, success_section(reported));
  add(page, {"ages", "Over a life", "", age_figures(reported)});
  const ReportedStudy& worst = worst_of_settings(reported);
  add(page, {"worlds", "Worlds", "", under_worst_setting(reported, world_figures(worst))});
  add(page, {"settling", "Arrival and settling", "", distribution_figures(reported)});
  add(page, zero_count_section(reported));
  add(page,
      {"jerks", "Jerks", "",
       reported.study.open_loop || !options.jerks ? std::vector<Figure>{}
                                                  : under_worst_setting(reported, jerk_figures(worst))});
  if (std::optional<PageSection> sensitivity = sensitivity_section(reported))
    add(page, std::move(*sensitivity));
  add(page, {"rotor", "Along the $track", "", under_worst_setting(reported, rotor_figures(worst))});
  if (std::optional<Figure> bode = bode_figure(worst))
    add(page, {"loop", "Stability margins", "", under_worst_setting(reported, {std::move(*bode)})});
  if (reported.study.plugin) {
    add(page, {"traces", "Response", without_traces_html(*reported.study.plugin), {}});
  } else {
    const Replay replay = [&](const SampleTrial& trial) { return replays.run(trial); };
    add(page, {"traces", "Response", "", response_figures(reported, replay)});
    add(page, {"paper", "The paper's figures", "", paper_figures(reported, replay)});
  }
  add(page, {"run", "Provenance", run_html(reported), {}});
  report.warnings = replays.warnings;
  FirstScreenParts parts = options.tuning ? options.tuning->first_screen : FirstScreenParts{};
  parts.warnings = warnings_html(report.warnings);
  page.sections.front() = first_screen(reported, parts);
  qualify_bounds(reported, page);
  put_on_axis(reported.study, page);
  return report;
}

}  // namespace zerocount::report
