#include "analysis/report/report.hpp"

#include <nlohmann/json.hpp>

#include "analysis/pairs/comparison/comparison.hpp"
#include "analysis/pairs/history/series.hpp"
#include "analysis/report/figures/answer_figures.hpp"
#include "analysis/report/figures/report_figures.hpp"
#include "analysis/trials/summary/move_behaviour.hpp"
#include "analysis/trials/summary/stored_statistics.hpp"
#include "analysis/trials/summary/study_statistics.hpp"
#include "analysis/trials/summary/summary.hpp"
#include "core/loop/encoder.hpp"
#include "experiments/manifest/load_study.hpp"
#include "tests/analysis/report/run_studies.hpp"
#include "tests/analysis/study_files.hpp"
#include "tests/results/failures.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test.hpp"

namespace zerocount::report {
namespace {

using testing::TemporaryFolder;
using testing::times_in;

/// The column of a figure's data, as numbers.
std::vector<double> column(const FigureData& data, const std::string& field) {
  std::size_t place = 0;
  while (data.columns.at(place).field != field) ++place;
  std::vector<double> values;
  for (const auto& row : data.rows)
    values.push_back(row[place].is_null() ? std::nan("") : row[place].get<double>());
  return values;
}

class Report : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = new TemporaryFolder;
    testing::run_study_file(*folder / "rich.h5", testing::rich_manifest(40));
  }
  static void TearDownTestSuite() { delete folder; }

  /// The report that the tests look at, made once for all of them.
  static const StudyReport& report() {
    static const StudyReport once = study_report(reading::AllTrialsFile(*folder / "rich.h5"));
    return once;
  }

  static inline TemporaryFolder* folder = nullptr;
  reading::AllTrialsFile file{*folder / "rich.h5"};
};

TEST_F(Report, HasAFigureForEachPartOfTheStudy) {
  const std::vector<std::string> names = figure_names(report().page);
  for (const char* name : {"success", "stability-map", "settling-time", "jerk-raster", "rotor-friction.k1",
                           "bode", "response"}) {
    EXPECT_EQ(std::count(names.begin(), names.end(), name), 1) << name;
  }
  for (const std::string& name : names) EXPECT_FALSE(says(name, "paper"));
}

TEST_F(Report, EveryFigureHasACaptionAndUnitsAndATable) {
  for (const std::string& name : figure_names(report().page)) {
    const Figure& figure = find_figure(report().page, name);
    EXPECT_GT(figure.caption.size(), 60U) << name;
    ASSERT_FALSE(figure.data.empty()) << name;
    EXPECT_FALSE(figure.data.front().rows.empty()) << name;
    bool shown = false;
    for (const FigureColumn& column : figure.data.front().columns) shown = shown || !column.title.empty();
    EXPECT_TRUE(shown) << name;
    for (const FigureData& data : figure.data) {
      for (const auto& row : data.rows) ASSERT_EQ(row.size(), data.columns.size()) << name;
    }
  }
}

/// [design point] label that figures show.
std::vector<std::string> labels_in_figures(const reading::AllTrialsFile& file) {
  const ReportedStudy reported = reported_study(file);
  std::vector<std::string> labels;
  for (std::int64_t point = 0; point < file.header().points; ++point)
    labels.push_back(marked_label_of(reported, point));
  return labels;
}

TEST_F(Report, SuccessFigureHasTheNumbersOfTheSummary) {
  const summary::StudySummary summary = summary::summarise(file);
  const FigureData data = find_figure(report().page, "success").data.front();
  const std::vector<std::string> labels = labels_in_figures(file);
  ASSERT_EQ(data.rows.size(), summary.points.size());
  for (const auto& row : data.rows) {
    const auto label = row[0].get<std::string>();
    const auto at = static_cast<std::size_t>(std::find(labels.begin(), labels.end(), label) - labels.begin());
    ASSERT_LT(at, labels.size()) << label;
    EXPECT_NEAR(row[1].get<double>(), summary.points[at].success_rate().value, 1e-6);
    EXPECT_NEAR(row[2].get<double>(), summary.points[at].success_rate().clopper_pearson.low, 1e-6);
    EXPECT_NEAR(row[3].get<double>(), summary.points[at].success_rate().clopper_pearson.high, 1e-6);
  }
}

