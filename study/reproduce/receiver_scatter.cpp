// Table 2 and figures 4 to 6: how positions scatter at two places and along two tracks.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "canyon/scene/flat_ground.h"
#include "canyon/study/reproduce/draws.h"
#include "canyon/study/reproduce/from_above.h"
#include "canyon/study/reproduce/paper_receiver.h"

namespace canyon::study {
namespace {

constexpr double kFoot_m = 0.3048;
constexpr double kSpeed_m_s = 1.5;  // of the tracks: constant, and not printed; a walk
constexpr double kBetweenStarts_s = 1800.0;

/// One of the paper's data collections, with its numbers: standard deviations of a real receiver and of its model.
struct Collection {
  const char* name;
  const char* figure;
  double real_m, real_deg, model_m, model_deg;
  PaperWay way;
  double after_s;  ///< the sky's start
  bool at_rest;
};

Eigen::Vector3d on_circle(double t_s) {
  const double radius_m = 30.0 * kFoot_m, a = kSpeed_m_s * t_s / radius_m;
  return {radius_m * std::cos(a), radius_m * std::sin(a), 1.0};
}

/// To and fro.
Eigen::Vector3d on_line(double t_s) {
  const double length_m = 60.0 * kFoot_m, way_m = std::fmod(kSpeed_m_s * std::abs(t_s), 2.0 * length_m);
  return {way_m < length_m ? way_m : 2.0 * length_m - way_m, 0.0, 1.0};
}

const std::vector<Collection>& collections() {
  const double loops_s = 8.0 * 2.0 * kPi * 30.0 * kFoot_m / kSpeed_m_s, passes_s = 10.0 * 60.0 * kFoot_m / kSpeed_m_s;
  static const std::vector<Collection> kAll{
      {"trial 1, 20 minutes at rest",
       "Fig. 4",
       1.943,
       4.465e-5,
       1.68,
       2.40e-5,
       {1200.0, 1.0, [](double) { return Eigen::Vector3d(0.0, 0.0, 1.0); }},
       0.0,
       true},
      {"trial 2, 20 minutes at rest",
       "Fig. 5",
       7.729,
       2.2389e-5,
       3.661,
       1.0746e-4,
       {1200.0, 1.0, [](double) { return Eigen::Vector3d(100.0, 0.0, 1.0); }},
       3600.0,
       true},
      {"circle of 30 ft, eight loops", "Fig. 6", 2.67, 4.5e-3, 0.85, 7.83e-5, {loops_s, 5.0, on_circle}, 7200.0, false},
      {"line of 60 ft, ten passes", "Fig. 6", 2.65, 6.5e-5, 0.85, 4.02e-5, {passes_s, 5.0, on_line}, 10800.0, false}};
  return kAll;
}

struct ReceiverForm {
  const char* form;
  gnss::GnssConfig config;
};

std::vector<ReceiverForm> receivers(const PaperSky& sky) {
  gnss::GnssConfig printed = error_free_receiver(sky, "single_uncorrected", "trilateration");
  printed.ionosphere.name = printed.troposphere.name = printed.ephemeris_error.name = "paper_printed";
  gnss::GnssConfig corrected = error_free_receiver(sky, "single_uncorrected", "trilateration");
  corrected.ionosphere.name = "paper";
  corrected.troposphere.name = corrected.ephemeris_error.name = "paper_corrected";
  gnss::GnssConfig ours;
  ours.satellites = sky.satellites;
  ours.mode.name = "single";
  ours.propagation.paths.name = "none";
  ours.reception.multipath_rule.name = "none";
  return {{"as printed, ranges alone", printed},
          {"as corrected, ranges alone", corrected},
          {"Canyon's receiver, no multipath", ours}};
}

/// Standard deviations of the error about its mean.
struct Scatter {
  double total_m = kNaN, horizontal_deg = kNaN;
};

/// The errors of the fixes in W.
std::vector<Eigen::Vector3d> errors_of(const std::vector<gnss::GnssOutput>& outputs) {
  std::vector<Eigen::Vector3d> out;
  const Eigen::Matrix3d R_WE = scene::flat_ground().frame().R_EW().transpose();
  for (const gnss::GnssOutput& o : outputs)
    out.push_back(o.fix.status == FixStatus::kNone ? Eigen::Vector3d::Constant(kNaN)
                                                   : Eigen::Vector3d(R_WE * (o.fix.p_A_E - o.truth.p_A_E)));
  return out;
}

Scatter scatter_of(const std::vector<Eigen::Vector3d>& errors) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero(), squares = sum;
  double n = 0.0;
  for (const Eigen::Vector3d& e : errors) {
    if (!e.allFinite()) continue;
    sum += e;
    squares += e.cwiseAbs2();
    n += 1.0;
  }
  if (n < 2.0) return {};
  const Eigen::Vector3d variance = ((squares - sum.cwiseAbs2() / n) / (n - 1.0)).cwiseMax(0.0);
  // A degree of latitude and of longitude at the place.
  const Geodetic& at = scene::flat_ground().frame().origin();
  const LocalFrame frame(at);
  constexpr double kStep_rad = 1e-6;
  const double lat_m = frame.from_geodetic({at.lat_rad + kStep_rad, at.lon_rad, at.h_m}).norm() / (kStep_rad / kDegree);
  const double lon_m = frame.from_geodetic({at.lat_rad, at.lon_rad + kStep_rad, at.h_m}).norm() / (kStep_rad / kDegree);
  return {std::sqrt(variance.sum()), std::hypot(std::sqrt(variance.y()) / lat_m, std::sqrt(variance.x()) / lon_m)};
}

/// Where the fixes are, one a second: the true places moved by the errors.
std::vector<Eigen::Vector3d> positions_of(const std::vector<Eigen::Vector3d>& errors, const PaperWay& way) {
  std::vector<Eigen::Vector3d> out;
  const auto every = static_cast<std::size_t>(way.rate_hz);
  for (std::size_t k = 0; k < errors.size(); k += every)
    out.push_back(way.p_W(static_cast<double>(k) / way.rate_hz) + errors[k]);
  return out;
}

/// The same from their mean, by those that there are.
std::vector<Eigen::Vector3d> about_mean(std::vector<Eigen::Vector3d> positions) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double n = 0.0;
  for (const Eigen::Vector3d& p : positions) {
    if (!p.allFinite()) continue;
    sum += p;
    n += 1.0;
  }
  for (Eigen::Vector3d& p : positions) p -= sum / n;
  return positions;
}

