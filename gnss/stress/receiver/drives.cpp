// Drives of a receiver by itself: where and when it is asked, what is told at the end, and receivers of the catalogue.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "canyon/core/earth/earth.h"
#include "canyon/core/files/place_files.h"
#include "canyon/core/process/embedded.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/gnss/antenna_height.h"
#include "canyon/gnss/sensor/gnss_config.h"
#include "canyon/gnss/sensor/receiver_catalogue.h"
#include "canyon/gnss/sensor/simulation/drive.h"
#include "canyon/gnss/sensor/simulation/drive_files.h"
#include "canyon/gnss/sensor/simulation/sky.h"
#include "canyon/gnss/stress/level_ground.h"
#include "canyon/gnss/stress/subjects.h"
#include "canyon/scene/scene_at.h"

namespace canyon::gnss {
namespace {

using Eigen::Vector3d;
using stress::kEpsilon;
using stress::Looks;

const GpsTime kDeparture = GpsTime::from_week_sow(2000, 345600.0);

/// Keeps what it was asked, and answers with some satellites and a fix that is off by what the index says.
class AskedSensor final : public GnssSensor {
 public:
  struct Question {
    std::int64_t index;
    GpsTime t;
    Vector3d p_A_W, v_A_W;
  };
  AskedSensor(LocalFrame frame, std::uint64_t seed) : frame_(std::move(frame)), draws_(seed, "stress.drives") {}
  GnssOutput measure(std::int64_t index, GpsTime t, const Vector3d& p_A_W, const Vector3d& v_A_W,
                     const scene::SceneAt&) override {
    asked.push_back({index, t, p_A_W, v_A_W});
    GnssOutput out;
    const auto k = static_cast<std::uint64_t>(index);
    out.truth.t = out.fix.t = out.epoch.t = t;
    out.truth.p_A_E = frame_.to_E(p_A_W);
    for (std::uint64_t i = 0; i < 3 + k % 4; ++i) {
      GnssObservationTruth s;
      s.sv = {GnssSystem::kGps, static_cast<std::uint8_t>(1 + i)};
      s.tracked = draws_.uniform(1, 8 * k + i) < 0.7;
      s.line_of_sight = draws_.uniform(2, 8 * k + i) < 0.6;
      s.elevation_rad = draws_.uniform(0.1, 1.5, 3, 8 * k + i), s.azimuth_rad = draws_.uniform(0, 6.2, 4, 8 * k + i);
      s.range_m = 2e7 + static_cast<double>(i);
      out.truth.satellites.push_back(s);
      if (!s.tracked) continue;
      GnssObservation o;
      o.sv = s.sv, o.cn0_dbhz = 30.0 + static_cast<double>(i);
      o.pseudorange_m = s.range_m + 5.0;
      out.epoch.observations.push_back(o);
    }
    if (k % 5 == 4) return out;
    out.fix.status = FixStatus::kSingle;
    error_enu_.emplace_back(draws_.normal(5, k), 2.0 * draws_.normal(6, k), 4.0 * draws_.normal(7, k));
    const Eigen::Matrix3d R = rotation_E_from_enu(geodetic_from_ecef(out.truth.p_A_E));
    out.fix.p_A_E = out.truth.p_A_E + R * error_enu_.back();
    out.fix.covariance_E = R * Vector3d(1.0, 4.0, 16.0).asDiagonal() * R.transpose();
    if (k % 3 != 0) out.fix.dop.gdop = draws_.uniform(1.0, 9.0, 8, k), gdop_.push_back(out.fix.dop.gdop);
    return out;
  }
  GnssCounters counters() const override { return {}; }

  std::vector<Question> asked{};
  const std::vector<Vector3d>& errors_enu() const { return error_enu_; }
  const std::vector<double>& gdop() const { return gdop_; }