/// The distribution functions are made again from the settling times, the band from its formula.
TEST_F(Report, SettlingCurvesAreDistributionFunctionsWithinTheirBounds) {
  const FigureData data = find_figure(report().page, "settling-time").data.front();
  const double half_width = std::sqrt(std::log(2.0 / 0.05) / (2.0 * 40.0));
  std::map<std::string, std::vector<double>> times;
  const std::vector<std::string> labels = labels_in_figures(file);
  const std::vector<double> all = file.measure("arrival_time", file.rows());
  for (std::size_t row = 0; row < all.size(); ++row) times[labels[row / 40]].push_back(all[row]);
  const std::vector<double> at = column(data, "time");
  const std::vector<double> proportion = column(data, "share");
  const std::vector<double> low = column(data, "low");
  const std::vector<double> high = column(data, "high");
  for (std::size_t i = 0; i < data.rows.size(); ++i) {
    const std::vector<double>& settled = times.at(data.rows[i][0].get<std::string>());
    const auto arrived =
        std::count_if(settled.begin(), settled.end(), [&](double t) { return t <= at[i] + 1e-9; });
    if (at[i] > 0.0) {
      EXPECT_NEAR(proportion[i], static_cast<double>(arrived) / 40.0, 1e-6);
    }
    EXPECT_NEAR(low[i], std::max(0.0, proportion[i] - half_width), 2e-6);
    EXPECT_NEAR(high[i], std::min(1.0, proportion[i] + half_width), 2e-6);
  }
}

/// The curves of the bands are made again from /outcome/band_settling_time.
TEST_F(Report, BandCurvesShowTheChosenPoint) {
  const FigureData data = find_figure(report().page, "settled").data.front();
  const std::int64_t point = reported_study(file).chosen.point;
  const std::vector<trial::MoveOutcome> moves = file.outcomes({point * 40, 40});
  const std::vector<double> at = column(data, "time");
  const std::vector<double> proportion = column(data, "share");
  ASSERT_FALSE(data.rows.empty());
  for (std::size_t i = 0; i < data.rows.size(); ++i) {
    const std::size_t slot = data.rows[i][0] == "±0 counts" ? 0 : 1;
    const auto settled = std::count_if(moves.begin(), moves.end(), [&](const trial::MoveOutcome& move) {
      return move.bands[slot].settling_time <= at[i] + 1e-9;
    });
    if (at[i] > 0.0) {
      EXPECT_NEAR(proportion[i], static_cast<double>(settled) / 40.0, 1e-6) << i;
    }
  }
}

/// Half of the trials do no better than the median one, and none does worse than the worst.
TEST_F(Report, SampleTrialsAreTheMedianAndTheWorst) {
  const ReportedStudy reported = reported_study(file);
  const goal::Question& question = question_of(reported);
  const std::vector<trial::MoveOutcome> outcomes = file.outcomes(file.rows());
  const auto badness = [&](std::int64_t index) {
    const auto row = static_cast<std::size_t>(reported.chosen.point * 40 + index);
    return badness_of(question, {&outcomes[row], 1});
  };
  const std::vector<SampleTrial> trials = sample_trials(reported);
  ASSERT_EQ(trials.size(), 2U);
  for (const SampleTrial& trial : trials) {
    EXPECT_EQ(trial.point, reported.chosen.point);
    int better = 0, worse = 0;
    for (std::int64_t index = 0; index < 40; ++index) {
      better += badness(index) < badness(trial.index);
      worse += badness(trial.index) < badness(index);
    }
    if (trial.name == "median") {
      EXPECT_LE(better, 19);
      EXPECT_LE(worse, 20);
    } else {
      EXPECT_EQ(worse, 0);
    }
  }
}

