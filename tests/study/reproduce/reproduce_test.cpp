// The paper's tables and figures beside ours: what is found of them, and how it is told.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Core>
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

const Ours& ours_of(const PaperRow& row, const std::string& form) {
  for (const Ours& ours : row.ours)
    if (ours.form == form) return ours;
  ADD_FAILURE() << "no form " << form << " of " << row.what;
  return row.ours.front();
}

double value_of(const PaperRow& row, const std::string& form) {
  return ours_of(row, form).value;
}

/// The curve of that name in the first panel whose name begins so and has `has` in it.
const PaperCurve& curve_of(const PaperPart& part, const std::string& begin, const std::string& has,
                           const std::string& name) {
  for (const PaperCurve& curve : part.curves)
    if (curve.panel.rfind(begin, 0) == 0 && curve.panel.find(has) != std::string::npos && curve.name == name)
      return curve;
  ADD_FAILURE() << "no curve " << name << " of " << begin << " with " << has;
  return part.curves.front();
}

/// Root of the mean square of its places' distance from their mean.
double rms_about_mean(const PaperCurve& curve) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double n = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < curve.x.size(); ++i)
    if (std::isfinite(curve.x[i])) sum += Eigen::Vector2d(curve.x[i], curve.y[i]), n += 1.0;
  for (std::size_t i = 0; i < curve.x.size(); ++i)
    if (std::isfinite(curve.x[i])) squares += (Eigen::Vector2d(curve.x[i], curve.y[i]) - sum / n).squaredNorm();
  return std::sqrt(squares / n);
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

/// One column of table 1: by ranges alone, each error as corrected or with its zenith delay. The satellites' own errors
/// no receiver corrects by itself: both columns have the same.
struct Table1Column {
  double ionosphere_m, satellites_m, troposphere_m;
};
Table1Column table_1_column(const PaperPart& part, const std::string& column) {
  return {value_of(row_named(part, "ionosphere"), "with its zenith delay, ranges alone, " + column),
          value_of(row_named(part, "satellites' own errors"), "as corrected, ranges alone"),
          value_of(row_named(part, "troposphere"), "as corrected, ranges alone, " + column)};
}