 private:
  LocalFrame frame_;
  RandomStream draws_;
  std::vector<Vector3d> error_enu_;
  std::vector<double> gdop_;
};

double ranked(std::vector<double> x, double share) {
  std::sort(x.begin(), x.end());
  const double at = share * static_cast<double>(x.size() - 1);
  for (std::size_t i = 0; i + 1 < x.size(); ++i)
    if (at >= static_cast<double>(i) && at <= static_cast<double>(i + 1))
      return x[i] + (at - static_cast<double>(i)) * (x[i + 1] - x[i]);
  return x.back();
}

/// Straight on with 3, -4 and 0.25 m/s over level ground at 2 m, into it towards the end; of each epoch index, instant,
/// place and velocity in W: 64 eps of 6.4e6 m, and of velocities a difference of places over a second of it.
StressFigure straight_drive() {
  Looks looks;
  const scene::Scene place(level_ground("drive", 300.0, 2.0));
  const Vector3d start_W(-20.0, 30.0, 5.0), v_W(3.0, -4.0, -0.25);
  std::vector<StampedPlace> places;
  for (int k = 0; k <= 20; ++k)
    places.push_back({kDeparture + 1.0 * k, place.frame().to_E(start_W + 1.0 * k * v_W), k});
  Drive drive{PlacePath(places), "drive.csv", kDeparture, 20.0, 4.0};
  looks.right(drive.epochs() == 81 && !drive.stands());
  AskedSensor sensor(place.frame(), 5);
  std::vector<GnssOutput> taken;
  const auto totals = simulate_drive(drive, sensor, place, [&](const GnssOutput& out) { taken.push_back(out); });
  if (!totals.ok() || taken.size() != 81 || sensor.asked.size() != 81) return {stress::kInfinity, 1.0};
  const double grain_m = 64.0 * kEpsilon * 6.4e6;
  std::int64_t below = 0, tracked = 0, nlos = 0;
  double deepest_m = 0.0, squares_m2 = 0.0;
  std::vector<double> level_m;
  for (std::size_t k = 0; k < 81; ++k) {
    const double t_s = 0.25 * static_cast<double>(k);
    const auto& q = sensor.asked[k];
    looks.right(q.index == static_cast<std::int64_t>(k) && q.t == kDeparture + t_s);
    looks.near((q.p_A_W - start_W - t_s * v_W).norm(), 0.0, grain_m);
    looks.near((q.v_A_W - v_W).norm(), 0.0, 10.0 * grain_m);
    const double depth_m = 2.0 - (5.0 - 0.25 * t_s);
    below += depth_m > 1e-5 ? 1 : 0, deepest_m = worse(deepest_m, depth_m);
    looks.near(depth_below_ground_m(place, q.p_A_W), depth_m > 0.0 ? depth_m : 0.0, 1e-6);
    for (const auto& s : taken[k].truth.satellites)
      if (s.tracked) ++tracked, nlos += s.line_of_sight ? 0 : 1;
  }
  for (const Vector3d& e : sensor.errors_enu()) {
    squares_m2 += e.squaredNorm();
    level_m.push_back(std::sqrt(e.x() * e.x() + e.y() * e.y()));
  }
  const DriveTotals& sum = *totals;
  const auto fixes = static_cast<double>(level_m.size());
  looks.right(sum.epochs == 81 && sum.fixes == static_cast<std::int64_t>(level_m.size()) && sum.tracked == tracked);
  looks.right(sum.nlos == nlos && sum.below_ground == below && below > 10 && sum.fixes < 70);
  looks.near(sum.deepest_m, deepest_m, 1e-6);
  looks.close(sum.satellites_mean(), static_cast<double>(tracked) / 81.0, 2.0);
  looks.close(sum.nlos_share(), static_cast<double>(nlos) / static_cast<double>(tracked), 2.0);
  looks.near(sum.rms_m(), std::sqrt(squares_m2 / fixes), grain_m);
  looks.close(sum.gdop_median(), ranked(sensor.gdop(), 0.5), 4.0);
  for (const double share : {0.0, 0.37, 0.5, 0.95, 1.0})
    looks.near(sum.horizontal_percentile_m(share), ranked(level_m, share), grain_m);
  std::size_t inside = 0;
  for (const Vector3d& e : sensor.errors_enu())
    inside += e.x() * e.x() + 0.25 * e.y() * e.y() <= -2.0 * std::log(0.5) ? 1 : 0;
  looks.right(sum.reported.count() == level_m.size());
  looks.near(sum.reported.inside(0.5), static_cast<double>(inside) / fixes, 1e-12);
  looks.right(depth_below_ground_m(place, {5e3, 0.0, -100.0}) == 0.0);
  // Nothing to say of nothing.
  const DriveTotals none;
  for (const double nothing :
       {none.satellites_mean(), none.nlos_share(), none.rms_m(), none.gdop_median(), none.horizontal_percentile_m(0.5),
        none.reported.inside(0.5), none.reported.log_score(), none.reported.beyond_3_sigma()})
    looks.right(std::isnan(nothing));
  // What it cannot cover is said, and a time beside its way is its end.
  places.back().p_E *= 1.01;
  Drive away{PlacePath(places), "drive.csv", kDeparture, 20.0, 1.0};
  looks.right(!simulate_drive(away, sensor, place, [](const GnssOutput&) {}).ok());
  Drive longer = drive;
  longer.duration_s = 30.0;
  const auto ended = simulate_drive(longer, sensor, place, [](const GnssOutput&) {});
  looks.right(ended.ok() && ended->epochs == 81);
  for (const auto& [duration_s, rate_hz, count] :
       {std::tuple{0.0, 1.0, 1}, {0.999, 1.0, 1}, {1.0, 1.0, 2}, {0.3, 10.0, 4}, {86400.0, 0.1, 8641}}) {
    drive.duration_s = duration_s, drive.rate_hz = rate_hz;
    looks.right(drive.epochs() == count);
  }
  return looks.figure();
}

/// A receiver that stands still, looked at every so often; and the tables that are made of it and of a drive, each row
/// with the digits that it is printed with.
StressFigure tables_of_looks() {
  Looks looks;
  const scene::Scene place(level_ground("sky", 300.0, 2.0));
  AskedSensor sensor(place.frame(), 6);
  GnssConfig config;
  config.rate_hz = 5.0;
  const auto sky = follow_sky(sensor, config, kDeparture, 60.0, 0.3, {1.0, 2.0, 3.0}, scene::SceneAt(place));
  looks.right(sky.size() == 201 && sensor.asked.size() == 201);
  std::string satellites = sky_satellites_csv(sky), dop = sky_dop_csv(sky);
  looks.right(std::count(dop.begin(), dop.end(), '\n') == 202);
  std::int64_t rows = 1;
  DriveFiles files(0.0);
  for (std::size_t k = 0; k < sky.size(); ++k) {
    const double t_s = 0.3 * static_cast<double>(k);
    looks.near(sky[k].t_s, t_s, 1e-12);
    const auto& q = sensor.asked[k];
    looks.right(q.index == std::llround(5.0 * t_s) && q.p_A_W == Vector3d(1.0, 2.0, 3.0) && q.v_A_W.isZero(0.0));
    looks.near(q.t - kDeparture, t_s, 1e-9);
    rows += static_cast<std::int64_t>(sky[k].output.truth.satellites.size());
    files.add(sky[k].output);
    for (const auto& s : sky[k].output.truth.satellites) {
      const double cn0 = cn0_of(sky[k].output, s.sv);
      looks.right(s.tracked ? cn0 == 29.0 + s.sv.prn : std::isnan(cn0));
    }
  }
  looks.right(std::count(satellites.begin(), satellites.end(), '\n') == rows);
  // Columns of the drive's tables: the pseudorange of the satellite's own row, and errors in east, north and up.
  const auto column = [](const std::string& line, int which) {
    std::size_t from = 0;
    for (int k = 0; k < which; ++k) from = line.find(',', from) + 1;
    const std::string word = line.substr(from, line.find(',', from) - from);
    return word.empty() ? kNaN : std::stod(word);
  };
  const auto lines = [](const std::string& text) {
    std::vector<std::string> out;
    for (std::size_t from = 0; from < text.size();) {
      const std::size_t end = text.find('\n', from);
      out.push_back(text.substr(from, end - from)), from = end + 1;
    }
    return out;
  };
  const auto by_satellite = lines(files.satellites_csv()), by_fix = lines(files.fixes_csv());
  looks.right(static_cast<std::int64_t>(by_satellite.size()) == rows && by_fix.size() == 202);
  std::size_t row = 0, fix = 0;
  for (std::size_t k = 0; k < sky.size(); ++k) {
    for (const auto& s : sky[k].output.truth.satellites) {
      const std::string& line = by_satellite[++row];
      looks.near(column(line, 3), s.elevation_rad * 180.0 / kPi, 0.51e-4);
      looks.near(column(line, 4), s.azimuth_rad * 180.0 / kPi, 0.51e-4);
      looks.right(s.tracked == std::isfinite(column(line, 8)) && s.tracked == std::isfinite(column(line, 12)));
      if (s.tracked) looks.near(column(line, 8), 2e7 + s.sv.prn - 1 + 5.0, 1e-3);
    }
    const std::string& line = by_fix[k + 1];
    if (sky[k].output.fix.status == FixStatus::kNone) {
      looks.right(std::isnan(column(line, 14)));
      continue;
    }
    const Vector3d& e = sensor.errors_enu()[fix++];
    for (int i = 0; i < 3; ++i) {
      looks.near(column(line, 14 + i), e[i], 0.51e-4 + 1e-8);
      looks.near(column(line, 11 + i), sky[k].output.truth.p_A_E[i], 0.51e-4 + 1e-8);
      looks.near(column(line, 8 + i), sky[k].output.fix.p_A_E[i], 0.51e-4 + 1e-8);
    }
  }
  return looks.figure();
}

/// Heights of the models' cover, to a micrometre beyond it, from a height and from a place; deep in the Earth by its
/// mean radius.
StressFigure heights_covered() {
  int wrong = 0;
  for (const double lat : {0.0, 0.7, 1.5707, -1.2})
    for (const auto& [h_m, good] : {std::pair{-500.0, true},
                                    {-500.001, false},
                                    {0.0, true},
                                    {20000.0, true},
                                    {20000.001, false},
                                    {4e5, false},
                                    {-3e5, false},
                                    {-6.36e6, false}}) {
      wrong += is_covered_height(h_m) == good ? 0 : 1;
      const Vector3d p_E = h_m < -1e6 ? Vector3d(0.0, 1e3, 0.0) : ecef_from_geodetic({lat, 0.3, h_m});
      for (const Status& status : {check_antenna_height(h_m, Error{}), check_antenna_height(p_E, Error{})}) {
        wrong += status.ok() == good ? 0 : 1;
        const char* side = h_m < -500.0 ? "below" : "above";
        if (!good) wrong += status.error().what.find(side) == std::string::npos ? 1 : 0;
      }
    }
  wrong += is_covered_height(-500.0 - 9e-7) && is_covered_height(20000.0 + 9e-7) ? 0 : 1;
  wrong +=
      check_antenna_height(Vector3d(0, 0, 6.2e6), Error{}).error().what.find("171000") == std::string::npos ? 1 : 0;
  return {1.0 * wrong, 0.0};
}

std::string sheet_of(const std::string& name) {
  return std::string(embedded_file("gnss/receivers/" + name + ".toml").value());
}

/// The sheet with one figure changed.
std::string with_line(std::string sheet, const std::string& key, const std::string& value) {
  const std::size_t from = ("\n" + sheet).find("\n" + key + " = ");
  return sheet.replace(from, sheet.find('\n', from) - from, key + " = " + value);
}

/// Of each built-in receiver the sheet is taken as it is, refused without any one of its figures or sources, and what
/// cannot be true of one receiver is named, at the limit and not beside it.
StressFigure sheets_of_receivers() {
  int wrong = 0;
  const auto names = receiver_names();
  wrong += names.size() == 6 && std::is_sorted(names.begin(), names.end()) ? 0 : 1;
  for (const std::string& name : names) {
    const std::string sheet = sheet_of(name);
    const auto read = load_receiver(name);
    wrong += read.ok() && read->name == name && !read->description.empty() ? 0 : 1;
    if (!read.ok()) continue;
    wrong += read->sources.size() == read->figures.table()->size() ? 0 : 1;
    GnssConfig config;
    wrong += read_config(&read->figures, "", config).ok() ? 0 : 1;
    for (std::size_t from = 0; from < sheet.size();) {
      const std::size_t end = sheet.find('\n', from);
      const std::string line = sheet.substr(from, end - from), without = sheet.substr(0, from) + sheet.substr(end + 1);
      from = end + 1;
      if (!line.empty() && line[0] != '#') wrong += parse_receiver(without, "sheet").ok() ? 1 : 0;
    }
  }
  const std::string m8 = sheet_of("m8");
  const auto passes = [&](const std::string& key, const std::string& value) {
    return parse_receiver(with_line(m8, key, value), "sheet").ok();
  };
  // BPSK(1) has lobes of 2.046 MHz; loops of B T = 1/2; what is found again needs more than there is; an average of
  // less than an integration.
  wrong +=
      passes("front_end_mhz", "2.046") && !passes("front_end_mhz", "2.045") && passes("front_end_mhz", "0.0") ? 0 : 1;
  wrong += passes("carrier_loop_hz", "24.9") && !passes("carrier_loop_hz", "25.0") ? 0 : 1;
  wrong += passes("code_loop_hz", "4.9") && !passes("code_loop_hz", "25.0") ? 0 : 1;
  wrong += passes("integration_ms", "10.0") ? 0 : 1;
  wrong += passes("cn0_averaging_s", "0.02") && !passes("cn0_averaging_s", "0.019") && passes("cn0_averaging_s", "0.0")
               ? 0
               : 1;
  wrong += passes("tracking_threshold_dbhz", "42.9") && !passes("tracking_threshold_dbhz", "43.0") ? 0 : 1;
  wrong += passes("solver", "\"trilateration\"") || passes("mode", "\"dgps\"") || passes("antenna", "\"sine\"") ? 1 : 0;
  const auto galileo = parse_receiver(with_line(with_line(m8, "systems", "\"GE\""), "front_end_mhz", "4.091"), "sheet");
  const auto wide = parse_receiver(with_line(with_line(m8, "systems", "\"GE\""), "front_end_mhz", "4.092"), "sheet");
  wrong += !galileo.ok() && wide.ok() ? 0 : 1;
  const auto unknown = load_receiver("m9");
  wrong += !unknown.ok() && unknown.error().expected.find("m8") != std::string::npos ? 0 : 1;
  // What stands beside the name is heard, what stood below is not.
  const auto below = ConfigNode::parse("[gnss]\nmask_deg = 12.0\nsmoothing_s = 7.0\n", "below");
  const auto over = ConfigNode::parse("[gnss]\nreceiver = \"m8\"\nsmoothing_s = 33.0\n", "over");
  ConfigNode tree = *below;
  wrong += lay_with_receiver(tree, *over).ok() ? 0 : 1;
  const auto number = [&](const char* key) { return std::get<double>(tree.find(key)->value_); };
  wrong += number("gnss.mask_deg") == 5.0 && number("gnss.smoothing_s") == 33.0 ? 0 : 1;
  return {1.0 * wrong, 0.0};
}

}  // namespace

std::vector<StressCase> receiver_drive_cases() {
  StressRows rows;
  rows.of({.group = StressGroup::kData,
           .mechanism = "a drive of a receiver by itself",
           .why = "a way in the wrong frame, an epoch too many, fixes that count twice or not at all",
           .expected = "places, counts and figures as they were put in: roundings of places on Earth",
           .unit = "of the bound"});
  rows.add("receiver_drives/straight_on", straight_drive).add("receiver_drives/tables", tables_of_looks);
  rows.of({StressGroup::kGeometry, "heights that models cover", "a limit the other way round, a depth for a height",
           "from -500 m to 20 km, a micrometre beyond it: exact", "wrong"});
  rows.add("receiver_drives/heights_covered", heights_covered);
  rows.of({StressGroup::kData, "sheets of receivers", "a figure that may be missing, a contradiction that is none",
           "each figure and source is asked for, and what contradicts is refused: exact", "wrong"});
  rows.add("receiver_drives/sheets_of_receivers", sheets_of_receivers);
  return rows.take();
}

}  // namespace canyon::gnss