/// The errors in the figure equal the errors of the samples, in rad and counts.
TEST_F(Report, TheResponseHasTheErrorsOfItsTrials) {
  const ReportedStudy reported = reported_study(file);
  const FigureData data = find_figure(report().page, "response").data.front();
  const std::vector<SampleTrial> trials = sample_trials(reported);
  const std::vector<double> error = column(data, "error");
  const std::vector<double> counts = column(data, "counts");
  const std::vector<double> time = column(data, "time");
  std::size_t row = 0;
  for (const SampleTrial& trial : trials) {
    const ReplayedTrial replayed = replay_trial(file.study(), trial.point, trial.index, trial.buckets);
    const double resolution = loop::fine_resolution(replayed.parameters.encoder);
    for (const trial::SampleRecord& sample : replayed.samples) {
      EXPECT_EQ(data.rows[row][0], trial.name);
      EXPECT_NEAR(time[row], sample.t, 1e-8);
      EXPECT_NEAR(counts[row], static_cast<double>(sample.error), 1e-5 * std::abs(counts[row]));
      EXPECT_NEAR(error[row], static_cast<double>(sample.error) * resolution, 1e-5 * std::abs(error[row]));
      ++row;
    }
  }
  EXPECT_EQ(row, data.rows.size());
}

/// Each mass has its own figure, with the boxes of its own goals, and its own overshoot.
TEST(TwoMasses, EachMassIsShownWithItsOwnGoals) {
  const TemporaryFolder folder;
  testing::run_study_file(
      folder / "joint.h5",
      "zerocount: 1\nname: joint\nseed: 7\ntrials: 12\n"
      "plant: {inertia: 0.5, sliding_damping: 1, load: {inertia: {uniform: [0.5, 2]}, stiffness: 2.0e+4}}\n"
      "friction: {model: coulomb, breakaway: 5, coulomb_ratio: 1}\nencoder: {fine: 1000000}\n"
      "command: {units: si, targets: [0.1, 0.02], hold: 0.4}\ndac: {bits: 20, range: 200}\n"
      "controller: {units: si, sample_rate: 4000, kp: 3.0e+4, ki: 3.0e+5, kd: 300}\n"
      "goals: {near: {of: load, on: [0], tolerance: 2.0e-3, within: 0.2, moves: 0.5},\n"
      "  sharp: {of: motor, on: [1], tolerance: 5.0e-4, within: 0.3, moves: 0.5}}\n");
  const reading::AllTrialsFile joint(folder / "joint.h5");
  const ReportedStudy reported = reported_study(joint);
  const StudyReport made = study_report(joint);
  const std::vector<SampleTrial> trials = sample_trials(reported);
  for (const auto& [name, half, from, load] :
       {std::tuple("response", 2e-3, 0.2, true), std::tuple("response-motor", 5e-4, 0.4 + 0.3, false)}) {
    const std::vector<FigureData>& data = find_figure(made.page, name).data;
    EXPECT_EQ(column(data[1], "high"), std::vector{half}) << name;
    EXPECT_EQ(column(data[1], "from"), std::vector{from}) << name;
    const std::vector<double> error = column(data[0], "error");
    std::size_t row = 0;
    for (const SampleTrial& trial : trials) {
      const ReplayedTrial replayed = replay_trial(joint.study(), trial.point, trial.index, trial.buckets);
      for (const trial::SampleRecord& sample : replayed.samples) {
        const double target = sample.t < 0.4 ? 0.1 : 0.02;
        const double expected = target - (load ? sample.load_theta : sample.theta);
        EXPECT_NEAR(error[row++], expected, 1e-5 * std::abs(expected) + 1e-9) << name;
      }
    }
    EXPECT_EQ(row, error.size());
  }
  const std::vector<summary::MoveBehaviour> behaviour = summary::behaviour_in(joint, joint.study());
  const std::vector<double> overshoots = joint.measure("load_true_overshoot", joint.rows());
  double largest = 0.0;  // of the first moves
  for (std::size_t i = 0; i < overshoots.size(); i += 2) largest = std::max(largest, overshoots[i]);
  EXPECT_NEAR(behaviour.front().overshoot_length.max, largest, 1e-12);
}

TEST_F(Report, TracesAreTheRecordedTrials) {
  ReportOptions options;
  int checked = 0;
  options.check = [&](const ReplayedTrial& replayed) -> std::vector<std::string> {
    ++checked;
    const trial::MoveOutcome recorded = file.outcomes({replayed.result.row, 1}).front();
    EXPECT_EQ(replayed.result.outcome.moves.front().final_position, recorded.final_position);
    return checked == 1 ? std::vector<std::string>{"a <difference>"} : std::vector<std::string>{};
  };
  const StudyReport report = study_report(file, options);
  EXPECT_GE(checked, 2);
  ASSERT_EQ(report.warnings.size(), 1U);
  EXPECT_TRUE(says(report.page.sections.front().html, "a &lt;difference&gt;"));
}

