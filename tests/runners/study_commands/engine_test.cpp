// The engine of a run: the same integers from both on a stable study, the choice recorded in the file, and
// trials of the two never mixed.
#include "results/reading/all_trials_file.hpp"
#include "tests/runners/program.hpp"
#include "tests/support/raw_hdf5.hpp"

namespace zerocount::testing {
namespace {

namespace fs = std::filesystem;

/// Manifest of two moves per trial that all settle, with jerks, at gains with which the contact never slides;
/// a gain is swept.
const char* const stable_manifest =
    "zerocount: 1\nname: stable\nseed: 77\ntrials: 120\n"
    "friction:\n"
    "  k1: {truncated_normal: {mean: 110, sd: 15, low: 90, high: 130}}\n"
    "  k2: {profile: {mean: 750, cv: 0.1, correlation_length: 0.3, marginal: lognormal}}\n"
    "  beta: {lognormal: {median: 2.0e5, cv: 0.2}}\n"
    "  alpha: {log_uniform: [0.25, 1.0]}\n"
    "  lambda: {log_uniform: [0.5, 5]}\n"
    "command: {targets: [{integers: [1, 30]}, {integers: [-30, 30]}], hold: 0.5}\n"
    "initial: {encoder_phase: {uniform: [0, 1]}, position: {uniform: [0, 6.283185307179586]}}\n"
    "verdict: {dwell: 0.02, window: 0.02}\n"
    "sweep: {grid: {controller.ki: [2.0e-5, 3.0e-5]}}\n";

class EngineOption : public ProgramTest {
 protected:
  fs::path at(const std::string& name) const { return folder_.path() / name; }

