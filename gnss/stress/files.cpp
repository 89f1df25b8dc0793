// Products of analysis centres as text and back.
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "canyon/core/output/printed.h"
#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/gnss/products/almanac_file.h"
#include "canyon/gnss/products/antex_file.h"
#include "canyon/gnss/products/clock_datum.h"
#include "canyon/gnss/products/clock_file.h"
#include "canyon/gnss/products/ionex_file.h"
#include "canyon/gnss/products/precise_orbits.h"
#include "canyon/gnss/satellites/sun.h"
#include "canyon/gnss/satellites/system_constants.h"
#include "canyon/gnss/signal.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

using Eigen::Vector3d;
using stress::kEpsilon;
using stress::kInfinity;
using stress::Worst;

const GpsTime kStart = GpsTime::from_calendar(2010, 7, 1, 0, 0, 0.0);

/// "  2010  7  1  0 15  0.00000000" of an instant counted as GPS time.
std::string words_of(GpsTime t, const char* seconds = "%11.8f") {
  const auto day_s = (t - kStart) - 86400.0 * std::floor((t - kStart) / 86400.0);
  const int day = 1 + static_cast<int>(std::floor((t - kStart) / 86400.0));
  const int hour = static_cast<int>(day_s / 3600.0), minute = static_cast<int>(day_s / 60.0) % 60;
  return printed("  2010  7 %2d %2d %2d ", day, hour, minute) + printed(seconds, std::fmod(day_s, 60.0));
}

/// The label of a header line, from column 61 on.
std::string labelled(std::string line, const std::string& label) {
  line.resize(60, ' ');
  return line + label + "\n";
}

const SatelliteId kG7{GnssSystem::kGps, 7}, kE3{GnssSystem::kGalileo, 3}, kR5{GnssSystem::kGlonass, 5};