TEST_F(Report, ShowsTheTrialsOfTheSelectedPoint) {
  ReportOptions options;
  options.point = 3;
  std::vector<std::int64_t> points;
  options.check = [&](const ReplayedTrial& replayed) {
    points.push_back(replayed.point);
    return std::vector<std::string>{};
  };
  study_report(file, options);
  EXPECT_EQ(std::count(points.begin(), points.end(), 3), std::ssize(points));
  options.point = 8;
  testing::expect_failure(ExitCode::bad_input, "unknown design point 8; expected 0 to 7",
                          [&] { study_report(file, options); });
}

TEST_F(Report, ComparesWithABaseline) {
  testing::run_study_file(*folder / "other.h5", testing::rich_manifest(30));
  const reading::AllTrialsFile baseline(*folder / "other.h5");
  ReportOptions options;
  options.comparison = comparison::compare_studies(baseline, file);
  const ReportPage page = study_report(file, options).page;
  EXPECT_EQ(page.sections[1].name, "baseline");
  EXPECT_TRUE(says(page.sections[1].html, "trials"));
  EXPECT_EQ(find_figure(page, "success-change").data.front().rows.size(), 8U);
}

// Each in units of its own margin: the interval lies within ± 1 just where the measure is equivalent.
TEST_F(Report, ShowsAllMeasuresAgainstTheirMargins) {
  testing::run_study_file(*folder / "other.h5", testing::rich_manifest(30));
  ReportOptions options;
  options.comparison = comparison::compare_studies(reading::AllTrialsFile(*folder / "other.h5"), file);
  const ReportPage page = study_report(file, options).page;
  const Figure& figure = find_figure(page, "margins");
  std::size_t measured = 0;
  for (const comparison::PointComparison& point : options.comparison->points) {
    for (const comparison::Judgement& measure : point.judgements)
      measured += measure.change != comparison::ChangeVerdict::not_measured;
  }
  ASSERT_EQ(figure.data.front().rows.size(), std::min<std::size_t>(measured, 60));
  for (const nlohmann::ordered_json& row : figure.data.front().rows) {
    const bool within = row[2] > -1.0 && row[3] < 1.0;
    EXPECT_EQ(row[4] == "equivalent", within) << row;
  }
}

TEST_F(Report, AnUnknownFigureIsRefusedWithTheNamesOfTheOthers) {
  const ReportPage page = report().page;
  testing::expect_failure(ExitCode::bad_input,
                          "unknown figure 'sucess'; this study has: success, stability-map",
                          [&] { find_figure(page, "sucess"); });
}

TEST_F(Report, ThePageIsSelfContained) {
  const std::string page = html_page(report().page);
  EXPECT_EQ(times_in(page, "<script"), times_in(page, "</script>"));
  EXPECT_EQ(times_in(page, "<script src"), 0U);
  EXPECT_EQ(times_in(page, "<link"), 1U);  // the icon, of nothing
  EXPECT_EQ(times_in(page, "default-src 'none'"), 1U);
  EXPECT_LT(page.size(), 2000000U);
}

TEST(ReportPage, AManifestCannotBreakIt) {
  const std::string hostile = "</script><script>window.broken = 1</script><!-- {{libraries}} & <b>";
  const TemporaryFolder folder;
  testing::run_study_file(folder / "a.h5", testing::rich_manifest(4));
  testing::run_study_file(folder / "b.h5", testing::rich_manifest(4, hostile));
  const std::string page = html_page(study_report(reading::AllTrialsFile(folder / "b.h5")).page);
  const std::string plain = html_page(study_report(reading::AllTrialsFile(folder / "a.h5")).page);
  EXPECT_EQ(times_in(page, "<script"), times_in(plain, "<script"));
  EXPECT_EQ(times_in(page, "</script"), times_in(plain, "</script"));
  EXPECT_EQ(times_in(page, "<!--"), times_in(plain, "<!--"));
  EXPECT_EQ(times_in(page, "&lt;script&gt;window.broken"), times_in(page, "window.broken"));
  EXPECT_GT(times_in(page, "{{libraries}}"), 0U);
}