/// A form's positions from above. At rest about their own mean, since the paper compares how positions drift and could
/// not say where its receiver truly stood; those of a track where they are, beside the true one.
void add_from_above(const std::vector<Eigen::Vector3d>& errors, const Collection& of, const char* form,
                    std::vector<PaperCurve>& out) {
  const std::string panel =
      std::string(of.figure) + ": " + of.name + ", from above" + (of.at_rest ? ", each form about its own mean" : "");
  if (of.at_rest) {
    out.push_back(from_above(panel, form, about_mean(positions_of(errors, of.way))));
    return;
  }
  if (out.empty()) {
    const std::vector<Eigen::Vector3d> none(errors.size(), Eigen::Vector3d::Zero());
    out.push_back(from_above(panel, "true track", positions_of(none, of.way)));
  }
  out.push_back(from_above(panel, form, positions_of(errors, of.way)));
}

/// A form's errors over time: a line a direction, a value a second.
void add_over_time(const std::vector<Eigen::Vector3d>& errors, const Collection& of, const char* form,
                   std::vector<PaperCurve>& out) {
  const auto every = static_cast<std::size_t>(of.way.rate_hz);
  constexpr std::array<const char*, 3> kNames{"east", "north", "up"};
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    PaperCurve curve{.panel = std::string(of.figure) + ": " + of.name + ", " + form + ", error over time",
                     .unit = "m",
                     .name = kNames[static_cast<std::size_t>(axis)],
                     .x = {},
                     .y = {},
                     .points = false};
    for (std::size_t k = 0; k < errors.size(); k += every) {
      curve.x.push_back(static_cast<double>(k) / of.way.rate_hz);
      curve.y.push_back(errors[k][axis]);
    }
    out.push_back(std::move(curve));
  }
}

}  // namespace

Result<PaperPart> receiver_scatter_part(const PaperSky& sky, std::int64_t draws) {
  PaperPart part{
      .name = "table_2",
      .title = "Table 2 and Fig. 4 to 6: how positions scatter at rest and along two tracks",
      .paper_says =
          "Standard deviations of a Garmin receiver and of the model; magnitude and direction of the drift "
          "are in good agreement, and the altitude has the largest error.",
      .made =
          "An open place, seven satellites at the first start; errors about their mean, total: root of the summed "
          "variances in metres, horizontal: of latitude and longitude in degrees. Tracks at 1.5 m/s. The range is "
          "over starts half an hour apart, with the satellites of each. Drawn, of the first start: positions from "
          "above in metres, where the paper has latitude and longitude, and the error over time.",
      .difference = {"The paper's standard deviations in degrees do not go with those in metres: trial 2 scatters more "
                     "in metres and less in degrees than trial 1, and 4.5e-3 deg would be 500 m.",
                     "Its errors are functions of place and time alone, so a fixed set of satellites scatters by "
                     "their slow motion; Canyon's receiver has noise and satellites' errors that wander as well.",
                     "Durations (20 minutes in the text, 30 in the table), the tracks' speed and the place of "
                     "trial 2 are not told."},
      .x_label = "Time, s",
      .rows = {},
      .curves = {}};
  const std::vector<ReceiverForm> forms = receivers(sky);
  for (const Collection& of : collections()) {
    std::vector<PaperCurve> above, over_time;
    PaperRow total{
        .what = std::string(of.name) + ": total", .unit = "m", .paper = of.model_m, .real = of.real_m, .ours = {}};
    PaperRow flat{.what = std::string(of.name) + ": latitude and longitude",
                  .unit = "deg",
                  .paper = of.model_deg,
                  .real = of.real_deg,
                  .ours = {}};
    for (const ReceiverForm& form : forms) {
      std::vector<double> totals_m, flats_deg;
      for (std::int64_t k = 0; k < draws; ++k) {
        const GpsTime start = sky.start + of.after_s + kBetweenStarts_s * static_cast<double>(k);
        CANYON_TRY(const auto outputs, measured(form.config, static_cast<std::uint64_t>(k + 1), start, of.way));
        const auto errors = errors_of(outputs);
        const Scatter found = scatter_of(errors);
        totals_m.push_back(found.total_m);
        flats_deg.push_back(found.horizontal_deg);
        if (k > 0) continue;
        add_from_above(errors, of, form.form, above);
        add_over_time(errors, of, form.form, over_time);
      }
      total.ours.push_back(over_draws(form.form, totals_m));
      flat.ours.push_back(over_draws(form.form, flats_deg));
    }
    part.rows.push_back(std::move(total));
    part.rows.push_back(std::move(flat));
    std::move(above.begin(), above.end(), std::back_inserter(part.curves));
    std::move(over_time.begin(), over_time.end(), std::back_inserter(part.curves));
  }
  return part;
}

}  // namespace canyon::study