/// SP3 of the built-in satellites: each number as it was written, km to a millimetre and microseconds to a picosecond,
/// times of four scales as GPS time. Left out are positions of nothing, inside the Earth and beyond 100 000 km, clocks
/// that are not known, epochs said twice, and what comes after the end.
StressFigure sp3(const char* scale, double ahead_s) {
  const auto orbits = make_nominal("GE");
  std::string text =
      "#cV2010  7  1  0  0  0.00000000       8 ORBIT IGS05 HLM  IGS\n## 1590 345600.00000000   900.00000000 55378 "
      "0.0000000000000\n";
  text += printed("%%c M  cc %s ccc cccc cccc cccc cccc ccccc ccccc ccccc ccccc\n", scale);
  const auto row = [](char kind, SatelliteId sv, const Vector3d& x, double fourth, const char* flags = "") {
    std::string line = printed("%c%s%14.6f%14.6f%14.6f%14.6f", kind, sv.str().c_str(), x.x(), x.y(), x.z(), fourth);
    if (*flags != '\0') line.resize(74, ' ');
    return line + flags + "\n";
  };
  constexpr int kCount = 8;
  for (int k = 0; k < kCount; ++k) {
    const GpsTime t = kStart + 900.0 * k;
    text += "*" + words_of(t) + "\n";
    for (const SatelliteId sv : {kG7, kE3}) {
      const auto state = orbits->state(sv, t);
      text += row('P', sv, 1e-3 * state->p_E, sv == kE3 && k == 4 ? 999999.999999 : 10.0 + 0.25 * k,
                  sv == kG7 && k == 5 ? "E   M" : "");
      if (sv == kG7) text += row('V', sv, 10.0 * state->v_E, 0.0);
    }
    const SatelliteId none{GnssSystem::kGps, static_cast<std::uint8_t>(9 + k)};
    const double radius_km =
        std::array{0.0, 1.0, 6399.9, 1e5 + 0.1, 5e5, 6300.0, 6390.0, 2e5}[static_cast<std::size_t>(k)];
    text += row('P', none, {0.0, radius_km, 0.0}, 1.0);
    if (k == 6) text += row('P', kG7, {20000.0, 0.0, 0.0}, 1.0);
  }
  text += "EOF\n*" + words_of(kStart + 900.0 * kCount) + "\n" + row('P', kG7, {20000.0, 0.0, 0.0}, 1.0);
  const auto found = parse_sp3_file(text, "made.sp3");
  if (!found || found->satellites.size() != 2) return {kInfinity, 1.0};
  Worst worst;
  worst.look(found->interval_s - 900.0, 1e-9);
  for (const auto& [sv, samples] : found->satellites) {
    worst.look(samples.size() == kCount ? 0.0 : kInfinity, 1.0);
    for (std::size_t k = 0; k < samples.size(); ++k) {
      const PreciseSample& s = samples[k];
      const GpsTime written = kStart + 900.0 * static_cast<double>(k);
      const auto state = orbits->state(sv, written);
      worst.look((s.t - written) - ahead_s, 1e-9);
      worst.look((s.p_E - state->p_E).cwiseAbs().maxCoeff<Eigen::PropagateNaN>(), 0.5e-3 + 64.0 * kEpsilon * 4e7);
      const bool unknown = sv == kE3 && k == 4;
      worst.look(unknown == std::isnan(s.clock_s) ? 0.0 : kInfinity, 1.0);
      if (!unknown) worst.look(s.clock_s - 1e-6 * (10.0 + 0.25 * static_cast<double>(k)), 1e-12 * 1e-3);
      worst.look(s.v_E.has_value() == (sv == kG7) ? 0.0 : kInfinity, 1.0);
      if (s.v_E) worst.look((*s.v_E - state->v_E).cwiseAbs().maxCoeff<Eigen::PropagateNaN>(), 0.5e-7 + 1e-11);
      worst.look(s.clock_event == (sv == kG7 && k == 5) && s.manoeuvre == (sv == kG7 && k == 5) ? 0.0 : kInfinity, 1.0);
    }
  }
  // Five of them cannot be; one is said twice.
  worst.look(found->warnings.size() >= 7 ? 0.0 : kInfinity, 1.0);
  return worst.figure();
}

/// A clock file of a quadratic clock: samples as written, straight lines between them, nothing across a gap, beside it,
/// or of another satellite. 1e-12 s as written; between samples the quadratic's h^2 / 8.
StressFigure clocks() {
  std::string text = labelled("     3.00           CLOCK DATA", "RINEX VERSION / TYPE") +
                     labelled("   GPS", "TIME SYSTEM ID") + labelled("", "END OF HEADER");
  const auto clock_s = [](double t_s) { return 1e-4 + 1e-11 * t_s + 1e-16 * t_s * t_s; };
  for (int k = 0; k < 40; ++k) {
    if (k == 17) continue;
    const double t_s = 30.0 * k;
    for (const SatelliteId sv : {kG7, kR5})
      text += "AS " + sv.str() + " " + words_of(kStart + t_s, "%9.6f").substr(1) + "  1   " +
              printed("%19.12E", (sv == kR5 ? -1.0 : 1.0) * clock_s(t_s)) + "\n";
    text += "AR ALGO" + words_of(kStart + t_s, "%9.6f").substr(1) + "  1    0.123456789012E-03\n";
  }
  const auto found = parse_clock_file(text, "made.clk");
  if (!found || found->satellites.size() != 2) return {kInfinity, 1.0};
  Worst worst;
  worst.look(found->interval_s - 30.0, 1e-9);
  const double written = 0.5e-12 * 1e-4 + 1e-18;
  for (double t_s = 0.0; t_s <= 39.0 * 30.0; t_s += 7.5) {
    const double of_g = found->clock_s(kG7, kStart + t_s), of_r = found->clock_s(kR5, kStart + t_s);
    if (t_s > 16.0 * 30.0 && t_s < 18.0 * 30.0) {
      worst.look(std::isnan(of_g) && std::isnan(of_r) ? 0.0 : kInfinity, 1.0);
      continue;
    }
    worst.look(of_g - clock_s(t_s), written + 1e-16 * 30.0 * 30.0 / 4.0);
    worst.look(of_g + of_r, 1e-300);
  }
  worst.look(std::isnan(found->clock_s(kG7, kStart + -0.001)) ? 0.0 : kInfinity, 1.0);
  worst.look(std::isnan(found->clock_s(kG7, kStart + 39.0 * 30.0 + 0.001)) ? 0.0 : kInfinity, 1.0);
  worst.look(std::isnan(found->clock_s(kE3, kStart)) ? 0.0 : kInfinity, 1.0);
  return worst.figure();
}