/// The names of cases stand in the data of the figures too.
TEST(ReportPage, NamesOfCasesCannotBreakIt) {
  const TemporaryFolder folder;
  const auto page_of = [&](const std::string& name) {
    testing::run_study_file(
        folder / "a.h5",
        "zerocount: 1\nname: cases\nseed: 1\ntrials: 4\ncommand: {targets: [3], hold: 0.15}\n"
        "verdict: {dwell: 0.02, window: 0.02}\n"
        "sweep: {cases: {\"" +
            name + "\": {controller.ki: 2.0e-5}, other: {controller.ki: 3.0e-5}}}\n");
    std::string page = html_page(study_report(reading::AllTrialsFile(folder / "a.h5")).page);
    std::filesystem::remove(folder / "a.h5");
    std::filesystem::remove(folder / "a.h5.shard.h5");
    return page;
  };
  const std::string page = page_of("</script><!-- <i>");
  const std::string plain = page_of("plain");
  EXPECT_EQ(times_in(page, "</script"), times_in(plain, "</script"));
  EXPECT_EQ(times_in(page, "<!--"), times_in(plain, "<!--"));
  EXPECT_EQ(times_in(page, "<i>"), times_in(plain, "<i>"));
}

TEST(ReportPage, AFlawlessStudyIsNotCalledPerfect) {
  const TemporaryFolder folder;
  testing::run_study_file(
      folder / "a.h5",
      "zerocount: 1\nname: easy\nseed: 1\ntrials: 30\ncommand: {targets: [3], hold: 0.15}\n"
      "controller: {ki: 2.0e-5}\nverdict: {dwell: 0.02, window: 0.02}\n");
  const StudyReport report = study_report(reading::AllTrialsFile(folder / "a.h5"));
  const std::string& verdict = report.page.sections.front().html;
  // 1 − 0.05^(1/30) = 9.503 %; ln 0.05 / ln 0.999 = 2994.2
  EXPECT_TRUE(says(verdict, "does not prove 100&nbsp;% repeatability", "9.6&nbsp;%", "2995 trials"));
}

/// The best of four flawless points has been chosen: 1 − (0.05/4)^(1/30) = 13.59 %.
TEST(ReportPage, BoundsOfTheBestPointAllowForItsChoice) {
  const TemporaryFolder folder;
  testing::run_study_file(
      folder / "a.h5",
      "zerocount: 1\nname: easy\nseed: 1\ntrials: 30\ncommand: {targets: [3], hold: 0.15}\n"
      "verdict: {dwell: 0.02, window: 0.02}\n"
      "sweep: {grid: {controller.ki: [1.8e-5, 1.9e-5, 2.0e-5, 2.1e-5]}}\n");
  const StudyReport report = study_report(reading::AllTrialsFile(folder / "a.h5"));
  const std::string& verdict = report.page.sections.front().html;
  EXPECT_TRUE(says(verdict, "Best of 4 points: ", "at most 13.6&nbsp;% fail"));
}

/// A saltelli study with three factors. Its trials share draws in rows of five (number of factors + 2).
std::string saltelli_manifest(const std::string& more) {
  return "zerocount: 1\nname: rows\nseed: 3\ntrials: 60\ndesign: saltelli\n"
         "friction: {k1: {uniform: [90, 130]}, lambda: 0.5}\n"
         "command: {targets: [{integers: [1, 10]}], hold: 0.15}\n"
         "initial: {encoder_phase: {uniform: [0, 1]}}\n"
         "verdict: {dwell: 0.02, window: 0.02}\n" +
         more;
}

/// The report page of a study with this manifest.
ReportPage page_of(const std::string& manifest) {
  const TemporaryFolder folder;
  testing::run_study_file(folder / "a.h5", manifest);
  return study_report(reading::AllTrialsFile(folder / "a.h5")).page;
}

