// The columns of a trace are those of the study, whatever they are.
#include "runners/study_commands/trace_writer.hpp"

#include <string>
#include <string_view>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace zerocount::study_commands {
namespace {

/// The trace of one sample, in a study with these further columns.
std::string trace_of(const study::StudyFeatures& features, bool json) {
  study::Study study;
  study.name = "extras";
  study.features = features;
  const study::StudyTrial trial;
  trial::SampleRecord record;
  record.count = 5;
  record.reference = 7;
  record.phase = loop::ControlPhase::coarse;
  record.drive_torque = 0.125;

  std::string text;
  TraceWriter writer([&text](std::string_view piece) { text += piece; }, json);
  writer.begin({study, 0, 0, trial});
  writer.write(record);
  writer.end({});
  return text;
}

TEST(TraceColumns, AreFourteenWhereTheStudyUsesNoMore) {
  EXPECT_EQ(trace_of({}, false),
            "k,t,target,count,coarse_count,error,code,torque,theta,omega,xp,xh,depth,mode\n"
            "0,0,0,5,0,0,0,0,0,0,0,0,0,stick\n");
}

TEST(TraceColumns, ThatTheStudyUsesComeAfterTheMode) {
  EXPECT_EQ(
      trace_of({.travel = true, .phases = true, .drive_torque = true}, false),
      "k,t,target,count,coarse_count,error,code,torque,theta,omega,xp,xh,depth,mode,reference,phase,drive_"
      "torque\n"
      "0,0,0,5,0,0,0,0,0,0,0,0,0,stick,7,coarse,0.125\n");
  EXPECT_TRUE(trace_of({.phases = true}, false).ends_with(",stick,coarse\n"));
}

TEST(TraceColumns, OfJsonAreTheSame) {
  const auto all = nlohmann::json::parse(
      trace_of({.travel = true, .phases = true, .drive_torque = true}, true))["samples"][0];
  EXPECT_EQ(all.size(), 17U);
  EXPECT_EQ(all["reference"], 7);
  EXPECT_EQ(all["phase"], "coarse");
  EXPECT_EQ(all["drive_torque"], 0.125);
  const auto few = nlohmann::json::parse(trace_of({}, true))["samples"][0];
  EXPECT_EQ(few.size(), 14U);
  EXPECT_FALSE(few.contains("reference"));
}

TEST(TraceOutcome, SaysWhetherItWasStoppedWhereTheStudyCanStop) {
  study::Study study;
  const study::StudyTrial trial;
  for (const bool stopped : {false, true}) {
    study.features.stopping = stopped;
    std::string text;
    TraceWriter writer([&text](std::string_view piece) { text += piece; }, true);
    writer.begin({study, 0, 0, trial});
    writer.end({{trial::MoveOutcome{}}});
    EXPECT_EQ(nlohmann::json::parse(text)["outcome"][0].contains("stopped"), stopped);
  }
}

}  // namespace
}  // namespace zerocount::study_commands