/// ANTEX whose patterns are linear in zenith angle and azimuth, so that they are the same between the columns, to the
/// hundredth of a millimetre that is written; beyond the last column its value, and a turn is none.
StressFigure antennas() {
  const auto value_mm = [](double zenith_deg, double azimuth_deg) {
    return 0.1 * zenith_deg + 0.02 * azimuth_deg - 3.0;
  };
  const auto numbers = [&](const std::string& head, double last, double step, const auto& of) {
    std::string line = head;
    line.resize(8, ' ');
    for (double z = 0.0; z <= last + 1e-9; z += step) line += printed("%8.2f", of(z));
    return line + "\n";
  };
  const auto frequency = [&](const char* code, double last, double step, bool azimuths, double offset_mm) {
    std::string out =
        labelled(printed("   %s", code), "START OF FREQUENCY") +
        labelled(printed("%10.2f%10.2f%10.2f", offset_mm, offset_mm + 1.0, offset_mm + 80.0), "NORTH / EAST / UP");
    out += numbers("   NOAZI", last, step, [&](double z) { return value_mm(z, 180.0); });
    for (double a = 0.0; azimuths && a <= 360.0; a += 30.0)
      out += numbers(printed("%8.1f", a), last, step, [&](double z) { return value_mm(z, a); });
    return out + labelled(printed("   %s", code), "END OF FREQUENCY");
  };
  const auto antenna = [&](const std::string& type, double last, double step, bool azimuths, const std::string& more) {
    return labelled("", "START OF ANTENNA") + labelled(type, "TYPE / SERIAL NO") +
           labelled(printed("  %6.1f", azimuths ? 30.0 : 0.0), "DAZI") +
           labelled(printed("  %6.1f%6.1f%6.1f", 0.0, last, step), "ZEN1 / ZEN2 / DZEN") + more +
           frequency("G01", last, step, azimuths, 10.0) + frequency("G02", last, step, azimuths, -20.0) +
           labelled("", "END OF ANTENNA");
  };
  const std::string receiver = "TRM29659.00     NONE",
                    satellite = "BLOCK IIR-M         G07                 G048      2008-012A ";
  const auto file = [&](const char* version) {
    return labelled(printed("%8s            M", version), "ANTEX VERSION / SYST") + labelled("", "END OF HEADER") +
           antenna(receiver, 90.0, 5.0, true, "") +
           antenna(satellite, 14.0, 1.0, false,
                   labelled(words_of(kStart, "%13.7f"), "VALID FROM") +
                       labelled(words_of(kStart + 86400.0 * 9, "%13.7f"), "VALID UNTIL"));
  };
  for (const char* version : {"1.2", "1.5", "2.0", "14.0", "-1.4"})
    if (parse_antex_file(file(version), "made.atx")) return {kInfinity, 1.0};
  if (!parse_antex_file(file("1.3"), "made.atx")) return {kInfinity, 1.0};
  const auto found = parse_antex_file(file("1.4"), "made.atx");
  if (!found || found->antennas.size() != 2 || !found->warnings.empty()) return {kInfinity, 1.0};
  Worst worst;
  const Antenna *ground = found->receiver("TRM29659.00"), *space = found->satellite(kG7, kStart + 86400.0);
  const bool named = ground != nullptr && space != nullptr && found->receiver("TRM29659.00     NONE") == ground &&
                     found->receiver("TRM29659.00     SCIT") == ground && found->receiver("TRM9") == nullptr &&
                     found->satellite(kG7, kStart + -1.0) == nullptr && found->satellite(kE3, kStart) == nullptr &&
                     found->satellite(kG7, kStart + 86400.0 * 9 + 1.0) == nullptr;
  if (!named) return {kInfinity, 1.0};
  const double ulp_m = 0.005e-3 * 1.001;
  for (double z = 0.0; z <= 100.0; z += 2.5)
    for (double a = -360.0; a < 720.0; a += 12.5) {
      const double turned = a - 360.0 * std::floor(a / 360.0);
      worst.look(
          ground->pattern("G01")->variation_m(z * kDegree, a * kDegree) - 1e-3 * value_mm(std::min(z, 90.0), turned),
          ulp_m);
      worst.look(space->pattern("G02")->variation_m(0.2 * z * kDegree, a * kDegree) -
                     1e-3 * value_mm(std::min(0.2 * z, 14.0), 180.0),
                 ulp_m);
    }
  worst.look((ground->pattern("G02")->offset_m - Vector3d(-0.020, -0.019, 0.060)).norm(), 8.0 * kEpsilon);
  worst.look(ground->pattern("G05") == nullptr ? 0.0 : kInfinity, 1.0);

  // From the centre of mass: z to the Earth, y across the Sun, the combination 2.546 of the first less 1.546 of the
  // second.
  const double f1 = 154.0, f2 = 120.0, first = f1 * f1 / (f1 * f1 - f2 * f2);
  const Vector3d offset_m = first * space->pattern("G01")->offset_m + (1.0 - first) * space->pattern("G02")->offset_m;
  for (const Vector3d& p : {Vector3d(2e7, 1e7, 1.2e7), Vector3d(-1e7, 2e7, -1.3e7)}) {
    const Vector3d found_m = satellite_offset_E(*space, p, kStart), z = -p.normalized(), sun = sun_direction_E(kStart);
    worst.look(found_m.norm() - offset_m.norm(), 32.0 * kEpsilon);
    worst.look(found_m.dot(z) - offset_m.z(), 32.0 * kEpsilon);
    worst.look(found_m.dot(z.cross(sun).normalized()) - offset_m.y(), 64.0 * kEpsilon);
    // x lies on the Sun's side.
    worst.look(z.cross(sun).normalized().cross(z).dot(sun) > 0.0 ? 0.0 : kInfinity, 1.0);
  }
  return worst.figure();
}