TEST(SaltelliTrials, MakeNoClaimAboutAllAxes) {
  for (const char* more : {"sweep: {grid: {controller.ki: [2.0e-5, 6.0e-5, 9.45e-5]}}\n",
                           "controller: {ki: 2.0e-5}\n", "controller: {ki: 9.45e-5}\n"}) {
    const ReportPage page = page_of(saltelli_manifest(more));
    const std::string& verdict = page.sections.front().html;
    for (const char* claim : {"confidence", "at least", "at most", "bounds 0", "% bounds", "account for"})
      EXPECT_FALSE(says(verdict, claim)) << claim << "\n" << verdict;
    EXPECT_TRUE(says(verdict, "dependent trials give no bounds", "are not independent"));
    EXPECT_FALSE(says(page.sections[1].html, "of all axes that the manifest describes"));
  }
}

TEST(SaltelliTrials, EveryBoundButThoseOfTheIndicesIsCalledTooNarrow) {
  const ReportPage page =
      page_of(saltelli_manifest("sweep: {grid: {controller.ki: [2.0e-5, 6.0e-5, 9.45e-5]}}\n"));
  const std::string& table = page.sections[1].html;
  EXPECT_TRUE(says(table, "all bounds here are too narrow"));
  std::size_t with_bounds = 0;
  for (const PageSection& section : page.sections) {
    for (const Figure& figure : section.figures) {
      const bool own = section.name == "sensitivity";
      bool bounds = false;
      for (const FigureData& data : figure.data) {
        for (const FigureColumn& column : data.columns) {
          if (column.title.find("bound") == std::string::npos) continue;
          bounds = true;
          EXPECT_EQ(column.title.ends_with(", too narrow"), !own) << figure.name;
        }
      }
      with_bounds += bounds;
      EXPECT_EQ(times_in(figure.caption, "are too narrow here"), bounds && !own ? 1U : 0U) << figure.name;
      EXPECT_EQ(times_in(figure.caption, "differ significantly"), 0U);
      EXPECT_EQ(times_in(figure.caption, "bands contain"), 0U);
    }
  }
  EXPECT_GE(with_bounds, 3U);
}

TEST_F(Report, BoundsOfIndependentTrialsAreNotCalledTooNarrow) {
  const std::string page = html_page(report().page);
  EXPECT_EQ(times_in(page, "too narrow"), 0U);
  EXPECT_GT(times_in(page, "of all axes that the manifest describes"), 0U);
}

struct PaperStudy {
  const char* name;
  const char* more;
  const char* figure;
};

class PaperFigures : public ::testing::TestWithParam<PaperStudy> {};

TEST_P(PaperFigures, AppearInStudiesThatReproduceThem) {
  const TemporaryFolder folder;
  testing::run_study_file(folder / "a.h5",
                          std::string("zerocount: 1\nname: paper\nseed: 1\ntrials: 3\n") + GetParam().more);
  const std::vector<std::string> names =
      figure_names(study_report(reading::AllTrialsFile(folder / "a.h5")).page);
  std::string found;
  for (const std::string& name : names) found += name.starts_with("paper") ? name : "";
  EXPECT_EQ(found, GetParam().figure);
}

INSTANTIATE_TEST_SUITE_P(
    Studies, PaperFigures,
    ::testing::Values(
        PaperStudy{"hysteresis",
                   "friction: {model: spring}\ncommand: {torque: {levels: [0.01, -0.01, 0.01], through: "
                   "exact}, hold: 0.01}\n",
                   "paper-fig4"},
        PaperStudy{"creep", "command: {torque: {levels: [0.1, 0, 0.1], through: exact}, hold: 0.1}\n",
                   "paper-fig4paper-fig6"},
        PaperStudy{"targets",
                   "command: {targets: [1], hold: 0.15}\nsweep: {grid: {command.targets.0: [1, 2, 3, 4]}}\n",
                   "paper-fig7"},
        PaperStudy{"jerks", "friction: {lambda: 0.5}\ncommand: {targets: [30], hold: 1.0}\n", "paper-fig8"},
        PaperStudy{
            "none",
            "command: {targets: [1], hold: 0.15}\nsweep: {grid: {controller.ki: [1.0e-5, 2.0e-5, 4.0e-5]}}\n",
            ""}),
    [](const auto& study) { return std::string(study.param.name); });

