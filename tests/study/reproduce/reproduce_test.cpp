// The paper's tables and figures beside ours: what is found of them, and how it is told.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "canyon/study/reproduce/draws.h"
#include "canyon/study/reproduce/paper_receiver.h"
#include "canyon/study/reproduce/parts.h"

namespace canyon::study {
namespace {

using ::testing::HasSubstr;

const PaperRow& row_named(const PaperPart& part, const std::string& what) {
  for (const PaperRow& row : part.rows)
    if (row.what == what) return row;
  ADD_FAILURE() << "no row " << what;
  return part.rows.front();
}

double value_of(const PaperRow& row, const std::string& form) {
  for (const Ours& ours : row.ours)
    if (ours.form == form) return ours.value;
  ADD_FAILURE() << "no form " << form << " of " << row.what;
  return kNaN;
}

// Durst & Goodin (2012), table 1; docs/paper.md names the pairing that comes nearest: ranges alone, the ionosphere raw
// with its zenith delay, the satellites' error as corrected.
TEST(PaperTable1, WhichPairingComesNearest) {
  const auto part = range_error_part({});
  ASSERT_TRUE(part.ok()) << part.error().str();
  const PaperRow &ionosphere = row_named(*part, "ionosphere"), &own = row_named(*part, "satellites' own errors");
  EXPECT_LT(std::abs(std::log(value_of(ionosphere, "with its zenith delay, ranges alone, raw") / 4.73)),
            std::abs(std::log(value_of(ionosphere, "as printed, ranges alone, raw") / 4.73)));
  EXPECT_EQ(nearest(own)->form, "as corrected, ranges alone");
  // A clock takes up what the ranges have in common: the satellites' error, nearly the same for all, then hardly shows.
  EXPECT_LT(value_of(own, "as corrected, with a clock"), 0.5);
  EXPECT_GT(value_of(own, "as corrected, ranges alone"), 3.0 * value_of(own, "as corrected, with a clock"));
}

// The order of error sources is the paper's: ionosphere, satellites, troposphere; by the nearest form of each.
TEST(PaperTable1, ErrorsStandInThePapersOrder) {
  const auto part = range_error_part({});
  ASSERT_TRUE(part.ok()) << part.error().str();
  const auto best = [&](const char* what) { return nearest(row_named(*part, what))->value; };
  EXPECT_GT(best("ionosphere"), best("satellites' own errors"));
  EXPECT_GT(best("satellites' own errors"), best("troposphere"));
}

TEST(PaperTable1, WithoutAnErrorThePlacesAreTheCircle) {
  const auto part = range_error_part({});
  ASSERT_TRUE(part.ok()) << part.error().str();
  const PaperCurve& truth = part->curves.front();
  ASSERT_EQ(truth.name, "no error");
  ASSERT_EQ(truth.x.size(), 24u);
  for (std::size_t i = 0; i < truth.x.size(); ++i) EXPECT_NEAR(std::hypot(truth.x[i], truth.y[i]), 9.144, 1e-3);
}

// Figure 3: about 3 deg/h; asked for is a factor of 1.5.
TEST(PaperFigure3, DriftsAsThePaperSays) {
  const auto parts = inertial_parts(20);
  ASSERT_TRUE(parts.ok()) << parts.error().str();
  ASSERT_EQ(parts->size(), 3u);
  const PaperRow& drift = row_named(parts->front(), "drift of a gyroscope");
  EXPECT_GT(value_of(drift, "as corrected"), 3.0 / 1.5);
  EXPECT_LT(value_of(drift, "as corrected"), 3.0 * 1.5);
  EXPECT_EQ(nearest(drift)->form, "as corrected");
  for (const PaperCurve& curve : parts->front().curves) EXPECT_EQ(curve.x.size(), 1200u) << curve.panel;
}

TEST(PaperTable2, EveryCollectionHasItsNumbers) {
  const auto part = receiver_scatter_part({}, 2);
  ASSERT_TRUE(part.ok()) << part.error().str();
  ASSERT_EQ(part->rows.size(), 8u);
  for (const PaperRow& row : part->rows) {
    EXPECT_TRUE(std::isfinite(row.paper) && std::isfinite(row.real)) << row.what;
    for (const Ours& ours : row.ours) EXPECT_GT(ours.value, 0.0) << row.what << ", " << ours.form;
  }
}

// A receiver without any error scatters by nothing, so that what the table shows is the errors' doing.
TEST(PaperTable2, WithoutErrorsNothingScatters) {
  const gnss::GnssConfig config = error_free_receiver({}, "single_uncorrected", "trilateration");
  const PaperWay line{20.0, 5.0, [](double t_s) { return Eigen::Vector3d(1.5 * t_s, 0.0, 1.0); }};
  const auto outputs = measured(config, 1, PaperSky{}.start, line);
  ASSERT_TRUE(outputs.ok()) << outputs.error().str();
  ASSERT_EQ(outputs->size(), 100u);
  for (const auto& o : *outputs) EXPECT_LT((o.fix.p_A_E - o.truth.p_A_E).norm(), 1e-5);
}

TEST(Reproduction, NearestIsByRatio) {
  const PaperRow row{.what = "w", .unit = "m", .paper = 2.0, .ours = {{"half", 1.0, {}}, {"more", 3.5, {}}}};
  EXPECT_EQ(nearest(row)->form, "more");
  EXPECT_EQ(nearest({.what = "w", .unit = "", .ours = {{"a", 1.0, {}}}}), nullptr) << "no number of the paper";
  EXPECT_EQ(nearest({.what = "w", .unit = "", .paper = 1.0, .ours = {{"a", kNaN, {}}}}), nullptr);
}

TEST(Reproduction, DrawsAreTheirMedianAndTheirEnds) {
  const Ours of = over_draws("f", {3.0, kNaN, 1.0, 7.0});
  EXPECT_EQ(of.value, 3.0);
  EXPECT_EQ(of.range.low, 1.0);
  EXPECT_EQ(of.range.high, 7.0);
  EXPECT_FALSE(over_draws("f", {2.0}).range.defined());
  EXPECT_TRUE(std::isnan(over_draws("f", {kNaN}).value));
}

// Of six seeds the interval of the median is from the least to the most (2 / 2^6 = 3 %), and Student's of the
// differences 2, 2, 2, 4, 4, 4 about their mean of 3 is 2.57058 sqrt(6 / 5 / 6) wide each way (t with 5 degrees of
// freedom).
TEST(OverSeedsRow, MediansAndTheDifferenceSeedBySeed) {
  const PaperRow row = over_seeds_row(
      "w", "m", {{"low", {1, 2, 3, 4, 5, 6}}, {"paper", {9, kNaN, 9, 9, 9, 9}}, {"high", {3, 4, 5, 8, 9, 10}}});
  ASSERT_EQ(row.ours.size(), 4u);
  EXPECT_EQ(row.ours[0].value, 3.5);
  EXPECT_EQ(row.ours[0].range.low, 1.0);
  EXPECT_EQ(row.ours[0].range.high, 6.0);
  EXPECT_FALSE(row.ours[1].range.defined()) << "five seeds have it";
  EXPECT_EQ(row.ours[3].form, "high less low");
  EXPECT_DOUBLE_EQ(row.ours[3].value, 3.0);
  const double wide = 2.57058 * std::sqrt(0.2);  // student_975 is right to 1 %
  EXPECT_NEAR(row.ours[3].range.low, 3.0 - wide, 0.01 * wide);
  EXPECT_NEAR(row.ours[3].range.high, 3.0 + wide, 0.01 * wide);
}

TEST(OverSeedsRow, ASeedWithoutTheFigureIsLeftOutOfWhatNeedsIt) {
  const PaperRow row = over_seeds_row("w", "m", {{"low", {1, kNaN, 3}}, {"high", {4, 5, 8}}});
  EXPECT_EQ(row.ours[0].value, 2.0);
  EXPECT_EQ(row.ours[1].value, 5.0);
  EXPECT_EQ(row.ours[2].value, 4.0) << "of the first and the last seed";
}

TEST(Reproduction, IsToldAsTableAndJson) {
  Reproduction all{.ephemeris = "sky", .start = "2010", .draws = 1, .missions = 0, .parts = {}};
  all.parts.push_back(
      {.name = "p",
       .title = "Part",
       .paper_says = "",
       .made = "",
       .difference = {"It differs."},
       .x_label = "",
       .rows = {{.what = "w", .unit = "m", .paper = 2.0, .real = 4.0, .ours = {{"f", 3.0, {2.5, 3.5}}}}},
       .curves = {{.panel = "a", .unit = "m", .name = "n", .x = {1.0}, .y = {kNaN}}}});
  const std::string table = reproduction_table(all);
  EXPECT_THAT(table, HasSubstr("its real sensor         4"));
  EXPECT_THAT(table, HasSubstr("3  (2.5 to 3.5)\n  It differs.\n"));
  EXPECT_EQ(reproduction_csv(all), "part,what,unit,paper,real,form,value,low,high\np,\"w\",m,2,4,\"f\",3,2.5,3.5\n");
  const auto json = reproduction_json(all);
  EXPECT_EQ(json["parts"][0]["rows"][0]["ratio"], 1.5);
  EXPECT_EQ(json["parts"][0]["rows"][0]["nearest"], "f");
  EXPECT_TRUE(json["parts"][0]["curves"][0]["y"][0].is_null());
}

}  // namespace
}  // namespace canyon::study