/// The two-frequency combination: it takes the ionosphere's 1 / f^2 out, and leaves ranges.
StressFigure combination() {
  Worst worst;
  for (const GnssSystem system :
       {GnssSystem::kGps, GnssSystem::kGalileo, GnssSystem::kBeidou, GnssSystem::kQzss, GnssSystem::kGlonass}) {
    const BandPair bands = precise_clock_bands(system);
    const CombinationWeights w = ionosphere_free(system, bands);
    const double f1 = carrier_hz(system, bands.first), f2 = carrier_hz(system, bands.second);
    worst.look(w.first + w.second - 1.0, 8.0 * kEpsilon);
    worst.look((w.first / (f1 * f1) + w.second / (f2 * f2)) * f1 * f1, 32.0 * kEpsilon);
    std::array<double, 10> delays{};
    for (std::size_t i = 0; i < 10; ++i) delays[i] = 1e-9 * static_cast<double>(i * i);
    const double expected = w.first * delays[static_cast<std::size_t>(bands.first)] +
                            w.second * delays[static_cast<std::size_t>(bands.second)];
    worst.look(delay_of_precise_clock_s(system, delays) - (system == GnssSystem::kGlonass ? 0.0 : expected),
               1e-9 * 64.0 * kEpsilon);
  }
  return worst.figure();
}

