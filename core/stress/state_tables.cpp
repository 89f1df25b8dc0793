// Tables of solutions: names and units of columns, axes, layouts without names, what is passed over, mistakes in words.
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/stress/looks.h"
#include "canyon/core/stress/subjects.h"
#include "canyon/core/stress/written_file.h"
#include "canyon/core/tables/column_names.h"
#include "canyon/core/tables/rtklib_header.h"
#include "canyon/core/tables/state_table.h"

namespace canyon {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using stress::kEpsilon;
using stress::Looks;
using stress::told_otherwise;
using stress::WrittenFile;

constexpr double kRadians = 3.14159265358979323846 / 180.0;
constexpr double kAxis_m = 6378137.0;

/// Every unit by what it is in SI, and none of another quantity's.
StressFigure units_of_columns() {
  Looks looks;
  using enum Quantity;
  const struct {
    const char* suffix;
    Quantity of;
    double si;
  } all[] = {{"s", kTime, 1},
             {"sec", kTime, 1},
             {"ms", kTime, 0.001},
             {"us", kTime, 0.000001},
             {"ns", kTime, 0.000000001},
             {"rad", kAngle, 1},
             {"deg", kAngle, kRadians},
             {"rad_s", kAngularRate, 1},
             {"rad/s", kAngularRate, 1},
             {"radps", kAngularRate, 1},
             {"rps", kAngularRate, 1},
             {"deg_s", kAngularRate, kRadians},
             {"deg/s", kAngularRate, kRadians},
             {"degps", kAngularRate, kRadians},
             {"dps", kAngularRate, kRadians},
             {"mdps", kAngularRate, kRadians / 1000},
             {"deg_h", kAngularRate, kRadians / 3600},
             {"dph", kAngularRate, kRadians / 3600},
             {"m", kLength, 1},
             {"mm", kLength, 0.001},
             {"cm", kLength, 0.01},
             {"km", kLength, 1000},
             {"m_s", kSpeed, 1},
             {"m/s", kSpeed, 1},
             {"mps", kSpeed, 1},
             {"mm_s", kSpeed, 0.001},
             {"km_h", kSpeed, 1000.0 / 3600},
             {"kmh", kSpeed, 1000.0 / 3600},
             {"kph", kSpeed, 1000.0 / 3600},
             {"m_s2", kAcceleration, 1},
             {"m/s2", kAcceleration, 1},
             {"m/s^2", kAcceleration, 1},
             {"mps2", kAcceleration, 1},
             {"mpss", kAcceleration, 1},
             {"g", kAcceleration, 9.80665},
             {"mg", kAcceleration, 0.00980665},
             {"m2", kArea, 1},
             {"m2_s2", kSpeedSquared, 1}};
  for (const auto& unit : all)
    for (const Quantity of :
         {kTime, kAngle, kAngularRate, kLength, kSpeed, kAcceleration, kArea, kSpeedSquared, kPlain}) {
      const auto found = unit_value(of, unit.suffix);
      looks.right(found.has_value() == (of == unit.of));
      if (found) looks.close(*found, unit.si, 2.0);
    }
  looks.right(column_units().size() == sizeof all / sizeof all[0] && !unit_value(kTime, "h") && !unit_value(kTime, ""));
  for (const auto& [name, factor] : {std::pair{"gx", 1.0}, {"gx*-1", -1.0}, {"gx* 0.05 ", 0.05}, {"gx*1e3", 1e3}})
    looks.right(column_factor(name) == factor);
  for (const char* none : {"gx*", "gx*0", "gx*two", "gx*1e999", "gx*1 2", "gx*nan"}) looks.right(!column_factor(none));
  for (const char* names : {"t_s,x", "sow lat", "A", "x;y"}) looks.right(is_header_line(names));
  for (const char* numbers : {"1.5e-3 -2E+5", "", "1,2;3", "+4 -5."}) looks.right(!is_header_line(numbers));
  return looks.figure();
}

/// Names as a reader knows them, with and without units and factors: the longest that fits; others passed over.
StressFigure names_of_columns() {
  int wrong = 0;
  const KnownColumn known[] = {{"v", Quantity::kSpeed, 3},
                               {"v_x", Quantity::kSpeed, 4},
                               {"lat", Quantity::kAngle, 5, "deg"},
                               {"week", Quantity::kPlain, 6},
                               {"speed", Quantity::kSpeed, 3}};
  const Error at{.file = "f", .line = 2, .key = {}, .what = {}, .expected = {}};
  const auto placed =
      place_columns({"none", " V_kmh * -2", "v_x", "LAT", "week", "week_no", "lat_variance"}, known, at);
  if (!placed.ok() || placed->size() != 4) return {stress::kInfinity, 0.0};
  const auto is = [&](std::size_t i, std::size_t field, int target, double factor, std::string_view unit) {
    const PlacedColumn& c = (*placed)[i];
    wrong +=
        c.field == field && c.target == target && std::abs(c.factor / factor - 1.0) < 4.0 * kEpsilon && c.unit == unit
            ? 0
            : 1;
  };
  is(0, 1, 3, -2.0 / 3.6, "kmh"), is(1, 2, 4, 1.0, ""), is(2, 3, 5, kRadians, ""), is(3, 4, 6, 1.0, "");
  const auto rad = place_columns({"lat_rad"}, known, at);
  wrong += rad.ok() && rad->size() == 1 && (*rad)[0].factor == 1.0 && (*rad)[0].unit == "rad" ? 0 : 1;
  const auto twice = place_columns({"v_m_s", "speed"}, known, at), factor = place_columns({"v*0"}, known, at);
  wrong += !twice.ok() && twice.error().str() == "f:2: two columns for speed, expected one" ? 0 : 1;
  wrong += !factor.ok() && factor.error().str() ==
                               "f:2: column \"v*0\": no factor, expected a number after the star that is not zero"
               ? 0
               : 1;
  const RtklibHeader dates = rtklib_header("  GPST  latitude(deg) longitude(deg)  height(m)   Q  ns   sdn(m)   sde(m)",
                                           "2010/07/01 13:00:00.000   1 2 3 4 5 6 7");
  wrong += dates.columns == "date,clock,lat_deg,lon_deg,h_m,q,-,sd_n_m,sd_e_m" && !dates.utc ? 0 : 1;
  const RtklibHeader weeks = rtklib_header(
      "  UTC  x-ecef(m) y-ecef(m) z-ecef(m) sdu(m) vn(m/s) ve(m/s) vu(m/s) sdvn sdve sdvu age(s)", "1590 392400.0 1 2");
  wrong +=
      weeks.columns == "gps_week,sow,x_m,y_m,z_m,sd_u_m,vn_m_s,ve_m_s,vu_m_s,sd_vn,sd_ve,sd_vu,-" && weeks.utc ? 0 : 1;
  wrong += is_rtklib_header("%  GPST  latitude(deg)") && is_rtklib_header("% x-ecef(m)") && !is_rtklib_header("% none")
               ? 0
               : 1;
  return {1.0 * wrong, 0.0};
}

/// At the equator and 90 degrees east: east is -x, north z, up y. All of a row in those axes; turns of a nose that
/// looks north, up by pitch, and a right side down by roll. Roundings of the radius, of angles 16.
StressFigure axes_of_rows() {
  Looks looks;
  const auto rounded = [&](const auto& found, const auto& exact, double size) {
    looks.near((found - exact).norm(), 0.0, 16.0 * kEpsilon * size);
  };
  const std::string names =
      "gps_week,sow,lat_deg,lon_deg,h_m,sd_n_m,sd_e_m,sd_u_m,vn_kmh,ve_m_s,vd_m_s,sd_vn,sd_ve,"
      "sd_vd,roll_deg,pitch_deg,heading_deg,q,status,offered\n";
  const WrittenFile file(names + "1590,5.000000001,0,90,100,1,2,3,36,20,30,4,5,6,0,0,0,4,single,1\n" +
                         "1590,6,0,90,100,1,2,3,36,20,30,4,5,6,20,0,90,105,x,0\n" +
                         "1590,7,0,90,100,1,2,3,36,20,30,4,5,6,0,10,0,-1,x,2\n" +
                         "1590,8,0,90,100,1,2,3,36,20,30,4,5,6,nan,10,0,2,none,1\n");
  const auto table = read_state_table(file.path());
  if (!table.ok() || table->rows.size() != 4 || !table->has_week || table->local) return {stress::kInfinity, 1.0};
  for (const StateRow& row : table->rows) {
    if (row.solved) rounded(row.p, Vector3d(0.0, kAxis_m + 100.0, 0.0), kAxis_m);
    rounded(row.p_covariance, Matrix3d(Vector3d(4.0, 9.0, 1.0).asDiagonal()), 9.0);
    rounded(row.v, Vector3d(-20.0, -30.0, 10.0), 30.0);
    rounded(row.v_covariance, Matrix3d(Vector3d(25.0, 36.0, 16.0).asDiagonal()), 36.0);
  }
  const StateRow &level = table->rows[0], &banked = table->rows[1], &climbing = table->rows[2], &lost = table->rows[3];
  looks.right(level.t == GpsTime{(1590LL * 604800 + 5) * kNsPerSecond + 1} && level.line == 2 && lost.line == 5);
  Matrix3d R;
  R << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  rounded(level.R->toRotationMatrix(), R, 1.0);
  const double s = std::sin(20.0 * kRadians), c = std::cos(20.0 * kRadians);
  R << -1, 0, 0, 0, s, c, 0, c, -s;
  rounded(banked.R->toRotationMatrix(), R, 1.0);
  const double s10 = std::sin(10.0 * kRadians), c10 = std::cos(10.0 * kRadians);
  R << 0, 1, 0, s10, 0, c10, c10, 0, -s10;
  rounded(climbing.R->toRotationMatrix(), R, 1.0);
  looks.right(!lost.R && !lost.solved && lost.p.hasNaN() && level.solved && level.offered && !banked.offered);
  looks.right(climbing.offered && level.quality == 4 && banked.quality == 0 && climbing.quality == 0 &&
              lost.quality == 2);
  looks.right(level.came == level.t && lost.came == lost.t);
  // In a frame of its own: east, north, up.
  const WrittenFile near(
      "t_ns x_km y_m z_m vx vy vz xx xy xz yy yz zz vxx vxy vxz vyy vyz vzz roll pitch yaw\n"
      "1500000001 0.01 20 30 1 2 3 1 2 3 4 5 6 7 8 9 10 11 12 0 10 90\n"
      "2500000001 0.01 20 30 1 2 3 1 2 3 4 5 6 7 8 9 10 11 12 20 0 0\n");
  const auto local = read_state_table(near.path());
  if (!local.ok() || local->rows.size() != 2 || local->has_week || !local->local) return {stress::kInfinity, 1.0};
  const StateRow& row = local->rows[0];
  looks.right(row.t.ns == 1'500'000'001 && row.v == Vector3d(1.0, 2.0, 3.0));
  rounded(row.p, Vector3d(10.0, 20.0, 30.0), 30.0);
  Matrix3d of_place, of_speed;
  of_place << 1, 2, 3, 2, 4, 5, 3, 5, 6;
  of_speed << 7, 8, 9, 8, 10, 11, 9, 11, 12;
  looks.right(row.p_covariance == of_place && row.v_covariance == of_speed);
  R << c10, 0, -s10, 0, 1, 0, s10, 0, c10;
  rounded(row.R->toRotationMatrix(), R, 1.0);
  R << 0, -c, s, 1, 0, 0, 0, s, c;
  rounded(local->rows[1].R->toRotationMatrix(), R, 1.0);
  return looks.figure();
}

/// Files without names, by how many numbers there are on a line; RTKLIB's, by their date in GPS time and UTC.
StressFigure layouts_of_rows() {
  int wrong = 0;
  const auto first_of = [&](const std::string& text, const std::string& columns = {}) {
    const WrittenFile file(text);
    const auto table = read_state_table(file.path(), columns);
    wrong += table.ok() && table->rows.size() == 1 ? 0 : 1;
    return table.ok() && !table->rows.empty() ? table->rows[0] : StateRow{};
  };
  const auto at = [&](const StateRow& row, std::int64_t week, double sow_s) {
    wrong += row.t == GpsTime::from_week_sow(static_cast<int>(week), sow_s) ? 0 : 1;
    wrong += (row.p - Vector3d(kAxis_m + 7.0, 0.0, 0.0)).norm() < 1e-8 ? 0 : 1;
  };
  const StateRow seven = first_of("5.5 0 0 7 1 2 3\n");
  at(seven, 0, 5.5);
  wrong += (seven.p_covariance.diagonal() - Vector3d(9.0, 4.0, 1.0)).norm() < 1e-13 ? 0 : 1;
  const StateRow eight = first_of("5.5 6378144 0 0 0 0 0.6 0.8\n");
  at(eight, 0, 5.5);
  wrong += eight.R && std::abs(eight.R->z() - 0.6) + std::abs(eight.R->w() - 0.8) < 1e-15 ? 0 : 1;
  const StateRow eleven = first_of("1590 5.5 0 0 7 1 2 3 0 0 0\n");
  at(eleven, 1590, 5.5);
  wrong += (eleven.v - Vector3d(-3.0, 2.0, 1.0)).norm() < 1e-14 && eleven.R ? 0 : 1;
  const StateRow thirteen = first_of("5.5;0;0;7;1;2;3;4;5;6;7;8;9\n");
  at(thirteen, 0, 5.5);
  wrong += (thirteen.v - Vector3d(-6.0, 5.0, 4.0)).norm() < 1e-14 ? 0 : 1;
  wrong += (thirteen.v_covariance.diagonal() - Vector3d(81.0, 64.0, 49.0)).norm() < 1e-13 ? 0 : 1;
  at(first_of("1590 5.5 0 0 7\n", "week,sow,lat_deg,lon_deg,h_m"), 1590, 5.5);
  at(first_of("a b c d e\n1590 5.5 0 0 7\n", "week,sow,lat_deg,lon_deg,h_m"), 1590, 5.5);
  at(first_of("5.5 0 0 7 1 2 3\n", "kf_gins_gnss"), 0, 5.5);
  const std::string names = " latitude(deg) longitude(deg) height(m) Q ns\n";
  at(first_of("% program : RTKLIB\n%  GPST " + names + "2010/07/01 13:00:59.250 0 0 7 5 8\n"), 1590, 392459.25);
  at(first_of("%  UTC " + names + "2010/07/01 13:00:59.250 0 0 7 5 8\n"), 1590, 392474.25);
  const StateRow weeks = first_of("%  GPST " + names + "1590 392459.25 0 0 7 5 8\n");
  at(weeks, 1590, 392459.25);
  wrong += weeks.quality == 5 && weeks.line == 2 ? 0 : 1;
  return {1.0 * wrong, 0.0};
}

/// Rows of a time that has been, and of nothing: counted, and left out; kept where lateness is allowed. Of two in the
/// wrong order the one ahead goes.
StressFigure rows_passed_over() {
  int wrong = 0;
  const WrittenFile file(
      "t,x,y,z\n1,1,1,1\n2,1,1,1\n2,2,2,2\n,3,3,3\n3,nan,1,1\n99,4,4,4\n4,5,5,5\n3.5,6,6,6\n5,7,7,7\n");
  const auto strict = read_state_table(file.path()), late = read_state_table(file.path(), {}, 0.75);
  if (!strict.ok() || !late.ok()) return {stress::kInfinity, 0.0};
  const auto is = [&](const StateTable& table, const std::vector<std::pair<double, double>>& rows) {
    wrong += table.rows.size() == rows.size() ? 0 : 1;
    for (std::size_t i = 0; i < rows.size() && i < table.rows.size(); ++i)
      wrong += table.rows[i].t == GpsTime{} + rows[i].first && table.rows[i].p.x() == rows[i].second ? 0 : 1;
  };
  is(*strict, {{1, 1}, {2, 1}, {3.5, 6}, {5, 7}});
  is(*late, {{1, 1}, {2, 1}, {2, 2}, {3.5, 6}, {4, 5}, {5, 7}});
  const auto counts = [&wrong](const PassedOver& over, std::size_t not_finite, std::size_t duplicates,
                               std::size_t reversed) {
    wrong += over.not_finite.count == not_finite && over.duplicates.count == duplicates &&
                     over.reversed.count == reversed && over.all() == not_finite + duplicates + reversed
                 ? 0
                 : 1;
  };
  counts(strict->passed_over, 2, 1, 2);
  counts(late->passed_over, 2, 0, 1);
  const Occurrences& back = strict->passed_over.reversed;
  wrong += back.line == 8 && back.t_s == 4.0 && back.after_s == 99.0 ? 0 : 1;
  wrong += late->rows[3].came == GpsTime{} + 4.0 && late->rows[4].came == GpsTime{} + 4.0 ? 0 : 1;
  return {1.0 * wrong, 0.0};
}

/// Each mistake with its line, what it is and what was expected.
StressFigure mistakes_of_tables() {
  int wrong = 0;
  const auto told = [&](const std::string& text, const std::string& words) {
    wrong += told_otherwise(
        text, [](const std::string& path) { return read_state_table(path); }, words);
  };
  const std::string expected =
      ", expected a time (sow or t_s) and a place (lat_deg,lon_deg,h_m or x_m,y_m,z_m) among the columns";
  told("", ": holds no solutions, expected at least one line of numbers");
  told("# only this\nt,x,y,z\n", ": holds no solutions, expected at least one line of numbers");
  told("\nx,y,z\n", ":2: no time among the columns" + expected);
  told("t,x,y\n", ":1: no place among the columns" + expected);
  told("date,lat,lon,h\n", ":1: no time among the columns" + expected);
  told("1 2 3\n",
       ":1: 3 columns without a header, expected a header of names, or 7, 8, 11 or 13 columns as of KF-GINS and TUM");
  told("t,x,y,z\n1,2,3\n", ":2: 3 fields, expected 4 or more");
  told("t,x,y,z\n1,2,3,four\n", ":2: \"four\" is not a finite number, expected a number");
  told("t_ns,x,y,z\n1e5,2,3,4\n", ":2: \"1e5\" is no time, expected whole nanoseconds");
  told("t_ms,x,y,z\n1e13,2,3,4\n", ":2: \"1e13\" is no time, expected seconds");
  told("week,t,x,y,z\n1.5,1,2,3,4\n", ":2: GPS week 1.5, expected a whole number from 0 to 14000");
  told("week,t,x,y,z\n14001,1,2,3,4\n", ":2: GPS week 14001, expected a whole number from 0 to 14000");
  told("t,lat,lon,h\n\n#\n1,90.1,0,0\n", ":4: latitude 90.1, expected degrees from -90 to 90");
  told("t,lat,lon,h\n1,90,-361,0\n", ":2: longitude -361, expected degrees from -360 to 360");
  told("t,lat,lon,h\n1,90,0,2e9\n", ":2: height 2e9, expected metres from -1e9 to 1e9");
  told("t,x,y,z\n1,0,-2e9,0\n", ":2: a place beyond 1e9 m, expected metres");
  told("t,x,y,z,vx,vy,vz\n1,0,0,0,4e8,0,0\n", ":2: a velocity of more than 3e8 m/s, expected m/s");
  told("t,x,y,z,qw,qx,qy,qz\n1,0,0,0,1.02,0,0,0\n", ":2: a quaternion of another norm than 1, expected norm 1");
  told("t,x,y,z\n1,0,0,0\n2,7e6,0,0\n", ":2: a place in another frame than those of other lines, expected one frame");
  told("date,clock,x,y,z\n2010/07/01,24:00:00,0,0,0\n",
       ":2: \"2010/07/01 24:00:00\" is no time, expected YYYY/MM/DD HH:MM:SS");
  for (const char* day : {"1979/12/31", "2251/01/01", "2010/13/01", "2010/00/01", "2010/01/32", "2010/01/00"})
    told(std::string("date,clock,x,y,z\n") + day + ",00:00:00,0,0,0\n",
         std::string(":2: \"") + day + " 00:00:00\" is no time, expected YYYY/MM/DD HH:MM:SS");
  return {1.0 * wrong, 0.0};
}

}  // namespace

std::vector<StressCase> state_table_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "units and axes of a table's columns",
           "a degree for a radian, north for east, a nose up that looks down, a variance of the other axis",
           "SI by definition; rows at 0 N, 90 E written out, where axes are those of E: roundings", "of the bound"});
  rows.add("tables/units_of_columns", units_of_columns).add("tables/axes_of_rows", axes_of_rows);
  rows.of({StressGroup::kData, "tables of solutions in many layouts, and their mistakes",
           "a name that begins like another, a column beside the one that is meant, a row too many or in disorder",
           "written-out rows, and each mistake word by word with its line: exact", "wrong"});
  rows.add("tables/names_of_columns", names_of_columns)
      .add("tables/layouts_of_rows", layouts_of_rows)
      .add("tables/rows_passed_over", rows_passed_over)
      .add("tables/mistakes", mistakes_of_tables);
  return rows.take();
}

}  // namespace canyon
