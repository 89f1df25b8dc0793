// Ways in files: references, poses and places, written and read, and the smooth way through places.
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "canyon/core/earth/earth.h"
#include "canyon/core/files/ascii_grid.h"
#include "canyon/core/files/files.h"
#include "canyon/core/files/line_reader.h"
#include "canyon/core/files/navigation_file.h"
#include "canyon/core/files/place_files.h"
#include "canyon/core/messages.h"
#include "canyon/core/motion/trajectory.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/stress/subjects.h"
#include "canyon/core/stress/written_file.h"
#include "canyon/core/units.h"

namespace canyon {
namespace {

using Eigen::Vector3d;
using stress::kEpsilon;
using stress::Looks;
using stress::told_otherwise;
using stress::WrittenFile;

constexpr std::int64_t kWeek_ns = 604800 * kNsPerSecond;

/// A level nose to the north at 0 N, 90 E, where east is -x, north z, up y; other attitudes and speeds written and
/// read: half a unit of 13 decimals of a degree is 6e-9 m, of 12 decimals 1e-14 rad, of 9 decimals of m/s.
StressFigure navigation_files() {
  Looks looks;
  const WrittenFile file(
      "# gravity  grs80_series \n# more\n1590 5.000000001 0 90 7.5 1 2 3 0 0 0\n1591,0,0,90,7.5,1,2,3,20,0,90\n");
  const auto found = read_navigation_file(file.path());
  if (!found.ok() || found->records.size() != 2) return {stress::kInfinity, 1.0};
  looks.right(found->gravity == "grs80_series" && found->gravity_line == 1);
  looks.right(found->records[0].t.ns == 1590 * kWeek_ns + 5'000'000'001 && found->records[1].t.ns == 1591 * kWeek_ns);
  looks.near((found->records[0].X_EU.p - Vector3d(0.0, 6378137.0 + 7.5, 0.0)).norm(), 0.0, 8.0 * kEpsilon * 6.4e6);
  looks.near((found->records[0].v_EU_E - Vector3d(-2.0, -3.0, 1.0)).norm(), 0.0, 32.0 * kEpsilon);
  Eigen::Matrix3d level, banked;
  const double s = std::sin(20.0 * kDegree), c = std::cos(20.0 * kDegree);
  level << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  banked << -1, 0, 0, 0, s, c, 0, c, -s;
  looks.near((found->records[0].X_EU.R.toRotationMatrix() - level).norm(), 0.0, 16.0 * kEpsilon);
  looks.near((found->records[1].X_EU.R.toRotationMatrix() - banked).norm(), 0.0, 16.0 * kEpsilon);
  const WrittenFile named("sow,pitch_deg,roll_deg,yaw_deg,h_m,lon_deg,lat_deg\n1.5,0,20,90,7.5,90,0\n");
  const auto by_name = read_navigation_file(named.path());
  if (!by_name.ok()) return {stress::kInfinity, 1.0};
  looks.right(by_name->records[0].t.ns == 1'500'000'000 && by_name->records[0].v_EU_E.hasNaN());
  looks.near((by_name->records[0].X_EU.R.toRotationMatrix() - banked).norm(), 0.0, 16.0 * kEpsilon);
  const RandomStream draws(1, "stress.path_files");
  NavigationFile made;
  made.gravity = "wgs84";
  for (std::uint64_t k = 0; k < 60; ++k) {
    const Geodetic at{draws.uniform(-1.5, 1.5, 0, k), draws.uniform(-3.1, 3.1, 1, k), draws.uniform(-100, 9000, 2, k)};
    NavigationRecord r;
    r.t = {1590 * kWeek_ns + 333'333'333 * static_cast<std::int64_t>(k)};
    r.X_EU = {Eigen::Quaterniond(Eigen::AngleAxisd(draws.uniform(0, 3, 3, k), draws.direction(4, k))),
              ecef_from_geodetic(at)};
    r.v_EU_E = 30.0 * draws.normal3(k, 5);
    made.records.push_back(r);
    const NedAttitude a = ned_attitude(at, r.X_EU.R);
    looks.right(a.heading_rad >= 0.0 && a.heading_rad < 2.0 * kPi && std::abs(a.pitch_rad) <= 0.5 * kPi);
  }
  const WrittenFile out;
  if (!write_navigation_file(out.path(), made).ok()) return {stress::kInfinity, 1.0};
  const auto back = read_navigation_file(out.path());
  if (!back.ok() || back->records.size() != 60) return {stress::kInfinity, 1.0};
  looks.right(back->gravity == "wgs84" && back->gravity_line == 2);
  for (std::size_t k = 0; k < 60; ++k) {
    const NavigationRecord &a = back->records[k], &b = made.records[k];
    looks.right(a.t == b.t);
    // Half a unit of both angles and of 7 decimals of the height; and there and back over coordinates.
    looks.near((a.X_EU.p - b.X_EU.p).norm(), 0.0, 1.41 * 5.6e-9 + 5e-8 + 16.0 * kEpsilon * 6.4e6);
    // Three angles to 8.7e-15 rad each, and their own roundings over the cosine of the pitch.
    const double sharp =
        std::cos(std::asin(std::min(1.0, std::abs(a.X_EU.R.toRotationMatrix().col(0).dot(
                                             rotation_E_from_enu(geodetic_from_ecef(b.X_EU.p)).col(2))))));
    looks.near(a.X_EU.R.angularDistance(b.X_EU.R), 0.0, 1.6e-14 + 32.0 * kEpsilon / sharp);
    looks.near((a.v_EU_E - b.v_EU_E).norm(), 0.0, 0.87e-9 + 64.0 * kEpsilon * 120.0);
  }
  return looks.figure();
}

/// Poses of three formats: the same bits, but for what a format has no room for.
StressFigure pose_files() {
  int wrong = 0;
  const RandomStream draws(2, "stress.path_files");
  Trajectory made;
  for (std::uint64_t k = 0; k < 40; ++k) {
    Eigen::Quaterniond q(Eigen::AngleAxisd(draws.uniform(0, 3, 0, k), draws.direction(1, k)));
    q.normalize();
    made.append(
        {GpsTime{1590 * kWeek_ns + 100'000'000 * static_cast<std::int64_t>(k) + 7}, {q, 50.0 * draws.normal3(k, 2)}});
  }
  const WrittenFile tum, kitti;
  wrong += write_tum(tum.path(), made).ok() && write_kitti(kitti.path(), made).ok() ? 0 : 1;
  const auto a = read_tum(tum.path()), b = read_kitti(kitti.path(), GpsTime{5}, 4.0);
  if (!a.ok() || !b.ok() || a->poses().size() != 40 || b->poses().size() != 40) return {stress::kInfinity, 0.0};
  for (std::size_t k = 0; k < 40; ++k) {
    const StampedPose &x = made.poses()[k], &of_tum = a->poses()[k], &of_kitti = b->poses()[k];
    wrong += of_tum.t == x.t && of_tum.X_WB.p == x.X_WB.p ? 0 : 1;
    wrong +=
        of_tum.X_WB.R.angularDistance(x.X_WB.R) < 4e-8 && (of_tum.X_WB.R.coeffs() - x.X_WB.R.coeffs()).norm() < 4e-16
            ? 0
            : 1;
    wrong += of_kitti.t.ns == 5 + 250'000'000 * static_cast<std::int64_t>(k) && of_kitti.X_WB.p == x.X_WB.p ? 0 : 1;
    wrong += (of_kitti.X_WB.R.toRotationMatrix() - x.X_WB.R.toRotationMatrix()).norm() < 16.0 * kEpsilon ? 0 : 1;
  }
  const WrittenFile early("-1.25 1 2 3 0 0 0 1\n-0.000000001, 4 5 6 0 0 1 0\n");
  const auto before = read_tum(early.path());
  wrong += before.ok() && before->poses()[0].t.ns == -1'250'000'000 && before->poses()[1].t.ns == -1 ? 0 : 1;
  const WrittenFile csv("qw,qx,qy,qz,more,z_m,y_m,x_m,sow,gps_week\n0.6,0,0,0.8,9,3,2,1,5.000000001,1590\n");
  const auto c = read_csv_trajectory(csv.path());
  wrong += c.ok() && c->poses()[0].t.ns == 1590 * kWeek_ns + 5'000'000'001 &&
                   c->poses()[0].X_WB.p == Vector3d(1, 2, 3) && std::abs(c->poses()[0].X_WB.R.z() - 0.8) < 1e-15
               ? 0
               : 1;
  const WrittenFile mission(
      "gps_week,sow,true_x_m,true_y_m,true_z_m,true_yaw_deg,true_pitch_deg,true_roll_deg\n0,1,1,2,3,90,0,0\n");
  const auto m = read_csv_trajectory(mission.path());
  wrong += m.ok() && (m->poses()[0].X_WB.R * Vector3d::UnitX() - Vector3d::UnitY()).norm() < 1e-15 ? 0 : 1;
  const auto told = [&](const auto& read, const std::string& text, const std::string& words) {
    wrong += told_otherwise(text, read, words);
  };
  const auto of_kitti = [](const std::string& path) { return read_kitti(path, {}, 1.0); };
  told(read_tum, "", ": holds no poses, expected at least one line of numbers");
  told(read_tum, "1 2 3\n", ":1: 3 columns, expected 8: t x y z qx qy qz qw");
  told(read_tum, "1 0 0 0 0 0 0 0.98\n", ":1: quaternion of norm 0.980000, expected norm 1");
  told(read_tum, "1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n",
       ":2: time does not increase, expected poses in the order of time");
  told(read_tum, "1 2e9 0 0 0 0 0 1\n", ":1: \"2e9\" is out of range, expected metres from -1e9 to 1e9");
  told(of_kitti, "1 0 0 0 0 1 0 0 0 0 1\n", ":1: 11 columns, expected 12: a 3 x 4 matrix, row by row");
  told(of_kitti, "1 0 0 0 0 1 0 0 0 0 -1 0\n", ":1: first three columns are not a rotation, expected orthonormal axes");
  told(of_kitti, "1.1 0 0 0 0 1 0 0 0 0 1 0\n",
       ":1: first three columns are not a rotation, expected orthonormal axes");
  told(read_csv_trajectory, "gps_week,sow,x_m\n",
       ":1: no column \"y_m\", expected the header gps_week,sow,x_m,y_m,z_m,qw,qx,qy,qz");
  told(read_csv_trajectory, "gps_week,sow,x_m,y_m,z_m,qw,qx,qy,qz\n1,2\n",
       ":2: 2 columns, expected 9 as in the header");
  told(read_csv_trajectory, "gps_week,sow,x_m,y_m,z_m,qw,qx,qy,qz\n0.5,2,0,0,0,1,0,0,0\n",
       ":2: \"0.5\" is not a GPS week, expected a whole number from 0 to 14000");
  const std::string columns =
      ", expected 11 columns, week sow lat lon h vN vE vD roll pitch heading, or a header with "
      "sow,lat_deg,lon_deg,h_m,vn,ve,vd,roll_deg,pitch_deg,heading_deg";
  told(read_navigation_file, "1 2 3\n", ":1: 3 columns" + columns);
  told(read_navigation_file, "sow,lat_deg\n", ":1: no column \"lon_deg\"" + columns);
  told(read_navigation_file, "1 2 91 0 0 0 0 0 0 0 0\n", ":1: latitude 91, expected degrees from -90 to 90");
  told(read_navigation_file, "1 2 0 361 0 0 0 0 0 0 0\n", ":1: longitude 361, expected degrees from -360 to 360");
  told(read_navigation_file, "-1 2 0 0 0 0 0 0 0 0 0\n", ":1: GPS week -1, expected a whole number from 0 to 14000");
  told(read_navigation_file, "1 2 0 0 0 4e8 0 0 0 0 0\n", ":1: \"4e8\" is out of range, expected m/s from -3e8 to 3e8");
  return {1.0 * wrong, 0.0};
}

/// Places by name and by size; and a way through them: the parabola that they lie on, and of any places a slope that is
/// continuous, of the parabola through three. Roundings of 6.4e6 m over steps of a second.
StressFigure places_and_ways() {
  Looks looks;
  const WrittenFile file("5,10,0,0,7\n5,11,6378144,0,0\n5 12.5 0 0 7 more\n");
  const auto read = read_places(file.path());
  if (!read.ok() || read->size() != 3) return {stress::kInfinity, 1.0};
  for (const StampedPlace& place : *read)
    looks.near((place.p_E - Vector3d(6378144.0, 0.0, 0.0)).norm(), 0.0, 8.0 * kEpsilon * 6.4e6);
  looks.right((*read)[2].t.ns == 5 * kWeek_ns + 12'500'000'000 && (*read)[2].line == 3);
  const WrittenFile named("h_m,sow,lat_deg,gps_week,lon_deg\n7,10,0,5,90\n"),
      ecef("z_m,sow,y_m,gps_week,x_m\n3,10,2,5,1\n");
  const auto by_name = read_places(named.path()), near = read_places(ecef.path());
  looks.right(by_name.ok() && near.ok() && near->front().p_E == Vector3d(1.0, 2.0, 3.0));
  if (by_name.ok())
    looks.near((by_name->front().p_E - Vector3d(0.0, 6378144.0, 0.0)).norm(), 0.0, 8.0 * kEpsilon * 6.4e6);
  const auto told = [&](const std::string& text, const std::string& words) {
    looks.right(told_otherwise(text, read_places, words) == 0);
  };
  const std::string rows = "gps_week,sow,lat_deg,lon_deg,h_m or gps_week,sow,x_m,y_m,z_m";
  told("", ": holds no places, expected at least one line of numbers");
  told("1,2,3,4\n", ":1: 4 fields, expected at least 5: " + rows);
  told("sow,x_m,y_m,z_m\n", ":1: header without the columns needed, expected " + rows);
  told("1,604801,0,0,0\n", ":1: no such time, expected a GPS week and seconds of week");
  told("-1,5,0,0,0\n", ":1: no such time, expected a GPS week and seconds of week");
  told("1,5,91,0,0\n", ":1: no such place, expected degrees, degrees, metres");
  told("1,5,0,361,0\n", ":1: no such place, expected degrees, degrees, metres");
  told("1,5,0,0,0\n1,5,0,0,0\n", ":2: time does not increase, expected places in the order of time");

  const GpsTime start = GpsTime::from_week_sow(2000, 0.0);
  const Vector3d a(6.3e6, 1e5, -2e5), b(3.0, -4.0, 5.0), c(0.7, 0.9, -0.2);
  const auto parabola = [&](double s) -> Vector3d { return a + s * b + s * s * c; };
  std::vector<StampedPlace> places;
  for (const double s : {0.0, 1.0, 2.5, 3.0, 5.0, 6.0}) places.push_back({start + s, parabola(s), 0});
  const PlacePath path(places);
  looks.right(path.first() == start && path.last() == start + 6.0);
  looks.right(!path.at(GpsTime{start.ns - 1}) && !path.at(GpsTime{path.last().ns + 1}));
  const double grain = 8.0 * kEpsilon * 6.4e6;
  // At the ends slopes are of one difference, so that the parabola holds between the inner places.
  for (double s = 1.0; s <= 5.0; s += 0.125) {
    looks.near((path.at(start + s)->p_E - parabola(s)).norm(), 0.0, grain);
    looks.near((path.at(start + s)->v_E - (b + 2.0 * s * c)).norm(), 0.0, 16.0 * grain);
  }
  looks.near((path.at(start)->v_E - (b + c)).norm(), 0.0, 16.0 * grain);
  looks.near((path.at(start + 6.0)->v_E - (b + 11.0 * c)).norm(), 0.0, 16.0 * grain);
  // Its derivative is the speed: cubics have no fifth difference, h = 1/8 s.
  for (const double s : {0.4, 1.7, 5.5}) {
    const auto at = [&](double t) { return path.at(start + t)->p_E; };
    const Vector3d slope = (8.0 * (at(s + 0.125) - at(s - 0.125)) - (at(s + 0.25) - at(s - 0.25))) / 1.5;
    looks.near((slope - path.at(start + s)->v_E).norm(), 0.0, 16.0 * grain);
  }
  const PlacePath still(std::vector<StampedPlace>{{start, a, 0}});
  looks.right(still.at(start + 1e6)->p_E == a && still.at(start - 1e6)->v_E.isZero(0.0));
  looks.right(stress::not_refused([] { return PlacePath(std::vector<StampedPlace>{}); }, "without places") == 0);
  looks.right(stress::not_refused([&] { return PlacePath({places[1], places[0]}); }, "at place 1") == 0);
  // Of a body: the lever arm turned with it.
  Trajectory body;
  for (int k = 0; k < 3; ++k)
    body.append(
        {start + 1.0 * k, {Eigen::Quaterniond(Eigen::AngleAxisd(0.5 * kPi, Vector3d::UnitZ())), {10.0 * k, 0.0, 0.0}}});
  const LocalFrame frame({0.0, 0.5 * kPi, 0.0});
  const PlacePath of_body(body, frame, {2.0, 0.0, 1.0});
  // East is -x, north z, up y.
  looks.near((of_body.at(start + 1.5)->p_E - Vector3d(-15.0, 6378138.0, 2.0)).norm(), 0.0, grain);
  return looks.figure();
}

/// Columns of numbers and their times; a grid as a GIS reads it.
StressFigure numbers_of_lines() {
  int wrong = 0;
  LineReader in("lines.txt", "# none\n\n  \nfirst \t\r\n#\nlast");
  std::string_view line;
  wrong += in.next(line) && line == "first" && in.number() == 4 && in.next(line) && line == "last" && in.number() == 6
               ? 0
               : 1;
  wrong += in.next(line) ? 1 : 0;
  wrong += split("a,,b", ",", false).size() == 3 && split(" a \t b ", " \t", true).size() == 2 &&
                   split("", ",", false).size() == 1
               ? 0
               : 1;
  wrong += trimmed(" \ta b\t ") == "a b" && trimmed("  ").empty() ? 0 : 1;
  const auto seconds = [&](const char* text, std::int64_t ns) {
    const auto found = parse_seconds(in, text);
    wrong += found.ok() && *found == ns ? 0 : 1;
  };
  seconds("392400.123456789", 392400123456789), seconds(" 5 ", 5000000000), seconds("0.0000000005", 1),
      seconds("1.9999999999", 2000000000);
  seconds("0.0000000004", 0), seconds("-1.5", -1500000000), seconds("1e3", 1000000000000),
      seconds("9199999999", 9199999999000000000), seconds("1.5e-3", 1500000);
  wrong += parse_seconds(in, "9.2e9").ok() || parse_seconds(in, "-9.2e9").ok() ? 1 : 0;
  wrong += parse_coordinate(in, "-1e9").ok() && !parse_coordinate(in, "1.1e9").ok() && parse_speed(in, "3e8").ok() &&
                   !parse_speed(in, "-3.1e8").ok()
               ? 0
               : 1;
  wrong += gps_instant(in, 3, 5).ok() && gps_instant(in, 3, 5)->ns == 3 * kWeek_ns + 5 &&
                   !gps_instant(in, 14000, 8'999'999'999'999'999'999).ok()
               ? 0
               : 1;
  const auto order = check_time_order(in, {0}, {5}, {5}, "more");
  wrong += !order.ok() && order.error().str() == "lines.txt:6: time does not increase, expected more" ? 0 : 1;
  wrong += check_time_order(in, {0}, {5}, {6}, "more").ok() ? 0 : 1;
  const auto far = check_time_order(in, {-9'000'000'000'000'000'000}, {5}, {6'000'000'000'000'000'000}, "more");
  wrong +=
      !far.ok() && far.error().str() == "lines.txt:6: more than 292 years after the first line, expected more" ? 0 : 1;
  Grid grid{.columns = 3, .rows = 2, .cell_m = 2.5, .west_m = -1.0, .south_m = 4.0, .values = {1, 2, 3, 4, kNaN, 6.04}};
  wrong += ascii_grid_text(grid, 1) ==
                   "ncols 3\nnrows 2\nxllcorner -1.000000\nyllcorner 4.000000\ncellsize 2.500000\nNODATA_value "
                   "-9999\n4.0 -9999 6.0\n1.0 2.0 3.0\n"
               ? 0
               : 1;
  grid.at(2, 1) = 7.0;
  wrong += grid.values[5] == 7.0 && grid.index(1, 1) == 4 ? 0 : 1;
  grid.values.pop_back();
  wrong += stress::not_refused([&] { return ascii_grid_text(grid, 1); }, "5 values for 3 x 2");
  const std::string text = projection_text(LocalFrame({0.25 * kPi, -0.5 * kPi, 7.0}));
  wrong +=
      text.find("PARAMETER[\"Longitude_Of_Center\",-90.000000000],PARAMETER[\"Latitude_Of_Center\",45.000000000]") !=
              std::string::npos
          ? 0
          : 1;
  return {1.0 * wrong, 0.0};
}

}  // namespace

std::vector<StressCase> path_file_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "references and places in files, and ways through them",
           "a roll of the other side, a column beside the one that is named, a slope with the other weight",
           "axes at 0 N, 90 E written out; parabolas; written and read to half a unit of the last decimal",
           "of the bound"});
  rows.add("path_files/references", navigation_files).add("path_files/places", places_and_ways);
  rows.of({StressGroup::kData, "poses and lines of numbers in files, and mistakes in them",
           "a nanosecond that a double has lost, a sign of a time before 1980, a line counted without its comments",
           "the same bits, and each mistake word by word with its line: exact", "wrong"});
  rows.add("path_files/poses", pose_files).add("path_files/lines", numbers_of_lines);
  return rows.take();
}

}  // namespace canyon