/// IONEX maps of a function that is bilinear in latitude and the longitude that stands still below the Sun: between
/// the points and the maps it is itself, to the tenth of a unit that is written.
StressFigure maps() {
  const auto value = [](double lat_deg, double sun_deg) {
    return 20.0 + 0.1 * lat_deg + 0.05 * std::abs(std::remainder(sun_deg, 360.0));
  };
  std::string text =
      labelled("     1.0            IONOSPHERE MAPS", "IONEX VERSION / TYPE") + labelled("     2", "MAP DIMENSION") +
      labelled("  6371.0", "BASE RADIUS") + labelled("   450.0 450.0   0.0", "HGT1 / HGT2 / DHGT") +
      labelled("    87.5 -87.5  -2.5", "LAT1 / LAT2 / DLAT") + labelled("  -180.0 180.0   5.0", "LON1 / LON2 / DLON") +
      labelled("    -1", "EXPONENT") + labelled("", "END OF HEADER");
  for (int m = 0; m < 3; ++m) {
    // Epochs are UTC; GPS time was 15 s ahead. Two hours are 30 degrees, six columns.
    text += labelled(printed("%6d", m + 1), "START OF TEC MAP");
    text += labelled(printed("  2010     7     1 %5d     0     0", 2 * m), "EPOCH OF CURRENT MAP");
    for (double lat = 87.5; lat >= -87.5; lat -= 2.5) {
      text += labelled(printed("  %6.1f%6.1f%6.1f%6.1f%6.1f", lat, -180.0, 180.0, 5.0, 450.0), "LAT/LON1/LON2/DLON/H");
      std::string line;
      for (int i = 0; i < 73; ++i) {
        line += printed("%5.0f", 10.0 * value(lat, -180.0 + 5.0 * i + 30.0 * m));
        if (i % 16 == 15 || i == 72) text += line + "\n", line.clear();
      }
    }
    text += labelled(printed("%6d", m + 1), "END OF TEC MAP");
  }
  text += labelled("", "END OF FILE");
  const auto found = parse_ionex_file(text, "made.ionex");
  if (!found || found->maps.size() != 3 || found->latitudes != 71 || found->longitudes != 73) return {kInfinity, 1.0};
  Worst worst;
  worst.look(found->base_radius_m - 6371e3 + (found->shell_height_m - 450e3), 1e-6);
  for (const double hours : {0.0, 0.7, 2.0, 3.9, 4.0})
    for (double lat = -87.5; lat <= 87.5; lat += 3.5)
      for (double lon = -190.0; lon < 540.0; lon += 12.5) {
        const double sun_deg = lon + 15.0 * hours, kink = std::min(std::abs(std::remainder(sun_deg, 360.0)),
                                                                   180.0 - std::abs(std::remainder(sun_deg, 360.0)));
        if (kink < 5.0) continue;  // where the function bends within a column
        worst.look(found->vtec_tecu(lat * kDegree, lon * kDegree, kStart + 15.0 + 3600.0 * hours) - value(lat, sun_deg),
                   0.05 * 1.0001);
      }
  for (const double hours : {-0.001, 4.001})
    worst.look(std::isnan(found->vtec_tecu(0.0, 0.0, kStart + 15.0 + 3600.0 * hours)) ? 0.0 : kInfinity, 1.0);
  worst.look(
      found->vtec_tecu(89.9 * kDegree, 0.3, kStart + 3600.0) - found->vtec_tecu(87.5 * kDegree, 0.3, kStart + 3600.0),
      1e-12);
  return worst.figure();
}