  void complete(const std::string& manifest, const std::string& output,
                const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"run", manifest, "-o", output};
    words.insert(words.end(), more.begin(), more.end());
    const ProgramResult result = program(words);
    ASSERT_EQ(result.code, 0) << result.err;
  }
};

bool same(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

void expect_same_inputs(const reading::AllTrialsFile& a, const reading::AllTrialsFile& b) {
  ASSERT_EQ(a.rows().count, b.rows().count);
  ASSERT_EQ(a.input_columns().size(), b.input_columns().size());
  for (std::size_t column = 0; column < a.input_columns().size(); ++column)
    EXPECT_EQ(a.input(column, a.rows()), b.input(column, b.rows())) << a.input_columns()[column].name;
}

TEST_F(EngineOption, GivesTheSameIntegersOnAStableStudy) {
  folder_.write("study.yaml", stable_manifest);
  complete("study.yaml", "batch.h5", {"--engine", "batch"});
  complete("study.yaml", "reference.h5", {"--engine", "reference"});
  const reading::AllTrialsFile batch(at("batch.h5"));
  const reading::AllTrialsFile reference(at("reference.h5"));
  expect_same_inputs(batch, reference);

  constexpr double counts = 1620000.0 / (2.0 * std::numbers::pi);  // a radian
  for (const layout::RecordField<trial::MoveOutcome>& field : reference.measures()) {
    const std::string& name = field.column.name;
    const bool angle = name == "final_position" || name == "creep";
    const double allowed = angle ? 1e-6 / counts : name == "true_error" ? 1e-6 : 0.0;
    const std::vector<double> a = batch.measure(name, batch.rows());
    const std::vector<double> b = reference.measure(name, reference.rows());
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_TRUE(same(a[i], b[i]) || std::abs(a[i] - b[i]) <= allowed)
          << name << " of row " << i << ": " << a[i] << " and " << b[i];
    }
  }
  EXPECT_EQ(reference.measure("broke_away", reference.rows()), std::vector<double>(480, 0.0));

  ASSERT_EQ(batch.jerk_count(), reference.jerk_count());
  EXPECT_GT(reference.jerk_count(), 100);
  const std::vector<layout::JerkRecord> ours = batch.jerks_at(0, batch.jerk_count());
  const std::vector<layout::JerkRecord> theirs = reference.jerks_at(0, reference.jerk_count());
  for (std::size_t i = 0; i < ours.size(); ++i) {
    EXPECT_EQ(ours[i].trial, theirs[i].trial) << i;
    EXPECT_EQ(ours[i].move, theirs[i].move) << i;
    EXPECT_EQ(ours[i].onset, theirs[i].onset) << i;
    EXPECT_EQ(ours[i].duration, theirs[i].duration) << i;
    EXPECT_EQ(ours[i].magnitude, theirs[i].magnitude) << i;
    EXPECT_EQ(ours[i].direction, theirs[i].direction) << i;
  }
}

TEST_F(EngineOption, DefaultsToBatchAndIsRecorded) {
  folder_.write("study.yaml", small_manifest(5));
  complete("study.yaml", "default.h5");
  complete("study.yaml", "batch.h5", {"--engine", "batch"});
  complete("study.yaml", "reference.h5", {"--engine", "reference"});
  EXPECT_EQ(reading::AllTrialsFile(at("default.h5")).header().engine, study::Engine::batch);
  EXPECT_EQ(reading::AllTrialsFile(at("reference.h5")).header().engine, study::Engine::reference);
  EXPECT_EQ(reading::AllTrialsFile(at("default.h5")).root().text("engine"), "batch");
  EXPECT_EQ(reading::AllTrialsFile(at("reference.h5")).root().text("engine"), "reference");
  expect_same_datasets(at("default.h5"), at("batch.h5"));

  EXPECT_TRUE(says(refusal({"run", "study.yaml", "-o", "x.h5", "--engine", "steam"}), "steam", "reference"));
  EXPECT_FALSE(fs::exists(at("x.h5")));
}

TEST_F(EngineOption, IsNamedInEveryFile) {
  folder_.write("study.yaml", small_manifest(3));
  complete("study.yaml", "odd.h5");
  fs::copy_file(at("odd.h5"), at("silent.h5"));
  remove_attribute(at("silent.h5"), "engine");
  EXPECT_TRUE(says(refusal({"summary", "silent.h5"}, 4), "engine"));
  replace_attribute(at("odd.h5"), "engine", "steam");
  EXPECT_TRUE(says(refusal({"summary", "odd.h5"}, 4), "steam"));
}

TEST_F(EngineOption, CannotBeChangedForAFinishedFile) {
  folder_.write("study.yaml", small_manifest(3));
  complete("study.yaml", "out.h5");
  const std::string bytes = folder_.read("out.h5");
  EXPECT_TRUE(says(refusal({"run", "study.yaml", "-o", "out.h5", "--engine", "reference"}), "engine"));
  EXPECT_EQ(folder_.read("out.h5"), bytes);
  EXPECT_EQ(program({"run", "study.yaml", "-o", "out.h5", "--engine", "batch"}).code, 0);
}

/// The engine of an unfinished run cannot be changed: its shards are refused like those of another study.
TEST_F(EngineOption, CannotBeChangedForAnUnfinishedRun) {
  folder_.write("study.yaml", small_manifest(20));
  for (const char* engine : {"batch", "reference"}) {
    const std::string other = engine == std::string("batch") ? "reference" : "batch";
    const std::string part = std::string(engine) + "-part.h5";
    const std::string output = std::string("from-") + engine + ".h5";
    complete("study.yaml", part, {"--shard", "1/2", "--engine", engine});
    fs::create_directory(at(output + ".shards"));
    fs::copy(at(part), at(output + ".shards") / "part.h5");
    EXPECT_TRUE(says(refusal({"run", "study.yaml", "-o", output, "--engine", other}), engine));
    EXPECT_FALSE(fs::exists(at(output)));
    EXPECT_TRUE(fs::exists(at(output + ".shards") / "part.h5"));
    complete("study.yaml", output, {"--engine", engine});
    complete("study.yaml", std::string("whole-") + engine + ".h5", {"--engine", engine});
    expect_same_datasets(at(output), at(std::string("whole-") + engine + ".h5"));
  }
}

TEST_F(EngineOption, MustBeEqualInAllPartsOfAMerge) {
  folder_.write("study.yaml", small_manifest(21));
  complete("study.yaml", "b1.h5", {"--shard", "1/2"});
  complete("study.yaml", "b2.h5", {"--shard", "2/2"});
  complete("study.yaml", "r1.h5", {"--shard", "1/2", "--engine", "reference"});
  complete("study.yaml", "r2.h5", {"--shard", "2/2", "--engine", "reference"});
  for (const auto& [one, two] : {std::pair{"b1.h5", "r2.h5"}, std::pair{"r1.h5", "b2.h5"}}) {
    const ProgramResult mixed = program({"merge", one, two, "-o", "mixed.h5"});
    EXPECT_EQ(mixed.code, 4) << mixed.err;
    EXPECT_TRUE(says(mixed.err, "engine"));
    EXPECT_FALSE(fs::exists(at("mixed.h5")));
  }
  for (const char* engine : {"batch", "reference"}) {
    const std::string initial(1, engine[0]);
    const std::string merged = "merged-" + initial + ".h5";
    ASSERT_EQ(program({"merge", initial + "2.h5", initial + "1.h5", "-o", merged}).code, 0);
    EXPECT_EQ(reading::AllTrialsFile(at(merged)).root().text("engine"), engine);
    complete("study.yaml", "whole-" + initial + ".h5", {"--engine", engine});
    expect_same_datasets(at(merged), at("whole-" + initial + ".h5"));
  }
}

/// Records and replays are the reference's, whichever engine ran the study.
TEST_F(EngineOption, LeavesRecordsAndReplaysToTheReference) {
  folder_.write("study.yaml", std::string(stable_manifest) + "retain: {trials: [2]}\n");
  complete("study.yaml", "batch.h5", {"--set", "trials=4"});
  complete("study.yaml", "reference.h5", {"--set", "trials=4", "--engine", "reference"});
  const reading::AllTrialsFile batch(at("batch.h5"));
  const reading::AllTrialsFile reference(at("reference.h5"));
  ASSERT_EQ(batch.trace_count(), reference.trace_count());
  const std::vector<layout::TraceRecord> ours = batch.trace_at(0, batch.trace_count());
  const std::vector<layout::TraceRecord> theirs = reference.trace_at(0, reference.trace_count());
  for (std::size_t i = 0; i < ours.size(); ++i) {
    ASSERT_EQ(ours[i].count, theirs[i].count) << i;
    ASSERT_EQ(ours[i].theta, theirs[i].theta) << i;
  }
  for (const char* trial : {"0", "2", "3"}) {
    const ProgramResult replay = program({"trace", "batch.h5", "--point", "1", "--trial", trial});
    EXPECT_EQ(replay.code, 0) << replay.err;
    EXPECT_EQ(replay.out, program({"trace", "reference.h5", "--point", "1", "--trial", trial}).out) << trial;
  }
}

/// The line of a text that names the engine; empty if there is none.
std::string engine_line(const std::string& text) {
  const std::size_t place = text.find("on the reference engine");
  if (place == std::string::npos) return "";
  const std::size_t start = text.rfind('\n', place) + 1;  // npos + 1 is 0
  return text.substr(text.find_first_not_of(' ', start),
                     text.find('\n', place) - text.find_first_not_of(' ', start));
}

/// A study of which no trial runs in lanes is the reference's, and its file says so, whatever was asked for.
/// If only some points run in lanes, the file names the batch engine.
TEST_F(EngineOption, NamesTheEngineThatRanTheTrials) {
  folder_.write("study.yaml", small_manifest(4));
  const std::vector<std::string> gap{"--set", "plant.load={inertia: 1.0e-4, gap: 1.0e-4}"};
  const auto with_gap = [&gap](std::vector<std::string> more) {
    more.insert(more.end(), gap.begin(), gap.end());
    return more;
  };
  complete("study.yaml", "gap.h5", with_gap({"--engine", "batch"}));
  complete("study.yaml", "asked.h5", with_gap({"--engine", "reference"}));
  EXPECT_EQ(reading::AllTrialsFile(at("gap.h5")).root().text("engine"), "reference");
  expect_same_datasets(at("gap.h5"), at("asked.h5"));
  EXPECT_EQ(program({"verify", "gap.h5"}).code, 0);
  complete("study.yaml", "gap.h5", with_gap({}));  // already complete
  complete("study.yaml", "some.h5",
           {"--set", "plant.load={inertia: 1.0e-4}", "--set", "sweep={grid: {plant.load.gap: [0, 1.0e-4]}}"});
  EXPECT_EQ(reading::AllTrialsFile(at("some.h5")).root().text("engine"), "batch");
}

TEST_F(EngineOption, RunAndCheckTellWhichPointsRunOnTheReferenceEngineAndWhy) {
  folder_.write(
      "laws.yaml",
      "zerocount: 1\nname: laws\nseed: 1\ntrials: 2\n"
      "command: {targets: [3], hold: 0.05}\nverdict: {window: 0.01}\n"
      "disturbance: {ripple: [{amplitude: 1.0e-5, periods: 36, phase: 0}]}\n"
      "sweep: {grid: {friction.model: [presliding, none, lugre], controller.ki: [2.0e-5, 3.0e-5]}}\n");
  const std::string two =
      "2 of 6 points run on the reference engine, several times slower, because of disturbance.ripple "
      "without friction";
  EXPECT_EQ(engine_line(program({"check", "laws.yaml"}).out), two);
  EXPECT_EQ(engine_line(program({"run", "laws.yaml", "-o", "a.h5"}).err), two);
  EXPECT_EQ(engine_line(program({"run", "laws.yaml", "-o", "b.h5", "--quiet"}).err), "");
  EXPECT_EQ(engine_line(program({"run", "laws.yaml", "-o", "c.h5", "--engine", "reference"}).err), "");
  const ProgramResult all =
      program({"check", "laws.yaml", "--set",
               "disturbance.vibration=[{amplitude: 1.0e-5, frequency: 1100, phase: 0}]"});
  EXPECT_EQ(engine_line(all.out),
            "all trials run on the reference engine, several times slower, because of a vibration above half "
            "the sample rate, disturbance.ripple without friction");
  const ProgramResult load = program(
      {"check", "laws.yaml", "--set", "plant.load={inertia: 1.0e-4, gap: 1.0e-4, damping_to_ground: 0.01}"});
  EXPECT_NE(engine_line(load.out).find("plant.load.gap, plant.load.damping_to_ground"), std::string::npos)
      << "without the gap the lanes still lack the damping: " << engine_line(load.out);
}

}  // namespace
}  // namespace zerocount::testing