/// The size of the report's page is bounded, however many trials the study has.
TEST(ReportPage, DoesNotGrowWithTheTrials) {
  const TemporaryFolder folder;
  study::Study study = manifest::parse_study(
      "zerocount: 1\nname: many\nseed: 1\ntrials: 5000\ncommand: {targets: [3], hold: 5.0}\n"
      "initial: {encoder_phase: {uniform: [0, 1]}}\n",
      "test");
  std::vector<testing::TrialRecord> trials;
  for (std::int64_t row = 0; row < 5000; ++row) {
    trials.push_back(testing::random_trial(row, 1));
    // A jerk ends before the next one begins.
    std::vector<trial::Jerk>& jerks = trials.back().jerks;
    const auto close = [](const trial::Jerk& a, const trial::Jerk& b) { return b.onset - a.onset < 2e-3; };
    jerks.erase(std::unique(jerks.begin(), jerks.end(), close), jerks.end());
    trials.back().outcome.moves.front().jerk_count = std::ssize(jerks);
  }
  testing::write_study_file(folder / "many.h5", study, trials, [&](const reading::AllTrialsFile& file) {
    layout::StoredStatistics stored;
    summary::take_stored_statistics(file, study, {},
                                    [&](const layout::StoredStatistics& only) { stored = only; });
    return stored;
  });
  const std::string page = html_page(study_report(reading::AllTrialsFile(folder / "many.h5")).page);
  EXPECT_LT(page.size(), 2000000U);
  EXPECT_TRUE(says(page, "Shown are 50 of the"));
}

// A reader looks at some dozen figures, and a browser must be able to open the page.

/// A report page with `figures` figures of `rows` rows of data each.
ReportPage page_with(int figures, int rows) {
  ReportPage page;
  page.title = "many figures";
  page.sections.push_back({"all", "All", "", {}});
  FigureData data{"rows", {{"value", "value", "1"}, {"other", "other", "1"}}};
  for (int row = 0; row < rows; ++row)
    data.rows.push_back(nlohmann::ordered_json::array({row + 0.125, 1e-3 * row}));
  for (int i = 0; i < figures; ++i) {
    const std::string name = fmt::format("figure-{}", i);
    page.sections.front().figures.push_back(
        {.name = name, .title = name, .caption = "", .specification = "history", .data = {data}});
  }
  return page;
}

TEST(ReportPage, LimitsTheFiguresAndNamesTheCommandForTheOthers) {
  const ReportPage page = page_with(500, 3);
  const std::string html = html_page(page);
  EXPECT_EQ(times_in(html, "<figure "), 48U);
  EXPECT_TRUE(says(html, "452 of 500 figures are left out", "zerocount plot FILE"));
  EXPECT_EQ(find_figure(page, "figure-499").name, "figure-499");
  EXPECT_EQ(times_in(html_page(page_with(48, 3)), "figures are left out"), 0U);
}

TEST(ReportPage, HasAtMostFiveMegabytesHoweverLargeItsFiguresAre) {
  const std::string html = html_page(page_with(40, 10'000));
  EXPECT_LT(html.size(), 5'000'000U);
  EXPECT_GT(times_in(html, "<figure "), 1U);
  EXPECT_TRUE(says(html, "of 40 figures are left out"));
}

/// A history of results with one run and `series` series.
history::History history_of_series(int series) {
  history::History history;
  const auto run = std::make_shared<const history::RunIdentity>();
  for (int i = 0; i < series; ++i) {
    history::Series& one = history.series.emplace_back();
    one.study = "axis";
    one.point = std::to_string(i);
    one.measure = "success_rate";
    one.runs.push_back({run, {}});
  }
  return history;
}

TEST(HistoryFigures, AreLimitedTo48Series) {
  const std::vector<Figure> few = document::figures(history_answer().of(history_of_series(40)));
  EXPECT_EQ(few.size(), 40U);
  EXPECT_EQ(times_in(few.front().caption, "Figures stand here"), 0U);
  const std::vector<Figure> many = document::figures(history_answer().of(history_of_series(4453)));
  EXPECT_EQ(many.size(), 48U);
  EXPECT_TRUE(says(many.front().caption, "Figures stand here for 48 of 4453 series", "--point"));
}

}  // namespace
}  // namespace zerocount::report
