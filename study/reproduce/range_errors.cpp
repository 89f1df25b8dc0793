// Table 1 and figure 1: mean receiver offset by each range error alone.
#include <cmath>

#include "canyon/scene/flat_ground.h"
#include "canyon/study/reproduce/from_above.h"
#include "canyon/study/reproduce/paper_receiver.h"

namespace canyon::study {
namespace {

constexpr double kCircle_m = 9.144;  // 30 ft
constexpr int kPoints = 24;

struct CircleOffsets {
  double mean_m = 0.0, pdop = 0.0;
  PaperCurve places;
};

/// Over a circle of 30 ft, a point every five seconds.
Result<CircleOffsets> offsets_on_circle(const gnss::GnssConfig& config, GpsTime start, const char* name) {
  const PaperWay circle{5.0 * kPoints, 0.2, [](double t_s) {
                          const double a = 2.0 * kPi * t_s / (5.0 * kPoints);
                          return Eigen::Vector3d(kCircle_m * std::cos(a), kCircle_m * std::sin(a), 1.0);
                        }};
  CANYON_TRY(const auto outputs, measured(config, 1, start, circle));
  CircleOffsets out;
  std::vector<Eigen::Vector3d> places_W;
  for (const gnss::GnssOutput& o : outputs) {
    if (o.fix.status == FixStatus::kNone)
      return Error{.what = "no position on the paper's circle: " + o.fix.reason,
                   .expected = "navigation data with at least four satellites above 18 deg"};
    out.mean_m += (o.fix.p_A_E - o.truth.p_A_E).norm() / kPoints;
    out.pdop += o.fix.dop.pdop / kPoints;
    places_W.push_back(scene::flat_ground().frame().to_W(o.fix.p_A_E));
  }
  out.places = from_above("Fig. 1: positions on the circle, from above", name, places_W);
  out.places.points = true;
  return out;
}

/// A range error, and a form of ours for it: which row of which effect, and whether the receiver corrects it.
struct ErrorForm {
  const char* form;
  const char* row;
  const char* mode;
  const char* solver;
};
constexpr const char *kRaw = "single_uncorrected", *kResidual = "single";
constexpr const char *kRanges = "trilateration", *kClock = "least_squares";

struct RangeErrorRow {
  const char* what;
  double paper_m;
  void (*set)(gnss::GnssConfig& config, const char* row);
  std::vector<ErrorForm> forms;
};

const std::vector<RangeErrorRow>& error_rows() {
  static const std::vector<RangeErrorRow> kRows{
      {"troposphere",
       0.57,
       [](gnss::GnssConfig& c, const char* row) { c.troposphere.name = row; },
       {{"as printed, ranges alone, raw", "paper_printed", kRaw, kRanges},
        {"as printed, ranges alone, corrected", "paper_printed", kResidual, kRanges},
        {"as corrected, ranges alone, raw", "paper_corrected", kRaw, kRanges},
        {"as corrected, ranges alone, corrected", "paper_corrected", kResidual, kRanges},
        {"as corrected, with a clock, corrected", "paper_corrected", kResidual, kClock}}},
      {"ionosphere",
       4.73,
       [](gnss::GnssConfig& c, const char* row) { c.ionosphere.name = row; },
       {{"as printed, ranges alone, raw", "paper_printed", kRaw, kRanges},
        {"with its zenith delay, ranges alone, raw", "paper", kRaw, kRanges},
        {"with its zenith delay, ranges alone, corrected", "paper", kResidual, kRanges},
        {"with its zenith delay, with a clock, raw", "paper", kRaw, kClock},
        {"single layer, ranges alone, raw", "single_layer", kRaw, kRanges}}},
      {"satellites' own errors",
       1.14,
       [](gnss::GnssConfig& c, const char* row) { c.ephemeris_error.name = row; },
       {{"as printed, ranges alone", "paper_printed", kRaw, kRanges},
        {"as corrected, ranges alone", "paper_corrected", kRaw, kRanges},
        {"as corrected, with a clock", "paper_corrected", kRaw, kClock}}}};
  return kRows;
}

/// The pairing that figure 1 is drawn of: ranges alone, and the form that comes nearest.
Result<PaperRow> row_of(const RangeErrorRow& row, const PaperSky& sky, std::vector<PaperCurve>& curves) {
  PaperRow out{.what = row.what, .unit = "m", .paper = row.paper_m, .ours = {}};
  std::vector<PaperCurve> places;
  for (const ErrorForm& form : row.forms) {
    gnss::GnssConfig config = error_free_receiver(sky, form.mode, form.solver);
    row.set(config, form.row);
    CANYON_TRY(CircleOffsets found, offsets_on_circle(config, sky.start, row.what));
    out.ours.push_back({form.form, found.mean_m, {}});
    places.push_back(std::move(found.places));
  }
  const Ours* best = nearest(out);
  if (best != nullptr) curves.push_back(std::move(places[static_cast<std::size_t>(best - out.ours.data())]));
  return out;
}

}  // namespace

Result<PaperPart> range_error_part(const PaperSky& sky) {
  PaperPart part{
      .name = "table_1",
      .title = "Table 1 and Fig. 1: what each range error alone moves the position by",
      .paper_says =
          "Mean offsets over a set of points along a circle, seven satellites: troposphere 0.57 m, ionosphere "
          "4.73 m, errors on board 1.14 m; dilution of precision 2.43.",
      .made =
          "24 points of a circle of 30 ft; every other error switched off; by ranges alone, as a trilateration "
          "without a clock does, or with the receiver's clock as a fourth unknown; raw, or as what a receiver's "
          "own correction leaves.",
      .difference = {"As printed the ionosphere is its mapping alone, in metres: it lacks the zenith delay.",
                     "As printed the satellites' error is 8 to 12 m a range; exponent 2 (Rref / R0 - 1) and 0.0918 "
                     "give the paper's own size.",
                     "A clock takes up what ranges have in common, most of the satellites' error: the paper's "
                     "positions cannot have had one.",
                     "The fourth row is no offset by a range error: beside it stand dilutions of this geometry."},
      .x_label = "",
      .rows = {},
      .curves = {}};
  CANYON_TRY(CircleOffsets truth, offsets_on_circle(error_free_receiver(sky, kRaw, kRanges), sky.start, "no error"));
  CANYON_TRY(const CircleOffsets with_clock,
             offsets_on_circle(error_free_receiver(sky, kRaw, kClock), sky.start, "no error, with a clock"));
  part.curves.push_back(std::move(truth.places));
  for (const RangeErrorRow& row : error_rows()) {
    CANYON_TRY(PaperRow found, row_of(row, sky, part.curves));
    part.rows.push_back(std::move(found));
  }
  part.rows.push_back({.what = "dilution of precision",
                       .unit = "",
                       .paper = 2.43,
                       .ours = {{"PDOP, ranges alone", truth.pdop, {}}, {"PDOP, with a clock", with_clock.pdop, {}}}});
  return part;
}

}  // namespace canyon::study
