// Sections of an answer, and tables inside their rows.
#include <nlohmann/json.hpp>

#include "analysis/document/answer.hpp"
#include "tests/support/test.hpp"

namespace zerocount::document {
namespace {

struct Rate {
  double from;
  std::optional<Bounded> rate;
};

struct Point {
  std::string label;
  std::vector<Rate> rates;
};

struct Report {
  std::vector<Point> points;
};

AnswerDescription<Report> report_description() {
  const auto rates = Description<Rate>()
                         .value({.key = "from", .heading = "from", .unit = "s"}, &Rate::from)
                         .value({.key = "rate", .heading = "rate", .unit = "1/s"}, &Rate::rate);
  const auto points = Description<Point>()
                          .title(&Point::label)
                          .value(in_data("label", "label of the point"), &Point::label)
                          .value({.key = "advice", .heading = "advice", .shown = Shown::in_json},
                                 [](const Point&) { return "more trials"; })
                          .table({.key = "rates", .heading = "rates"}, rates, &Point::rates);
  AnswerDescription<Report> answer{{.name = "report", .meaning = "points", .csv_table = "points.rates"}, {}};
  answer.items.headline([](const Report& report) { return std::to_string(report.points.size()) + " points"; })
      .sections({.key = "points", .meaning = "the points"}, points, &Report::points);
  return answer;
}

const Report two_points{
    {{"low", {{0.5, Bounded{2.0, 1.0, 4.0}}, {1.0, {}}}}, {"b, high", {{0.25, Bounded{3.0, 2.0, 5.0}}}}}};

TEST(Sections, StandOneBelowTheOtherForPeople) {
  const std::string text = document::text(report_description().of(two_points));
  EXPECT_EQ(text.find("2 points"), 0U);
  EXPECT_LT(text.find("low:"), text.find("2 [1, 4]")) << text;
  EXPECT_LT(text.find("2 [1, 4]"), text.find("b, high:")) << text;
  EXPECT_LT(text.find("b, high:"), text.find("3 [2, 5]")) << text;
  EXPECT_EQ(text.find("more trials"), std::string::npos) << text;
}

TEST(Sections, AreAListOfObjectsInJson) {
  const auto json = document::json(report_description().of(two_points));
  ASSERT_EQ(json["points"].size(), 2U);
  EXPECT_EQ(json["points"][1]["label"], "b, high");
  EXPECT_EQ(json["points"][1]["advice"], "more trials");
  EXPECT_EQ(json["points"][0]["rates"][0]["rate_high"], 4.0);
  EXPECT_TRUE(json["points"][0]["rates"][1]["rate"].is_null());
  const auto schema = json_schema(report_description().complete_type());
  EXPECT_EQ(schema["properties"]["points"]["items"]["properties"]["rates"]["type"], "array");
}

TEST(Sections, GiveTheLinesOfATableInThemTheirValues) {
  EXPECT_EQ(csv(report_description().of(two_points)),
            "label,from,rate,rate_low,rate_high\n"
            "low,0.5,2,1,4\n"
            "low,1,nan,nan,nan\n"
            "\"b, high\",0.25,3,2,5\n");
}

}  // namespace
}  // namespace zerocount::document