// The order of error sources is the paper's, ionosphere, satellites, troposphere, in what a receiver's own corrections
// leave. Raw it is another one: there the troposphere is the largest (docs/paper.md).
TEST(PaperTable1, ErrorsStandInThePapersOrder) {
  const auto part = range_error_part({});
  ASSERT_TRUE(part.ok()) << part.error().str();
  const Table1Column corrected = table_1_column(*part, "corrected"), raw = table_1_column(*part, "raw");
  EXPECT_GT(corrected.ionosphere_m, corrected.satellites_m);
  EXPECT_GT(corrected.satellites_m, corrected.troposphere_m);
  EXPECT_GT(raw.troposphere_m, raw.ionosphere_m);
  EXPECT_GT(raw.ionosphere_m, raw.satellites_m);
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

constexpr const char *kFormulas = "as corrected, ranges alone", *kReceiver = "Canyon's receiver, no multipath";

/// A collection's total standard deviations over 20 starts, least and most, as docs/paper.md has them.
struct DocumentedScatter {
  const char* collection;
  Interval formulas_m, receiver_m;
};
const DocumentedScatter kRest[] = {{"trial 1, 20 minutes at rest", {0.14, 5.4}, {0.90, 1.8}},
                                   {"trial 2, 20 minutes at rest", {0.14, 5.5}, {0.97, 2.2}}};
const DocumentedScatter kCircle{"circle of 30 ft, eight loops", {0.03, 6.4}, {0.86, 1.7}};
const DocumentedScatter kLine{"line of 60 ft, ten passes", {0.01, 1.3}, {0.84, 1.4}};

const PaperRow& total_of(const PaperPart& part, const DocumentedScatter& one) {
  return row_named(part, std::string(one.collection) + ": total");
}

/// The median lies between the documented ends, and no start is beyond them by more than a factor of 1.5, which is what
/// is asked of figure 3 too. The least are printed to 0.01 m.
void expect_within(const PaperRow& row, const char* form, const Interval& documented_m) {
  const Ours& ours = ours_of(row, form);
  EXPECT_TRUE(ours.value > documented_m.low && ours.value < documented_m.high) << row.what << ", " << form;
  EXPECT_GT(ours.range.low, (documented_m.low - 0.005) / 1.5) << row.what << ", " << form;
  EXPECT_LT(ours.range.high, 1.5 * documented_m.high) << row.what << ", " << form;
}

TEST(PaperTable2Nightly, ScattersAsDocumented) {
  const auto part = receiver_scatter_part({}, 20);
  ASSERT_TRUE(part.ok()) << part.error().str();
  for (const DocumentedScatter& one : {kRest[0], kRest[1], kCircle, kLine}) {
    const PaperRow& row = total_of(*part, one);
    expect_within(row, kFormulas, one.formulas_m);
    expect_within(row, kReceiver, one.receiver_m);
    EXPECT_LT(value_of(row, kReceiver), row.real) << "the paper's real receiver had multipath, ours has none";
  }
  const PaperRow &circle = total_of(*part, kCircle), &line = total_of(*part, kLine);
  // The formulas are functions of place and time alone: they drift with the satellites, and a uniform drift scatters by
  // its duration. 20 minutes, 306 s of the circle and 122 s of the line are 3.9 and 2.5 apart; asked for is half of it.
  EXPECT_GT(value_of(circle, kFormulas), 0.5 * 2.5 * value_of(line, kFormulas));
  for (const DocumentedScatter& rest : kRest) {
    const PaperRow& row = total_of(*part, rest);
    EXPECT_GT(value_of(row, kFormulas), 0.5 * 3.9 * value_of(circle, kFormulas)) << row.what;
    // A receiver's noise is there however short the track: 20 minutes at rest have less than twice of it.
    for (const PaperRow* track : {&circle, &line})
      EXPECT_LT(value_of(row, kReceiver), 2.0 * value_of(*track, kReceiver)) << row.what << ", " << track->what;
  }
  // So on tracks it is the noise that scatters, and not the formulas.
  for (const PaperRow* track : {&circle, &line})
    EXPECT_GT(value_of(*track, kReceiver), 2.0 * value_of(*track, kFormulas)) << track->what;
}

TEST(PaperTable2, EveryCollectionHasItsNumbers) {
  const auto part = receiver_scatter_part({}, 2);
  ASSERT_TRUE(part.ok()) << part.error().str();
  ASSERT_EQ(part->rows.size(), 8u);
  for (const PaperRow& row : part->rows) {
    EXPECT_TRUE(std::isfinite(row.paper) && std::isfinite(row.real)) << row.what;
    ASSERT_EQ(row.ours.size(), 3u) << row.what;
    for (const Ours& ours : row.ours) {
      EXPECT_EQ(ours.n, 2) << row.what << ", " << ours.form;
      EXPECT_GT(ours.range.low, 0.0) << row.what << ", " << ours.form;
      EXPECT_TRUE(ours.range.low < ours.value && ours.value < ours.range.high) << row.what << ", " << ours.form;
    }
  }
  // Degrees and metres are of one scatter: a degree of longitude at 32 degrees north is more than 94 km, one of
  // latitude less than 111 km. The horizontal part is less than the whole, and of a receiver with noise more than a
  // fifth of it, for HDOP is not so small a part of PDOP.
  for (const DocumentedScatter& one : {kRest[0], kRest[1], kCircle, kLine}) {
    const PaperRow& flat = row_named(*part, std::string(one.collection) + ": latitude and longitude");
    const PaperRow& total = total_of(*part, one);
    for (const Ours& ours : flat.ours) EXPECT_LT(94e3 * ours.value, value_of(total, ours.form)) << flat.what;
    EXPECT_GT(111e3 * value_of(flat, kReceiver), 0.2 * value_of(total, kReceiver)) << flat.what;
  }
}

// Figures 4 and 5: a position a second of each form about its own mean. The mean of 1200 numbers of some metres is zero
// but for rounding; what is drawn is the start of which the table has the scatter.
TEST(PaperTable2, RestIsDrawnFromAboveAboutItsMean) {
  const auto part = receiver_scatter_part({}, 1);
  ASSERT_TRUE(part.ok()) << part.error().str();
  const char* const figures[] = {"Fig. 4", "Fig. 5"};
  for (std::size_t trial = 0; trial < 2; ++trial) {
    for (const Ours& ours : total_of(*part, kRest[trial]).ours) {
      const PaperCurve& curve = curve_of(*part, figures[trial], "from above", ours.form);
      EXPECT_TRUE(curve.from_above);
      ASSERT_EQ(curve.x.size(), 1200u);
      double east_m = 0.0, north_m = 0.0;
      for (std::size_t i = 0; i < curve.x.size(); ++i) {
        if (!std::isfinite(curve.x[i])) continue;
        east_m += curve.x[i];
        north_m += curve.y[i];
      }
      EXPECT_LT(std::hypot(east_m, north_m) / 1200.0, 1e-9) << figures[trial] << ", " << ours.form;
      EXPECT_GT(rms_about_mean(curve), 0.0) << figures[trial] << ", " << ours.form;
      EXPECT_LT(rms_about_mean(curve), ours.value) << figures[trial] << ", " << ours.form << ": it has no height";
      EXPECT_EQ(curve_of(*part, figures[trial], ours.form + ", error over time", "up").y.size(), 1200u);
    }
  }
}

// Figure 6: the true track is the circle of 30 ft, and each form's positions are as far from their middle but for what
// they scatter (triangle inequality of root mean squares; the middle of not quite whole loops is less than 0.1 m beside
// the circle's). And the line of 60 ft, on which ten passes have nine turns.
TEST(PaperTable2, TracksAreDrawnFromAbove) {
  const auto part = receiver_scatter_part({}, 1);
  ASSERT_TRUE(part.ok()) << part.error().str();
  const PaperCurve& circle = curve_of(*part, "Fig. 6: circle", "from above", "true track");
  EXPECT_GT(circle.x.size(), 300u);
  for (std::size_t i = 0; i < circle.x.size(); ++i) EXPECT_NEAR(std::hypot(circle.x[i], circle.y[i]), 9.144, 1e-9);
  for (const Ours& ours : total_of(*part, kCircle).ours) {
    const PaperCurve& curve = curve_of(*part, "Fig. 6: circle", "from above", ours.form);
    EXPECT_EQ(curve.x.size(), circle.x.size());
    EXPECT_NEAR(rms_about_mean(curve), 9.144, ours.value + 0.1) << ours.form;
  }
  const PaperCurve& line = curve_of(*part, "Fig. 6: line", "from above", "true track");
  int turns = 0;
  for (std::size_t i = 1; i < line.x.size(); ++i) {
    EXPECT_TRUE(line.x[i] >= 0.0 && line.x[i] <= 60.0 * 0.3048 && line.y[i] == 0.0) << line.x[i];
    EXPECT_LT(std::abs(line.x[i] - line.x[i - 1]), 1.5 + 1e-9) << "1.5 m/s, a point a second";
    turns += i > 1 && (line.x[i] - line.x[i - 1]) * (line.x[i - 1] - line.x[i - 2]) < 0.0 ? 1 : 0;
  }
  EXPECT_EQ(turns, 9);
  for (const Ours& ours : total_of(*part, kLine).ours)
    EXPECT_EQ(curve_of(*part, "Fig. 6: line", "from above", ours.form).x.size(), line.x.size());
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
  EXPECT_EQ(of.n, 3);
  EXPECT_FALSE(over_draws("f", {2.0}).range.defined());
  EXPECT_TRUE(std::isnan(over_draws("f", {kNaN}).value));
  EXPECT_EQ(over_draws("f", {kNaN}).n, 0);
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
  EXPECT_EQ(row.ours[0].n, 6);
  EXPECT_EQ(row.ours[1].n, 5);
  EXPECT_EQ(row.ours[3].n, 6);
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
       .rows = {{.what = "w", .unit = "m", .paper = 2.0, .real = 4.0, .ours = {{"f", 3.0, {2.5, 3.5}, 20}}}},
       .curves = {
           {.panel = "a", .unit = "m", .name = "n", .x = {1.0}, .y = {kNaN}, .from_above = true, .labels = {"7"}}}});
  const std::string table = reproduction_table(all);
  EXPECT_THAT(table, HasSubstr("its real sensor         4"));
  EXPECT_THAT(table, HasSubstr("3  (2.5 to 3.5, n = 20)\n  It differs.\n"));
  EXPECT_EQ(reproduction_csv(all),
            "part,what,unit,paper,real,form,value,low,high,n\np,\"w\",m,2,4,\"f\",3,2.5,3.5,20\n");
  const auto json = reproduction_json(all);
  EXPECT_EQ(json["parts"][0]["rows"][0]["ratio"], 1.5);
  EXPECT_EQ(json["parts"][0]["rows"][0]["nearest"], "f");
  EXPECT_EQ(json["parts"][0]["rows"][0]["ours"][0]["n"], 20);
  EXPECT_TRUE(json["parts"][0]["curves"][0]["y"][0].is_null());
  EXPECT_EQ(json["parts"][0]["curves"][0]["from_above"], true);
  EXPECT_EQ(json["parts"][0]["curves"][0]["labels"][0], "7");
}

}  // namespace
}  // namespace canyon::study