/// An almanac of both formats: the same orbits, each element as it was written (semicircles of SEM to 1e-14), at the
/// turn of weeks that is nearest; records that cannot be are left out.
StressFigure almanac(int turns) {
  const int week = 590 + 1024 * turns;
  const GpsTime near = GpsTime::from_week_sow(week, 100000.0);
  std::string yuma, sem = "2 CURRENT.ALM\n" + printed("%d 319488\n\n", week % 1024);
  for (const auto& [prn, e] : {std::pair{7, 0.0123}, {9, 1.2}}) {
    yuma +=
        printed("******** Week %d almanac for PRN-%02d ********\n", week % 1024, prn) +
        printed("ID:                         %02d\n", prn) + "Health:                     000\n" +
        printed("Eccentricity:               %.10E\n", e) + "Time of Applicability(s):  319488.0000\n" +
        printed("Orbital Inclination(rad):   %.10f\n", 0.96) + printed("Rate of Right Ascen(r/s):  %.10E\n", -8e-9) +
        printed("SQRT(A)  (m 1/2):           %.6f\n", 5153.6) + printed("Right Ascen at Week(rad):   %.10E\n", 1.25) +
        printed("Argument of Perigee(rad):   %.9f\n", -0.75) + printed("Mean Anom(rad):             %.10E\n", 2.5) +
        printed("Af0(s):                     %.10E\n", 1e-4) + printed("Af1(s/s):                   %.10E\n", -2e-12) +
        printed("week:                        %d\n\n", week % 1024);
    sem += printed("%d\n48\n0\n %.14E %.14E %.14E\n %.14E %.14E %.14E\n %.14E %.14E %.14E\n0\n11\n\n", prn, e,
                   0.96 / kPi - 0.30, -8e-9 / kPi, 5153.6, 1.25 / kPi, -0.75 / kPi, 2.5 / kPi, 1e-4, -2e-12);
  }
  Worst worst;
  for (const std::string& text : {yuma, sem}) {
    const auto found = parse_almanac_file(text, "made.alm", near);
    if (!found || found->kepler.size() != 1 || found->warnings.size() != 1) return {kInfinity, 1.0};
    const KeplerEphemeris& k = found->kepler[0];
    worst.look(k.sv == kG7 && k.health == 0 ? 0.0 : kInfinity, 1.0);
    worst.look(k.toe - GpsTime::from_week_sow(week, 319488.0), 1e-9);
    for (const auto& [x, expected] : {std::pair{k.e, 0.0123},
                                      {k.i0_rad, 0.96},
                                      {k.sqrt_a, 5153.6},
                                      {k.omega0_rad, 1.25},
                                      {k.argument_of_perigee_rad, -0.75},
                                      {k.m0_rad, 2.5},
                                      {k.af0_s, 1e-4},
                                      {k.af1, -2e-12},
                                      {k.omega_dot_rad_s, -8e-9}})
      worst.look(x - expected, 1e-13 * std::max(std::abs(expected), 0.1));
  }
  return worst.figure();
}

}  // namespace

std::vector<StressCase> file_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "a product's text and back",
           "columns off by one, a unit of the line before, a time scale, a record that cannot be taken for one",
           "each number as it was written, to its last decimal; interpolated functions that interpolation keeps",
           "of the bound"});
  rows.add("files/sp3_in_gps_time", [] { return sp3("GPS", 0.0); })
      .add("files/sp3_in_beidou_time", [] { return sp3("BDT", 14.0); })
      .add("files/sp3_in_utc", [] { return sp3("UTC", 15.0); })
      .add("files/sp3_in_tai", [] { return sp3("TAI", -19.0); })
      .add("files/clocks", clocks)
      .add("files/antennas", antennas)
      .add("files/ionosphere_maps", maps);
  for (const int turns : {0, 1, 2})
    rows.add("files/almanac_of_turn_" + std::to_string(turns), [turns] { return almanac(turns); });
  rows.of({StressGroup::kGeometry, "the two-frequency combination of each system", "weights of the other band",
           "no ionosphere and whole ranges, to 32 eps", "of the bound"});
  rows.add("files/combination_of_bands", combination);
  return rows.take();
}

}  // namespace canyon::gnss
