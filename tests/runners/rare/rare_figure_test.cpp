// The figure of `rare`: where failures lie in the range of all trials.
#include "runners/rare/rare_run.hpp"
#include "tests/support/test.hpp"

namespace zerocount::rare {
namespace {

TEST(RareFigure, PlacesFailuresInTheRangeOfAllTrials) {
  const FailureInput stiffness{"friction.k1", "N m/rad", 2.0, {100.0, 110.0, 120.0}, {115.0, 120.0, 130.0}};
  const FailureInput constant{"dac.bits", "1", 0.4, {12.0, 12.0, 12.0}, {12.0, 12.0, 12.0}};
  const std::vector<document::Figure> figures = rare_figures({stiffness, constant});
  ASSERT_EQ(figures.size(), 1U);
  const auto& rows = figures[0].data[0].rows;
  ASSERT_EQ(rows.size(), 2U) << "of the input that varies";
  EXPECT_EQ(rows[0].dump(), R"(["friction.k1","all trials",100,110,120,"N m/rad",0,0.5,1])");
  EXPECT_EQ(rows[1].dump(), R"(["friction.k1","failures",115,120,130,"N m/rad",0.75,1,1.5])");
  EXPECT_TRUE(rare_figures({constant}).empty());
}

}  // namespace
}  // namespace zerocount::rare
